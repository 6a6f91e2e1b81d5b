//! Runs the passes over a scan on the widest vectors that the processor has; the bits do not depend on it.

use brdfit_core::lm::{Bounds, Linearization, Problem};
use brdfit_core::microfacet::Microfacet;
use brdfit_core::model::Model;
use brdfit_core::real::Real;
use brdfit_core::residuals::Residuals;
use brdfit_core::search::{Candidate, Region, Scene};
use pulp::NullaryFnOnce;

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

/// A scan whose passes use `simd`; in single precision without `WIDE` those of every processor.
///
/// Wide vectors of single precision for every model would double the time to compile this crate, and instruments that fit in single precision run their own build.
#[derive(Debug)]
pub struct FastScan<'a, R, M, const P: usize, const C: usize = 6, const WIDE: bool = true> {
    /// The observations.
    pub scan: Residuals<'a, R, M, P, C>,
    /// The instructions.
    pub simd: Simd,
}

/// The same for `TERMS` of Eq. 14.
pub type FastEq14<'a, R, const TERMS: u8, const P: usize> = FastScan<'a, R, Microfacet<TERMS>, P>;

struct Cost<'a, R, M, const P: usize, const C: usize>(&'a Residuals<'a, R, M, P, C>, &'a [R; P]);
impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> NullaryFnOnce for Cost<'_, R, M, P, C> {
    type Output = R;
    #[inline(always)]
    fn call(self) -> R {
        self.0.inlined_cost(self.1)
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

struct Propose<'a, R, M, const P: usize, const C: usize>(
    &'a Residuals<'a, R, M, P, C>,
    &'a Bounds<R, P>,
    u64,
    u64,
    Region<'a, R, P>,
);
impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> NullaryFnOnce for Propose<'_, R, M, P, C> {
    type Output = Candidate<R, P>;
    #[inline(always)]
    fn call(self) -> Candidate<R, P> {
        self.0.inlined_candidate(self.1, self.2, self.3, self.4)
    }
}

struct Level<'a, R, M, const P: usize, const C: usize>(
    &'a Residuals<'a, R, M, P, C>,
    &'a Bounds<R, P>,
    &'a [R; P],
);
impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> NullaryFnOnce for Level<'_, R, M, P, C> {
    type Output = ([R; P], R);
    #[inline(always)]
    fn call(self) -> ([R; P], R) {
        self.0.inlined_level(self.1, self.2)
    }
}

impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize, const WIDE: bool> FastScan<'_, R, M, P, C, WIDE> {
    const VECTORS: bool = WIDE || size_of::<R>() == size_of::<f64>();

    #[inline(always)]
    fn run<F: NullaryFnOnce>(&self, pass: F) -> F::Output {
        match self.simd {
            #[cfg(target_arch = "x86_64")]
            Simd::V3(simd) if const { Self::VECTORS } => simd.vectorize(pass),
            #[cfg(target_arch = "x86_64")]
            Simd::V4(simd) if const { Self::VECTORS } => simd.vectorize(pass),
            _ => pass.call(),
        }
    }
}

impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize, const WIDE: bool> Problem<R, P>
    for FastScan<'_, R, M, P, C, WIDE>
{
    fn cost(&self, x: &[R; P]) -> R {
        self.run(Cost(&self.scan, x))
    }
    fn linearize(&self, x: &[R; P]) -> Linearization<R, P> {
        self.run(Linearize(&self.scan, x))
    }
    fn bend(&self, x: &[R; P], step: &[R; P], to: [R; P]) -> [R; P] {
        self.scan.bend(x, step, to)
    }
}

impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize, const WIDE: bool> Scene<R, P>
    for FastScan<'_, R, M, P, C, WIDE>
{
    fn candidate(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, region: Region<R, P>) -> Candidate<R, P> {
        self.run(Propose(&self.scan, bounds, seed, i, region))
    }
    fn level(&self, bounds: &Bounds<R, P>, x: &[R; P]) -> ([R; P], R) {
        self.run(Level(&self.scan, bounds, x))
    }
    fn apart(&self, x: &[R; P], y: &[R; P], factor: R) -> bool {
        self.scan.apart(x, y, factor)
    }
}
