//! Every tolerance of the tests, with what was measured.

// Optimum: what a fit with default options reaches.

/// MSE^2 over the least value known, less 1; dimensionless.
/// Asked for; measured 2.1e-13 at most on the 18 noisy synthetic sets, the digits of the table.
pub const OPTIMUM_MSE2: f64 = 1e-6;
/// MSE^2 of a set without noise; dimensionless.
/// Asked for; measured 2.3e-33 at most.
pub const IDEAL_MSE2: f64 = 1e-16;
/// rho_d over its actual value, less 1, for noise within +-10 %; dimensionless.
/// Asked for; measured 0.0192 at most, which is the noise: the optimum itself is there.
pub const ACTUAL_RHO_D: f64 = 0.03;
/// m over its actual value, less 1, for noise within +-10 %; dimensionless.
/// Asked for; measured 0.0244 at most, which is the noise: the optimum itself is there.
pub const ACTUAL_M: f64 = 0.03;
/// Root of the mean squared difference of ln f between the fit and the model without noise; dimensionless.
/// Asked for; measured 0.0163 at most.
pub const IDEAL_RMS_LN: f64 = 0.02;
