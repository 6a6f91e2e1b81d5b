//! One fit of a scan by each local solver, from one start within the bounds.

use std::convert::Infallible;

use basin::{
    BoundedLevenbergMarquardt, BoxBounds, ConstraintDescription, ConstraintSet, Constraints, DenseMatrix, Executor,
    Jacobian, PointState, Residual,
};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use rmpfit::{MPFitter, MPPar, MPResult, MPSide};

use crate::course::Course;

/// A problem of `basin`: the course with its bounds.
pub struct Bounded<'a> {
    pub course: &'a Course,
    pub lower: Vec<f64>,
    pub upper: Vec<f64>,
}

impl Constraints for Bounded<'_> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;
    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new().with_bounds(BoxBounds::new(Some(&self.lower), Some(&self.upper)))
    }
}

impl Residual for Bounded<'_> {
    type Param = Vec<f64>;
    type Output = Vec<f64>;
    type Error = Infallible;
    fn residual(&self, x: &Vec<f64>) -> Result<Vec<f64>, Infallible> {
        Ok(self.course.residuals(x))
    }
}

impl Jacobian for Bounded<'_> {
    type Jacobian = DenseMatrix<f64>;
    fn jacobian(&self, x: &Vec<f64>) -> Result<DenseMatrix<f64>, Infallible> {
        Ok(self.residual_and_jacobian(x)?.1)
    }
    fn residual_and_jacobian(&self, x: &Vec<f64>) -> Result<(Vec<f64>, DenseMatrix<f64>), Infallible> {
        let (values, gradients) = self.course.linearized(x);
        let matrix = DenseMatrix::from_row_slice(values.len(), 6, gradients.as_flattened());
        Ok((values, matrix))
    }
}

pub fn basin(course: &Course, start: &[f64; 6]) {
    let solver = BoundedLevenbergMarquardt::new().with_relative_cost_change_tolerance(1e-10);
    let problem = Bounded {
        course,
        lower: course.lower.to_vec(),
        upper: course.upper.to_vec(),
    };
    let run = Executor::new(problem, solver, PointState::new(start.to_vec()));
    let _ = run.max_iter(200).run();
}

/// The bounds as `rmpfit` wants them.
struct Limited<'a>(&'a Course, Vec<MPPar>);

impl MPFitter for Limited<'_> {
    fn eval(&mut self, x: &[f64], deviates: &mut [f64]) -> MPResult<()> {
        deviates.copy_from_slice(&self.0.residuals(x));
        Ok(())
    }
    fn number_of_points(&self) -> usize {
        self.0.rows()
    }
    fn parameters(&self) -> &[MPPar] {
        &self.1
    }
    fn jacobian(&mut self, x: &[f64], deviates: &mut [f64], derivs: &mut [Option<Vec<f64>>]) -> MPResult<()> {
        let (residuals, gradients) = self.0.linearized(x);
        deviates.copy_from_slice(&residuals);
        for (k, column) in derivs.iter_mut().enumerate() {
            if let Some(column) = column {
                column
                    .iter_mut()
                    .zip(&gradients)
                    .for_each(|(d, gradient)| *d = gradient[k]);
            }
        }
        Ok(())
    }
}

pub fn rmpfit(course: &Course, start: &[f64; 6]) {
    let limit = |k: usize| MPPar {
        limited_low: true,
        limited_up: true,
        limit_low: course.lower[k],
        limit_up: course.upper[k],
        side: MPSide::User,
        ..MPPar::new()
    };
    let mut x = *start;
    let _ = Limited(course, (0..6).map(limit).collect()).mpfit(&mut x);
}

/// For solvers without bounds: x = lower + (upper - lower) sin^2 u.
pub struct Free<'a> {
    pub course: &'a Course,
    pub u: Vec<f64>,
}

impl<'a> Free<'a> {
    pub fn begin(course: &'a Course, start: &[f64; 6]) -> Self {
        let part = |k: usize| (start[k] - course.lower[k]) / (course.upper[k] - course.lower[k]);
        Free {
            course,
            u: (0..6).map(|k| part(k).sqrt().asin()).collect(),
        }
    }

    pub fn x(&self) -> [f64; 6] {
        let (lower, upper) = (&self.course.lower, &self.course.upper);
        std::array::from_fn(|k| (lower[k] + (upper[k] - lower[k]) * self.u[k].sin().powi(2)).min(upper[k]))
    }

    /// Residuals, and their derivatives by u.
    pub fn linearized(&self) -> (Vec<f64>, Vec<[f64; 6]>) {
        let (residuals, mut gradients) = self.course.linearized(&self.x());
        for gradient in &mut gradients {
            for (k, slope) in gradient.iter_mut().enumerate() {
                *slope *= (self.course.upper[k] - self.course.lower[k]) * (2.0 * self.u[k]).sin();
            }
        }
        (residuals, gradients)
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Free<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;
    fn set_params(&mut self, u: &DVector<f64>) {
        self.u.copy_from_slice(u.as_slice());
    }
    fn params(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.u)
    }
    fn residuals(&self) -> Option<DVector<f64>> {
        (!self.course.is_over()).then(|| DVector::from_vec(self.course.residuals(&self.x())))
    }
    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let (_, gradients) = self.linearized();
        Some(DMatrix::from_row_slice(gradients.len(), 6, gradients.as_flattened()))
    }
}

pub fn levenberg_marquardt(course: &Course, start: &[f64; 6]) {
    let _ = LevenbergMarquardt::new()
        .with_tol(1e-10)
        .minimize(Free::begin(course, start));
}
