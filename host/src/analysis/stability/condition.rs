//! Condition of J'J by one-sided Jacobi rotations of the columns of J, which find small singular values to their own relative accuracy.

/// Ratio of the largest to the least eigenvalue of J'J after each column of J is scaled to length 1, at least 1, dimensionless.
///
/// `columns` are those of J; without any the condition is 1.
/// It saturates at 1e30: what is singular in f64 has no other number.
pub fn condition(mut columns: Vec<Vec<f64>>) -> f64 {
    const LARGEST: f64 = 1e30;
    const SWEEPS: usize = 60;
    for column in &mut columns {
        let length = dot(column, column).sqrt();
        column.iter_mut().for_each(|x| *x /= length);
    }
    for _ in 0..SWEEPS {
        let mut turned = false;
        for j in 1..columns.len() {
            for i in 0..j {
                turned |= rotate(&mut columns, i, j);
            }
        }
        if !turned {
            break;
        }
    }
    let eigenvalues = columns.iter().map(|column| dot(column, column));
    let (least, most) = eigenvalues.fold((f64::MAX, 0.0), |(a, b), x| (x.min(a), x.max(b)));
    if columns.is_empty() || most.is_nan() {
        return 1.0;
    }
    (most / least).min(LARGEST)
}

/// Makes columns i and j orthogonal; false if they are.
fn rotate(columns: &mut [Vec<f64>], i: usize, j: usize) -> bool {
    let (alpha, beta) = (dot(&columns[i], &columns[i]), dot(&columns[j], &columns[j]));
    let gamma = dot(&columns[i], &columns[j]);
    if gamma.abs() <= f64::EPSILON * (alpha * beta).sqrt() {
        return false;
    }
    let zeta = (beta - alpha) / (2.0 * gamma);
    let tan = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
    let cos = 1.0 / (1.0 + tan * tan).sqrt();
    let sin = cos * tan;
    for k in 0..columns[i].len() {
        let (a, b) = (columns[i][k], columns[j][k]);
        columns[i][k] = cos * a - sin * b;
        columns[j][k] = sin * a + cos * b;
    }
    true
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_conditions() {
        assert_eq!(condition(vec![]), 1.0);
        assert_eq!(condition(vec![vec![3.0, 0.0], vec![0.0, 1e-9]]), 1.0);
        // Two unit columns at an angle with cosine g have eigenvalues 1 + g and 1 - g.
        let close = condition(vec![vec![1.0, 0.0], vec![1.0, 1e-6]]);
        assert!((close / 4e12 - 1.0).abs() < 1e-6, "{close:e}");
        assert_eq!(condition(vec![vec![1.0, 1.0], vec![2.0, 2.0]]), 1e30);
    }
}
