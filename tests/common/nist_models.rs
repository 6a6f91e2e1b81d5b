//! The 27 nonlinear regression sets of NIST's Statistical Reference Datasets: their models, and a fit of each from both certified starts.

use std::f64::consts::PI;

use brdfit_core::lm::{Bounds, Options, Problem, Stop, fit};
use brdfit_core::uncertainty::Uncertainty;

use crate::dual::{Dual, LeastSquares};

/// How one fit of one set ended.
#[derive(Clone, Debug)]
pub struct Run<S> {
    pub name: &'static str,
    /// Which certified start, 1 or 2.
    pub start: usize,
    pub parameters: usize,
    /// Evaluations of the residuals.
    pub passes: u32,
    pub stop: S,
    /// Least over the parameters of -log10 |b - certified| / |certified|, at most 11: the certified values have 11 digits.
    pub lre: f64,
    /// The same of the residual sum of squares.
    pub lre_cost: f64,
    /// The same of the standard errors of the parameters and of the residual standard deviation.
    pub lre_deviations: f64,
}

/// Residuals and their derivatives as a function of the parameters.
pub type Residuals<'a, const P: usize> = &'a dyn Fn(&[Dual<P>; P]) -> Vec<Dual<P>>;

/// Whatever finds a least sum of squares.
pub trait Solver {
    /// How it tells its end.
    type Stop;
    /// The parameters, the sum of squares there, the number of evaluations of the residuals, and how it ended.
    fn solve<const P: usize>(&self, residuals: Residuals<P>, start: [f64; P]) -> ([f64; P], f64, u32, Self::Stop);
}

fn free<const P: usize>() -> Bounds<f64, P> {
    Bounds {
        lower: [-f64::MAX; P],
        upper: [f64::MAX; P],
    }
}

/// The core's solver, where each evaluation is one with derivatives.
impl Solver for Options<f64> {
    type Stop = Stop;
    fn solve<const P: usize>(&self, residuals: Residuals<P>, start: [f64; P]) -> ([f64; P], f64, u32, Stop) {
        let fit = fit(&LeastSquares(residuals), &free(), start, self);
        let stop = fit.stop.expect("a fit that ran to its end has a stop");
        (fit.x, fit.at.cost, fit.passes, stop)
    }
}

struct Set<const P: usize> {
    starts: [[f64; P]; 2],
    certified: [f64; P],
    /// Standard errors of those.
    deviations: [f64; P],
    cost: f64,
    /// Residual standard deviation.
    scale: f64,
    /// y and the predictors.
    rows: Vec<Vec<f64>>,
}

fn number(text: &str) -> f64 {
    text.parse().unwrap_or_else(|_| panic!("not a number: {text}"))
}

fn read<const P: usize>(name: &str) -> Set<P> {
    let path = format!("{}/tests/data/nist/{name}.dat", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let lines: Vec<&str> = text.lines().collect();
    let mut set = Set {
        starts: [[0.0; P]; 2],
        certified: [0.0; P],
        deviations: [0.0; P],
        cost: 0.0,
        scale: 0.0,
        rows: Vec::new(),
    };
    // "b1 = start1 start2 certified deviation", from line 41.
    for i in 0..P {
        let cells: Vec<&str> = lines[40 + i].split_whitespace().collect();
        assert_eq!(cells[0], format!("b{}", i + 1), "{name}");
        set.starts[0][i] = number(cells[2]);
        set.starts[1][i] = number(cells[3]);
        set.certified[i] = number(cells[4]);
        set.deviations[i] = number(cells[5]);
    }
    assert!(lines[40 + P].trim().is_empty(), "{name} has more than {P} parameters");
    let after = |head: &str| {
        let found = lines.iter().find_map(|line| line.strip_prefix(head));
        number(found.unwrap_or_else(|| panic!("{name}: {head}")).trim())
    };
    set.cost = after("Residual Sum of Squares:");
    set.scale = after("Residual Standard Deviation:");
    set.rows = lines[60..]
        .iter()
        .filter(|line| !line.trim().is_empty())
        .map(|line| line.split_whitespace().map(number).collect())
        .collect();
    set
}

fn lre(value: f64, certified: f64) -> f64 {
    let error = (value - certified).abs() / certified.abs();
    if error.is_nan() {
        f64::NEG_INFINITY
    } else {
        (-error.log10()).min(11.0)
    }
}

fn run<S: Solver, const P: usize>(
    runs: &mut Vec<Run<S::Stop>>,
    solver: &S,
    name: &'static str,
    model: fn(&[f64], &[Dual<P>; P]) -> Dual<P>,
) {
    let set = read::<P>(name);
    let residuals = |b: &[Dual<P>; P]| -> Vec<Dual<P>> {
        set.rows
            .iter()
            .map(|row| {
                let y = if name == "Nelson" { libm::log(row[0]) } else { row[0] };
                model(&row[1..], b) - y
            })
            .collect()
    };
    for (i, start) in set.starts.iter().enumerate() {
        let (x, cost, passes, stop) = solver.solve(&residuals, *start);
        let known = Uncertainty::new(&LeastSquares(&residuals).linearize(&x), &x, &free(), set.rows.len());
        runs.push(Run {
            name,
            start: i + 1,
            parameters: P,
            passes,
            stop,
            lre: (0..P)
                .map(|k| lre(x[k], set.certified[k]))
                .fold(f64::INFINITY, f64::min),
            lre_cost: lre(cost, set.cost),
            lre_deviations: (0..P)
                .map(|k| lre(known.held.standard_error(k), set.deviations[k]))
                .fold(lre(known.scale, set.scale), f64::min),
        });
    }
}

/// More damping than by default, for the first starts are far off on purpose (BoxBOD's first leads to a plateau after a bold step), patience for the valleys of MGH10, and steps to the end of rounding.
pub fn options() -> Options<f64> {
    Options {
        damping: 1e3,
        max_passes: 10_000,
        cost_tolerance: 1e-20,
        ..Options::default()
    }
}

/// All 54 runs.
pub fn run_all<S: Solver>(solver: &S) -> Vec<Run<S::Stop>> {
    let mut runs = Vec::new();
    let all = &mut runs;
    run::<_, 2>(all, solver, "Misra1a", |x, b| b[0] * (-b[1] * x[0]).one_less_exp());
    run::<_, 3>(all, solver, "Chwirut2", |x, b| {
        (-b[0] * x[0]).exp() / (b[1] + b[2] * x[0])
    });
    run::<_, 3>(all, solver, "Chwirut1", |x, b| {
        (-b[0] * x[0]).exp() / (b[1] + b[2] * x[0])
    });
    run::<_, 6>(all, solver, "Lanczos3", lanczos);
    run::<_, 8>(all, solver, "Gauss1", gauss);
    run::<_, 8>(all, solver, "Gauss2", gauss);
    run::<_, 2>(all, solver, "DanWood", |x, b| b[0] * Dual::from(x[0]).pow(b[1]));
    run::<_, 2>(all, solver, "Misra1b", |x, b| {
        b[0] * (1.0 - (1.0 + b[1] * x[0] / 2.0).powf(-2.0))
    });
    run::<_, 5>(all, solver, "Kirby2", |x, b| {
        let x = x[0];
        (b[0] + (b[1] + b[2] * x) * x) / (1.0 + (b[3] + b[4] * x) * x)
    });
    run::<_, 7>(all, solver, "Hahn1", cubic_by_cubic);
    run::<_, 3>(all, solver, "Nelson", |x, b| b[0] - b[1] * x[0] * (-b[2] * x[1]).exp());
    run::<_, 5>(all, solver, "MGH17", |x, b| {
        b[0] + b[1] * (-b[3] * x[0]).exp() + b[2] * (-b[4] * x[0]).exp()
    });
    run::<_, 6>(all, solver, "Lanczos1", lanczos);
    run::<_, 6>(all, solver, "Lanczos2", lanczos);
    run::<_, 8>(all, solver, "Gauss3", gauss);
    run::<_, 2>(all, solver, "Misra1c", |x, b| {
        b[0] * (1.0 - (1.0 + 2.0 * b[1] * x[0]).powf(-0.5))
    });
    run::<_, 2>(all, solver, "Misra1d", |x, b| b[0] * b[1] * x[0] / (1.0 + b[1] * x[0]));
    run::<_, 4>(all, solver, "Roszman1", |x, b| {
        b[0] - b[1] * x[0] - (b[2] / (x[0] - b[3])).atan() / PI
    });
    run::<_, 9>(all, solver, "ENSO", |x, b| {
        let year = 2.0 * PI * x[0] / 12.0;
        let (first, second) = (2.0 * PI * x[0] / b[3], 2.0 * PI * x[0] / b[6]);
        b[0] + b[1] * year.cos()
            + b[2] * year.sin()
            + b[4] * first.cos()
            + b[5] * first.sin()
            + b[7] * second.cos()
            + b[8] * second.sin()
    });
    run::<_, 4>(all, solver, "MGH09", |x, b| {
        b[0] * (x[0] * x[0] + x[0] * b[1]) / (x[0] * x[0] + x[0] * b[2] + b[3])
    });
    run::<_, 7>(all, solver, "Thurber", cubic_by_cubic);
    run::<_, 2>(all, solver, "BoxBOD", |x, b| b[0] * (-b[1] * x[0]).one_less_exp());
    run::<_, 3>(all, solver, "Rat42", |x, b| b[0] / (1.0 + (b[1] - b[2] * x[0]).exp()));
    run::<_, 3>(all, solver, "MGH10", |x, b| b[0] * (b[1] / (x[0] + b[2])).exp());
    run::<_, 3>(all, solver, "Eckerle4", |x, b| {
        b[0] / b[1] * (-0.5 * ((x[0] - b[2]) / b[1]).square()).exp()
    });
    run::<_, 4>(all, solver, "Rat43", |x, b| {
        b[0] / (1.0 + (b[1] - b[2] * x[0]).exp()).pow(1.0 / b[3])
    });
    run::<_, 3>(all, solver, "Bennett5", |x, b| b[0] * (b[1] + x[0]).pow(-1.0 / b[2]));
    runs
}

fn lanczos(x: &[f64], b: &[Dual<6>; 6]) -> Dual<6> {
    let x = x[0];
    b[0] * (-b[1] * x).exp() + b[2] * (-b[3] * x).exp() + b[4] * (-b[5] * x).exp()
}

fn gauss(x: &[f64], b: &[Dual<8>; 8]) -> Dual<8> {
    let x = x[0];
    b[0] * (-b[1] * x).exp()
        + b[2] * (-((x - b[3]) / b[4]).square()).exp()
        + b[5] * (-((x - b[6]) / b[7]).square()).exp()
}

fn cubic_by_cubic(x: &[f64], b: &[Dual<7>; 7]) -> Dual<7> {
    let x = x[0];
    (b[0] + (b[1] + (b[2] + b[3] * x) * x) * x) / (1.0 + (b[4] + (b[5] + b[6] * x) * x) * x)
}
