//! What to fit, and how.

use brdfit_core::brdf::{ABSORBING, ALL, DIFFUSE, Params, SURFACE, VOLUME};
use brdfit_core::search::{CANDIDATES, PAPER_STARTS};

use crate::simd::Simd;

/// How the global optimum is searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Candidates, short fits, convergence of the best.
    Default,
    /// Uniform starts over the bounds, each fitted to convergence (section 3 of the paper).
    Paper,
}

/// The number type of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Double.
    F64,
    /// Single, as firmware does.
    F32,
}

/// What to fit and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitOptions {
    /// How to search.
    pub method: Method,
    /// Seed of the starts.
    pub seed: u64,
    /// Number of starts (`paper`) or candidates (`default`); `None` for the method's own.
    pub starts: Option<u32>,
    /// One of [`TERM_SETS`].
    pub terms: u8,
    /// Let the scan choose among the sets of the program's `choose` in place of `terms`; [`crate::fit`] does not look at it.
    pub choose_terms: bool,
    /// Least parameters; Table 1 by default.
    pub lower: Params<f64>,
    /// Largest parameters.
    pub upper: Params<f64>,
    /// The number type.
    pub precision: Precision,
    /// Leave out samples far from the fit ([`crate::robust`]).
    pub robust: bool,
    /// The vector instructions; they change speed and no bit.
    pub simd: Simd,
}

impl PartialEq for Simd {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl Default for FitOptions {
    fn default() -> Self {
        FitOptions {
            method: Method::Default,
            seed: 0,
            starts: None,
            terms: ALL,
            choose_terms: false,
            lower: Params {
                rho_d: 0.0,
                rho_s: 0.0,
                rho_v: 0.0,
                m: 1e-5,
                n: 1.0,
                kappa: 0.0,
            },
            upper: Params {
                rho_d: 1.0,
                rho_s: 100.0,
                rho_v: 100.0,
                m: 10.0,
                n: 100.0,
                kappa: 100.0,
            },
            precision: Precision::F64,
            robust: false,
            simd: Simd::best(),
        }
    }
}

impl FitOptions {
    /// The number of starts or candidates that will be used.
    pub fn starts(&self) -> u32 {
        self.starts.unwrap_or(match self.method {
            Method::Default => CANDIDATES,
            Method::Paper => PAPER_STARTS,
        })
    }
}

/// The sets of terms that are compiled in.
pub const TERM_SETS: [u8; 8] = [
    DIFFUSE,
    DIFFUSE | SURFACE,
    DIFFUSE | SURFACE | ABSORBING,
    DIFFUSE | SURFACE | VOLUME,
    ALL,
    SURFACE,
    SURFACE | ABSORBING,
    SURFACE | VOLUME | ABSORBING,
];
