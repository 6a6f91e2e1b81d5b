//! Problems of Moré, Garbow and Hillstrom, "Testing unconstrained optimization software" (ACM TOMS 7, 1981), with at most 9 parameters.

use std::f64::consts::PI;

use brdfit_core::lm::{Bounds, Options, Stop, fit};

use crate::dual::{Dual, LeastSquares};

/// A known minimum: its sum of squares and where that is known from.
pub type Known = (f64, &'static str);

/// How one fit ended.
#[derive(Clone, Debug)]
pub struct Run {
    pub name: &'static str,
    pub parameters: usize,
    /// Factor of the standard start: 1, 10 or 100.
    pub factor: f64,
    pub passes: u32,
    pub stop: Stop,
    pub cost: f64,
    /// The known minimum that was reached, if any was.
    pub reached: Option<Known>,
}

fn run<const P: usize>(
    runs: &mut Vec<Run>,
    options: &Options<f64>,
    name: &'static str,
    start: [f64; P],
    known: &[Known],
    residuals: impl Fn(&[Dual<P>; P]) -> Vec<Dual<P>>,
) {
    let bounds = Bounds {
        lower: [-f64::MAX; P],
        upper: [f64::MAX; P],
    };
    let problem = LeastSquares(residuals);
    for factor in [1.0, 10.0, 100.0] {
        let fit = fit(&problem, &bounds, start.map(|x| factor * x), options);
        let cost = fit.at.cost;
        let close = |&&(minimum, _): &&Known| (cost - minimum).abs() <= (1e-4 * minimum).max(1e-20);
        runs.push(Run {
            name,
            parameters: P,
            factor,
            passes: fit.passes,
            stop: fit.stop.expect("a fit that ran to its end has a stop"),
            cost,
            reached: known.iter().find(close).copied(),
        });
    }
}

const GLOBAL: &str = "global";

/// Each problem from its standard start, 10 and 100 times it.
#[allow(
    clippy::too_many_lines,
    reason = "one statement a problem, in the order of the paper"
)]
pub fn run_all(options: &Options<f64>) -> Vec<Run> {
    let mut runs = Vec::new();
    let all = &mut runs;
    run(all, options, "Rosenbrock", [-1.2, 1.0], &[(0.0, GLOBAL)], |x| {
        vec![10.0 * (x[1] - x[0].square()), 1.0 - x[0]]
    });
    let minima = [(0.0, GLOBAL), (48.9842, "local, in the paper")];
    run(all, options, "Freudenstein and Roth", [0.5, -2.0], &minima, |x| {
        vec![
            -13.0 + x[0] + ((5.0 - x[1]) * x[1] - 2.0) * x[1],
            -29.0 + x[0] + ((x[1] + 1.0) * x[1] - 14.0) * x[1],
        ]
    });
    run(all, options, "Powell badly scaled", [0.0, 1.0], &[(0.0, GLOBAL)], |x| {
        vec![1e4 * x[0] * x[1] - 1.0, (-x[0]).exp() + (-x[1]).exp() - 1.0001]
    });
    run(all, options, "Brown badly scaled", [1.0, 1.0], &[(0.0, GLOBAL)], |x| {
        vec![x[0] - 1e6, x[1] - 2e-6, x[0] * x[1] - 2.0]
    });
    // With x1 (1 - x2) = c the residuals tend to y_i - i c: 0.452 at c = 111/112.
    let minima = [(0.0, GLOBAL), (0.452009, "as (x1, x2) goes to (inf, 1)")];
    run(all, options, "Beale", [1.0, 1.0], &minima, |x| {
        let power = [x[1], x[1] * x[1], x[1] * x[1] * x[1]];
        let y = [1.5, 2.25, 2.625];
        (0..3).map(|i| y[i] - x[0] * (1.0 - power[i])).collect()
    });
    run(
        all,
        options,
        "Jennrich and Sampson",
        [0.3, 0.4],
        &[(124.362, GLOBAL)],
        |x| {
            (1..=10)
                .map(f64::from)
                .map(|i| 2.0 + 2.0 * i - ((i * x[0]).exp() + (i * x[1]).exp()))
                .collect()
        },
    );
    run(
        all,
        options,
        "Helical valley",
        [-1.0, 0.0, 0.0],
        &[(0.0, GLOBAL)],
        |x| {
            let turn = if x[0].v > 0.0 {
                (x[1] / x[0]).atan() / (2.0 * PI)
            } else if x[0].v < 0.0 {
                (x[1] / x[0]).atan() / (2.0 * PI) + 0.5
            } else {
                0.25 * x[1].v.signum() + -(x[0] / x[1]).atan() / (2.0 * PI)
            };
            let radius = (x[0].square() + x[1].square()).sqrt();
            vec![10.0 * (x[2] - 10.0 * turn), 10.0 * (radius - 1.0), x[2]]
        },
    );
    let minima = [(8.21487e-3, GLOBAL), (17.4286, "at (0.8406, -inf, -inf), in the paper")];
    run(all, options, "Bard", [1.0; 3], &minima, |x| {
        const Y: [f64; 15] = [
            0.14, 0.18, 0.22, 0.25, 0.29, 0.32, 0.35, 0.39, 0.37, 0.58, 0.73, 0.96, 1.34, 2.10, 4.39,
        ];
        Y.iter()
            .zip(1..)
            .map(|(&y, i)| {
                let u = f64::from(i);
                let v = 16.0 - u;
                y - (x[0] + u / (v * x[1] + u.min(v) * x[2]))
            })
            .collect()
    });
    // A needle between two samples, which it fits, and 0 elsewhere.
    let minima = [
        (1.12793e-8, GLOBAL),
        (0.2811277, "as (x1, x2) goes to infinity, not in the paper"),
    ];
    run(all, options, "Gaussian", [0.4, 1.0, 0.0], &minima, |x| {
        const Y: [f64; 8] = [0.0009, 0.0044, 0.0175, 0.0540, 0.1295, 0.2420, 0.3521, 0.3989];
        (0..15)
            .map(|i| {
                let t = (7.0 - f64::from(i)) / 2.0;
                x[0] * (-x[1] * (t - x[2]).square() / 2.0).exp() - Y[usize::min(i as usize, 14 - i as usize)]
            })
            .collect()
    });
    run(
        all,
        options,
        "Meyer",
        [0.02, 4000.0, 250.0],
        &[(87.9458, GLOBAL)],
        |x| {
            const Y: [f64; 16] = [
                34780.0, 28610.0, 23650.0, 19630.0, 16370.0, 13720.0, 11540.0, 9744.0, 8261.0, 7030.0, 6005.0, 5147.0,
                4427.0, 3820.0, 3307.0, 2872.0,
            ];
            Y.iter()
                .zip(1..)
                .map(|(&y, i)| x[0] * (x[1] / (45.0 + 5.0 * f64::from(i) + x[2])).exp() - y)
                .collect()
        },
    );
    // From 100 times the start every exponential underflows, and with them the gradient: the cost is the sum of t^2.
    let minima = [(0.0, GLOBAL), (32.835, "plateau, where J is exactly 0")];
    run(all, options, "Gulf research", [5.0, 2.5, 0.15], &minima, |x| {
        (1..100)
            .map(|i| {
                let t = f64::from(i) / 100.0;
                let y = 25.0 + (-50.0 * t.ln()).powf(2.0 / 3.0);
                (-((y - x[1]).abs().pow(x[2]) / x[0])).exp() - t
            })
            .collect()
    });
    let minima = [(0.0, GLOBAL), (0.07558874, "plateau at infinity, not in the paper")];
    run(all, options, "Box 3-D", [0.0, 10.0, 20.0], &minima, |x| {
        (1..=10)
            .map(|i| {
                let t = f64::from(i) / 10.0;
                (-t * x[0]).exp() - (-t * x[1]).exp() - x[2] * ((-t).exp() - (-10.0 * t).exp())
            })
            .collect()
    });
    run(
        all,
        options,
        "Powell singular",
        [3.0, -1.0, 0.0, 1.0],
        &[(0.0, GLOBAL)],
        |x| {
            vec![
                x[0] + 10.0 * x[1],
                5.0f64.sqrt() * (x[2] - x[3]),
                (x[1] - 2.0 * x[2]).square(),
                10.0f64.sqrt() * (x[0] - x[3]).square(),
            ]
        },
    );
    run(all, options, "Wood", [-3.0, -1.0, -3.0, -1.0], &[(0.0, GLOBAL)], |x| {
        vec![
            10.0 * (x[1] - x[0].square()),
            1.0 - x[0],
            90.0f64.sqrt() * (x[3] - x[2].square()),
            1.0 - x[2],
            10.0f64.sqrt() * (x[1] + x[3] - 2.0),
            (x[1] - x[3]) / 10.0f64.sqrt(),
        ]
    });
    let minima = [
        (3.07505e-4, GLOBAL),
        (1.02734e-3, "at (inf, -14.07, -inf, -inf), in the paper"),
    ];
    run(
        all,
        options,
        "Kowalik and Osborne",
        [0.25, 0.39, 0.415, 0.39],
        &minima,
        |x| {
            const Y: [f64; 11] = [
                0.1957, 0.1947, 0.1735, 0.1600, 0.0844, 0.0627, 0.0456, 0.0342, 0.0323, 0.0235, 0.0246,
            ];
            const U: [f64; 11] = [4.0, 2.0, 1.0, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625];
            (0..11)
                .map(|i| Y[i] - x[0] * (U[i] * U[i] + U[i] * x[1]) / (U[i] * U[i] + U[i] * x[2] + x[3]))
                .collect()
        },
    );
    run(
        all,
        options,
        "Brown and Dennis",
        [25.0, 5.0, -5.0, -1.0],
        &[(85822.2, GLOBAL)],
        |x| {
            (1..=20)
                .map(|i| {
                    let t = f64::from(i) / 5.0;
                    (x[0] + t * x[1] - t.exp()).square() + (x[2] + t.sin() * x[3] - t.cos()).square()
                })
                .collect()
        },
    );
    run(
        all,
        options,
        "Osborne 1",
        [0.5, 1.5, -1.0, 0.01, 0.02],
        &[(5.46489e-5, GLOBAL)],
        |x| {
            const Y: [f64; 33] = [
                0.844, 0.908, 0.932, 0.936, 0.925, 0.908, 0.881, 0.850, 0.818, 0.784, 0.751, 0.718, 0.685, 0.658,
                0.628, 0.603, 0.580, 0.558, 0.538, 0.522, 0.506, 0.490, 0.478, 0.467, 0.457, 0.448, 0.438, 0.431,
                0.424, 0.420, 0.414, 0.411, 0.406,
            ];
            Y.iter()
                .zip(0..)
                .map(|(&y, i)| {
                    let t = 10.0 * f64::from(i);
                    y - (x[0] + x[1] * (-t * x[3]).exp() + x[2] * (-t * x[4]).exp())
                })
                .collect()
        },
    );
    let minima = [
        (0.0, GLOBAL),
        (5.65565e-3, "local, in the paper"),
        (0.3063668, "stationary, not in the paper"),
    ];
    run(
        all,
        options,
        "Biggs EXP6",
        [1.0, 2.0, 1.0, 1.0, 1.0, 1.0],
        &minima,
        |x| {
            (1..=13)
                .map(|i| {
                    let t = f64::from(i) / 10.0;
                    let y = (-t).exp() - 5.0 * (-10.0 * t).exp() + 3.0 * (-4.0 * t).exp();
                    x[2] * (-t * x[0]).exp() - x[3] * (-t * x[1]).exp() + x[5] * (-t * x[4]).exp() - y
                })
                .collect()
        },
    );
    run(all, options, "Watson 6", [0.0; 6], &[(2.28767e-3, GLOBAL)], watson);
    run(all, options, "Watson 9", [0.0; 9], &[(1.39976e-6, GLOBAL)], watson);
    run(
        all,
        options,
        "Penalty I",
        [1.0, 2.0, 3.0, 4.0],
        &[(2.24997e-5, GLOBAL)],
        |x| {
            let norm = x.iter().fold(Dual::from(-0.25), |sum, &x| sum + x.square());
            x.iter().map(|&x| 1e-5f64.sqrt() * (x - 1.0)).chain([norm]).collect()
        },
    );
    run(
        all,
        options,
        "Variably dimensioned 8",
        std::array::from_fn(|j| 1.0 - (j as f64 + 1.0) / 8.0),
        &[(0.0, GLOBAL)],
        |x: &[Dual<8>; 8]| {
            let sum = x
                .iter()
                .zip(1..)
                .fold(Dual::from(0.0), |sum, (&x, j)| sum + f64::from(j) * (x - 1.0));
            x.iter().map(|&x| x - 1.0).chain([sum, sum.square()]).collect()
        },
    );
    let minima = [(0.0, GLOBAL), (1.0, "at (0, ..., 0, n + 1), in the paper")];
    run(all, options, "Brown almost linear 5", [0.5; 5], &minima, |x| {
        let sum = x.iter().fold(Dual::from(0.0), |sum, &x| sum + x);
        let product = x.iter().fold(Dual::from(1.0), |product, &x| product * x);
        (0..4).map(|i| x[i] + sum - 6.0).chain([product - 1.0]).collect()
    });
    run(
        all,
        options,
        "Chebyquad 8",
        std::array::from_fn(|j| (j as f64 + 1.0) / 9.0),
        &[(3.51687e-3, GLOBAL)],
        |x: &[Dual<8>; 8]| {
            let mut r = vec![Dual::from(0.0); 8];
            for &x in x {
                let y = 2.0 * x - 1.0;
                let (mut before, mut now) = (Dual::from(1.0), y);
                for r in &mut r {
                    *r = *r + now / 8.0;
                    (before, now) = (now, 2.0 * y * now - before);
                }
            }
            for i in (2..=8).step_by(2) {
                r[i - 1] = r[i - 1] + 1.0 / ((i * i) as f64 - 1.0);
            }
            r
        },
    );
    run(
        all,
        options,
        "Broyden tridiagonal 8",
        [-1.0; 8],
        &[(0.0, GLOBAL)],
        |x| {
            (0..8)
                .map(|i| {
                    let before = if i > 0 { x[i - 1] } else { Dual::from(0.0) };
                    let after = if i < 7 { x[i + 1] } else { Dual::from(0.0) };
                    (3.0 - 2.0 * x[i]) * x[i] - before - 2.0 * after + 1.0
                })
                .collect()
        },
    );
    runs
}

fn watson<const P: usize>(x: &[Dual<P>; P]) -> Vec<Dual<P>> {
    let mut r = vec![x[0], x[1] - x[0].square() - 1.0];
    for i in 1..=29 {
        let t = f64::from(i) / 29.0;
        let (mut slope, mut value) = (Dual::from(0.0), Dual::from(0.0));
        for j in (0..P).rev() {
            value = value * t + x[j];
            if j > 0 {
                slope = slope * t + j as f64 * x[j];
            }
        }
        r.push(slope - value.square() - 1.0);
    }
    r
}

/// The runs as a Markdown table.
pub fn table(runs: &[Run]) -> String {
    let mut text =
        String::from("| problem | P | start | cost | reached | passes | stop |\n|---|--:|--:|--:|---|--:|---|\n");
    for run in runs {
        let Run {
            name,
            parameters,
            factor,
            passes,
            stop,
            cost,
            reached,
        } = run;
        let reached = match reached {
            Some((minimum, kind)) => format!("{minimum:e}, {kind}"),
            None => "no".to_string(),
        };
        text += &format!("| {name} | {parameters} | {factor} | {cost:.6e} | {reached} | {passes} | {stop:?} |\n");
    }
    text
}
