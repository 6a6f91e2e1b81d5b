//! Numbers that stand for no value, such as 9999 and 1e30.

use super::options::ReadOptions;
use super::raw::RawScan;
use super::units::{Angles, Quantity};
use crate::error::Error;
use crate::number::shortest;

/// A BRDF that no surface has: light of 100 nm from a mirror of 1 m goes into 1e-14 sr.
const LARGEST: f64 = 1e15;
/// Smaller numbers that programs write for none, or a converter at its end.
const USUAL: [f64; 9] = [
    999.0,
    9999.0,
    99_999.0,
    999_999.0,
    9_999_999.0,
    32_767.0,
    65_535.0,
    1e10,
    1e12,
];
/// So many times as large as all other values one of these must be, and in so many rows, to be no value for sure.
const ABOVE: f64 = 100.0;
const ROWS: usize = 2;

/// Refuses values among others that stand for none.
///
/// # Errors
/// The first of them, with the option that leaves them out.
pub fn doubt(scan: &RawScan, unit: Angles, options: &ReadOptions) -> Result<(), Error> {
    let quantity = options.quantity.unwrap_or(scan.quantity);
    let wanted = |value: f64| options.max_value.is_none_or(|largest| value < largest);
    let rows = || scan.rows.iter().filter(|row| wanted(row.value));
    let brdf = |value: f64, theta_s: f64| quantity.brdf(value / scan.about.divisor, unit.radians(theta_s));
    let valid = || rows().filter_map(|row| Some((row, brdf(row.value, row.theta_s).ok()?)));
    let too_large = || {
        let others = valid().any(|(_, brdf)| brdf < LARGEST);
        valid().find(|(_, brdf)| *brdf >= LARGEST).filter(|_| others)
    };
    let first = match usual(rows().map(|row| row.value), quantity) {
        Some(mark) => rows().find(|row| row.value == mark),
        None => too_large().map(|(row, _)| row),
    };
    let Some(row) = first else { return Ok(()) };
    let value = shortest(row.value);
    Err(Error::new(format!(
        "the value is {value}, as no surface has: does it stand for none?"
    ))
    .help(format!(
        "leave such values out with --max-value {value}, or take them as they are with --value-unit plain"
    ))
    .at(row.line, scan.places.value))
}

/// The largest of these values, if it is one of [`USUAL`], in several rows, and far above all others.
fn usual(values: impl Iterator<Item = f64> + Clone, quantity: Quantity) -> Option<f64> {
    if quantity.is_logarithm().is_some() {
        return None;
    }
    let most = values.clone().filter(|value| value.is_finite()).fold(0.0, f64::max);
    if !USUAL.contains(&most) || values.clone().filter(|&value| value == most).count() < ROWS {
        return None;
    }
    let others = values.filter(|&value| value < most).fold(0.0, f64::max);
    (others > 0.0 && others * ABOVE <= most).then_some(most)
}

#[cfg(test)]
mod tests {
    use super::super::{ReadOptions, parse};

    #[test]
    fn marks_that_are_repeated_are_refused() {
        let read = |cells: &str, options: &ReadOptions| {
            let cells = cells.split(' ').enumerate();
            let rows: String = cells.map(|(k, cell)| format!("45,{},{cell}\n", k + 1)).collect();
            let text = format!("theta_i,theta_s,brdf\n{rows}");
            parse("scan.csv", text.as_bytes(), options).map(|scans| scans[0].samples.len())
        };
        let plain = ReadOptions::default();
        for (cells, mark) in [
            ("0.1 9999 0.2 9999", "9999"),
            ("0.1 65535 65535 0.2", "65535"),
            ("0.1 1 9.99 999 999 0.2", "999"),
            ("0.1 1e30 0.2", "1e30"),
        ] {
            let error = read(cells, &plain).unwrap_err();
            let help = format!("leave such values out with --max-value {mark},");
            assert!(
                error.column == Some(3) && error.help.as_ref().is_some_and(|text| text.starts_with(&help)),
                "{error}"
            );
            let cut = ReadOptions {
                max_value: mark.parse().ok(),
                ..ReadOptions::default()
            };
            assert_eq!(
                read(cells, &cut).unwrap(),
                cells.split(' ').filter(|cell| *cell != mark).count()
            );
        }
        // Once, near other values, or of another size, it may be a peak.
        for cells in ["0.1 9999 0.2", "0.1 999 999 10", "0.1 9998 9998", "999 999 999"] {
            assert!(read(cells, &plain).is_ok(), "{cells}");
        }
    }
}
