//! Are results of the fit that a proof would be about?

use brdfit_core::geometry::Sample;
use serde_json::Value;

use crate::analysis::fit::FittedScan;
use crate::engine::{FitOptions, Material, robust};
use crate::error::Error;
use crate::input::Measurement;
use crate::number::shortest;
use crate::page::results::StoredFit;
use crate::result::json::provenance::provenance;
use crate::terms::term_names;

const HELP: &str = "give certify the options of the fit";

/// Refuses results of which a proof of `fitted`, the fit of the same scan with the options given here, would not be one.
///
/// # Errors
/// Another model, other terms, wider bounds or bounds that exclude their parameters, other samples or weights, or an instrument.
pub(super) fn same(stored: &StoredFit, measurement: &Measurement, fitted: &FittedScan) -> Result<(), Error> {
    let Ok(material) = &stored.material else {
        return Ok(());
    };
    same_model(stored, material, &fitted.options)?;
    if let Some(told) = &stored.told {
        same_options(told, measurement, &fitted.options)?;
    }
    same_samples(stored, material, &robust::kept(&measurement.samples, &fitted.outcome))
}

/// Of what every result tells: model, terms, and parameters within the bounds.
fn same_model(stored: &StoredFit, material: &Material, options: &FitOptions) -> Result<(), Error> {
    if material.model != options.model {
        let name = material.model.name;
        return Err(Error::new(format!("the results are of the model {name}"))
            .help(format!("only --model {} has a proof", options.model.name)));
    }
    if let Some(terms) = stored.terms.filter(|terms| *terms != options.terms) {
        let names = term_names(terms).join(",");
        return Err(Error::new(format!("the results are of the terms {names}")).help(format!("give --terms {names}")));
    }
    for place in options.present() {
        let (name, value) = (options.model.parameters[place].name, material.values[place]);
        if !(options.lower[place] <= value && value <= options.upper[place]) {
            return Err(Error::new(format!(
                "{name} is {} in the results, outside its bounds",
                shortest(value)
            ))
            .help("give the --bounds and --fix of the fit"));
        }
    }
    Ok(())
}

/// Of what JSON tells: what was said about the file, what took part in the fit, and bounds, which may be narrower here.
fn same_options(told: &Value, measurement: &Measurement, options: &FitOptions) -> Result<(), Error> {
    let here = serde_json::to_value(provenance(&measurement.about, Some(options))).unwrap_or_default();
    for part in ["read_options", "robust", "instrument"] {
        let (then, now) = (&told[part], &here[part]);
        if then != now {
            let name = part.replace('_', " ");
            return Err(Error::new(format!("{name}: {} in the results, {} here", words(then), words(now))).help(HELP));
        }
    }
    for place in options.present() {
        let name = options.model.parameters[place].name;
        let bound = |end: usize| told["bounds"][name][end].as_f64();
        let (Some(lower), Some(upper)) = (bound(0), bound(1)) else {
            continue;
        };
        if lower > options.lower[place] || upper < options.upper[place] {
            let (lower, upper) = (shortest(lower), shortest(upper));
            return Err(
                Error::new(format!("{name} was held between {lower} and {upper} in the results"))
                    .help("give the --bounds and --fix of the fit"),
            );
        }
    }
    Ok(())
}

fn words(told: &Value) -> String {
    match told {
        Value::Null => "none".into(),
        Value::Object(members) if members.is_empty() => "none".into(),
        other => other.to_string(),
    }
}

/// Costs that differ by more than this part are of other samples, weights, or of an instrument; a fit in `f32` may leave less.
const OTHER: f64 = 1e-3;
/// Below this mean square of residuals a fit is exact, and its cost is rounding.
const ROUNDING: f64 = 1e-10;

/// Of what tables tell too: how many samples the fit had, and the MSE^2 that its parameters have with them.
fn same_samples(stored: &StoredFit, material: &Material, samples: &[Sample<f64>]) -> Result<(), Error> {
    let count = samples.len() as f64;
    if let Some(before) = stored.samples.filter(|before| *before != count) {
        let what = format!("{} samples in the results, {} here", shortest(before), shortest(count));
        return Err(Error::new(what).help(HELP));
    }
    let squares = samples
        .iter()
        .filter_map(|sample| material.residual(sample))
        .map(|r| r * r);
    let here = squares.sum::<f64>() / (count * count);
    match stored.mse2 {
        Some(before) if (before - here).abs() > OTHER * before.max(here) && before.max(here) * count > ROUNDING => {
            let (before, here) = (shortest(before), shortest(here));
            let what = format!("the MSE^2 is {before} in the results, and their parameters have {here} here");
            Err(Error::new(what).help(HELP))
        }
        _ => Ok(()),
    }
}
