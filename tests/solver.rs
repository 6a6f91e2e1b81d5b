//! The bounded Levenberg-Marquardt solver: each way to stop, at several scales, and what holds on every fit.

#![allow(
    clippy::disallowed_methods,
    reason = "oracles may use std's functions; the code under test may not"
)]

use brdfit_core::lm::{Bounds, Fit, Options, Problem, Stop, fit};
use brdfit_core::real::Real;
use brdfit_core::start;
use brdfit_suite::dual::{Dual, LeastSquares};
use brdfit_suite::tolerance::{self, check};

/// Factors of the cost, and of each parameter.
const SCALES: [(f64, [f64; 2]); 5] = [
    (1.0, [1.0, 1.0]),
    (1e-10, [1.0, 1.0]),
    (1e10, [1.0, 1.0]),
    (1e-10, [1e6, 1e-4]),
    (1e10, [1e-3, 1e5]),
];

const FREE: Bounds<f64, 2> = Bounds {
    lower: [-f64::MAX; 2],
    upper: [f64::MAX; 2],
};

/// y = b1 exp(-b2 t) with errors of up to 0.05, so that the cost does not vanish at the optimum; at scale (1, [1, 1]) it is near (2, 0.7).
fn decay(cost: f64, scale: [f64; 2], noise: f64) -> LeastSquares<impl Fn(&[Dual<2>; 2]) -> Vec<Dual<2>>> {
    LeastSquares(move |b: &[Dual<2>; 2]| {
        (0..12)
            .map(|i| {
                let t = 0.3 * f64::from(i);
                let y = 2.0 * (-0.7 * t).exp() + noise * f64::from(i * 7 % 5 - 2);
                cost.sqrt() * (b[0] / scale[0] * (-b[1] / scale[1] * t).exp() - y)
            })
            .collect()
    })
}

fn scaled(x: [f64; 2], scale: [f64; 2]) -> [f64; 2] {
    [x[0] * scale[0], x[1] * scale[1]]
}

/// What the undamped model of one free parameter `k` promises.
fn promise_of(fit: &Fit<f64, 2>, k: usize) -> f64 {
    fit.at.gradient[k] * fit.at.gradient[k] / fit.at.hessian[k][k]
}

/// The documented inequality of `Stop::Cost`: the largest promise over `cost_tolerance * cost`, over many tolerances.
fn largest_promise(
    problem: &impl Problem<f64, 2>,
    bounds: &Bounds<f64, 2>,
    start: [f64; 2],
    promise: impl Fn(&Fit<f64, 2>) -> f64,
) -> f64 {
    let mut worst = 0.0f64;
    for k in 0..100 {
        let options = Options {
            cost_tolerance: 10f64.powf(-0.5 - 0.15 * f64::from(k)),
            ..Options::default()
        };
        let fit = fit(problem, bounds, start, &options);
        if fit.stop == Some(Stop::Cost) {
            worst = worst.max(promise(&fit) / (options.cost_tolerance * fit.at.cost));
        }
    }
    println!("largest promise: {worst}");
    worst
}

#[test]
fn stop_cost_at_every_scale() {
    let options = Options::default();
    let plain = fit(&decay(1.0, [1.0, 1.0], 0.025), &FREE, [1.0, 0.1], &options);
    let mut worst = 0.0f64;
    for (cost, scale) in SCALES {
        let fit = fit(&decay(cost, scale, 0.025), &FREE, scaled([1.0, 0.1], scale), &options);
        assert_eq!(fit.stop, Some(Stop::Cost), "{cost:e} {scale:?}");
        // With 2 parameters the model promises g' H^-1 g.
        let promise = |fit: &Fit<f64, 2>| {
            let ([g0, g1], [[a, b], [_, d]]) = (fit.at.gradient, fit.at.hessian);
            (g0 * g0 * d - 2.0 * g0 * g1 * b + g1 * g1 * a) / (a * d - b * b)
        };
        let problem = decay(cost, scale, 0.025);
        check(
            largest_promise(&problem, &FREE, scaled([1.0, 0.1], scale), promise),
            tolerance::PROMISE,
        );
        for ((x, scale), plain) in fit.x.iter().zip(scale).zip(plain.x) {
            worst = worst.max((x / scale / plain - 1.0).abs());
        }
        worst = worst.max((fit.at.cost / cost / plain.at.cost - 1.0).abs());
        assert!(
            fit.passes.abs_diff(plain.passes) <= 1,
            "{} passes, not {}",
            fit.passes,
            plain.passes
        );
    }
    println!("parameters at five scales: {worst:.1e}");
    check(worst, tolerance::SCALES);
}

#[test]
fn stop_step_at_every_scale() {
    // No reduction is small enough: only rounding ends the fit.
    let options = Options {
        cost_tolerance: 0.0,
        ..Options::default()
    };
    let mut better = 0.0f64;
    for (cost, scale) in SCALES {
        let problem = decay(cost, scale, 0.025);
        let fit = fit(&problem, &FREE, scaled([1.0, 0.1], scale), &options);
        assert_eq!(fit.stop, Some(Stop::Step), "{cost:e} {scale:?}");
        // No neighbour is better by more than rounding.
        for k in 0..2 {
            for factor in [1.0 - 1e-10, 1.0 + 1e-10] {
                let mut x = fit.x;
                x[k] *= factor;
                better = better.max(1.0 - problem.cost(&x) / fit.at.cost);
            }
        }
    }
    println!("better neighbour: {better:e}");
    check(better, tolerance::NEIGHBOUR);
}

#[test]
fn an_exact_solution_is_reached_and_ends() {
    let mut worst = 0.0f64;
    for (cost, scale) in SCALES {
        let fit = fit(
            &decay(cost, scale, 0.0),
            &FREE,
            scaled([1.0, 0.1], scale),
            &Options::default(),
        );
        assert!(fit.stop.is_some_and(Stop::converged), "{fit:?}");
        worst = worst.max(fit.at.cost / cost);
    }
    println!("exact curve: {worst:e}");
    check(worst, tolerance::EXACT_CURVE);
}

#[test]
fn stop_passes_at_every_scale() {
    let options = Options {
        max_passes: 4,
        ..Options::default()
    };
    for (cost, scale) in SCALES {
        let fit = fit(&decay(cost, scale, 0.025), &FREE, scaled([1.0, 0.1], scale), &options);
        assert_eq!((fit.stop, fit.passes), (Some(Stop::Passes), 4), "{cost:e} {scale:?}");
    }
}

#[test]
fn stop_not_finite_at_every_scale() {
    for (cost, scale) in SCALES {
        for start in [[f64::INFINITY, 1.0], [1.0, -1e5], [1.0, f64::NEG_INFINITY]] {
            let start = scaled(start, scale);
            let fit = fit(&decay(cost, scale, 0.025), &FREE, start, &Options::default());
            assert_eq!((fit.stop, fit.passes), (Some(Stop::NotFinite), 1), "{start:?}");
        }
    }
}

#[test]
fn a_step_to_where_nothing_is_finite_is_refused() {
    // The first step wants x below 0, where the logarithm is NaN.
    let problem = LeastSquares(|x: &[Dual<1>; 1]| vec![x[0].ln() + 5.0]);
    let free = Bounds {
        lower: [-f64::MAX],
        upper: [f64::MAX],
    };
    let fit = fit(&problem, &free, [3.0], &Options::default());
    assert!(fit.stop.is_some_and(Stop::converged));
    assert_eq!(Real::portable_ln(fit.x[0]), -5.0, "{fit:?}");
}

#[test]
fn bounds_are_attained_exactly() {
    let problem = decay(1.0, [1.0, 1.0], 0.025);
    let free = fit(&problem, &FREE, [1.0, 0.1], &Options::default()).x;
    for (lower, upper, at) in [
        ([0.0, 0.0], [free[0] - 0.3, 5.0], (0, free[0] - 0.3)),
        ([free[0] + 0.1, 0.0], [9.0, 5.0], (0, free[0] + 0.1)),
        ([0.0, 0.0], [9.0, free[1] - 0.1], (1, free[1] - 0.1)),
        ([0.0, free[1] + 1.0 / 3.0], [9.0, 5.0], (1, free[1] + 1.0 / 3.0)),
    ] {
        let bounds = Bounds { lower, upper };
        let fit = fit(&problem, &bounds, [1.0, 0.1], &Options::default());
        assert_eq!(fit.x[at.0], at.1, "{fit:?}");
        assert!(fit.stop.is_some_and(Stop::converged));
        // The gradient pulls outwards there, and vanishes along the other parameter.
        let outwards = if at.1 == upper[at.0] { -1.0 } else { 1.0 };
        assert!(outwards * fit.at.gradient[at.0] > 0.0);
        let promise = largest_promise(&problem, &bounds, [1.0, 0.1], |fit| promise_of(fit, 1 - at.0));
        check(promise, tolerance::PROMISE);
    }
}

#[test]
fn equal_bounds_hold_a_parameter() {
    let problem = decay(1.0, [1.0, 1.0], 0.025);
    for value in [0.1, 1.0 / 3.0, 2.0] {
        let bounds = Bounds {
            lower: [0.0, value],
            upper: [9.0, value],
        };
        let fit = fit(&problem, &bounds, [1.0, 5.0], &Options::default());
        assert_eq!(fit.x[1], value);
        assert!(fit.stop.is_some_and(Stop::converged));
        let promise = largest_promise(&problem, &bounds, [1.0, 5.0], |fit| promise_of(fit, 0));
        check(promise, tolerance::PROMISE);
        let all = Bounds {
            lower: [1.5, value],
            upper: [1.5, value],
        };
        let held = brdfit_core::lm::fit(&problem, &all, [7.0, 7.0], &Options::default());
        assert_eq!((held.x, held.stop, held.passes), ([1.5, value], Some(Stop::Step), 1));
    }
}

/// A thousand boxes and starts on Rosenbrock's valley: every step stays inside and none makes it worse.
#[test]
fn never_outside_and_never_worse() {
    let problem =
        LeastSquares(|x: &[Dual<2>; 2]| vec![10.0 * (x[1] - x[0].square()), 1.0 - x[0], 0.1 * x[0].sin() * x[1]]);
    for i in 0..1000 {
        let [a, b, c]: [f64; 3] = start::even(1, i);
        let [d, e, f]: [f64; 3] = start::even(2, i);
        let lower = [4.0 * a - 3.0, 4.0 * b - 3.0];
        let bounds = Bounds {
            lower,
            upper: [lower[0] + 3.0 * c, lower[1] + 3.0 * d],
        };
        // Some starts outside: they are moved to the box.
        let first = [6.0 * e - 3.0, 6.0 * f - 3.0];
        let options = Options::default();
        let mut fit = Fit::begin(&problem, &bounds, first, &options);
        let mut cost = problem.cost(&bounds.clamp(first));
        while fit.stop.is_none() {
            fit.step(&problem, &bounds, &options);
            assert!(fit.at.cost <= cost);
            assert_eq!(fit.x, bounds.clamp(fit.x), "{bounds:?}");
            cost = fit.at.cost;
        }
        assert!(fit.stop.is_some_and(Stop::converged), "{bounds:?} {first:?} {fit:?}");
        assert_eq!(problem.cost(&fit.x), fit.at.cost);
    }
}

#[test]
fn a_fit_goes_on_where_it_was_left() {
    let problem = decay(1.0, [1.0, 1.0], 0.025);
    let options = Options::default();
    let whole = fit(&problem, &FREE, [1.0, 0.1], &options);
    let mut parts = Fit::begin(&problem, &FREE, [1.0, 0.1], &options);
    for passes in 2..u32::MAX {
        parts.run(&problem, &FREE, &options, passes);
        assert!(parts.passes <= passes);
        if parts.stop.is_some() {
            break;
        }
    }
    assert_eq!(
        (parts.x, parts.at, parts.stop, parts.passes),
        (whole.x, whole.at, whole.stop, whole.passes)
    );
}
