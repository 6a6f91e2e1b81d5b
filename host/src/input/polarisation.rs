//! Polarisations: their names, and the mean of s and p.

use super::raw::{RawScan, Row, Weight};
use crate::error::Error;
use brdfit_core::real::Real;

/// A polarisation by its usual name; another text stays as it is.
pub fn name(text: &str) -> String {
    let plain: String = text.to_lowercase().chars().filter(|c| c.is_alphanumeric()).collect();
    match plain.as_str() {
        "s" | "spol" | "spolarised" | "spolarized" | "te" | "perpendicular" | "perp" | "senkrecht" | "ss" => {
            "s".to_string()
        }
        "p" | "ppol" | "ppolarised" | "ppolarized" | "tm" | "parallel" | "par" | "para" | "pp" => "p".to_string(),
        _ => text.trim().to_string(),
    }
}

/// The mean of the s and p scans in each direction of a row.
///
/// # Errors
/// The two do not have the same directions.
pub fn mean(s: RawScan, p: &RawScan, names: Vec<String>) -> Result<RawScan, Error> {
    let direction = |row: &Row| [row.theta_i, row.theta_s, row.delta_phi.unwrap_or(f64::NAN)].map(f64::to_bits);
    let mut others: Vec<&Row> = p.rows.iter().collect();
    // Rows of one direction keep their order, so that repeated ones meet.
    others.sort_by_key(|row| direction(row));
    let mut own: Vec<usize> = (0..s.rows.len()).collect();
    own.sort_by_key(|&place| direction(&s.rows[place]));
    let lone = |row: &Row, of: &str| {
        Error::new(format!(
            "this direction has only {of} polarisation, so there is no mean"
        ))
        .at_line(row.line)
        .help("measure both, or fit them apart (--polarisation apart)")
    };
    let mut rows = s.rows.clone();
    for k in 0..own.len().max(others.len()) {
        match (own.get(k).map(|&place| &s.rows[place]), others.get(k)) {
            (Some(row), Some(other)) if direction(row) == direction(other) => rows[own[k]] = row_mean(row, other, &s)?,
            (Some(row), Some(other)) if direction(row) > direction(other) => return Err(lone(other, "p")),
            (Some(row), _) => return Err(lone(row, "s")),
            (None, Some(other)) => return Err(lone(other, "p")),
            (None, None) => {}
        }
    }
    Ok(RawScan { names, rows, ..s })
}

/// One row for the two of a direction.
fn row_mean(s: &Row, p: &Row, scan: &RawScan) -> Result<Row, Error> {
    let (value, weight) = match scan.quantity.is_logarithm() {
        None => (0.5 * (s.value + p.value), weight(s, p)),
        Some(factor) => {
            let [a, b] = [s, p].map(|row| Real::portable_exp(row.value * factor));
            let sigma = |row: &Row, f: f64| match row.weight {
                Weight::Sigma(sigma) => Weight::Sigma(sigma * factor * f),
                other => other,
            };
            let at = |row: &Row, value: f64| Row {
                value,
                weight: sigma(row, value),
                ..*row
            };
            let value = Real::portable_ln(0.5 * (a + b)) / factor;
            let weight = match weight(&at(s, a), &at(p, b)) {
                Some(Weight::Sigma(sigma)) => Some(Weight::Sigma(sigma / (0.5 * (a + b)) / factor)),
                other => other,
            };
            (value, weight)
        }
    };
    let weight = weight.ok_or_else(|| {
        Error::new("s and p have different kinds of weights")
            .at_line(p.line)
            .help("give both their standard deviations, or --weights equal")
    })?;
    Ok(Row { value, weight, ..*s })
}

/// The weight of a mean, whose standard deviations are independent.
fn weight(s: &Row, p: &Row) -> Option<Weight> {
    let half = |a: f64, b: f64| 0.5 * (a * a + b * b).sqrt();
    Some(match (s.weight, p.weight) {
        (Weight::Unknown, Weight::Unknown) => Weight::Unknown,
        (Weight::Sigma(a), Weight::Sigma(b)) => Weight::Sigma(half(a, b)),
        (Weight::RelativeSigma(a), Weight::RelativeSigma(b)) => Weight::Sigma(half(a * s.value, b * p.value)),
        (Weight::Factor(a), Weight::Factor(b)) => Weight::Factor(0.5 * (a + b)),
        _ => return None,
    })
}
