//! What the MEX links: the functions of the C interface, and of the program's library the program itself, weights by standard deviations, and errors that account for residuals which are alike along the angle.

mod program;

// For its C functions.
use brdfit_capi as _;

use brdfit::analysis::choose::Wanted;
use brdfit::analysis::deviations::settled;
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
    /// What [`brdfit_matlab_weighted`] has returned; 0 for weights that are none of standard deviations.
    pub sigma_ln: f64,
}

impl Asked {
    fn options(&self, [lower, upper]: [[f64; PARAMETERS]; 2]) -> Option<FitOptions> {
        Some(FitOptions {
            seed: self.seed,
            starts: (self.candidates > 0).then_some(self.candidates),
            terms: u8::try_from(self.terms).ok()?,
            lower: Values::from(lower),
            upper: Values::from(upper),
            ..FitOptions::of(Model::find(if self.ggx == 0 { "beckmann" } else { "ggx" })?)
        })
    }
}

fn sample(row: &[f64]) -> Sample<f64> {
    Sample {
        theta_i: row[0],
        theta_s: row[1],
        delta_phi: row[2],
        brdf: row[3],
        weight: row[4],
    }
}

/// Gives samples, whose weights are standard deviations over BRDF, the weights and ln f that the program fits: of standard deviations over the fitted f, and without what noise takes from ln f.
///
/// Returns the standard deviation of ln f that a weight of 1 stands for.
///
/// # Safety
/// `samples` has `5 * count` numbers; `lower` and `upper` have 6 each.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_matlab_weighted(
    samples: *mut f64,
    count: usize,
    asked: &Asked,
    lower: &[f64; PARAMETERS],
    upper: &[f64; PARAMETERS],
) -> f64 {
    // SAFETY: the caller's.
    let numbers = unsafe { std::slice::from_raw_parts_mut(samples, SAMPLE * count) };
    let given = numbers.chunks_exact(SAMPLE).map(sample);
    let deviation = |sample: Sample<f64>| Deviation {
        absolute: sample.weight * sample.brdf,
        relative: 0.0,
    };
    let deviations = given.clone().map(deviation).collect();
    let over = |sample: Sample<f64>| Sample {
        weight: 1.0 / sample.weight,
        ..sample
    };
    let mut samples: Vec<Sample<f64>> = given.map(over).collect();
    let sigma_ln = weight::normalised(&mut samples);
    let mut measurement = Measurement {
        deviations,
        ..Measurement::of_samples("samples", samples, Some(sigma_ln))
    };
    // What cannot be fitted is told by the search.
    if let Some(options) = asked.options([*lower, *upper]) {
        measurement = settled(measurement, &Wanted::One(options));
    }
    for (row, sample) in numbers.chunks_exact_mut(SAMPLE).zip(&measurement.samples) {
        row[3] = sample.brdf;
        row[4] = sample.weight;
    }
    measurement.sigma_ln.unwrap_or(sigma_ln)
}

/// Writes what the program knows of the fit `x` of these samples: 6 standard errors, 6 x 6 correlations, standard errors that are the half of a 95 % interval, effective degrees of freedom, the angle in degrees over which residuals are correlated (NaN if they are not), and the least and the largest factor by which that raises errors.
///
/// Returns 0, or 1 if there is no fit.
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
    bounds: [[f64; PARAMETERS]; 2],
    x: [f64; PARAMETERS],
) -> Option<Uncertainty> {
    let options = asked.options(bounds)?;
    let samples = numbers.chunks_exact(SAMPLE).map(sample).collect();
    let sigma_ln = (asked.sigma_ln != 0.0).then_some(asked.sigma_ln);
    let measurement = Measurement::of_samples("samples", samples, sigma_ln);
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
