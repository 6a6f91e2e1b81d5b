//! Every tolerance of the tests, each with what was measured; one that is ten times looser than that fails.

/// Asserts that `measured` is within `tolerance`, and that the tolerance is no ten times looser than that.
pub fn check(measured: f64, tolerance: f64) {
    assert!(
        measured <= tolerance,
        "measured {measured:e} exceeds the tolerance {tolerance:e}"
    );
    assert!(
        measured * 10.0 >= tolerance,
        "the tolerance {tolerance:e} can be tightened to {measured:e}, which is what was measured"
    );
}

/// The same of a number of right digits, of which more is better.
pub fn check_digits(measured: f64, least: f64) {
    check(10f64.powf(-measured), 10f64.powf(-least));
}

/// Least log relative error of a parameter over the 54 runs of NIST's sets; measured 7.0.
pub const NIST_LEAST_LRE: f64 = 6.5;
/// Median of the same; measured 10.2.
pub const NIST_MEDIAN_LRE: f64 = 10.0;
/// Least of the 27 runs from the nearer start with the default options; measured 6.9.
pub const NIST_DEFAULT_LRE: f64 = 6.5;
/// Largest relative distance of a cost from the published minimum of Moré, Garbow and Hillstrom, which has 6 digits; measured 8.4e-6.
pub const MGH_COST: f64 = 1e-5;
/// Largest cost where the minimum is 0; measured 1e-30.
pub const MGH_ZERO: f64 = 1e-29;
