//! Standard deviations that are larger than their values, and so in another unit.

use super::options::{ReadOptions, Weights};
use super::part::Part;
use super::raw::{RawScan, Row, Weight};
use crate::error::Error;
use crate::number::shortest;

/// Refuses deviations of which most are larger than their values, unless an option names their column.
///
/// # Errors
/// They may be percent, with the option that settles it.
pub fn doubt(scan: &RawScan, options: &ReadOptions) -> Result<(), Error> {
    let named = |part: &Part| matches!(part, Part::Sigma | Part::RelativeSigma | Part::PercentSigma);
    if options.weights == Weights::Equal || options.columns.iter().any(|(part, _)| named(part)) {
        return Ok(());
    }
    let quantity = options.quantity.unwrap_or(scan.quantity);
    let is_linear = quantity.is_logarithm().is_none();
    let is_larger = |row: &&Row| match row.weight {
        Weight::Sigma(sigma) => is_linear && row.value > 0.0 && sigma > row.value,
        Weight::RelativeSigma(sigma) => sigma > 1.0,
        _ => false,
    };
    let larger = || scan.rows.iter().filter(is_larger);
    let Some(first) = larger().next().filter(|_| 2 * larger().count() > scan.rows.len()) else {
        return Ok(());
    };
    let what = match first.weight {
        Weight::RelativeSigma(sigma) => format!(
            "most relative standard deviations are larger than 1, such as {}: are they percent?",
            shortest(sigma)
        ),
        Weight::Sigma(sigma) => format!(
            "most standard deviations are larger than their values, such as {} of {}: are they percent?",
            shortest(sigma),
            shortest(first.value)
        ),
        _ => return Ok(()),
    };
    let column = scan.places.weight;
    let number = column.map_or("N".to_string(), |column| column.to_string());
    let error = Error::new(what).help(format!(
        "say --columns percent_sigma={number} if so, take them as they are with --columns sigma={number} or rel_sigma={number}, or leave them out with --weights equal"
    ));
    Err(error.at(first.line, column))
}

#[cfg(test)]
mod tests {
    use super::super::{ReadOptions, parse, part};

    #[test]
    fn percent_without_a_sign_is_asked_for() {
        let rows = "20,-40,0.1,S\n20,0,0.2,S\n20,40,3.5,S\n";
        let read = |name: &str, sigma: &str, columns: &str| {
            let text = format!("theta_i,theta_s,brdf,{name}\n{}", rows.replace('S', sigma));
            let options = ReadOptions {
                columns: columns
                    .split_terminator(',')
                    .map(|one| part::parse(one).unwrap())
                    .collect(),
                ..ReadOptions::default()
            };
            parse("scan.csv", text.as_bytes(), &options).map(|scans| scans[0].sigma_ln)
        };
        for name in ["std", "uncertainty", "rel_sigma", "u"] {
            let error = read(name, "2", "").unwrap_err();
            let line = error.to_string();
            assert_eq!((error.line, error.column), (Some(2), Some(4)), "{line}");
            assert!(line.contains("--columns percent_sigma=4"), "{line}");
            let sigma = read(name, "2", "percent_sigma=4").unwrap();
            assert!(sigma.is_some_and(|sigma| (sigma - 0.02).abs() < 1e-12), "{sigma:?}");
            assert!(read(name, "2", "sigma=4").is_ok() && read(name, "0.02", "").is_ok());
        }
        assert!(read("u (%)", "2", "").is_ok() && read("sigma", "0.15", "").is_ok());
    }
}
