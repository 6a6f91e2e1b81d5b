//! A scan that counts what is asked of it, and notes when the cost was least.

use std::cell::{Cell, RefCell};

use brdfit_core::brdf::{ALL, Brdf, Params};
use brdfit_core::geometry::{Geometry, Sample};
use brdfit_suite::hard_scenes::Task;

/// One scan for one racer: the model of Eq. 14 with its analytic derivatives.
pub struct Course {
    pub samples: Vec<Sample<f64>>,
    geometry: Vec<Geometry<f64>>,
    ln_f: Vec<f64>,
    pub lower: [f64; 6],
    pub upper: [f64; 6],
    /// Passes after which it is over.
    cap: f64,
    passes: Cell<f64>,
    /// Passes until each improvement, and the cost there.
    best: RefCell<Vec<(f64, f64)>>,
}

impl Course {
    pub fn new(task: &Task, cap: f64) -> Self {
        let geometry = |s: &Sample<f64>| Geometry::new(s.theta_i, s.theta_s, s.delta_phi).expect("a valid scene");
        Course {
            geometry: task.samples.iter().map(geometry).collect(),
            ln_f: task.samples.iter().map(|s| s.brdf.ln()).collect(),
            samples: task.samples.clone(),
            lower: task.lower.to_array(),
            upper: task.upper.to_array(),
            cap,
            passes: Cell::new(0.0),
            best: RefCell::default(),
        }
    }

    /// Number of samples.
    pub fn rows(&self) -> usize {
        self.ln_f.len()
    }

    /// Is the work of the race done?
    pub fn is_over(&self) -> bool {
        self.passes.get() >= self.cap
    }

    /// Work so far, in passes with derivatives.
    pub fn passes(&self) -> f64 {
        self.passes.get()
    }

    /// Work that is left.
    pub fn left(&self) -> f64 {
        (self.cap - self.passes.get()).max(0.0)
    }

    /// Counts work, in passes with derivatives.
    pub fn spend(&self, passes: f64) {
        self.passes.set(self.passes.get() + passes);
    }

    /// Notes a cost that was met now.
    pub fn note(&self, cost: f64) {
        self.note_at(self.passes.get(), cost);
    }

    /// Notes a cost that was met after so many passes.
    pub fn note_at(&self, passes: f64, cost: f64) {
        let mut best = self.best.borrow_mut();
        if passes <= self.cap && cost.is_finite() && best.last().is_none_or(|&(_, least)| cost < least) {
            best.push((passes, cost));
        }
    }

    /// The improvements.
    pub fn improvements(self) -> Vec<(f64, f64)> {
        self.best.into_inner()
    }

    fn at(&self, x: &[f64]) -> Brdf<f64, ALL> {
        Brdf::new(&Params::from_array(std::array::from_fn(|k| x[k])))
    }

    /// Residuals of ln f: a pass without derivatives, which counts half. Once it is over they are large, and cost nothing.
    pub fn residuals(&self, x: &[f64]) -> Vec<f64> {
        if self.is_over() {
            return vec![1e3; self.rows()];
        }
        let brdf = self.at(x);
        let rows = self.geometry.iter().zip(&self.ln_f);
        let rows: Vec<f64> = rows.map(|(geometry, ln_f)| brdf.ln_f(geometry) - ln_f).collect();
        self.spend(0.5);
        self.note(rows.iter().map(|r| r * r).sum());
        rows
    }

    /// The same with derivatives by the parameters: a whole pass.
    pub fn linearized(&self, x: &[f64]) -> (Vec<f64>, Vec<[f64; 6]>) {
        if self.is_over() {
            return (vec![1e3; self.rows()], vec![[0.0; 6]; self.rows()]);
        }
        let brdf = self.at(x);
        let rows = self.geometry.iter().zip(&self.ln_f);
        let (residuals, gradients): (Vec<f64>, Vec<[f64; 6]>) = rows
            .map(|(geometry, ln_f)| {
                let (value, gradient) = brdf.gradient(geometry);
                (value - ln_f, gradient)
            })
            .unzip();
        self.spend(1.0);
        self.note(residuals.iter().map(|r| r * r).sum());
        (residuals, gradients)
    }
}
