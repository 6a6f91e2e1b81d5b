//! Runs the passes over a scan on the widest vectors that the processor has; the bits do not depend on it.

use brdfit_core::lm::{Bounds, Linearization, Problem};
use brdfit_core::microfacet::Microfacet;
use brdfit_core::model::Model;
use brdfit_core::real::Real;
use brdfit_core::residuals::Residuals;
use brdfit_core::search::{Candidate, Region, Scene};
pub use pulp::NullaryFnOnce;

use crate::threads;

/// A set of vector instructions.
#[derive(Clone, Copy, Debug)]
pub enum Simd {
    /// What every processor of the target has.
    Portable,
    /// AVX2.
    #[cfg(target_arch = "x86_64")]
    V3(pulp::x86::V3),
    /// AVX-512.
    #[cfg(target_arch = "x86_64")]
    V4(pulp::x86::V4),
}

impl Simd {
    /// Those that this processor has, slowest first.
    pub fn available() -> Vec<Simd> {
        #[allow(unused_mut)]
        let mut list = vec![Simd::Portable];
        #[cfg(target_arch = "x86_64")]
        {
            list.extend(pulp::x86::V3::try_new().map(Simd::V3));
            list.extend(pulp::x86::V4::try_new().map(Simd::V4));
        }
        list
    }

    /// The fastest that this processor has.
    pub fn best() -> Simd {
        Simd::available().pop().unwrap_or(Simd::Portable)
    }

    /// The next fewer instructions, for passes that are not compiled for these.
    pub fn fewer(self) -> Simd {
        match self {
            #[cfg(target_arch = "x86_64")]
            Simd::V4(_) => pulp::x86::V3::try_new().map_or(Simd::Portable, Simd::V3),
            _ => Simd::Portable,
        }
    }

    /// Runs a computation with these instructions, as far as it is compiled into [`NullaryFnOnce::call`].
    #[inline(always)]
    pub fn run<F: NullaryFnOnce>(self, computation: F) -> F::Output {
        match self {
            #[cfg(target_arch = "x86_64")]
            Simd::V4(simd) => simd.vectorize(computation),
            #[cfg(target_arch = "x86_64")]
            Simd::V3(simd) => simd.vectorize(computation),
            Simd::Portable => computation.call(),
        }
    }

    /// `portable`, `avx2` or `avx512`.
    pub fn name(self) -> &'static str {
        match self {
            Simd::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Simd::V3(_) => "avx2",
            #[cfg(target_arch = "x86_64")]
            Simd::V4(_) => "avx512",
        }
    }
}

impl PartialEq for Simd {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

/// No vectors: passes go lane by lane.
pub const SCALAR: u8 = 0;
/// Vectors in double precision: AVX2, or what every processor has where that is not of x86-64.
pub const AVX2: u8 = 1;
/// Those of every processor, and in double precision AVX2 and AVX-512 too.
pub const AVX512: u8 = 2;
/// All of them in single precision as well.
pub const EVERY: u8 = 3;

/// A scan whose passes use `simd`, as far as `VECTORS` has them compiled: [`SCALAR`], [`AVX2`], [`AVX512`] or [`EVERY`].
///
/// Each set of instructions takes time to compile, so only Eq. 14 has all: instruments that fit in single precision run their own build.
#[derive(Debug)]
pub struct FastScan<'a, R, M, const P: usize, const C: usize = 6, const VECTORS: u8 = EVERY> {
    /// The observations.
    pub scan: Residuals<'a, R, M, P, C>,
    /// The instructions.
    pub simd: Simd,
}

/// The same for `TERMS` of Eq. 14.
pub type FastEq14<'a, R, const TERMS: u8, const P: usize> = FastScan<'a, R, Microfacet<TERMS>, P>;

/// The pass of both [`Problem::cost`] and [`Scene::level`].
struct Sums<'a, R, M, const P: usize, const C: usize>(&'a Residuals<'a, R, M, P, C>, &'a [R; P]);
impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> NullaryFnOnce for Sums<'_, R, M, P, C> {
    type Output = [R; 3];
    #[inline(always)]
    fn call(self) -> [R; 3] {
        self.0.inlined_totals(self.1)
    }
}

struct Linearize<'a, R, M, const P: usize, const C: usize>(&'a Residuals<'a, R, M, P, C>, &'a [R; P]);
impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> NullaryFnOnce for Linearize<'_, R, M, P, C> {
    type Output = Linearization<R, P>;
    #[inline(always)]
    fn call(self) -> Linearization<R, P> {
        self.0.inlined_linearize(self.1)
    }
}

struct Weights<'a, R, M, const P: usize, const C: usize>(&'a Residuals<'a, R, M, P, C>, &'a [R; P]);
impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> NullaryFnOnce for Weights<'_, R, M, P, C> {
    type Output = Linearization<R, P>;
    #[inline(always)]
    fn call(self) -> Linearization<R, P> {
        self.0.inlined_weights(self.1)
    }
}

impl<'a, R: Real, M: Model<R, P, C> + Sync, const P: usize, const C: usize, const VECTORS: u8>
    FastScan<'a, R, M, P, C, VECTORS>
{
    const DOUBLE: bool = size_of::<R>() == size_of::<f64>();
    #[cfg(target_arch = "x86_64")]
    const HAS_AVX2: bool = VECTORS == EVERY || VECTORS != SCALAR && Self::DOUBLE;
    #[cfg(target_arch = "x86_64")]
    const HAS_AVX512: bool = VECTORS == EVERY || VECTORS == AVX512 && Self::DOUBLE;
    const HAS_PORTABLE: bool = match VECTORS {
        SCALAR => false,
        AVX2 => Self::DOUBLE && cfg!(not(target_arch = "x86_64")),
        _ => true,
    };

    /// A scan with the instructions that `simd` and the passes of this model have both.
    pub fn new(scan: Residuals<'a, R, M, P, C>, simd: Simd) -> Self {
        #[cfg(target_arch = "x86_64")]
        let simd = match simd {
            Simd::V4(_) if !Self::HAS_AVX512 => simd.fewer(),
            other => other,
        };
        FastScan { scan, simd }
    }

    /// What `of` gives of each part of the scan ([`PART`]), on the threads of the pool, added in order.
    #[inline(always)]
    fn summed<S: Send + Sync>(&self, of: &(dyn Fn(&Residuals<'_, R, M, P, C>) -> S + Sync), add: fn(&mut S, &S)) -> S {
        if self.scan.parts() <= 1 {
            return of(&self.scan);
        }
        threads::sum(self.scan.parts(), &|k| of(&self.scan.part(k)), add)
    }

    fn totals(&self, x: &[R; P]) -> [R; 3] {
        let of = |part: &Residuals<'_, R, M, P, C>| self.run(Sums(part, x), || part.scalar_totals(x));
        self.summed(&of, |sum, part| {
            sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += *part);
        })
    }

    /// A pass with vectors, or lane by lane where there are none.
    #[inline(always)]
    fn run<F: NullaryFnOnce>(&self, pass: F, scalar: impl FnOnce() -> F::Output) -> F::Output {
        match self.simd {
            #[cfg(target_arch = "x86_64")]
            Simd::V4(simd) if const { Self::HAS_AVX512 } => simd.vectorize(pass),
            #[cfg(target_arch = "x86_64")]
            Simd::V3(simd) if const { Self::HAS_AVX2 } => simd.vectorize(pass),
            _ if const { Self::HAS_PORTABLE } => pass.call(),
            _ => scalar(),
        }
    }
}

impl<R: Real, M: Model<R, P, C> + Sync, const P: usize, const C: usize, const VECTORS: u8> Problem<R, P>
    for FastScan<'_, R, M, P, C, VECTORS>
{
    fn cost(&self, x: &[R; P]) -> R {
        self.totals(x)[0]
    }
    fn linearize(&self, x: &[R; P]) -> Linearization<R, P> {
        let of = |part: &Residuals<'_, R, M, P, C>| self.run(Linearize(part, x), || part.scalar_linearize(x));
        self.summed(&of, Linearization::add_part)
    }
    fn bend(&self, x: &[R; P], step: &[R; P], to: [R; P]) -> [R; P] {
        self.scan.bend(x, step, to)
    }
}

impl<R: Real, M: Model<R, P, C> + Sync, const P: usize, const C: usize, const VECTORS: u8> Scene<R, P>
    for FastScan<'_, R, M, P, C, VECTORS>
{
    fn propose(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, region: Region<R, P>) -> Candidate<R, P> {
        self.scan.propose(bounds, seed, i, region)
    }
    fn weigh(&self, bounds: &Bounds<R, P>, candidate: &mut Candidate<R, P>) {
        self.scan.weigh_by(bounds, candidate, |x| {
            let of = |part: &Residuals<'_, R, M, P, C>| self.run(Weights(part, x), || part.scalar_weights(x));
            self.summed(&of, Linearization::add_part)
        });
    }
    fn level(&self, bounds: &Bounds<R, P>, x: &[R; P]) -> ([R; P], R) {
        Residuals::<R, M, P, C>::levelled(bounds, x, self.totals(x))
    }
    fn apart(&self, x: &[R; P], y: &[R; P], factor: R) -> bool {
        self.scan.apart(x, y, factor)
    }
}
