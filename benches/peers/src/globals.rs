//! Other people's global methods, in the logarithms of the parameters: NLopt's MLSL, and `basin`'s differential evolution and CMA-ES.

use std::convert::Infallible;

use basin::{
    BoundedCmaEs, BoxBounds, ConstraintDescription, ConstraintSet, Constraints, CostFunction, De, DenseMatrix,
    Executor, PopulationProgress,
};
use nlopt::{Algorithm, Nlopt, Target};

use crate::course::Course;

/// Least of those parameters that may be 0, for a logarithm.
pub const SMALLEST: f64 = 1e-3;

/// The bounds in logarithms.
pub fn box_of(course: &Course) -> [Vec<f64>; 2] {
    let lower = course
        .lower
        .iter()
        .map(|&x| if x > 0.0 { x.ln() } else { SMALLEST.ln() });
    [lower.collect(), course.upper.iter().map(|x| x.ln()).collect()]
}

fn exp(u: &[f64]) -> Vec<f64> {
    u.iter().map(|u| u.exp()).collect()
}

/// Multi-level single linkage with a low-discrepancy sequence (Rinnooy Kan and Timmer 1987; Kucherenko and Sytsko 2005), with a local method.
fn mlsl(course: &Course, local: Algorithm, seed: u64) {
    let [lower, upper] = box_of(course);
    let objective = |u: &[f64], slopes: Option<&mut [f64]>, course: &mut &Course| -> f64 {
        let x = exp(u);
        let residuals = match slopes {
            None => course.residuals(&x),
            Some(slopes) => {
                let (residuals, gradients) = course.linearized(&x);
                for (k, slope) in slopes.iter_mut().enumerate() {
                    let rows = residuals.iter().zip(&gradients);
                    *slope = rows.map(|(r, gradient)| 2.0 * r * gradient[k]).sum::<f64>() * x[k];
                }
                residuals
            }
        };
        residuals.iter().map(|r| r * r).sum()
    };
    let mut global = Nlopt::new(Algorithm::GMlslLds, 6, objective, Target::Minimize, course);
    let mut own = global.get_local_optimizer(local);
    own.set_ftol_rel(1e-10).expect("a tolerance");
    own.set_maxeval(300).expect("a limit");
    global.set_lower_bounds(&lower).expect("bounds");
    global.set_upper_bounds(&upper).expect("bounds");
    global.set_local_optimizer(own).expect("a local method");
    let cap = course.left().ceil() as u32;
    global.set_maxeval(2 * cap + 10).expect("a limit");
    // Its sequence has no seed: the first point is another one.
    let mut first = crate::racers::log_uniform(course, seed, 0).map(f64::ln);
    let _ = global.optimize(&mut first);
}

pub fn mlsl_lbfgs(course: &Course, seed: u64) {
    mlsl(course, Algorithm::Lbfgs, seed);
}

pub fn mlsl_slsqp(course: &Course, seed: u64) {
    mlsl(course, Algorithm::Slsqp, seed);
}

/// The cost over logarithms, as `basin` wants it.
struct Logarithms<'a> {
    course: &'a Course,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl<'a> Logarithms<'a> {
    fn of(course: &'a Course) -> Self {
        let [lower, upper] = box_of(course);
        Logarithms { course, lower, upper }
    }
}

impl CostFunction for Logarithms<'_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Infallible;
    fn cost(&self, u: &Vec<f64>) -> Result<f64, Infallible> {
        Ok(self.course.residuals(&exp(u)).iter().map(|r| r * r).sum())
    }
}

impl Constraints for Logarithms<'_> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;
    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new().with_bounds(BoxBounds::new(Some(&self.lower), Some(&self.upper)))
    }
}

pub fn differential_evolution(course: &Course, seed: u64) {
    let generations = (2.0 * course.left() / De::<f64>::default_pop_size(6) as f64).ceil() as u64;
    let solver = De::<f64>::new(seed);
    let run = Executor::new(Logarithms::of(course), solver, PopulationProgress::empty());
    let _ = run.max_iter(generations).run();
}

/// Restarted from uniform means, as often as there is work left.
pub fn cma_es(course: &Course, seed: u64) {
    let mut k = 0;
    while !course.is_over() {
        let problem = Logarithms::of(course);
        let mean: Vec<f64> = crate::racers::log_uniform(course, seed, k)
            .iter()
            .map(|x| x.ln())
            .collect();
        let solver = BoundedCmaEs::<Vec<f64>, DenseMatrix<f64>>::new(seed + k, 2.0)
            .with_absolute_distribution_size_tolerance(Some(1e-6));
        let run = Executor::new(problem, solver, PopulationProgress::from_point(mean));
        let _ = run.max_iter(300).run();
        k += 1;
    }
}
