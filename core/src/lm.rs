//! Bounded Levenberg-Marquardt for any small least-squares problem; knows no BRDF.

use crate::boxqp;
use crate::real::Real;
use crate::saved::{Saved, Tape};

/// Sum of squared residuals with its first-order model.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Linearization<R, const P: usize> {
    /// Sum of squared residuals r.
    pub cost: R,
    /// J' r.
    pub gradient: [R; P],
    /// J' J.
    pub hessian: [[R; P]; P],
}

impl<R: Real, const P: usize> Linearization<R, P> {
    /// That of no residuals.
    pub const fn zero() -> Self {
        Linearization {
            cost: R::ZERO,
            gradient: [R::ZERO; P],
            hessian: [[R::ZERO; P]; P],
        }
    }

    /// Adds a residual with its derivatives by the parameters.
    ///
    /// ```
    /// use brdfit_core::lm::Linearization;
    ///
    /// // The line a + b t through (0, 1) and (1, 3), at a = b = 0.
    /// let mut sums = Linearization::<f64, 2>::zero();
    /// for (t, y) in [(0.0, 1.0), (1.0, 3.0)] {
    ///     sums.add(0.0 - y, &[1.0, t]);
    /// }
    /// assert_eq!((sums.cost, sums.gradient), (10.0, [-4.0, -3.0]));
    /// ```
    pub fn add(&mut self, residual: R, row: &[R; P]) {
        self.cost += residual * residual;
        for i in 0..P {
            self.gradient[i] += row[i] * residual;
            for j in 0..P {
                self.hessian[i][j] += row[i] * row[j];
            }
        }
    }

    /// Adds the sums over other residuals.
    pub fn add_part(&mut self, part: &Self) {
        self.cost += part.cost;
        for i in 0..P {
            self.gradient[i] += part.gradient[i];
            for j in 0..P {
                self.hessian[i][j] += part.hessian[i][j];
            }
        }
    }
}

/// A least-squares problem in `P` parameters.
pub trait Problem<R, const P: usize> {
    /// Sum of squared residuals at `x`.
    fn cost(&self, x: &[R; P]) -> R;
    /// The same with J'r and J'J.
    fn linearize(&self, x: &[R; P]) -> Linearization<R, P>;
    /// Where a step leads: `to` is `x + step`, and may be bent to where the linear model holds further, as long as it agrees with it to first order.
    ///
    /// A problem that knows nothing better gives `to`; one that wraps another passes this on, or fits take about twice the passes: so there is no default.
    fn bend(&self, x: &[R; P], step: &[R; P], to: [R; P]) -> [R; P];
}

impl<R, S: Problem<R, P> + ?Sized, const P: usize> Problem<R, P> for &S {
    fn cost(&self, x: &[R; P]) -> R {
        (**self).cost(x)
    }
    fn linearize(&self, x: &[R; P]) -> Linearization<R, P> {
        (**self).linearize(x)
    }
    fn bend(&self, x: &[R; P], step: &[R; P], to: [R; P]) -> [R; P] {
        (**self).bend(x, step, to)
    }
}

/// `lower <= x <= upper` for each parameter; equal bounds hold it fixed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Bounds<R, const P: usize> {
    /// Least values.
    pub lower: [R; P],
    /// Largest values.
    pub upper: [R; P],
}

impl<R: Real, const P: usize> Bounds<R, P> {
    /// The nearest point within; NaN becomes the lower bound.
    pub fn clamp(&self, x: [R; P]) -> [R; P] {
        let mut inside = x;
        self.keep(&mut inside);
        inside
    }

    /// The same, in place.
    #[cfg_attr(target_os = "none", inline(never))]
    pub(crate) fn keep(&self, x: &mut [R; P]) {
        for i in 0..P {
            x[i] = x[i].max(self.lower[i]).min(self.upper[i]);
        }
    }
}

/// When to stop, and how carefully to begin.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Options<R> {
    /// See [`Stop::Cost`]; dimensionless.
    pub cost_tolerance: R,
    /// See [`Stop::Step`]; dimensionless.
    pub step_tolerance: R,
    /// See [`Stop::Passes`].
    pub max_passes: u32,
    /// First damping, in units of the largest diagonal of J'J seen so far.
    pub damping: R,
}

impl<R: Real> Default for Options<R> {
    fn default() -> Self {
        Options {
            cost_tolerance: R::EPSILON,
            step_tolerance: R::EPSILON,
            max_passes: 500,
            damping: R::of(1e-3),
        }
    }
}

/// [`Fit::settle`]: the first damping at most, and what is left of it after each step.
const SETTLING_DAMPING: f64 = 1e-7;
const SETTLING_FALL: f64 = 0.1;
/// No more than this part of the cost may a step of it lose.
const SETTLING_RISE: f64 = 1e-6;
/// It ends where a step promises no more than the square of so many units of rounding, of the cost: that of the gradient.
const SETTLED: f64 = 256.0;

/// How a fit ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Stop {
    /// Converged: with a damping of at most 1e-2 the linear model promises a reduction of at most `cost_tolerance * cost`.
    Cost,
    /// Converged as far as rounding allows: no step longer than `step_tolerance` of each parameter lowers the cost.
    Step,
    /// `max_passes` evaluations were made.
    Passes,
    /// Cost or derivatives are not finite at the start: nothing was done.
    NotFinite,
}

/// How a fit can have ended, or not, in the order of [`crate::saved`].
const ENDS: [Option<Stop>; 5] = [
    None,
    Some(Stop::Cost),
    Some(Stop::Step),
    Some(Stop::Passes),
    Some(Stop::NotFinite),
];

impl Stop {
    /// True if more passes would not lower the cost.
    pub fn converged(self) -> bool {
        matches!(self, Stop::Cost | Stop::Step)
    }
}

/// Where a fit is; copied, it can be continued later.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fit<R, const P: usize> {
    /// Best parameters so far.
    pub x: [R; P],
    /// Cost and its model there.
    pub at: Linearization<R, P>,
    /// Evaluations of [`Problem::linearize`] so far.
    pub passes: u32,
    /// How it ended, if it has.
    pub stop: Option<Stop>,
    damping: R,
    growth: R,
    /// The largest diagonal of J'J so far: a parameter that the residuals have just lost sight of is not thrown far away (Moré 1978).
    scale: [R; P],
}

impl<R: Real, const P: usize> Fit<R, P> {
    /// The place of a fit that was never begun; all zeros.
    pub(crate) const fn nowhere() -> Self {
        Fit {
            x: [R::ZERO; P],
            at: Linearization::zero(),
            passes: 0,
            stop: Some(Stop::Cost),
            damping: R::ZERO,
            growth: R::ZERO,
            scale: [R::ZERO; P],
        }
    }

    /// Begins at the point of `bounds` nearest to `start`; one pass.
    pub fn begin(
        problem: &(impl Problem<R, P> + ?Sized),
        bounds: &Bounds<R, P>,
        start: [R; P],
        options: &Options<R>,
    ) -> Self {
        let x = bounds.clamp(start);
        let mut fit = Fit {
            x,
            at: problem.linearize(&x),
            passes: 1,
            stop: None,
            damping: options.damping,
            growth: R::of(2.0),
            scale: [R::ZERO; P],
        };
        for i in 0..P {
            fit.scale[i] = fit.at.hessian[i][i];
        }
        if !is_finite(&fit.at) {
            fit.end(Stop::NotFinite);
        }
        fit
    }

    fn end(&mut self, stop: Stop) {
        self.stop = Some(stop);
        #[cfg(feature = "defmt")]
        defmt::info!(
            "fit: cost {=f64} after {=u32} passes, {}",
            self.at.cost.f64(),
            self.passes,
            stop
        );
    }

    /// Makes steps until the fit ends, or has made `passes` in all.
    pub fn run(
        &mut self,
        problem: &(impl Problem<R, P> + ?Sized),
        bounds: &Bounds<R, P>,
        options: &Options<R>,
        passes: u32,
    ) {
        while self.stop.is_none() && self.passes < passes {
            self.step(problem, bounds, options);
        }
    }

    /// One trial step; how many passes it took: one, or none if the fit ends before it.
    pub fn step(
        &mut self,
        problem: &(impl Problem<R, P> + ?Sized),
        bounds: &Bounds<R, P>,
        options: &Options<R>,
    ) -> u32 {
        if self.stop.is_some() {
            return 0;
        }
        if self.passes >= options.max_passes {
            self.end(Stop::Passes);
            return 0;
        }
        let cost = self.at.cost;
        let step = self.bounded(&self.at.hessian, bounds);
        let mut x = problem.bend(&self.x, &step, self.straight(&step));
        self.land(bounds, &step, &mut x);
        let mut moved = false;
        for i in 0..P {
            moved |= (x[i] - self.x[i]).abs() > options.step_tolerance * self.x[i].abs();
        }
        if !moved {
            self.end(Stop::Step);
            return 0;
        }
        let mut predicted = R::ZERO;
        for i in 0..P {
            let mut h_step = R::ZERO;
            for j in 0..P {
                h_step += self.at.hessian[i][j] * step[j];
            }
            predicted -= step[i] * (self.at.gradient[i] + self.at.gradient[i] + h_step);
        }
        if self.damping <= R::of(1e-2) && !(predicted > options.cost_tolerance * cost) {
            self.end(Stop::Cost);
            return 0;
        }
        let trial = problem.linearize(&x);
        self.passes += 1;
        let gain = (cost - trial.cost) / predicted;
        if trial.cost < cost && is_finite(&trial) {
            self.x = x;
            self.at = trial;
            for i in 0..P {
                self.scale[i] = self.scale[i].max(trial.hessian[i][i]);
            }
            let two = R::of(2.0);
            let wave = two * gain.min(R::ONE) - R::ONE;
            self.damping *= (R::ONE - wave * wave * wave).max(R::of(1.0 / 3.0));
            self.damping = self.damping.max(R::MIN_POSITIVE);
            self.growth = two;
        } else {
            self.damping = (self.damping * self.growth).min(R::MAX);
            self.growth = (self.growth + self.growth).min(R::of(1e6));
        }
        1
    }

    /// The damped step within the bounds, by this model of the second derivatives.
    #[cfg_attr(target_os = "none", inline(never))]
    fn bounded(&self, model: &[[R; P]; P], bounds: &Bounds<R, P>) -> [R; P] {
        let mut lower = [R::ZERO; P];
        let mut upper = [R::ZERO; P];
        let mut damped = *model;
        for i in 0..P {
            lower[i] = bounds.lower[i] - self.x[i];
            upper[i] = bounds.upper[i] - self.x[i];
            // A column of J below rounding has no scale of its own, and its step could be of any size: see it as just above.
            let unseen = R::EPSILON / self.x[i].abs().max(R::ONE);
            let scale = (unseen * unseen * self.at.cost).max(self.scale[i]).max(R::MIN_POSITIVE);
            damped[i][i] += self.damping * scale;
        }
        boxqp::minimize(&damped, &self.at.gradient, &lower, &upper)
    }

    /// Where a step leads if it is not bent.
    #[cfg_attr(target_os = "none", inline(never))]
    fn straight(&self, step: &[R; P]) -> [R; P] {
        let mut x = self.x;
        for i in 0..P {
            x[i] += step[i];
        }
        x
    }

    /// Keeps the end of a step within the bounds; a step to a bound ends on it, whatever the rounding of the sum.
    #[cfg_attr(target_os = "none", inline(never))]
    fn land(&self, bounds: &Bounds<R, P>, step: &[R; P], x: &mut [R; P]) {
        bounds.keep(x);
        for i in 0..P {
            if step[i] == bounds.upper[i] - self.x[i] {
                x[i] = bounds.upper[i];
            } else if step[i] == bounds.lower[i] - self.x[i] {
                x[i] = bounds.lower[i];
            }
        }
    }

    /// Follows a fit that has converged, beyond what its cost can tell, to where the gradient vanishes, so that its end does not depend on its start; in at most so many passes more. Not for an exact fit, of which the gradient is rounding.
    pub fn settle_within(&mut self, problem: &(impl Problem<R, P> + ?Sized), bounds: &Bounds<R, P>, passes: u32) {
        let mut model = self.at.hessian;
        let end = self.passes.saturating_add(passes);
        while self.stop.is_some_and(Stop::converged)
            && self.passes < end
            && self.settle(problem, bounds, &mut model) > 0
        {}
    }

    /// One step of a fit that has converged, beyond what its cost can tell: to where the gradient vanishes; how many passes it took: one, or none if there is nothing left to gain.
    ///
    /// Along a valley J'J may be a hundredth of the second derivative. So it is corrected in `model`, at first J'J, by the gradients at both ends of each step: the symmetric correction of rank one (Nocedal and Wright 2006, Eq. 6.24), where that leaves it positive along the step.
    #[cfg_attr(target_os = "none", inline(never))]
    pub(crate) fn settle(
        &mut self,
        problem: &(impl Problem<R, P> + ?Sized),
        bounds: &Bounds<R, P>,
        model: &mut [[R; P]; P],
    ) -> u32 {
        self.damping = self.damping.min(R::of(SETTLING_DAMPING));
        let step = self.bounded(model, bounds);
        let mut x = self.straight(&step);
        self.land(bounds, &step, &mut x);
        let mut way = x;
        let mut promised = R::ZERO;
        for i in 0..P {
            way[i] -= self.x[i];
            promised -= way[i] * self.at.gradient[i];
        }
        let least = R::of(SETTLED) * R::EPSILON;
        if !(promised > least * least * self.at.cost) {
            return 0;
        }
        let trial = problem.linearize(&x);
        self.passes += 1;
        let (mut slope, mut curvature, mut missing) = (R::ZERO, R::ZERO, trial.gradient);
        for i in 0..P {
            missing[i] -= self.at.gradient[i];
            for j in 0..P {
                missing[i] -= model[i][j] * way[j];
            }
            slope += way[i] * trial.gradient[i];
            curvature += way[i] * missing[i];
        }
        if curvature > R::of(-0.9) * promised && curvature.abs() > R::of(0.01) * promised {
            for i in 0..P {
                for j in 0..P {
                    model[i][j] += missing[i] * missing[j] / curvature;
                }
            }
        }
        // No further beyond where the slope vanishes than before it.
        if slope <= promised && trial.cost < self.at.cost * R::of(1.0 + SETTLING_RISE) {
            self.x = x;
            self.at = trial;
            self.damping *= R::of(SETTLING_FALL);
        }
        1
    }
}

/// A whole fit from one start.
pub fn fit<R: Real, const P: usize>(
    problem: &(impl Problem<R, P> + ?Sized),
    bounds: &Bounds<R, P>,
    start: [R; P],
    options: &Options<R>,
) -> Fit<R, P> {
    let mut fit = Fit::begin(problem, bounds, start, options);
    fit.run(problem, bounds, options, u32::MAX);
    fit
}

fn is_finite<R: Real, const P: usize>(at: &Linearization<R, P>) -> bool {
    let mut finite = at.cost.is_finite();
    for i in 0..P {
        finite &= at.gradient[i].is_finite();
        for j in 0..P {
            finite &= at.hessian[i][j].is_finite();
        }
    }
    finite
}

impl<R: Real, const P: usize> Saved for Fit<R, P> {
    fn shape(&self) -> [u32; 3] {
        [2, size_of::<R>() as u32, P as u32]
    }
    fn fields(&mut self, tape: &mut Tape<'_>) {
        tape.reals(&mut self.x);
        tape.reals(core::slice::from_mut(&mut self.at.cost));
        tape.reals(&mut self.at.gradient);
        tape.reals(self.at.hessian.as_flattened_mut());
        tape.u32(&mut self.passes);
        tape.one_of(&mut self.stop, &ENDS);
        tape.reals(core::slice::from_mut(&mut self.damping));
        tape.reals(core::slice::from_mut(&mut self.growth));
        tape.reals(&mut self.scale);
    }
}
