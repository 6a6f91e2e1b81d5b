//! The weight of a row, from what the file says of its uncertainty.

use crate::input::options::{ReadOptions, Weights};
use crate::input::raw::{Row, Weight};
use crate::input::units::Quantity;
use crate::input::weight::{Deviation, Source};
use crate::number::shortest;

/// Where a weight is from, and what the file says of the value's standard deviation.
pub(super) type Known = (Source, Deviation);

const UNIT: Known = (
    Source::Unit,
    Deviation {
        absolute: 0.0,
        relative: 0.0,
    },
);

/// The weight of a row, not normalised, and where it is from.
pub(super) fn weight(row: &Row, quantity: Quantity, options: &ReadOptions, brdf: f64) -> Result<(f64, Known), String> {
    let known = match options.weights {
        Weights::File => row.weight,
        Weights::Equal => Weight::Unknown,
    };
    let sigma = match known {
        Weight::Unknown => return Ok((1.0, UNIT)),
        Weight::Factor(factor) if factor >= 0.0 && factor.is_finite() => return Ok((factor, UNIT)),
        Weight::Own(factor, deviation) if factor >= 0.0 && factor.is_finite() => {
            return Ok((factor, (Source::Unit, deviation)));
        }
        Weight::Factor(factor) | Weight::Own(factor, _) => {
            return Err(format!(
                "the weight is {}, and must be a number from 0 on",
                shortest(factor)
            ));
        }
        Weight::RelativeSigma(sigma) => sigma,
        Weight::Sigma(sigma) => match quantity.is_logarithm() {
            Some(factor) => sigma * factor,
            None => sigma / row.value,
        },
    };
    let whole = (sigma * sigma + options.sigma_floor * options.sigma_floor).sqrt();
    if sigma >= 0.0 && whole >= f64::MIN_POSITIVE && whole.is_finite() {
        let is_absolute = matches!(known, Weight::Sigma(_)) && quantity.is_logarithm().is_none();
        let deviation = if is_absolute {
            Deviation {
                absolute: sigma * brdf,
                relative: options.sigma_floor,
            }
        } else {
            Deviation {
                absolute: 0.0,
                relative: whole,
            }
        };
        Ok((1.0 / whole, (Source::Sigma, deviation)))
    } else {
        let (name, number) = match known {
            Weight::Sigma(sigma) => ("the standard deviation", sigma),
            _ => ("the relative standard deviation", sigma),
        };
        let what = format!("{name} is {}, which gives no weight", shortest(number));
        Err(what + " (--sigma-floor 0.01 or --weights equal would)")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Error;
    use crate::input::left_out::Reason;
    use crate::input::{Measurement, parse};

    fn read(text: &str, options: &ReadOptions) -> Result<Measurement, Error> {
        parse("scan.csv", text.as_bytes(), options).map(|mut scans| scans.remove(0))
    }

    #[test]
    fn weights_are_normalised() {
        let text = "theta_i,theta_s,brdf,sigma\n45,1,2,0.2\n45,2,1,0.05\n60,3,1,0.1\n";
        let scan = read(text, &ReadOptions::default()).unwrap();
        let sigma_ln = [0.1, 0.05, 0.1];
        let unit = scan.sigma_ln.unwrap();
        for (sample, sigma) in scan.samples.iter().zip(sigma_ln) {
            assert!((sample.weight * sigma / unit - 1.0).abs() < 1e-15);
        }
        let mean = scan
            .samples
            .iter()
            .map(|sample| sample.weight * sample.weight)
            .sum::<f64>()
            / 3.0;
        assert!((mean - 1.0).abs() < 1e-15 && scan.read_as.weighted);
        let equal = ReadOptions {
            weights: Weights::Equal,
            ..ReadOptions::default()
        };
        let scan = read(text, &equal).unwrap();
        assert!(scan.samples.iter().all(|sample| sample.weight == 1.0));
        assert_eq!((scan.sigma_ln, scan.read_as.weighted), (None, false));
        let by_angle = ReadOptions {
            weight_angle: vec![(60.0, 0.0), (45.0, 3.0)],
            ..equal
        };
        let scan = read(text, &by_angle).unwrap();
        assert_eq!((scan.samples.len(), scan.samples[0].weight), (2, 1.0));
        assert_eq!(scan.left_out[0].reason, Reason::NoWeight);
    }

    #[test]
    fn a_standard_deviation_of_zero_is_refused() {
        let text = "theta_i,theta_s,brdf,sd\n45,1,2,0.2\n45,2,1,0\n";
        let error = read(text, &ReadOptions::default()).unwrap_err();
        assert_eq!((error.line, error.column), (Some(3), Some(4)));
        assert!(error.what.contains("--sigma-floor"), "{error}");
        let floor = ReadOptions {
            sigma_floor: 0.1,
            ..ReadOptions::default()
        };
        let scan = read(text, &floor).unwrap();
        let ratio = scan.samples[1].weight / scan.samples[0].weight;
        assert!((ratio - 2f64.sqrt()).abs() < 1e-15);
    }
}
