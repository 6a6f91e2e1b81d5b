//! The processes that residuals may be, and the errors that follow: the filter of the product against the whole matrix of covariances.
#![allow(
    clippy::disallowed_methods,
    reason = "oracles may use std's functions; the code under test may not"
)]

use brdfit::analysis::bootstrap::Noise;
use brdfit::analysis::misfit::likelihood::likelihoods;
use brdfit::analysis::misfit::mixture::matched;
use brdfit::analysis::misfit::process::{Process, Residuals};
use brdfit::analysis::misfit::sandwich::{Common, covariance};
use brdfit::analysis::misfit::smoothed::smoothed;
use brdfit_suite::tolerance::{self, check};

const COLUMNS: usize = 3;

/// A residual of some line.
struct Point {
    angle: f64,
    offset: f64,
    line: usize,
    residual: f64,
    row: Vec<f64>,
}

/// The correlation of two residuals that are not the same one.
fn kernel(process: Process, angle: f64) -> f64 {
    let x = angle.abs() / process.length;
    process.part
        * if process.smooth {
            let x = 2.146_193_220_620_582_6 * x;
            (1.0 + x) * (-x).exp()
        } else {
            (-x).exp()
        }
}

/// The root and the determinant's logarithm of a symmetric matrix, and the solutions of the equations with these right sides.
fn solved(mut a: Vec<Vec<f64>>, mut right: Vec<Vec<f64>>) -> (f64, Vec<Vec<f64>>) {
    let mut ln = 0.0;
    for k in 0..a.len() {
        ln += a[k][k].ln();
        for i in 0..a.len() {
            if i != k {
                let factor = a[i][k] / a[k][k];
                let (from, into) = (a[k].clone(), &mut a[i]);
                into.iter_mut().zip(&from).for_each(|(x, y)| *x -= factor * y);
                let (from, into) = (right[k].clone(), &mut right[i]);
                into.iter_mut().zip(&from).for_each(|(x, y)| *x -= factor * y);
            }
        }
    }
    for k in 0..a.len() {
        let pivot = a[k][k];
        right[k].iter_mut().for_each(|x| *x /= pivot);
    }
    (ln, right)
}

fn product(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let column = |row: &Vec<f64>, j: usize| row.iter().zip(b).map(|(x, line)| x * line[j]).sum();
    let count = b.first().map_or(0, Vec::len);
    a.iter()
        .map(|row| (0..count).map(|j| column(row, j)).collect())
        .collect()
}

fn turned(a: &[Vec<f64>]) -> Vec<Vec<f64>> {
    (0..a[0].len()).map(|j| a.iter().map(|row| row[j]).collect()).collect()
}

/// Short and long, nearly alone and under noise.
const PROCESSES: [Process; 4] = [
    process(0.3, 0.9, false),
    process(0.3, 0.9, true),
    process(1.0, 0.3, true),
    process(0.02, 0.999, false),
];

const fn process(length: f64, part: f64, smooth: bool) -> Process {
    Process { length, part, smooth }
}

#[test]
fn filter_and_sandwich_are_those_of_the_whole_matrix() {
    let mut noise = Noise::new(1, 0);
    let mut point = |line: usize, k: usize| Point {
        angle: 0.1 * k as f64 + 0.05 * noise.unit(),
        offset: 0.1 * k as f64 + 0.03 * noise.unit(),
        line,
        residual: noise.normal(),
        row: (0..COLUMNS).map(|_| noise.normal()).collect(),
    };
    let lines: Vec<Vec<Point>> = [14, 1, 9]
        .iter()
        .enumerate()
        .map(|(line, &count)| (0..count).map(|k| point(line, k)).collect())
        .collect();
    let all: Vec<&Point> = lines.iter().flatten().collect();
    let ends = lines.iter().scan(0, |end, line| {
        *end += line.len();
        Some(*end)
    });
    let residuals = Residuals {
        angles: all.iter().map(|point| point.angle).collect(),
        offsets: all.iter().map(|point| point.offset).collect(),
        values: all.iter().map(|point| point.residual).collect(),
        rows: all.iter().flat_map(|point| point.row.clone()).collect(),
        columns: COLUMNS,
        ends: ends.collect(),
    };
    let rows: Vec<Vec<f64>> = all.iter().map(|point| point.row.clone()).collect();
    let degrees = (all.len() - COLUMNS) as f64;
    let (mut of_ln, mut of_covariance) = (0.0f64, 0.0f64);
    let mut before = None;
    for (place, process) in PROCESSES.into_iter().enumerate() {
        let matrix = |of: &dyn Fn(&Point, &Point) -> f64| -> Vec<Vec<f64>> {
            let one = |i: usize, j: usize| if i == j { 1.0 } else { of(all[i], all[j]) };
            (0..all.len())
                .map(|i| (0..all.len()).map(|j| one(i, j)).collect())
                .collect()
        };
        let along = |a: &Point, b: &Point| {
            if a.line == b.line {
                kernel(process, a.angle - b.angle)
            } else {
                0.0
            }
        };
        let v = matrix(&along);
        let columns: Vec<Vec<f64>> = all
            .iter()
            .map(|point| [&point.row[..], &[point.residual]].concat())
            .collect();
        let (ln_v, solution) = solved(v.clone(), columns.clone());
        let normal = product(&turned(&columns), &solution);
        let j_j: Vec<Vec<f64>> = normal[..COLUMNS].iter().map(|row| row[..COLUMNS].to_vec()).collect();
        let j_r: Vec<Vec<f64>> = normal[..COLUMNS].iter().map(|row| vec![row[COLUMNS]]).collect();
        let (ln_j, best) = solved(j_j, j_r.clone());
        let explained: f64 = best.iter().zip(&j_r).map(|(x, y)| x[0] * y[0]).sum();
        let rest = normal[COLUMNS][COLUMNS] - explained;
        let expected = -0.5 * (degrees * rest.ln() + ln_v + ln_j);
        let (ln, variance) = likelihoods(&residuals, &PROCESSES, degrees)[place];
        of_ln = of_ln
            .max((ln - expected).abs())
            .max((variance * degrees / rest - 1.0).abs());
        assert!(before.replace(ln).is_none_or(|before: f64| (before - ln).abs() > 1e-3));
        // The sandwich: within lines, and with what lines have in common.
        let mut common = Common::new(&residuals);
        common.correlation = 0.6 * process.part;
        let shared = |a: &Point, b: &Point| {
            let own = if a.line == b.line {
                0.4 * kernel(process, a.angle - b.angle)
            } else {
                0.0
            };
            own + 0.6 * kernel(process, a.offset - b.offset)
        };
        let pairs = [
            (covariance(&residuals, process, variance), v),
            (
                common
                    .covariances(&residuals, &[(process, variance)])
                    .unwrap()
                    .remove(0),
                matrix(&shared),
            ),
        ];
        for (got, v) in pairs {
            let meat = product(&turned(&rows), &product(&v, &rows));
            for (got, exact) in got.iter().zip(meat.iter().flatten()) {
                of_covariance = of_covariance.max((got - variance * exact).abs() / variance);
            }
        }
    }
    check(of_ln, tolerance::RESTRICTED_LIKELIHOOD);
    check(of_covariance, tolerance::SANDWICH);
}

/// The mean of a normal process given its sums with noise: K V^-1 r.
#[test]
fn a_smoothed_line_is_the_mean_by_the_whole_matrix() {
    let mut noise = Noise::new(2, 0);
    let angles: Vec<f64> = (0..25).map(|k| 0.1 * f64::from(k / 2 + k % 3) + 0.04).collect();
    let mut angles: Vec<f64> = angles.iter().map(|angle| angle + 0.02 * noise.unit()).collect();
    angles.sort_by(f64::total_cmp);
    // A direction that was measured twice.
    angles[7] = angles[6];
    let values: Vec<f64> = angles.iter().map(|_| noise.normal()).collect();
    let mut worst = 0.0f64;
    for process in PROCESSES {
        let row = |&a: &f64| angles.iter().map(|&b| kernel(process, a - b)).collect();
        let own: Vec<Vec<f64>> = angles.iter().map(row).collect();
        let mut whole = own.clone();
        (0..angles.len()).for_each(|k| whole[k][k] = 1.0);
        let right = values.iter().map(|&value| vec![value]).collect();
        let expected = product(&own, &solved(whole, right).1);
        let got = smoothed(&angles, &values, process);
        let apart = got.iter().zip(&expected).map(|(got, exact)| (got - exact[0]).abs());
        worst = apart.fold(worst, f64::max);
    }
    check(worst, tolerance::SMOOTHED);
}

#[test]
fn a_mixture_of_one_is_itself() {
    let one = matched(&[(1.0, 4.0)], 12.0);
    assert!(
        (one.variance - 4.0).abs() < 1e-6 && (one.degrees - 12.0).abs() < 1e-3,
        "{one:?}"
    );
    let wide = matched(&[(0.9, 1.0), (0.1, 25.0)], 100.0);
    assert!(wide.degrees < 10.0, "{wide:?}");
}
