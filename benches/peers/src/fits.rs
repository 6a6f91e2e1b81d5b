//! One fit of a scan by each of the Rust peers, from one start within the bounds.

use std::cell::Cell;
use std::convert::Infallible;

use basin::{
    BoundedLevenbergMarquardt, BoxBounds, ConstraintDescription, ConstraintSet, Constraints, DenseMatrix, Executor,
    Jacobian, PointState, Residual,
};
use brdfit_core::brdf::{ALL, Brdf, Params};
use brdfit_core::geometry::{Geometry, Sample};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use rmpfit::{MPFitter, MPPar, MPResult, MPSide};

/// A scan with the model's own analytic derivatives, one sample after the other.
pub struct Scan {
    pub geometry: Vec<Geometry<f64>>,
    pub ln_f: Vec<f64>,
    pub lower: Vec<f64>,
    pub upper: Vec<f64>,
    /// Evaluations of all residuals, with or without their derivatives.
    pub evaluations: Cell<u32>,
}

impl Scan {
    pub fn new(samples: &[Sample<f64>], lower: [f64; 6], upper: [f64; 6]) -> Self {
        let geometry = |s: &Sample<f64>| Geometry::new(s.theta_i, s.theta_s, s.delta_phi).expect("the sets are valid");
        Scan {
            geometry: samples.iter().map(geometry).collect(),
            ln_f: samples.iter().map(|s| s.brdf.ln()).collect(),
            lower: lower.to_vec(),
            upper: upper.to_vec(),
            evaluations: Cell::new(0),
        }
    }

    fn brdf(&self, x: &[f64]) -> Brdf<f64, ALL> {
        self.evaluations.set(self.evaluations.get() + 1);
        Brdf::new(&Params::from_array(std::array::from_fn(|k| x[k])))
    }

    fn residuals(&self, x: &[f64]) -> impl Iterator<Item = f64> {
        let brdf = self.brdf(x);
        let rows = self.geometry.iter().zip(&self.ln_f);
        rows.map(move |(geometry, ln_f)| brdf.ln_f(geometry) - ln_f)
    }

    fn rows(&self, x: &[f64]) -> impl Iterator<Item = (f64, [f64; 6])> {
        let brdf = self.brdf(x);
        let rows = self.geometry.iter().zip(&self.ln_f);
        rows.map(move |(geometry, ln_f)| {
            let (value, gradient) = brdf.gradient(geometry);
            (value - ln_f, gradient)
        })
    }

    fn cost(&self, x: &[f64]) -> f64 {
        self.residuals(x).map(|r| r * r).sum()
    }
}

/// Fits from a start, and returns the sum of squares that it ends at.
pub type Peer = fn(&Scan, &[f64; 6]) -> f64;

/// Those in Rust.
pub const PEERS: [(&str, Peer); 3] = [
    ("`basin` 3.2, BoundedLevenbergMarquardt", basin),
    ("`rmpfit` 2.0", rmpfit),
    ("`levenberg-marquardt` 0.15", levenberg_marquardt),
];

impl Constraints for &Scan {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;
    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new().with_bounds(BoxBounds::new(Some(&self.lower), Some(&self.upper)))
    }
}

impl Residual for &Scan {
    type Param = Vec<f64>;
    type Output = Vec<f64>;
    type Error = Infallible;
    fn residual(&self, x: &Vec<f64>) -> Result<Vec<f64>, Infallible> {
        Ok(self.residuals(x).collect())
    }
}

impl Jacobian for &Scan {
    type Jacobian = DenseMatrix<f64>;
    fn jacobian(&self, x: &Vec<f64>) -> Result<DenseMatrix<f64>, Infallible> {
        Ok(self.residual_and_jacobian(x)?.1)
    }
    fn residual_and_jacobian(&self, x: &Vec<f64>) -> Result<(Vec<f64>, DenseMatrix<f64>), Infallible> {
        let (values, gradients): (Vec<f64>, Vec<[f64; 6]>) = self.rows(x).unzip();
        let matrix = DenseMatrix::from_row_slice(values.len(), 6, gradients.as_flattened());
        Ok((values, matrix))
    }
}

fn basin(scan: &Scan, start: &[f64; 6]) -> f64 {
    let solver = BoundedLevenbergMarquardt::new().with_relative_cost_change_tolerance(1e-10);
    let run = Executor::new(scan, solver, PointState::new(start.to_vec()))
        .max_iter(200)
        .run();
    run.map_or(f64::INFINITY, |result| 2.0 * result.cost())
}

/// The bounds as `rmpfit` wants them.
struct Limited<'a>(&'a Scan, Vec<MPPar>);

impl MPFitter for Limited<'_> {
    fn eval(&mut self, x: &[f64], deviates: &mut [f64]) -> MPResult<()> {
        self.0.residuals(x).zip(deviates).for_each(|(r, deviate)| *deviate = r);
        Ok(())
    }
    fn number_of_points(&self) -> usize {
        self.0.ln_f.len()
    }
    fn parameters(&self) -> &[MPPar] {
        &self.1
    }
    fn jacobian(&mut self, x: &[f64], deviates: &mut [f64], derivs: &mut [Option<Vec<f64>>]) -> MPResult<()> {
        for (i, (r, gradient)) in self.0.rows(x).enumerate() {
            deviates[i] = r;
            for (column, d) in derivs.iter_mut().zip(gradient) {
                if let Some(column) = column {
                    column[i] = d;
                }
            }
        }
        Ok(())
    }
}

fn rmpfit(scan: &Scan, start: &[f64; 6]) -> f64 {
    let limit = |k: usize| MPPar {
        limited_low: true,
        limited_up: true,
        limit_low: scan.lower[k],
        limit_up: scan.upper[k],
        side: MPSide::User,
        ..MPPar::new()
    };
    let mut x = *start;
    let status = Limited(scan, (0..6).map(limit).collect()).mpfit(&mut x);
    status.map_or(f64::INFINITY, |status| status.best_norm)
}

/// Without bounds of its own: x = lower + (upper - lower) sin^2 u.
struct Free<'a> {
    scan: &'a Scan,
    u: DVector<f64>,
}

impl Free<'_> {
    fn x(&self) -> [f64; 6] {
        let (lower, upper) = (&self.scan.lower, &self.scan.upper);
        std::array::from_fn(|k| (lower[k] + (upper[k] - lower[k]) * self.u[k].sin().powi(2)).min(upper[k]))
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Free<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;
    fn set_params(&mut self, u: &DVector<f64>) {
        self.u.copy_from(u);
    }
    fn params(&self) -> DVector<f64> {
        self.u.clone()
    }
    fn residuals(&self) -> Option<DVector<f64>> {
        Some(DVector::from_iterator(
            self.scan.ln_f.len(),
            self.scan.residuals(&self.x()),
        ))
    }
    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let slope = |k: usize| (self.scan.upper[k] - self.scan.lower[k]) * (2.0 * self.u[k]).sin();
        let x = self.x();
        let rows = self.scan.rows(&x);
        let entries = rows.flat_map(|(_, gradient)| (0..6).map(move |k| gradient[k] * slope(k)));
        Some(DMatrix::from_row_iterator(self.scan.ln_f.len(), 6, entries))
    }
}

fn levenberg_marquardt(scan: &Scan, start: &[f64; 6]) -> f64 {
    let part = |k: usize| (start[k] - scan.lower[k]) / (scan.upper[k] - scan.lower[k]);
    let u = DVector::from_iterator(6, (0..6).map(|k| part(k).sqrt().asin()));
    let (problem, report) = LevenbergMarquardt::new().with_tol(1e-10).minimize(Free { scan, u });
    if report.objective_function.is_finite() {
        2.0 * report.objective_function
    } else {
        scan.cost(&problem.x())
    }
}
