//! Every tolerance of the tests, each with what was measured; one that is ten times looser than that fails.

/// The largest error that passes; its number is not to be had, so that each is checked for being no looser than needed.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance(f64);

impl Tolerance {
    /// Of another case than the worst, which is given to [`check`].
    pub fn admits(self, measured: f64) -> bool {
        measured <= self.0
    }
}

/// Asserts that `measured` is within `tolerance`, and that the tolerance is no ten times looser than that.
#[track_caller]
pub fn check(measured: f64, Tolerance(tolerance): Tolerance) {
    assert!(
        measured <= tolerance,
        "measured {measured:e} exceeds the tolerance {tolerance:e}"
    );
    assert!(
        measured * 10.0 >= tolerance,
        "the tolerance {tolerance:e} can be tightened to {measured:e}, which is what was measured"
    );
}

/// The same of a relative error given by its number of right digits.
#[track_caller]
pub fn check_digits(digits: f64, tolerance: Tolerance) {
    check(10f64.powf(-digits), tolerance);
}

/// Largest relative error of a parameter over the 54 runs of NIST's sets; measured 2.4e-7, 6.6 digits.
pub const NIST_LARGEST: Tolerance = Tolerance(3e-7);
/// Median of the same; measured 7e-11, 10.2 digits.
pub const NIST_MEDIAN: Tolerance = Tolerance(1e-10);
/// Largest of the 51 runs that the default options get right; measured 2.4e-7.
pub const NIST_DEFAULT: Tolerance = Tolerance(3e-7);
/// Largest relative error of a standard error, the same runs but Lanczos1's; measured 4.7e-7, 6.3 digits.
pub const NIST_DEVIATION: Tolerance = Tolerance(1e-6);
/// Median of the same; measured 1.2e-10, 9.93 digits.
pub const NIST_MEDIAN_DEVIATION: Tolerance = Tolerance(3e-10);
/// Largest relative distance of a cost from the published minimum of Moré, Garbow and Hillstrom, which has 6 digits; measured 8.4e-6.
pub const MGH_COST: Tolerance = Tolerance(1e-5);
/// Largest cost where the minimum is 0; measured 1e-30.
pub const MGH_ZERO: Tolerance = Tolerance(1e-29);
/// ln f against 60 digits, in epsilons of its natural scale (see tests/model.rs), f64; measured 1.14.
pub const LN_F_F64: Tolerance = Tolerance(1.5);
/// Its six derivatives; measured 1.50.
pub const GRADIENT_F64: Tolerance = Tolerance(2.0);
/// ln f, f32; measured 0.93.
pub const LN_F_F32: Tolerance = Tolerance(1.0);
/// Its six derivatives, f32; measured 1.68.
pub const GRADIENT_F32: Tolerance = Tolerance(2.0);
/// A component of J'r against central differences of the cost, as a part of it, f64; measured 1.9e-10.
pub const DIFFERENCES_F64: Tolerance = Tolerance(3e-10);
/// The same, f32; measured 7.6e-4.
pub const DIFFERENCES_F32: Tolerance = Tolerance(1e-3);
/// F against 60 digits, in epsilons of its natural scale, f64; measured 4.50.
pub const FRESNEL_F64: Tolerance = Tolerance(5.0);
/// dF/dn and dF/dkappa; measured 2.34.
pub const FRESNEL_GRADIENT_F64: Tolerance = Tolerance(2.5);
/// F, f32; measured 4.50.
pub const FRESNEL_F32: Tolerance = Tolerance(5.0);
/// dF/dn and dF/dkappa, f32; measured 2.03.
pub const FRESNEL_GRADIENT_F32: Tolerance = Tolerance(2.5);
/// ln f less that of Eq. 14 as printed, on ordinary scenes, f64; measured 1.7e-14.
pub const LITERAL_LN_F: Tolerance = Tolerance(5e-14);
/// p dlnf/dp less central differences over 2e-5 p, relative where above 1; measured 6.3e-10.
pub const LITERAL_GRADIENT: Tolerance = Tolerance(1e-9);
/// exp in f64, ulp; measured 0.854.
pub const EXP_F64: Tolerance = Tolerance(1.0);
/// ln in f64, ulp; measured 0.768.
pub const LN_F64: Tolerance = Tolerance(1.0);
/// rsqrt in f64, ulp; measured 0.750.
pub const RSQRT_F64: Tolerance = Tolerance(1.0);
/// exp in f32, ulp; measured 0.923.
pub const EXP_F32: Tolerance = Tolerance(1.0);
/// ln in f32, ulp; measured 0.783.
pub const LN_F32: Tolerance = Tolerance(1.0);
/// rsqrt in f32, ulp; measured 0.75.
pub const RSQRT_F32: Tolerance = Tolerance(1.0);
/// Sine and cosine in f64, ulp; measured 0.766.
pub const SIN_COS_F64: Tolerance = Tolerance(1.0);
/// Sine and cosine in f32, ulp; measured 0.810.
pub const SIN_COS_F32: Tolerance = Tolerance(1.0);
/// Relative error of the double-double oracle; measured 5.1e-24, of ln near 1.
pub const ORACLE: Tolerance = Tolerance(1e-23);
/// Relative difference of the parameters and the cost of one problem at five scales; measured 2.2e-16.
pub const SCALES: Tolerance = Tolerance(1e-15);
/// What the undamped linear model promises at `Stop::Cost`, over `cost_tolerance * cost`; measured 0.99, and 10 % more may come from the damping.
pub const PROMISE: Tolerance = Tolerance(1.1);
/// Cost of a curve that can be fitted exactly, per unit of its scale; measured 3.2e-31.
pub const EXACT_CURVE: Tolerance = Tolerance(1e-30);
/// Rise of the cost while the best is followed by its gradient, in epsilons of it; measured 13.
pub const SETTLED_RISE: Tolerance = Tolerance(30.0);
/// What a step of 1e-10 away from where `Stop::Step` ended can still lower the cost, relative to it; measured 1.2e-15, rounding.
pub const NEIGHBOUR: Tolerance = Tolerance(3e-15);
/// Cost of a scan of m = 1e-5 or 10 that the model fits exactly; measured 2.0e-31.
pub const SMOOTH_F64: Tolerance = Tolerance(1e-30);
/// Cost of a scan at normal incidence, where rho_s and rho_v are one parameter; measured 9.5e-24.
pub const NORMAL_F64: Tolerance = Tolerance(2e-23);
/// The same in f32; measured 5.3e-13.
pub const NORMAL_F32: Tolerance = Tolerance(2e-12);
/// Cost of a scan of n = kappa = 100, the corner of Table 1, measured 4.0e-30.
pub const METAL: Tolerance = Tolerance(3e-29);
/// Relative error of the cost of samples that count twice; measured 2.3e-15.
pub const TWICE: Tolerance = Tolerance(6e-15);
/// Relative distance of ln f from the nearer lobe's exponent of 10^8 to 10^10, from the other factors; measured 1.9e-7.
pub const NEEDLE: Tolerance = Tolerance(5e-7);

// Optimum: what a fit with default options reaches.

/// MSE^2 over the least value known, less 1; dimensionless.
/// 1e-6 was asked for; measured 3.1e-13 at most, the digits of the table.
pub const OPTIMUM_MSE2: Tolerance = Tolerance(1e-12);
/// MSE^2 of a set without noise; dimensionless.
/// Measured 2.3e-33 at most.
pub const IDEAL_MSE2: Tolerance = Tolerance(1e-32);
/// rho_d over its actual value, less 1, for noise within +-10 %; dimensionless.
/// Asked for; measured 0.0192 at most, which is the noise: the optimum itself is there.
pub const ACTUAL_RHO_D: Tolerance = Tolerance(0.03);
/// m over its actual value, less 1, for noise within +-10 %; dimensionless.
/// Asked for; measured 0.0244 at most, which is the noise: the optimum itself is there.
pub const ACTUAL_M: Tolerance = Tolerance(0.03);
/// Root of the mean squared difference of ln f between the fit and the model without noise; dimensionless.
/// Asked for; measured 0.0163 at most.
pub const IDEAL_RMS_LN: Tolerance = Tolerance(0.02);

// Stability: what rounding does to a fit.

/// ln f at the optima of the built-in cases of `brdfit stability`, f64, in ulp of its natural scale; measured 0.9.
pub const STABLE_LN_F: Tolerance = Tolerance(1.5);
/// Its six derivatives; measured 4.9, where f is 1e-17 sr^-1.
pub const STABLE_GRADIENT: Tolerance = Tolerance(5.0);
/// Relative error of any parameter of test data 1 and 2 without noise; dimensionless.
/// 1e-6 was asked for; measured 6.5e-12, which is rounding times the root of the condition, 1e5.
pub const RECOVERED: Tolerance = Tolerance(3e-11);
/// Cost of test data 3 without noise.
/// 1e-26 was asked for; measured 9.3e-30, which is rounding.
pub const VALLEY_COST: Tolerance = Tolerance(5e-29);
/// Most passes of one fit from each of 100 candidates to its end, the nine sets with noise; measured 1008, into a minimum of test data 1 with a thousand times the cost of the best.
pub const PASSES_NOISY: Tolerance = Tolerance(1100.0);
/// The same of test data 2 and 3 alone, in whose valleys n and kappa end; measured 911, from a needle far narrower than the peak (127 from the candidates of 0.1.0, which were wider).
pub const PASSES_VALLEY: Tolerance = Tolerance(1000.0);
/// The same without noise, where the valley is followed to the last bit; measured 501.
pub const PASSES_IDEAL: Tolerance = Tolerance(550.0);
/// Largest median of the same passes over the 100 fits of a set; measured 43 (39 from the candidates of 0.1.0).
pub const PASSES_MEDIAN: Tolerance = Tolerance(45.0);

// Uncertainty: what a scan tells about the parameters.

/// Covariances and correlations of linear problems less those of a literal inverse, relative to the standard errors; measured 1.1e-15.
pub const COVARIANCE: Tolerance = Tolerance(5e-15);
/// The push over that of a literal inverse, less 1; below 5e-15 where measured.
pub const PUSH: Tolerance = Tolerance(5e-15);
/// Relative error of a standard error beside two parameters that are one; measured 8.9e-16.
pub const BESIDE_SINGULAR: Tolerance = Tolerance(5e-15);
/// By how much the errors of a peak and its width are less than what moves of two standard errors give, relatively; measured 0.295 where the second maximum is not yet one, and 0.5 without it.
pub const TWO_MAXIMA: Tolerance = Tolerance(0.35);
/// Directional-hemispherical reflectance over a midpoint rule of 500^2 directions (1000^2 of narrow lobes), less 1; measured 9.6e-5.
pub const REFLECTANCE: Tolerance = Tolerance(2e-4);
/// Its derivatives but that by m less central differences, relative where above 0.01; measured 3.3e-5.
pub const REFLECTANCE_GRADIENT: Tolerance = Tolerance(1e-4);
/// That by m less central differences of the midpoint rule of 400^2 directions; measured 1.2e-3.
pub const REFLECTANCE_BY_M: Tolerance = Tolerance(2e-3);
/// Rise of the cost at the ends of profile intervals over what it should be there, less 1, by an independent search, which may stay above; measured 1.8e-4.
pub const INTERVAL_END: Tolerance = Tolerance(1e-3);
/// Width of the 95 % profile interval of rho_d over that from its standard error, less 1; measured 6.6e-3.
pub const INTERVAL_QUADRATIC: Tolerance = Tolerance(1e-2);
/// Standard deviation of rho_d over 400 copies over its standard error, less 1; the spread of 400 copies is itself known to 0.035; measured between 0.01 and 0.1.
pub const BOOTSTRAP: Tolerance = Tolerance(0.1);

// Files as instruments write them.

/// Relative error of any parameter of a scan without noise, in any text format; measured 1.8e-12.
pub const FORMATS: Tolerance = Tolerance(3e-12);
/// Root of the mean squared difference of ln f between a model and the samples of a whole MERL file of it, dimensionless; measured 5.0e-15.
pub const MERL_WHOLE: Tolerance = Tolerance(1e-14);
/// The same of the samples in plane, whose theta_d is rounded to half a degree; measured 2.2e-2.
pub const MERL_IN_PLANE: Tolerance = Tolerance(3e-2);
/// Median of the relative differences between a smoothed FRED file and one of the runs that it was made of; measured 0.138.
pub const FRED_SMOOTHED: Tolerance = Tolerance(0.15);

// Exports.

/// BRDF in a Zemax file, which has 10 digits, less that of Eq. 14 as printed; relative.
/// Asked for are 1e-6; the digits leave 5e-10.
pub const ZEMAX_ROUND_TRIP: Tolerance = Tolerance(1e-9);
/// BRDF in a BiRD file less that of Eq. 14 as printed; relative; measured 3.0e-13.
pub const BIRD_ROUND_TRIP: Tolerance = Tolerance(5e-13);
/// BRDF in an OpenMATERIAL file less that of Eq. 14 as printed; relative; measured 6.1e-13.
pub const OPENMATERIAL_ROUND_TRIP: Tolerance = Tolerance(1e-12);
/// BRDF of the shader for BRDF Explorer, computed in double, less that of Eq. 14 as printed; relative; measured 1.5e-13.
pub const SHADER: Tolerance = Tolerance(5e-13);
// Robust fits: root of the mean squared difference of ln f between the fit of a raw scan and that of the cleaned one.

/// Of a black paint; measured 0.0023.
pub const ROBUST_AEROGLAZE: Tolerance = Tolerance(0.003);
/// Of another; measured 0.0020.
pub const ROBUST_MAGIC: Tolerance = Tolerance(0.003);
/// Of carbon nanotubes; measured 0.0135.
pub const ROBUST_SINGULARITY: Tolerance = Tolerance(0.02);
/// Relative difference of rho_d; measured 0.011.
pub const ROBUST_RHO_D: Tolerance = Tolerance(0.015);
/// The same of m; measured 0.030.
pub const ROBUST_M: Tolerance = Tolerance(0.04);
/// Of a robust fit of a scan with many outliers against the truth, with noise of 5 %; measured 0.0124.
pub const ROBUST_TRUTH: Tolerance = Tolerance(0.015);
/// The same of a robust fit and one of a scan without its outliers, over the samples of the scan; measured 2.0e-15.
pub const ROBUST_SAME: Tolerance = Tolerance(5e-15);
// Other lobes.

/// ln f and its derivatives of models put together from other lobes against 60 digits, in epsilons, f64.
pub const LOBES_F64: Tolerance = Tolerance(20.0);
/// The same in f32, of the largest of the ten.
pub const LOBES_F32: Tolerance = Tolerance(100.0);
/// Difference of the hyper-Cauchy distribution at q = 2 from GGX, in ln f and its derivatives; measured 2.7e-15.
pub const TAIL_GGX: Tolerance = Tolerance(1e-14);
/// Difference of the derivative by q from that of differences; measured 5.4e-11.
pub const TAIL_SLOPE: Tolerance = Tolerance(1e-10);
/// Cost of the best fit of a model to its own data; rounding.
pub const LOBES_FIT: Tolerance = Tolerance(1e-28);

// Several scans together.

/// Relative distance of the gain in the error of m by three scans from the root of 3.
pub const JOINT_GAIN: Tolerance = Tolerance(0.05);
pub const ZEMAX_AVERAGED: Tolerance = Tolerance(0.1);
/// Ratios of a material's values in the forms of Speos and of Zemax, against their median at an angle of incidence; measured 9.5e-15.
pub const SPEOS_ZEMAX: Tolerance = Tolerance(2e-14);
/// That median, less 1; measured 0.174.
pub const SPEOS_ZEMAX_FACTOR: Tolerance = Tolerance(0.2);

// The program's results.

/// An angle in degrees after radians and back; measured 3.6e-15.
pub const DEGREES: Tolerance = Tolerance(1e-14);
/// Largest relative error of a parameter from a scan without noise; measured 2.1e-14.
pub const IDEAL_PRINTED: Tolerance = Tolerance(5e-14);
/// Root of the mean squared residual of ln f of the same; measured 2.2e-16.
pub const IDEAL_RMS: Tolerance = Tolerance(1e-15);
/// Relative error of rho_d of the same in f32; measured 8.9e-8, one unit in the last place.
pub const IDEAL_F32: Tolerance = Tolerance(1e-7);
/// Root of the mean squared residual of scans with 5 % of noise or less, piped from one command to another; measured 0.0265.
pub const PIPED_RMS: Tolerance = Tolerance(0.03);
/// A factor of noise beyond its range; rounding of the quotient it is known by.
pub const PRINTED: Tolerance = Tolerance(1e-15);
/// Largest relative error of a parameter from a scan whose noise the weights make up for; measured 1.9e-12.
pub const WEIGHTED: Tolerance = Tolerance(5e-12);
/// Relative difference between a genuine ASTM file and a table of six digits that others made of it; measured 3.5e-6.
pub const GARNET_TABLE: Tolerance = Tolerance(5e-6);
/// The same of a LUMOS file; measured 0.
pub const LUMOS_TABLE: Tolerance = Tolerance(1e-15);

// What a scan tells.

/// Quantile of Student's t less that of printed tables; measured 4.9e-9.
pub const STUDENT: Tolerance = Tolerance(1e-8);
/// How much less the cost has risen at an interval's end, by a search with another seed, than it should; relative; measured 1.9e-4.
pub const INTERVAL_BELOW: Tolerance = Tolerance(3e-4);
/// How much less than a point of a profile a search finds there; relative; measured 1.1e-15.
pub const PROFILE_POINT: Tolerance = Tolerance(5e-15);
/// Size of a simulated noise against the one asked for, of 2000 samples; relative; measured 0.0080.
pub const NOISE_SIZE: Tolerance = Tolerance(0.02);
/// Threshold of 95 % for rho_d from 100 copies, over that of F, less 1; 100 copies know it to 0.2.
pub const CALIBRATED: Tolerance = Tolerance(0.2);
/// chi^2 against the rms residual over the standard deviation that every sample has; relative; measured 3.3e-15.
pub const CHI2: Tolerance = Tolerance(5e-15);
/// AICc and BIC against their formulas; relative; measured 0.
pub const CRITERION: Tolerance = Tolerance(1e-15);
/// F against the quantile at its own probability; measured 9.4e-13.
pub const F_TEST: Tolerance = Tolerance(5e-12);
/// Peak and width of a lobe in degrees, against a table in steps of 0.001; measured 4.7e-4.
pub const LOBE_ANGLES: Tolerance = Tolerance(1e-3);
/// BRDF at the peak against the largest of that table; relative; measured 1.6e-9.
pub const LOBE_PEAK: Tolerance = Tolerance(5e-9);
/// Standard errors of peak and width against those from differences in that table; relative; measured 0.0093.
pub const LOBE_STDERR: Tolerance = Tolerance(0.02);
/// Reflectance of a grey surface, and its standard error; measured 5.6e-17.
pub const GREY: Tolerance = Tolerance(3e-16);
/// Models of stray light against 60 digits, in epsilons of the largest logarithm on the way: ln f in f64; measured 1.39.
pub const STRAY_LIGHT_F64: Tolerance = Tolerance(2.0);
/// Their derivatives; measured 1.87.
pub const STRAY_LIGHT_GRADIENT_F64: Tolerance = Tolerance(2.5);
/// ln f in f32; measured 1.30.
pub const STRAY_LIGHT_F32: Tolerance = Tolerance(2.0);
/// Their derivatives; measured 2.31.
pub const STRAY_LIGHT_GRADIENT_F32: Tolerance = Tolerance(3.0);
/// Models of paints and Torrance and Sparrow's against 60 digits, in epsilons: ln f in f64; measured 3.54.
pub const PAINTS_F64: Tolerance = Tolerance(5.0);
/// Their derivatives; measured 7.14.
pub const PAINTS_GRADIENT_F64: Tolerance = Tolerance(9.0);
/// ln f in f32; measured 3.35.
pub const PAINTS_F32: Tolerance = Tolerance(5.0);
/// Their derivatives; measured 5.77.
pub const PAINTS_GRADIENT_F32: Tolerance = Tolerance(7.0);
/// |beta - beta_0| near the specular direction, in epsilons of f32; measured 0.95.
pub const SHIFT_F32: Tolerance = Tolerance(1.5);
/// Mirrors among the facets against a surface whose F is 1, in ln f and its derivative; measured 3.6e-15.
pub const MIRRORS: Tolerance = Tolerance(5e-15);
/// Their derivative from that of differences; measured 2.8e-10.
pub const MIRRORS_SLOPE: Tolerance = Tolerance(4e-10);
/// Exponential slopes: their sum over t less 1; measured 1.4e-12.
pub const EXPONENTIAL_SUM: Tolerance = Tolerance(2e-12);
/// Their g, relative; measured 2.2e-16.
pub const EXPONENTIAL_VALUE: Tolerance = Tolerance(3e-16);
/// ln f of a distribution with a free tail against 60 digits, in epsilons of the largest logarithm on the way; measured 7.27.
pub const TAIL_VALUE: Tolerance = Tolerance(10.0);
/// Its derivative by q, in epsilons of its size; measured 1.57.
pub const TAIL_DERIVATIVE: Tolerance = Tolerance(2.0);
/// Tables of other models than Eq. 14, read back: the largest relative difference, near narrow peaks.
pub const TABLE_ROUND_TRIP: Tolerance = Tolerance(1e-6);
/// Values of RGL tensor files, read back, relative and times cos theta_s: they have single precision.
pub const RGL_ROUND_TRIP: Tolerance = Tolerance(1e-6);
/// ln of the restricted likelihood by the filter against that of whole matrices; absolute; measured 2.2e-16.
pub const RESTRICTED_LIKELIHOOD: Tolerance = Tolerance(2e-15);
/// The sandwich by recursion against that of whole matrices; measured 1e-14.
pub const SANDWICH: Tolerance = Tolerance(1e-13);
/// What of residuals is their process, against the whole matrix; residuals are of size 1; measured 1.2e-13.
pub const SMOOTHED: Tolerance = Tolerance(3e-13);

// The instrument.

/// ln of what is seen through an aperture of 2 degrees of a lobe of m = 0.1 against a fine grid of it, which is good to about 1e-4; measured between 2e-5 and 2e-4.
pub const APERTURE: Tolerance = Tolerance(2e-4);

// Scans of any size.

/// Costs of fits by any model of a scan times 1e-300 to 1e300, relative; measured 2.3e-14.
pub const SCALED_COST: Tolerance = Tolerance(5e-14);
/// Relative difference of parameters of a scan times 1e-300 to 1e300, whose costs agree to 1e-14; measured 1.8e-15.
pub const SCALED_F64: Tolerance = Tolerance(5e-15);
/// The same of standard errors, of which those of rho_s and n are as large as their values; measured 6.7e-10.
pub const SCALED_ERRORS_F64: Tolerance = Tolerance(1e-9);
/// The same in single precision, times 1e-30 to 1e30; measured 1.6e-5.
pub const SCALED_F32: Tolerance = Tolerance(2e-5);
/// The same of what `fit` tells of a scan with parameters that are determined only together; measured 9.8e-9.
pub const SCALED_OUTPUT: Tolerance = Tolerance(3e-8);

// Reflectance in every corner.

/// The oracle with two and with three parts a halving, relative; measured 1.6e-7.
pub const REFLECTANCE_ORACLE: Tolerance = Tolerance(3e-7);
/// The reflectance of one lobe against it, m from 1e-5 to 10, at 0 to 89.5 degrees; measured 2.1e-7.
pub const REFLECTANCE_CORNERS: Tolerance = Tolerance(4e-7);
