//! Eq. 14 with all terms, in one number type: names without parameters, and bounds that are constants.

macro_rules! usual {
    ($real:ident) => {
        use crate::{brdf, geometry, lm, residuals, search};

        /// Number of parameters.
        pub const P: usize = brdf::parameters(brdf::ALL);

        /// [`geometry::Sample`].
        pub type Sample = geometry::Sample<$real>;
        /// [`geometry::Observation`].
        pub type Observation = geometry::Observation<$real>;
        /// [`geometry::Block`].
        pub type Block = geometry::Block<$real>;
        /// [`brdf::Params`].
        pub type Params = brdf::Params<$real>;
        /// [`lm::Bounds`].
        pub type Bounds = lm::Bounds<$real, P>;
        /// [`lm::Fit`].
        pub type Fit = lm::Fit<$real, P>;
        /// [`residuals::Scan`].
        pub type Scan<'a> = residuals::Scan<'a, $real, { brdf::ALL }, P>;
        /// [`search::Search`] with room for `M` minima and `F` fits.
        pub type Search<const M: usize, const F: usize> = search::Search<$real, P, M, F>;

        /// Solver coordinates of `params`: those of [`residuals::Scan::coordinates`], as a constant.
        pub const fn coordinates(params: &Params) -> [$real; P] {
            let &Params {
                rho_d,
                rho_s,
                rho_v,
                m,
                n,
                kappa,
            } = params;
            [rho_d, rho_s, rho_v, m, n, kappa * kappa]
        }

        /// Bounds on the solver's coordinates: those of [`residuals::Scan::bounds`], as a constant.
        pub const fn bounds(lower: &Params, upper: &Params) -> Bounds {
            Bounds {
                lower: coordinates(lower),
                upper: coordinates(upper),
            }
        }
    };
}

/// The usual types in `f32`, with all terms of Eq. 14, under names without parameters.
///
/// [`bounds`](single::bounds) is constant, so what firmware needs can stand in static memory:
///
/// ```
/// use brdfit_core::lm::Options;
/// use brdfit_core::search::CANDIDATES;
/// use brdfit_core::single::{Block, Bounds, Observation, Params, Sample, Scan, Search, bounds};
///
/// static BOUNDS: Bounds = bounds(
///     &Params { rho_d: 0.0, rho_s: 0.0, rho_v: 0.0, m: 1e-5, n: 1.0, kappa: 0.0 },
///     &Params { rho_d: 1.0, rho_s: 100.0, rho_v: 100.0, m: 10.0, n: 100.0, kappa: 100.0 },
/// );
/// static EMPTY: Block = Block::EMPTY;
///
/// let mut blocks = [EMPTY; 3];
/// for row in 0..41 {
///     let sample = Sample::in_plane(0.5, (row as f32 - 20.0) * 0.05, 0.3);
///     blocks[row / 16].set(row % 16, &Observation::new(&sample)?);
/// }
/// let scan = Scan::new(&blocks);
/// let mut search: Search<4, 3> = Search::new();
/// search.begin(&BOUNDS, 0, CANDIDATES, &Options::default());
/// while search.step(&scan) {}
/// let params = Scan::params(&search.best().unwrap().x);
/// assert!((params.rho_d / core::f32::consts::PI - 0.3).abs() < 0.01);
/// # Ok::<(), brdfit_core::geometry::SampleError>(())
/// ```
pub mod single {
    usual!(f32);
}

/// The same in `f64` as [`single`] in `f32`.
pub mod double {
    usual!(f64);
}

#[cfg(test)]
mod tests {
    use super::single::{Bounds, Params, Scan, bounds};

    #[test]
    fn constants_are_those_of_the_scan() {
        const LOWER: Params = Params {
            rho_d: 0.1,
            rho_s: 0.2,
            rho_v: 0.3,
            m: 0.4,
            n: 1.1,
            kappa: 0.7,
        };
        const UPPER: Params = Params { kappa: 3.3, ..LOWER };
        const BOUNDS: Bounds = bounds(&LOWER, &UPPER);
        assert_eq!(BOUNDS, Scan::bounds(&LOWER, &UPPER));
    }
}
