//! A model of one's own, from its formula alone.
//!
//! ```
//! use brdfit_core::dual::Number;
//! use brdfit_core::formula::{Directions, Formula, Own};
//! use brdfit_core::geometry::{Block, Sample};
//! use brdfit_core::lm::Options;
//! use brdfit_core::model::{Parameter, Role};
//! use brdfit_core::real::Real;
//! use brdfit_core::residuals::{Residuals, observe};
//! use brdfit_core::search::{CANDIDATES, search};
//!
//! /// Ward 1992, isotropic: a Lambertian term and a Gaussian lobe.
//! #[derive(Clone, Copy)]
//! struct Ward;
//!
//! impl Formula<3> for Ward {
//!     const PARAMETERS: [Parameter; 3] = [
//!         Parameter::new("rho_d", "ρ_d", Role::Weight, 1.0),
//!         Parameter::new("rho_s", "ρ_s", Role::Weight, 10.0),
//!         Parameter::new("m", "m", Role::Slope, 3.0).bounds(1e-3, 3.0).domain(1e-6, 1e3),
//!     ];
//!     fn brdf<R: Real, N: Number<R>>([rho_d, rho_s, m]: &[N; 3], at: &Directions<R>) -> N {
//!         let m2 = m.squared();
//!         let lobe = (N::of(-at.tan2_theta_h) / m2).exp() / (m2 * (R::of(4.0) * R::PI));
//!         *rho_d / R::PI + *rho_s * lobe / (at.cos_i * at.cos_s).sqrt()
//!     }
//! }
//!
//! let truth = [0.2, 0.1, 0.3];
//! let samples = (-8..=8).map(|step| {
//!     let (theta_i, theta_s) = (0.5, f64::from(step) * 0.15);
//!     let at = Directions::new(theta_i, theta_s, f64::PI).expect("above the horizon");
//!     Sample::in_plane(theta_i, theta_s, Ward::brdf(&truth, &at))
//! });
//! let mut blocks = [Block::EMPTY; 2];
//! for (row, sample) in samples.enumerate() {
//!     blocks[row / 16].set(row % 16, &observe::<f64, Own<Ward>, 3, 8>(&sample)?);
//! }
//! let scan = Residuals::<f64, Own<Ward>, 3, 8>::new(&blocks);
//! let bounds = Residuals::<f64, Own<Ward>, 3, 8>::usual_bounds();
//! let found = search(&scan, &bounds, 0, CANDIDATES, &Options::default());
//! assert!(found.best.x.iter().zip(truth).all(|(x, truth)| (x - truth).abs() < 1e-9));
//! # Ok::<(), brdfit_core::geometry::SampleError>(())
//! ```

use core::marker::PhantomData;

use crate::bend::{FINEST, peak};
use crate::dual::{Dual, Number};
use crate::geometry::{Block, Geometry, LANES, SampleError};
use crate::model::{GROUP, Model, Parameter, Rows, SUMS, Seen, WEIGHTS, Want, weights};
use crate::pack::Pack;
use crate::real::Real;

/// A pair of directions, as formulas of a BRDF want it; all dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Directions<R> {
    /// cos theta_i.
    pub cos_i: R,
    /// cos theta_s.
    pub cos_s: R,
    /// sin theta_i.
    pub sin_i: R,
    /// sin theta_s; in plane negative on the side of incidence.
    pub sin_s: R,
    /// Cosine of the azimuth of scattering less that of incidence: -1 is forward.
    pub cos_phi: R,
    /// tan^2 of the angle between the surface normal and the normal of a facet that mirrors one direction into the other (Eq. 13).
    pub tan2_theta_h: R,
    /// Cosine of the angle of incidence on that facet (Eq. 12).
    pub cos_theta_d: R,
    /// |beta - beta_0|: how far the direction cosines along the surface are from those of the specular direction, 0 to 2.
    pub shift: R,
}

/// Numbers of [`Directions`].
const COLUMNS: usize = 8;

impl<R: Real> Directions<R> {
    /// Of angles in radians as in [`crate::geometry::Sample`].
    ///
    /// # Errors
    /// [`SampleError::NotFinite`] and [`SampleError::BeyondHorizon`].
    pub fn new(theta_i: R, theta_s: R, delta_phi: R) -> Result<Self, SampleError> {
        let facet = Geometry::new(theta_i, theta_s, delta_phi)?.surface();
        let (sin_i, cos_i) = theta_i.portable_sin_cos();
        let (sin_s, cos_s) = theta_s.portable_sin_cos();
        let in_plane = delta_phi.abs() == R::PI;
        Ok(Directions {
            cos_i,
            cos_s,
            sin_i,
            sin_s,
            cos_phi: if in_plane {
                -R::ONE
            } else {
                delta_phi.portable_sin_cos().1
            },
            tan2_theta_h: facet.tan2_theta_h,
            cos_theta_d: facet.cos_theta_d,
            // Without the cancellation of a difference of sines.
            shift: facet.tan2_theta_h.sqrt() * (cos_i + cos_s),
        })
    }

    fn columns(self) -> [R; COLUMNS] {
        [
            self.cos_i,
            self.cos_s,
            self.sin_i,
            self.sin_s,
            self.cos_phi,
            self.tan2_theta_h,
            self.cos_theta_d,
            self.shift,
        ]
    }

    fn from_columns([cos_i, cos_s, sin_i, sin_s, cos_phi, tan2_theta_h, cos_theta_d, shift]: [R; COLUMNS]) -> Self {
        Directions {
            cos_i,
            cos_s,
            sin_i,
            sin_s,
            cos_phi,
            tan2_theta_h,
            cos_theta_d,
            shift,
        }
    }
}

/// A BRDF as a formula of `P` parameters.
pub trait Formula<const P: usize>: Copy {
    /// The parameters, in the order of the formula.
    const PARAMETERS: [Parameter; P];

    /// f in sr^-1; what is less than [`Real::TINY`] counts as that.
    ///
    /// A parameter of role [`crate::model::Role::Absorption`] comes as its square.
    fn brdf<R: Real, N: Number<R>>(x: &[N; P], at: &Directions<R>) -> N;

    /// f and its derivatives; by dual numbers, unless the formula gives faster ones, which [`worst_slope`] checks.
    fn gradient<R: Real>(x: &[R; P], at: &Directions<R>) -> (R, [R; P]) {
        let Dual { value, slopes } = Self::brdf(&Dual::variables(x), at);
        (value, slopes)
    }
}

/// The derivative of [`Formula::gradient`] that differs most from that of dual numbers: its place, and by how much, as a part of the larger.
pub fn worst_slope<R: Real, F: Formula<P>, const P: usize>(x: &[R; P], at: &Directions<R>) -> (usize, R) {
    let given = F::gradient(x, at).1;
    let exact = F::brdf(&Dual::variables(x), at).slopes;
    let mut worst = (0, R::ZERO);
    for k in 0..P {
        let larger = given[k].abs().max(exact[k].abs()).max(R::MIN_POSITIVE);
        let off = (given[k] - exact[k]).abs() / larger;
        if !(off <= worst.1) {
            worst = (k, off);
        }
    }
    worst
}

/// The model of a formula.
#[derive(Clone, Copy, Debug)]
pub struct Own<F>(PhantomData<F>);

fn lane_of<R: Real, const L: usize>(block: &Block<R, L, COLUMNS>, lane: usize) -> [R; COLUMNS] {
    core::array::from_fn(|column| block.columns[column][lane % L])
}

impl<R: Real, F: Formula<P>, const P: usize> Model<R, P, COLUMNS> for Own<F> {
    const PARAMETERS: [Parameter; P] = F::PARAMETERS;
    type Pass = [R; P];
    type Begun<const L: usize> = ();

    fn geometry(theta_i: R, theta_s: R, delta_phi: R) -> Result<[R; COLUMNS], SampleError> {
        Ok(Directions::new(theta_i, theta_s, delta_phi)?.columns())
    }

    fn pass(x: &[R; P]) -> [R; P] {
        *x
    }

    fn begin<const L: usize>(_pass: &[R; P], _block: &Block<R, L, COLUMNS>) {}

    fn rows<const GRADIENT: bool>(
        pass: &[R; P],
        block: &Block<R, LANES, COLUMNS>,
        (): &(),
        lane: usize,
    ) -> Rows<R, GROUP, P> {
        let mut rows = Rows {
            ln_f: Pack::splat(R::ZERO),
            gradient: [Pack::splat(R::ZERO); P],
        };
        let want = if GRADIENT { Want::Gradient } else { Want::Value };
        for k in 0..GROUP {
            let lane = (lane + k * SUMS) % LANES;
            let mut gradient = [R::ZERO; P];
            rows.ln_f.0[k] = Self::row(pass, block, lane, want, &mut gradient);
            for (column, slope) in rows.gradient.iter_mut().zip(gradient) {
                column.0[k] = slope;
            }
        }
        rows
    }

    fn row<const L: usize>(
        pass: &[R; P],
        block: &Block<R, L, COLUMNS>,
        lane: usize,
        want: Want,
        row: &mut [R; P],
    ) -> R {
        let at = Directions::from_columns(lane_of(block, lane));
        if want == Want::Value {
            return F::brdf(pass, &at).max(R::TINY).ln();
        }
        let (f, slopes) = F::gradient(pass, &at);
        let f = f.max(R::TINY);
        *row = match want {
            // As f is linear in the weights, its derivatives by these.
            Want::Columns => core::array::from_fn(|k| {
                if F::PARAMETERS[k].is_weight() {
                    slopes[k]
                } else {
                    R::ZERO
                }
            }),
            _ => slopes.map(|slope| slope / f * block.weight[lane % L]),
        };
        f.ln()
    }

    fn columns(pass: &[R; P], block: &Block<R, LANES, COLUMNS>, lane: usize) -> [Pack<R, GROUP>; WEIGHTS] {
        let mut columns = [Pack::splat(R::ZERO); WEIGHTS];
        for k in 0..GROUP {
            let mut row = [R::ZERO; P];
            let _ = Self::row(pass, block, lane + k * SUMS, Want::Columns, &mut row);
            for (column, place) in columns.iter_mut().zip(weights(&F::PARAMETERS)) {
                column.0[k] = place.and_then(|place| row.get(place).copied()).unwrap_or(R::ZERO);
            }
        }
        columns
    }

    fn seen(blocks: &[Block<R, LANES, COLUMNS>]) -> Seen<R> {
        let mut seen = Seen::nothing();
        let (cos_theta_d, third) = peak(blocks, [5, 6], &mut seen.near[0]);
        seen.near[1] = seen.near[0];
        seen.peaks = Pack::splat(cos_theta_d);
        seen.finest = R::of(FINEST) * third.sqrt();
        seen
    }
}
