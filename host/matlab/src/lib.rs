//! What the MEX links: the functions of the C interface, and one of the program's library, for errors that account for residuals which are alike along the angle.

// For its C functions.
use brdfit_capi as _;

use brdfit::analysis::fit::known;
use brdfit::analysis::misfit::coverage_factor;
use brdfit::engine::uncertainty::Uncertainty;
use brdfit::engine::{FitOptions, Model, Outcome, Values, fit_from};
use brdfit::input::Measurement;
use brdfit::input::weight::{self, Deviation};
use brdfit_core::geometry::Sample;

/// Numbers of a sample: theta_i, theta_s and delta_phi in radians, BRDF in sr^-1, weight.
const SAMPLE: usize = 5;
/// Parameters of the models that the C interface has.
const PARAMETERS: usize = 6;
/// Numbers that are written: standard errors, correlations, and five more.
const KNOWN: usize = PARAMETERS + PARAMETERS * PARAMETERS + 5;

/// What was asked of the search.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    /// Seed of the candidates.
    pub seed: u64,
    /// Largest number of candidates; 0 for the usual one.
    pub candidates: u32,
    /// A sum of BRDFIT_DIFFUSE and others.
    pub terms: u32,
    /// 0 for Eq. 14, else GGX.
    pub ggx: u32,
    /// 0 for weights that are none of standard deviations.
    pub sigma: u32,
}

/// Writes what the program knows of the fit `x` of these samples: 6 standard errors, 6 x 6 correlations, standard errors that are the half of a 95 % interval, effective degrees of freedom, the angle in degrees over which residuals are correlated (NaN if they are not), and the least and the largest factor by which that raises errors.
///
/// With standard deviations the weights are 1 over those of ln f. Returns 0, or 1 if there is no fit.
///
/// # Safety
/// `samples` has `5 * count` numbers, `lower`, `upper` and `x` have 6 each, and `to` has room for 47.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_matlab_known(
    samples: *const f64,
    count: usize,
    asked: &Asked,
    lower: &[f64; PARAMETERS],
    upper: &[f64; PARAMETERS],
    x: &[f64; PARAMETERS],
    to: &mut [f64; KNOWN],
) -> i32 {
    // SAFETY: the caller's.
    let numbers = unsafe { std::slice::from_raw_parts(samples, SAMPLE * count) };
    let Some(uncertainty) = uncertainty(numbers, asked, [*lower, *upper], *x) else {
        return 1;
    };
    write(&uncertainty, to);
    0
}

/// None if there is no fit.
fn uncertainty(
    numbers: &[f64],
    asked: &Asked,
    [lower, upper]: [[f64; PARAMETERS]; 2],
    x: [f64; PARAMETERS],
) -> Option<Uncertainty> {
    let options = FitOptions {
        seed: asked.seed,
        starts: (asked.candidates > 0).then_some(asked.candidates),
        terms: u8::try_from(asked.terms).ok()?,
        lower: Values::from(lower),
        upper: Values::from(upper),
        ..FitOptions::of(Model::find(if asked.ggx == 0 { "beckmann" } else { "ggx" })?)
    };
    let sample = |row: &[f64]| Sample {
        theta_i: row[0],
        theta_s: row[1],
        delta_phi: row[2],
        brdf: row[3],
        weight: row[4],
    };
    let mut samples: Vec<Sample<f64>> = numbers.chunks_exact(SAMPLE).map(sample).collect();
    let deviation = |sample: &Sample<f64>| Deviation {
        absolute: sample.brdf / sample.weight,
        relative: 0.0,
    };
    let deviations = samples.iter().map(deviation).filter(|_| asked.sigma != 0).collect();
    let sigma_ln = (asked.sigma != 0).then(|| weight::normalised(&mut samples));
    let measurement = Measurement {
        deviations,
        ..Measurement::of_samples("samples", samples, sigma_ln)
    };
    let outcome = fit_from(&measurement.samples, &options, &[Values::from(x)]).ok()?;
    let (Outcome { uncertainty, .. }, _) = known(&measurement, &measurement.samples, &options, outcome);
    Some(uncertainty)
}

fn write(known: &Uncertainty, to: &mut [f64; KNOWN]) {
    let correlations = known.correlation.iter().flat_map(|row| row.iter());
    let (length, factor) = known.misfit.map_or((f64::NAN, (1.0, 1.0)), |misfit| {
        (misfit.length.to_degrees(), misfit.factor)
    });
    let more = [coverage_factor(known), known.effective, length, factor.0, factor.1];
    let all = known.stderr.iter().chain(correlations).chain(&more);
    to.iter_mut().zip(all).for_each(|(to, from)| *to = *from);
}
