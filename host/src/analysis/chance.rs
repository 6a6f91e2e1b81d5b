//! Probabilities of Student's t, F, chi^2 and the normal distribution, of the same bits on every machine: what is below them is libm's.

use std::f64::consts::FRAC_1_PI;

use brdfit_core::real::Real;
use special::{Beta, Error, Gamma};

/// The part of a Beta distribution of `p` and `q` that is below `x`; NaN of what is no number, whose series would not end.
fn beta(x: f64, p: f64, q: f64) -> f64 {
    if !(x.is_finite() && p.is_finite() && q.is_finite()) {
        return f64::NAN;
    }
    x.inc_beta(p, q, p.ln_beta(q))
}

/// The series of whole degrees of freedom has half as many terms; beyond this the incomplete beta function is faster.
const LONGEST_SERIES: f64 = 200.0;

/// What is above a `t` that is not negative, and the density there, of Student's t of `degrees` degrees of freedom, for many `t`.
///
/// Of whole degrees it is a finite series (Abramowitz and Stegun 1964, 26.7.3 and 26.7.4), right to a few roundings of 1: small tails have fewer digits.
pub fn tail_of_t(degrees: f64) -> impl Fn(f64) -> (f64, f64) {
    let ln_beta = (0.5 * degrees).ln_beta(0.5);
    let top = 1.0 / (Real::sqrt(degrees) * Real::portable_exp(ln_beta));
    let whole = (1.0..=LONGEST_SERIES).contains(&degrees) && degrees.fract() == 0.0;
    let (even, terms) = (degrees % 2.0 == 0.0, if whole { degrees as usize / 2 } else { 0 });
    // Each is the last times (2k - 1) / 2k, or 2k / (2k + 1).
    let ratio = |k: f64| {
        if even {
            (2.0 * k - 1.0) / (2.0 * k)
        } else {
            2.0 * k / (2.0 * k + 1.0)
        }
    };
    let mut factors = vec![1.0; terms];
    for k in 1..terms {
        factors[k] = factors[k - 1] * ratio(k as f64);
    }
    move |t| {
        let square = t * t;
        let part = degrees / (degrees + square);
        if !whole {
            let density = top * Real::portable_exp(-0.5 * (degrees + 1.0) * libm::log1p(square / degrees));
            let above = match part.is_finite() && degrees.is_finite() {
                true => 0.5 * part.inc_beta(0.5 * degrees, 0.5, ln_beta),
                false => f64::NAN,
            };
            return (above, density);
        }
        let (mut sum, mut power) = (0.0, 1.0);
        for factor in &factors {
            sum += factor * power;
            power *= part;
        }
        let (sin, cos) = (t / Real::sqrt(degrees + square), Real::sqrt(part));
        if even {
            (0.5 - 0.5 * sin * sum, top * power * cos)
        } else {
            let within = libm::atan(t / Real::sqrt(degrees)) + sin * cos * sum;
            (0.5 - FRAC_1_PI * within, top * power * part)
        }
    }
}

/// The half width of the interval that holds Student's t with probability `level`; the normal distribution's for an infinite number of degrees of freedom, and infinite for none.
pub fn within_t(level: f64, degrees: f64) -> f64 {
    if degrees.is_infinite() {
        return std::f64::consts::SQRT_2 * level.inv_error();
    }
    if !(degrees > 0.0) {
        return f64::INFINITY;
    }
    let (p, q) = (0.5, 0.5 * degrees);
    let part = level.inv_inc_beta(p, q, p.ln_beta(q));
    Real::sqrt(degrees * part / (1.0 - part))
}

/// The probability that F of `more` and `left` degrees of freedom is above `f`; `None` unless all are positive numbers.
pub fn above_f(f: f64, more: f64, left: f64) -> Option<f64> {
    let known = more > 0.0 && left > 0.0 && f >= 0.0;
    known.then(|| beta(left / (left + more * f), 0.5 * left, 0.5 * more))
}

/// The probability that chi^2 of `degrees` degrees of freedom, at least 1, is below `x`; NaN of what is no number.
pub fn below_chi2(x: f64, degrees: f64) -> f64 {
    if !(x.is_finite() && degrees >= 1.0) {
        return f64::NAN;
    }
    (0.5 * x).inc_gamma(0.5 * degrees)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: f64, actual: f64) {
        assert!((found / actual - 1.0).abs() < 1e-12, "{found:e} in place of {actual:e}");
    }

    // The values are of 40 digits (mpmath's incomplete functions).

    #[test]
    fn tails_are_those_of_high_precision() {
        let near = |found: f64, actual: f64| assert!((found - actual).abs() < 1e-15, "{found:e} {actual:e}");
        near(tail_of_t(1.0)(0.5).0, 0.352_416_382_349_566_73);
        near(tail_of_t(3.5)(2.0).0, 0.063_069_261_287_956_767);
        near(tail_of_t(165.0)(1.96).0, 0.025_840_071_106_703_644);
        near(tail_of_t(20.0)(12.0).0, 6.797_778_512_940_339_6e-11);
        close(above_f(1.0, 1.0, 5.0).unwrap(), 0.363_217_467_649_122_63);
        close(above_f(3.5, 2.0, 165.0).unwrap(), 0.032_458_506_114_284_555);
        close(above_f(80.0, 3.0, 165.0).unwrap(), 5.347_974_308_735_428_5e-32);
        assert_eq!(above_f(1.0, 0.0, 5.0), None);
        assert!(tail_of_t(4.0)(f64::NAN).0.is_nan() && tail_of_t(f64::INFINITY)(1.0).0.is_nan());
        assert!(below_chi2(f64::INFINITY, 4.0).is_nan());
        close(below_chi2(0.5, 1.0), 0.520_499_877_813_046_54);
        close(below_chi2(165.0, 165.0), 0.514_641_659_017_425_21);
        close(below_chi2(210.0, 165.0), 0.989_778_078_820_499_1);
    }

    /// ln Gamma of 100 leaves the incomplete function 13 digits.
    #[test]
    fn tails_and_densities_are_those_of_the_incomplete_beta_function() {
        for degrees in [1.0, 2.0, 3.0, 4.0, 5.0, 36.0, 165.0, 199.0, 200.0, 201.0, 36.5] {
            let tail = tail_of_t(degrees);
            let above_t = |t: f64| 0.5 * above_f(t * t, 1.0, degrees).unwrap();
            for t in [0.0, 0.2, 0.4, 1.0, 1.9, 3.2, 8.0] {
                let (above, density) = tail(t);
                assert!((above - above_t(t)).abs() < 1e-13, "{degrees} {t}");
                let step = 1e-4 * (1.0 + t);
                let slope = (above_t(t + step) - above_t(t - step)) / (2.0 * step);
                assert!(
                    t < 0.1 || (density + slope).abs() < 1e-7 * (1.0 + t),
                    "{degrees} {t}: {density} {slope}"
                );
            }
        }
    }

    #[test]
    fn intervals_are_those_of_high_precision() {
        close(within_t(0.95, 1.0), 12.706_204_736_174_693);
        close(within_t(0.95, 3.25), 3.048_339_870_186_650_6);
        close(within_t(0.682_689_492_137_085, 165.0), 1.003_039_499_672_637_1);
        close(within_t(0.95, 165.0), 1.974_445_630_092_382_5);
        close(within_t(0.95, f64::INFINITY), 1.959_963_984_540_053_9);
        assert_eq!(within_t(0.95, 0.0), f64::INFINITY);
    }

    /// ln Gamma of large numbers cancels, which leaves fewer digits.
    #[test]
    fn of_many_samples_ten_digits_are_left() {
        let close =
            |found: f64, actual: f64| assert!((found / actual - 1.0).abs() < 1e-9, "{found:e} in place of {actual:e}");
        close(tail_of_t(1e5)(3.0).0, 0.001_350_230_442_032_359_6);
        close(above_f(4.0, 1.0, 1e5).unwrap(), 0.045_502_963_457_506_463);
        close(within_t(0.99, 1e5), 2.575_878_469_908_375);
        close(below_chi2(100_500.0, 1e5), 0.868_145_188_396_616_22);
    }
}
