//! The search of one scan, over whatever gives its passes.

pub mod beside;
pub mod calibration;
pub mod joint;
pub mod nuisance;
pub mod offset;
pub mod scaled;
pub mod settled;
pub mod setup;
pub mod watched;

use brdfit_core::geometry::Sample;
use brdfit_core::lm::{self, Bounds, Options, Stop};
use brdfit_core::model::Parameter;
use brdfit_core::real::Real;
use brdfit_core::search::{self, Found, Scene};

use crate::error::FitError;
use crate::instrument::View;
use crate::layout::Layout;
use crate::options::{FitOptions, Method};
use crate::outcome::{Minimum, Outcome};
use crate::passes::Kernel;
use crate::threads;
use crate::uncertainty::{self, NEAR_ZERO};
use crate::until::Watched;
use crate::values::Values;
use beside::{Beside, Rows};
use nuisance::Nuisance;
use settled::Settled;
use setup::Setup;

/// Refuses fewer samples and priors than free parameters.
pub(crate) fn enough(samples: &[Sample<f64>], options: &FitOptions) -> Result<(), FitError> {
    let free = options.free().count();
    if samples.len() + options.prior_count() < free {
        return Err(FitError::TooFew(samples.len(), free));
    }
    Ok(())
}

pub(crate) fn descend_from<const P: usize>(
    scene: &Kernel<f64, P>,
    own: &[Parameter; P],
    samples: &[Sample<f64>],
    options: &FitOptions,
    setup: &Setup,
    starts: &[Values],
) -> Result<Option<(f64, Values)>, FitError> {
    let layout = Layout::new(own, options.model);
    let bounds = layout.bounds::<f64>(options);
    let rows = Rows::new(&layout, options, setup, samples);
    let beside = Beside { scene, rows: &rows };
    let scene = &Watched {
        scene: if rows.is_empty() { scene } else { &beside },
        until: options.until,
    };
    let ends = starts
        .iter()
        .map(|start| lm::fit(scene, &bounds, layout.coordinates(start), &Options::default()));
    let finite = ends.filter(|fit| fit.at.cost.is_finite());
    let best = finite.min_by(|a, b| a.at.cost.total_cmp(&b.at.cost));
    if options.until.is_over() {
        return Err(FitError::Interrupted);
    }
    Ok(best.map(|best| (best.at.cost - rows.costs(&best.x).1, layout.values(&best.x))))
}

/// A scene for one thread: searches are compiled for this type alone.
pub(crate) fn single<'a, R, const P: usize>(scene: &'a Kernel<'a, R, P>) -> &'a (dyn Scene<R, P> + 'a) {
    scene
}

/// The search of one scan; `exact` is the same scan in `f64`.
pub(crate) fn run<R: Real, const P: usize>(
    scene: &Kernel<R, P>,
    exact: &Kernel<f64, P>,
    own: &[Parameter; P],
    samples: &[Sample<f64>],
    options: &FitOptions,
    setup: &Setup,
    known: &[Values],
) -> Result<Outcome, FitError> {
    let layout = Layout::new(own, options.model);
    let rows = Rows::new(&layout, options, setup, samples);
    let beside = Beside { scene, rows: &rows };
    let scene = &Watched {
        scene: if rows.is_empty() { scene } else { &beside },
        until: options.until,
    };
    let bounds: Bounds<R, P> = layout.bounds(options);
    let lm = Options::default();
    let starts = options.starts();
    let known: Vec<[R; P]> = known.iter().map(|values| layout.coordinates(values)).collect();
    let found: Found<R, P> = match options.method {
        Method::Default => search::search_from(single(scene), &bounds, options.seed, starts, &known, &lm),
        Method::Paper => {
            let own = starts as usize;
            let fits = threads::try_each(own + known.len(), &|i| match i.checked_sub(own) {
                // A million starts that end at once take seconds too.
                _ if options.until.is_over() => Err(FitError::Interrupted),
                None => Ok(search::paper_fit(single(scene), &bounds, options.seed, i as u64, &lm)),
                Some(k) => Ok(lm::fit(single(scene), &bounds, known[k], &lm)),
            })?;
            search::paper(single(scene), &bounds, fits, &lm)
        }
    };
    if options.until.is_over() {
        return Err(FitError::Interrupted);
    }
    let count = samples.len() as f64;
    let mse2 = |cost: R| cost.f64() / (count * count);
    let minima: Vec<Minimum> = found
        .minima
        .as_slice()
        .iter()
        .map(|minimum| Minimum {
            mse2: mse2(minimum.cost),
            params: layout.values(&minimum.x),
            hits: minimum.hits,
            first_start: minimum.first_start,
        })
        .collect();
    let best = found.best;
    let on_bound = |k: &usize| {
        let (lower, upper) = (bounds.lower[*k], bounds.upper[*k]);
        lower < upper && (best.x[*k] == lower || best.x[*k] == upper)
    };
    let counted = samples.iter().filter(|sample| sample.weight != 0.0).count();
    let x64 = best.x.map(R::f64);
    let (priors, limit) = rows.costs(&x64);
    let cost = best.at.cost.f64() - limit;
    let view = options.view(layout.values(&best.x));
    let nuisance = setup.nuisance.then(|| {
        // Derivatives by the coordinates from those by the parameters; at kappa = 0 both have theirs a little above.
        let mut near = x64;
        if let Some(kappa) = layout.squared().filter(|&kappa| x64[kappa] == 0.0) {
            near[kappa] = NEAR_ZERO * NEAR_ZERO;
        }
        let slopes = layout.slopes(&near);
        let of = View {
            material: view.material.off_zero(),
            ..view
        };
        let row = |gradient: Values| {
            std::array::from_fn(|k| match slopes[k] {
                0.0 => 0.0,
                slope => gradient[layout.places[k]] * slope,
            })
        };
        Nuisance::new(samples, &view, |sample| {
            of.gradient(sample).map_or([0.0; P], |(_, all)| row(all))
        })
    });
    let known = Settled {
        scene: exact,
        rows: &rows,
        nuisance,
    };
    let known: &Kernel<f64, P> = if rows.is_empty() && !setup.nuisance {
        exact
    } else {
        &known
    };
    let counted = counted + rows.prior_count() - usize::from(setup.nuisance);
    let box64 = Bounds {
        lower: bounds.lower.map(R::f64),
        upper: bounds.upper.map(R::f64),
    };
    Ok(Outcome {
        model: options.model,
        terms: options.terms & options.model.terms,
        uncertainty: uncertainty::at(known, &x64, &box64, &layout, options, counted),
        samples: samples.len(),
        cost,
        mse2: (cost - priors) / (count * count),
        rms_ln: ((cost - priors) / count).sqrt(),
        params: layout.values(&best.x),
        at_bound: (0..P).filter(on_bound).map(|k| own[k].name).collect(),
        stop: best.stop.unwrap_or(Stop::Passes),
        minima,
        improvement_potential: found.minima.improvement_potential().f64(),
        evaluations: found.evaluations,
        robust: None,
        prior_cost: priors,
        sigma: None,
        aperture: options.instrument.aperture,
        offset: None,
    })
}
