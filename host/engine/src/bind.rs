//! The searches over the passes of one model: where the types of a model end and its values at run time begin.
//!
//! Only the passes are compiled for each model; a search sees them through one dynamic call a pass, and is compiled once for each number of parameters.

use brdfit_core::geometry::Sample;
use brdfit_core::model::{Model, Parameter};
use brdfit_core::real::Real;

use crate::averaged::Averaged;
use crate::compiled::{Compiled, Found, Joint, Searches, Sets};
use crate::error::FitError;
use crate::options::{FitOptions, Precision};
use crate::outcome::Outcome;
use crate::passes::{Both, Kernel, blocks_of, scene};
use crate::search::joint;
use crate::search::setup::Setup;
use crate::search::watched::{self, Trace};
use crate::search::{self, enough};
use crate::simd::Simd;
use crate::until::Until;
use crate::values::Values;

/// Makes a scan of samples, and does something with it.
type Point<R, const P: usize> = fn(&[Sample<f64>], Simd, Then<R, P>) -> Result<(), FitError>;
/// Makes a scan through an aperture of some half-angle from that without it, as long as that is wanted, and does something with it.
type Through<const P: usize> = fn(&Kernel<f64, P>, &[Sample<f64>], (f64, Until), Then<f64, P>) -> Result<(), FitError>;
/// What is done with a scan.
type Then<'a, R, const P: usize> = &'a mut dyn FnMut(&Kernel<R, P>);

/// A model with `P` parameters, whatever its type.
struct Bound<const P: usize> {
    own: &'static [Parameter; P],
    double: Point<f64, P>,
    single: Point<f32, P>,
    /// If that is compiled.
    through: Option<Through<P>>,
}

/// `VECTORS` says for which instructions, as in [`crate::simd::FastScan`].
const fn bound<M: Both<P, C>, const P: usize, const C: usize, const VECTORS: u8>() -> Bound<P> {
    Bound {
        own: &<M as Model<f64, P, C>>::PARAMETERS,
        double: point::<f64, M, P, C, VECTORS>,
        single: point::<f32, M, P, C, VECTORS>,
        through: None,
    }
}

/// Model `M` with all its terms, and the `sets` of them that are compiled on their own.
pub(crate) const fn searches<M: Both<P, C>, const P: usize, const C: usize, const VECTORS: u8>(
    sets: &'static [Compiled],
) -> Sets {
    Sets {
        whole: const {
            &Bound {
                through: Some(through::<M, P, C>),
                ..bound::<M, P, C, VECTORS>()
            }
        },
        sets,
    }
}

/// A set of terms on its own.
pub(crate) const fn set<M: Both<P, C>, const P: usize, const C: usize, const VECTORS: u8>(terms: u8) -> Compiled {
    Compiled {
        terms,
        searches: const { &bound::<M, P, C, VECTORS>() },
    }
}

fn point<R: Real, M: Model<R, P, C> + Send + Sync, const P: usize, const C: usize, const VECTORS: u8>(
    samples: &[Sample<f64>],
    simd: Simd,
    then: Then<R, P>,
) -> Result<(), FitError> {
    let blocks = blocks_of::<R, M, P, C>(samples)?;
    then(&scene::<R, M, P, C, VECTORS>(&blocks, simd));
    Ok(())
}

fn through<M: Both<P, C>, const P: usize, const C: usize>(
    point: &Kernel<f64, P>,
    samples: &[Sample<f64>],
    (half_angle, until): (f64, Until),
    then: Then<f64, P>,
) -> Result<(), FitError> {
    then(&Averaged::new::<M>(point, samples, half_angle, until)?);
    Ok(())
}

/// What `then` makes of the samples as `point` has them compiled.
fn with<R: Real, T, const P: usize>(
    point: Point<R, P>,
    samples: &[Sample<f64>],
    options: &FitOptions,
    then: impl Fn(&Kernel<R, P>) -> Result<T, FitError>,
) -> Result<T, FitError> {
    let mut made = Err(FitError::Interrupted);
    // Of a list of models those that are left end here, before a million samples are compiled, or room is made for as many starts.
    if !options.until.is_over() {
        point(samples, options.simd, &mut |scan| made = then(scan))?;
    }
    made
}

impl<const P: usize> Bound<P> {
    /// The same as the detector of `options` sees them.
    fn seen<T>(
        &self,
        samples: &[Sample<f64>],
        options: &FitOptions,
        then: impl Fn(&Kernel<f64, P>) -> Result<T, FitError>,
    ) -> Result<T, FitError> {
        let aperture = options.instrument.aperture;
        let Some(through) = self.through.filter(|_| aperture > 0.0) else {
            return with(self.double, samples, options, then);
        };
        with(self.double, samples, options, |point| {
            let mut made = Err(FitError::Interrupted);
            through(point, samples, (aperture, options.until), &mut |scan| made = then(scan))?;
            made
        })
    }

    /// The joint fit of all scans, the first of which are `before`.
    fn joint_after(
        &self,
        before: &[&Kernel<f64, P>],
        all: &[&[Sample<f64>]],
        shared: &[bool],
        options: &FitOptions,
    ) -> Joint {
        let place = before.len();
        let Some(samples) = all.get(place) else {
            return joint::run(before, self.own, shared, options, all);
        };
        let found = self.seen(samples, options, |scan| {
            Ok(self.joint_after(&[before, &[scan]].concat(), all, shared, options))
        });
        // An interruption is of no scan.
        let of = |error| match error {
            FitError::Interrupted => all.len(),
            _ => place,
        };
        found.map_err(|error| (of(error), error))?
    }
}

impl<const P: usize> Searches for Bound<P> {
    fn fit(
        &self,
        samples: &[Sample<f64>],
        options: &FitOptions,
        setup: &Setup,
        known: &[Values],
    ) -> Result<Outcome, FitError> {
        enough(samples, options)?;
        self.seen(samples, options, |exact| match options.precision {
            Precision::F32 if options.instrument.aperture == 0.0 => with(self.single, samples, options, |scene| {
                search::run(scene, exact, self.own, samples, options, setup, known)
            }),
            _ => search::run(exact, exact, self.own, samples, options, setup, known),
        })
    }

    fn descend(
        &self,
        samples: &[Sample<f64>],
        options: &FitOptions,
        setup: &Setup,
        starts: &[Values],
    ) -> Result<Found, FitError> {
        self.seen(samples, options, |scene| {
            search::descend_from(scene, self.own, samples, options, setup, starts)
        })
    }

    fn trace(&self, samples: &[Sample<f64>], options: &FitOptions) -> Result<Trace, FitError> {
        enough(samples, options)?;
        with(self.double, samples, options, |exact| match options.precision {
            Precision::F64 => Ok(watched::watch(exact, exact, self.own, options)),
            Precision::F32 => with(self.single, samples, options, |scene| {
                Ok(watched::watch(scene, exact, self.own, options))
            }),
        })
    }

    fn joint(&self, all: &[&[Sample<f64>]], shared: &[bool], options: &FitOptions) -> Joint {
        self.joint_after(&[], all, shared, options)
    }
}
