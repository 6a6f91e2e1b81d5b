//! What C sees: plain data, and memory of a known size.

use brdfit_core::brdf::{ABSORBING, ALL, DIFFUSE, Params, SURFACE, VOLUME};
use brdfit_core::geometry::{Block, LANES};
use brdfit_core::lm::Stop;
use brdfit_core::minima::Minimum;
use brdfit_core::search::Trial;

use crate::fit::State;
use crate::search;

/// Lambertian term rho_d / pi.
pub const BRDFIT_DIFFUSE: u32 = 1;
/// Surface lobe, around the specular direction.
pub const BRDFIT_SURFACE: u32 = 2;
/// Volume lobe, around the direction back to the source.
pub const BRDFIT_VOLUME: u32 = 4;
/// kappa is a parameter; without it kappa = 0.
pub const BRDFIT_ABSORBING: u32 = 8;
/// All terms: six parameters.
pub const BRDFIT_ALL: u32 = 15;

/// The model of Eq. 14: Beckmann's distribution of facets.
pub const BRDFIT_MODEL_BECKMANN: u32 = 0;
/// The same with the distribution of Trowbridge and Reitz, called GGX, whose tails are wider; of it the terms are BRDFIT_ALL.
pub const BRDFIT_MODEL_GGX: u32 = 1;

/// Samples that one block holds.
pub const BRDFIT_BLOCK_SAMPLES: usize = 16;
/// Size of a block, in numbers of its type.
pub const BRDFIT_BLOCK_NUMBERS: usize = 128;
/// Size of a block of float, bytes.
pub const BRDFIT_BLOCK_SIZE_F32: usize = 512;
/// Size of a block of double, bytes.
pub const BRDFIT_BLOCK_SIZE_F64: usize = 1024;
/// Alignment of a block, bytes.
pub const BRDFIT_BLOCK_ALIGNMENT: usize = 64;
/// Size of a fit, in numbers of its type.
pub const BRDFIT_FIT_NUMBERS: usize = 96;
/// Size of a fit in float, bytes.
pub const BRDFIT_FIT_SIZE_F32: usize = 384;
/// Size of a fit in double, bytes.
pub const BRDFIT_FIT_SIZE_F64: usize = 768;
/// Of a search in steps, what does not depend on its minima and fits, in units of brdfit_search_state.
pub const BRDFIT_SEARCH_BASE: usize = 196;
/// What a minimum takes of it.
pub const BRDFIT_SEARCH_MINIMUM: usize = 5;
/// What a fit takes of it.
pub const BRDFIT_SEARCH_FIT: usize = 31;

const _: () = assert!(BRDFIT_DIFFUSE == DIFFUSE as u32 && BRDFIT_SURFACE == SURFACE as u32);
const _: () = assert!(BRDFIT_VOLUME == VOLUME as u32 && BRDFIT_ABSORBING == ABSORBING as u32);
const _: () = assert!(BRDFIT_ALL == ALL as u32);
const _: () = assert!(BRDFIT_BLOCK_SAMPLES == LANES);
const _: () = assert!(size_of::<brdfit_sample<f32>>() == 20 && size_of::<brdfit_sample<f64>>() == 40);
const _: () = assert!(size_of::<brdfit_params<f32>>() == 24 && size_of::<brdfit_params<f64>>() == 48);
const _: () = assert!(size_of::<brdfit_options<f32>>() == 88 && size_of::<brdfit_options<f64>>() == 144);
const _: () = assert!(size_of::<brdfit_result<f32>>() == 36 && size_of::<brdfit_result<f64>>() == 64);
const _: () = assert!(size_of::<brdfit_minimum<f32>>() == 32 && size_of::<brdfit_minimum<f64>>() == 64);
// A block is just as large as C believes, for blocks lie side by side; a fit is at most that.
const _: () = assert!(size_of::<brdfit_block<f32>>() == BRDFIT_BLOCK_SIZE_F32);
const _: () = assert!(size_of::<brdfit_block<f64>>() == BRDFIT_BLOCK_SIZE_F64);
const _: () = assert!(size_of::<brdfit_fit<f32>>() == BRDFIT_FIT_SIZE_F32);
const _: () = assert!(size_of::<brdfit_fit<f64>>() == BRDFIT_FIT_SIZE_F64);
const _: () = assert!(align_of::<brdfit_block<f32>>() == BRDFIT_BLOCK_ALIGNMENT);
const _: () = assert!(size_of::<Block<f32>>() == BRDFIT_BLOCK_SIZE_F32);
const _: () = assert!(size_of::<Block<f64>>() == BRDFIT_BLOCK_SIZE_F64);
const _: () = assert!(align_of::<Block<f32>>() <= BRDFIT_BLOCK_ALIGNMENT);
const _: () = assert!(align_of::<Block<f64>>() <= BRDFIT_BLOCK_ALIGNMENT);
const _: () = assert!(size_of::<State<f32>>() <= BRDFIT_FIT_SIZE_F32);
const _: () = assert!(size_of::<State<f64>>() <= BRDFIT_FIT_SIZE_F64);
const _: () = assert!(align_of::<State<f64>>() <= align_of::<brdfit_fit<f64>>());
const _: () = assert!(size_of::<brdfit_search_state<f32>>() == 8 && size_of::<brdfit_search_state<f64>>() == 16);
const _: () = assert!(size_of::<search::State<f32>>() <= 8 * BRDFIT_SEARCH_BASE);
const _: () = assert!(size_of::<search::State<f64>>() <= 16 * BRDFIT_SEARCH_BASE);
const _: () = assert!(size_of::<Minimum<f32, 6>>() <= 8 * BRDFIT_SEARCH_MINIMUM);
const _: () = assert!(size_of::<Minimum<f64, 6>>() <= 16 * BRDFIT_SEARCH_MINIMUM);
const _: () = assert!(size_of::<Trial<f32, 6>>() <= 8 * BRDFIT_SEARCH_FIT);
const _: () = assert!(size_of::<Trial<f64, 6>>() <= 16 * BRDFIT_SEARCH_FIT);
const _: () = assert!(align_of::<search::State<f64>>() <= align_of::<brdfit_search_state<f64>>());
const _: () = assert!(size_of::<brdfit_geometry<f32>>() == 24 && size_of::<brdfit_geometry<f64>>() == 48);
const _: () = assert!(size_of::<brdfit_uncertainty<f32>>() == 176 && size_of::<brdfit_uncertainty<f64>>() == 352);

/// What every function returns; brdfit_error_text() says it in words.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum brdfit_error {
    /// No error.
    None = 0,
    /// A pointer is null.
    Null = -1,
    /// A pointer is not aligned as its type asks; blocks need BRDFIT_BLOCK_ALIGNMENT bytes.
    Misaligned = -2,
    /// A length is zero, or larger than memory can be.
    Length = -3,
    /// There is no room for a further sample.
    Full = -4,
    /// A number is NaN or infinite.
    NotFinite = -5,
    /// An angle is at or beyond the horizon, or theta_i is negative.
    BeyondHorizon = -6,
    /// A BRDF or a weight is zero or negative.
    NotPositive = -7,
    /// A parameter has a value that it cannot have: see brdfit_params.
    Params = -8,
    /// Lower bounds are above the upper ones, or a bound has a value that its parameter cannot have.
    Bounds = -9,
    /// There is no such model, or none of just these terms.
    Terms = -10,
    /// A tolerance, the damping or a number of passes or candidates is out of range.
    Options = -11,
    /// There are fewer samples than parameters.
    TooFew = -12,
    /// The scan, the fit or the search was never begun, or has been overwritten.
    NotBegun = -13,
    /// No start gives a finite model, or no fit has begun yet.
    NoFit = -14,
    /// Bytes are not a saved search of this version, of these terms, minima and fits and this type of number, or were damaged.
    Saved = -15,
    /// The memory of a search is smaller than what its minima and fits take: see BRDFIT_SEARCH.
    Small = -16,
}

/// How a fit ended; brdfit_stop_text() says it in words.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum brdfit_stop {
    /// It has not ended.
    None = 0,
    /// Converged: no further reduction worth the cost tolerance is to be expected.
    Cost = 1,
    /// Converged as far as rounding allows.
    Step = 2,
    /// The largest number of passes was made.
    Passes = 3,
    /// The model is not finite at the start: nothing was done.
    NotFinite = 4,
}

impl From<Option<Stop>> for brdfit_stop {
    fn from(stop: Option<Stop>) -> Self {
        match stop {
            None => brdfit_stop::None,
            Some(Stop::Cost) => brdfit_stop::Cost,
            Some(Stop::Step) => brdfit_stop::Step,
            Some(Stop::Passes) => brdfit_stop::Passes,
            Some(Stop::NotFinite) => brdfit_stop::NotFinite,
        }
    }
}

/// One measured value of the BRDF.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct brdfit_sample<R> {
    /// Angle of incidence, radians, 0 <= theta_i < pi/2.
    pub theta_i: R,
    /// Scattering angle, radians, -pi/2 < theta_s < pi/2; in plane positive forward, towards the specular peak.
    pub theta_s: R,
    /// Azimuth of scattering less azimuth of incidence, radians; BRDFIT_PI is forward.
    pub delta_phi: R,
    /// Measured BRDF, sr^-1, above 0.
    pub brdf: R,
    /// Factor of the residual of ln BRDF, dimensionless, above 0: 1, or 1 / sigma with sigma the relative standard uncertainty of brdf.
    pub weight: R,
}

/// The six parameters of Eq. 14 and of GGX, dimensionless; those of absent terms are 0, but m and n are 1.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct brdfit_params<R> {
    /// Diffuse reflectance, 0 to 1e6.
    pub rho_d: R,
    /// Weight of the surface lobe, 0 to 1e6.
    pub rho_s: R,
    /// Weight of the volume lobe, 0 to 1e6.
    pub rho_v: R,
    /// Slope of the facets, 1e-6 to 1e6.
    pub m: R,
    /// Real part of the index of refraction n - i kappa, 1 to 1e6.
    pub n: R,
    /// Its imaginary part, 0 to 1e6.
    pub kappa: R,
}

impl<R> From<brdfit_params<R>> for Params<R> {
    fn from(params: brdfit_params<R>) -> Self {
        Params {
            rho_d: params.rho_d,
            rho_s: params.rho_s,
            rho_v: params.rho_v,
            m: params.m,
            n: params.n,
            kappa: params.kappa,
        }
    }
}

impl<R> From<Params<R>> for brdfit_params<R> {
    fn from(params: Params<R>) -> Self {
        brdfit_params {
            rho_d: params.rho_d,
            rho_s: params.rho_s,
            rho_v: params.rho_v,
            m: params.m,
            n: params.n,
            kappa: params.kappa,
        }
    }
}

/// What to fit and how; brdfit_options_init_f32() and _f64() set all of it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct brdfit_options<R> {
    /// Seed of the candidates of a search; 0.
    pub seed: u64,
    /// A sum of BRDFIT_DIFFUSE and others; BRDFIT_ALL.
    pub terms: u32,
    /// BRDFIT_MODEL_BECKMANN or BRDFIT_MODEL_GGX; BRDFIT_MODEL_BECKMANN.
    pub model: u32,
    /// Largest number of candidates of a search, at least 1; 435. Of more than that all are made.
    pub candidates: u32,
    /// Largest number of passes of a fit, at least 1; 500.
    pub max_passes: u32,
    /// Least parameters; Table 1 of the paper. Equal to the upper ones they hold a parameter fixed.
    pub lower: brdfit_params<R>,
    /// Largest parameters; Table 1 of the paper.
    pub upper: brdfit_params<R>,
    /// A fit ends when its linear model promises a relative reduction of the cost of at most this; the distance from 1 to the next number.
    pub cost_tolerance: R,
    /// A fit ends when no step longer than this part of each parameter lowers the cost; the distance from 1 to the next number.
    pub step_tolerance: R,
    /// First damping of a fit, in units of the largest diagonal of J'J; 1e-3.
    pub damping: R,
}

/// Memory of BRDFIT_BLOCK_SAMPLES samples.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub struct brdfit_block<R> {
    /// Not to be touched.
    pub opaque: [R; BRDFIT_BLOCK_NUMBERS],
}

/// Samples in blocks of the caller. The fields are to be read only: brdfit_scan_init_f32() and others write them.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct brdfit_scan<R> {
    /// The caller's blocks.
    pub blocks: *mut brdfit_block<R>,
    /// Their number.
    pub capacity: usize,
    /// Samples added so far.
    pub samples: usize,
}

/// A fit under way; it holds no pointers, and may be copied.
#[repr(C, align(8))]
#[derive(Clone, Copy, Debug)]
pub struct brdfit_fit<R> {
    /// Not to be touched.
    pub opaque: [R; BRDFIT_FIT_NUMBERS],
}

/// Where a fit is.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct brdfit_result<R> {
    /// The best parameters so far.
    pub params: brdfit_params<R>,
    /// Sum of squared weighted residuals of ln BRDF there, dimensionless; MSE^2 of the paper is cost / samples^2.
    pub cost: R,
    /// Evaluations of the model with its derivatives, each over all samples, so far.
    pub passes: u32,
    /// How it ended, if it has.
    pub stop: brdfit_stop,
}

/// One of the distinct minima that a search found.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct brdfit_minimum<R> {
    /// Its parameters.
    pub params: brdfit_params<R>,
    /// As in brdfit_result.
    pub cost: R,
    /// How many fits ended here.
    pub hits: u32,
}

/// What a search found, and what it took.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct brdfit_found<R> {
    /// The best fit.
    pub best: brdfit_result<R>,
    /// Number of distinct minima that were written.
    pub minima: usize,
    /// Evaluations of the model without derivatives.
    pub cost_passes: u32,
    /// Evaluations with derivatives.
    pub linearize_passes: u32,
}

/// A unit of the memory of a search under way, which takes BRDFIT_SEARCH(minima, fits) of them, one after the other; all of them together may be copied.
#[repr(C, align(8))]
#[derive(Clone, Copy, Debug)]
pub struct brdfit_search_state<R> {
    /// Not to be touched.
    pub opaque: [R; 2],
}

/// What the model needs to know of a pair of directions, first for the surface lobe, then for the volume lobe; dimensionless.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct brdfit_geometry<R> {
    /// tan^2 theta_h and tan^2 theta_he (Eq. 13), 0 or more.
    pub tan2_theta_h: [R; 2],
    /// cos theta_d and cos theta_de (Eq. 12), above 0, at most 1.
    pub cos_theta_d: [R; 2],
    /// What else of f does not depend on the parameters, 0 or more.
    pub factor: [R; 2],
}

/// What a fit knows of its parameters, for residuals of equal and independent errors. Where residuals wander along the angle, as those of most measured scans do, true errors are several times larger; the program brdfit estimates that, this does not.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct brdfit_uncertainty<R> {
    /// Standard errors; 0 of parameters that are absent, held or on a bound (of kappa at 0 too), very large where nothing is known.
    pub standard_errors: brdfit_params<R>,
    /// Correlations, -1 to 1, row by row in the order of brdfit_params; 0 where one is absent or held.
    pub correlations: [R; 36],
    /// Standard deviation of a residual; infinite without degrees of freedom.
    pub scale: R,
    /// Ratio of the largest to the least eigenvalue of the scaled J'J, 1 or more.
    pub condition: R,
}
