//! What a model is: its parameters, and what a pass over a scan computes of it.
//!
//! Scan, candidates, search, minima and uncertainty are written once, against [`Model`]; [`crate::formula`] makes one from a formula alone.

use crate::geometry::{Block, LANES, SampleError};
use crate::lm::Bounds;
use crate::pack::Pack;
use crate::real::Real;

/// What a parameter does, and so how a search proposes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Role {
    /// f is linear in it: a candidate has the value that fits best.
    Weight,
    /// The width of a peak, dimensionless: candidates go down to what the scan resolves.
    Slope,
    /// The real part of an index of refraction.
    Index,
    /// The imaginary part of an index of refraction; the solver's coordinate is its square.
    Absorption,
    /// Anything else.
    Shape,
}

/// One parameter of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Parameter {
    /// What files and options call it.
    pub name: &'static str,
    /// What plots and reports call it.
    pub symbol: &'static str,
    /// Its unit; empty where it is dimensionless.
    pub unit: &'static str,
    /// What it is, in a few words.
    pub what: &'static str,
    /// What it does.
    pub role: Role,
    /// Least and largest value of a fit, unless the caller says otherwise.
    pub bounds: (f64, f64),
    /// Least and largest value that it can have at all; the bounds lie within.
    pub domain: (f64, f64),
    /// Between which values of the solver's coordinate candidates are spread, within the bounds; evenly in the logarithm if the first is above 0. Weights are not spread.
    pub spread: (f64, f64),
}

/// The largest value of a parameter that keeps the arithmetic of `f32` finite.
pub const LARGEST: f64 = 1e6;

impl Parameter {
    /// A dimensionless parameter that is 0 or more, up to `most` in a fit.
    pub const fn new(name: &'static str, symbol: &'static str, role: Role, most: f64) -> Self {
        Parameter {
            name,
            symbol,
            unit: "",
            what: "",
            role,
            bounds: (0.0, most),
            domain: (0.0, LARGEST),
            spread: (0.0, most),
        }
    }
    /// The same, said what it is.
    pub const fn what(mut self, what: &'static str) -> Self {
        self.what = what;
        self
    }
    /// The same, with a unit.
    pub const fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }
    /// The same, with other bounds of a fit.
    pub const fn bounds(mut self, lower: f64, upper: f64) -> Self {
        self.bounds = (lower, upper);
        self
    }
    /// The same, with another domain.
    pub const fn domain(mut self, lower: f64, upper: f64) -> Self {
        self.domain = (lower, upper);
        self
    }
    /// The same, with candidates between other values.
    pub const fn spread(mut self, lower: f64, upper: f64) -> Self {
        self.spread = (lower, upper);
        self
    }
    /// Is the solver's coordinate the square of the parameter?
    ///
    /// F is even in kappa: its derivative by kappa is 0 at 0, and a search in kappa cannot leave 0.
    pub const fn is_squared(&self) -> bool {
        matches!(self.role, Role::Absorption)
    }
    /// Derivative of the parameter by the solver's coordinate, where that is `x`; 0 at kappa = 0, where there is none.
    pub fn slope<R: Real>(&self, x: R) -> R {
        match self.is_squared() {
            false => R::ONE,
            true if x > R::ZERO => R::of(0.5) / x.sqrt(),
            true => R::ZERO,
        }
    }
    /// Is f linear in it?
    pub const fn is_weight(&self) -> bool {
        matches!(self.role, Role::Weight)
    }
}

/// Weights of a model at most.
pub const WEIGHTS: usize = 4;
/// Number of partial sums that run side by side.
pub(crate) const SUMS: usize = 8;
/// Lanes of a block for each of them, which go through the model's formulas side by side.
pub const GROUP: usize = LANES / SUMS;

/// ln f of `G` lanes of a block, with its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Rows<R, const G: usize, const P: usize> {
    /// ln f, f in sr^-1.
    pub ln_f: Pack<R, G>,
    /// Its derivatives by the solver's coordinates.
    pub gradient: [Pack<R, G>; P],
}

/// What is wanted of one row beside ln f.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Want {
    /// Nothing.
    Value,
    /// Its derivatives by the solver's coordinates, times the lane's weight.
    Gradient,
    /// In the place of each weight f of that weight at 1 and the others at 0, sr^-1; the other places stay as they are, and ln f is not wanted.
    Columns,
}

/// What the directions of a scan tell before any fit.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Seen<R> {
    /// The least slope that a few samples still see, dimensionless; 0 if nothing is known of it.
    pub finest: R,
    /// cos theta_d nearest to the peak of the surface and of the volume lobe.
    pub peaks: Pack<R, 2>,
    /// (tan^2 theta_h, ln f) of the samples nearest to the peak of each lobe, nearest first; tan^2 theta_h is the largest number where there are fewer.
    pub near: [[(R, R); NEAR]; 2],
}

/// Samples near a peak that are remembered.
pub const NEAR: usize = 8;

impl<R: Real> Seen<R> {
    /// Of a scan that tells nothing.
    pub const fn nothing() -> Self {
        let mut seen = Seen {
            finest: R::ZERO,
            peaks: Pack([R::ONE; 2]),
            near: [[(R::ZERO, R::ZERO); NEAR]; 2],
        };
        // A loop, where an image would otherwise copy one half from the other.
        let near = seen.near.as_flattened_mut();
        let mut k = 0;
        while k < near.len() {
            near[k].0 = R::MAX;
            k += 1;
        }
        seen
    }
}

/// A model of `P` parameters that needs `C` numbers of each pair of directions.
///
/// It has no value: what is left out at compile time costs nothing.
/// Each method is compiled into the passes of [`crate::residuals::Residuals`]; those with lanes must be written so that the compiler can turn a loop over lanes into vector instructions.
pub trait Model<R: Real, const P: usize, const C: usize>: Copy {
    /// Its parameters, in the order of the solver's coordinates; at most [`WEIGHTS`] of them are weights.
    const PARAMETERS: [Parameter; P];
    /// What follows from the parameters alone.
    type Pass: Copy;
    /// What follows from them for a block, before its lanes go side by side.
    type Begun<const L: usize>: Copy;

    /// The numbers of a pair of directions, in radians as in [`crate::geometry::Sample`].
    ///
    /// # Errors
    /// [`SampleError::NotFinite`] and [`SampleError::BeyondHorizon`].
    fn geometry(theta_i: R, theta_s: R, delta_phi: R) -> Result<[R; C], SampleError>;

    /// What follows from the solver's coordinates alone.
    fn pass(x: &[R; P]) -> Self::Pass;

    /// What follows from them for one block.
    fn begin<const L: usize>(pass: &Self::Pass, block: &Block<R, L, C>) -> Self::Begun<L>;

    /// ln f of the lanes of [`Pack::gather`], and if `GRADIENT` its derivatives.
    fn rows<const GRADIENT: bool>(
        pass: &Self::Pass,
        block: &Block<R, LANES, C>,
        begun: &Self::Begun<LANES>,
        lane: usize,
    ) -> Rows<R, GROUP, P>;

    /// ln f of one lane, and in `row` what is wanted beside it.
    fn row<const L: usize>(pass: &Self::Pass, block: &Block<R, L, C>, lane: usize, want: Want, row: &mut [R; P]) -> R;

    /// f of each weight at 1 and the others at 0, sr^-1, in the lanes of [`Pack::gather`]; in the order of the weights among the parameters.
    fn columns(pass: &Self::Pass, block: &Block<R, LANES, C>, lane: usize) -> [Pack<R, GROUP>; WEIGHTS];

    /// What the directions of a scan tell.
    fn seen(blocks: &[Block<R, LANES, C>]) -> Seen<R> {
        let _ = blocks;
        Seen::nothing()
    }

    /// Sets the weights of a point so that its lobes are as high as at another one that differs in the index.
    fn keep_heights(seen: &Seen<R>, like: &[R; P], x: &mut [R; P]) {
        let _ = seen;
        for (k, parameter) in Self::PARAMETERS.iter().enumerate() {
            if parameter.is_weight() {
                x[k] = like[k];
            }
        }
    }

    /// Moves a point that has good weights to where the model all but vanishes at weights of 1, and its weights up to their bounds, so that f stays; false if it does not.
    ///
    /// Along this way the cost hardly changes, so that a fit takes long for it.
    fn fade(x: &mut [R; P], bounds: &Bounds<R, P>) -> bool {
        let _ = (x, bounds);
        false
    }

    /// See [`crate::lm::Problem::bend`].
    fn bend(seen: &Seen<R>, x: &[R; P], step: &[R; P], to: [R; P]) -> [R; P] {
        let _ = (seen, x, step);
        to
    }
}

/// Place of weight `w` among `parameters`, if there are so many.
pub(crate) const fn weight<const P: usize>(parameters: &[Parameter; P], w: usize) -> Option<usize> {
    let mut found = 0;
    let mut k = 0;
    while k < P {
        if parameters[k].is_weight() {
            if found == w {
                return Some(k);
            }
            found += 1;
        }
        k += 1;
    }
    None
}

/// The places of all weights among `parameters`.
pub(crate) const fn weights<const P: usize>(parameters: &[Parameter; P]) -> [Option<usize>; WEIGHTS] {
    let mut places = [None; WEIGHTS];
    let mut w = 0;
    while w < WEIGHTS {
        places[w] = weight(parameters, w);
        w += 1;
    }
    assert!(
        weight(parameters, WEIGHTS).is_none(),
        "a model has at most four weights"
    );
    places
}
