//! Eq. 3 to 14 as printed, with analytic derivatives, in numbers of 256 bits: what ln f and its gradient are, whatever the rounding of f32 and f64.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use dashu_float::{FBig, round::mode::HalfEven};

/// Bits of a number; the half angles near a peak lose up to 60 of them.
const BITS: usize = 256;
type Number = FBig<HalfEven, 2>;

fn number(x: f64) -> Number {
    let finite = Number::try_from(x).unwrap_or(Number::ZERO);
    finite.with_precision(BITS).value()
}

fn square(x: &Number) -> Number {
    x * x
}

/// A complex number.
#[derive(Clone)]
struct Complex {
    re: Number,
    im: Number,
}

impl Complex {
    fn real(re: &Number) -> Self {
        let im = number(0.0);
        Complex { re: re.clone(), im }
    }
    fn plus(&self, other: &Self) -> Self {
        let (re, im) = (&self.re + &other.re, &self.im + &other.im);
        Complex { re, im }
    }
    fn minus(&self, other: &Self) -> Self {
        let (re, im) = (&self.re - &other.re, &self.im - &other.im);
        Complex { re, im }
    }
    fn times(&self, other: &Self) -> Self {
        let re = &self.re * &other.re - &self.im * &other.im;
        let im = &self.re * &other.im + &self.im * &other.re;
        Complex { re, im }
    }
    fn conjugate(&self) -> Self {
        let (re, im) = (self.re.clone(), -&self.im);
        Complex { re, im }
    }
    fn modulus2(&self) -> Number {
        square(&self.re) + square(&self.im)
    }
    fn over(&self, other: &Self) -> Self {
        let product = self.times(&other.conjugate());
        let modulus2 = other.modulus2();
        let (re, im) = (&product.re / &modulus2, &product.im / &modulus2);
        Complex { re, im }
    }
    /// The root with a positive real part, of a number that is not negative and real.
    fn root(&self) -> Self {
        let re = ((self.modulus2().sqrt() + &self.re) / number(2.0)).sqrt();
        let im = &self.im / (number(2.0) * &re);
        Complex { re, im }
    }
}

/// F of unpolarised light, dF/dn and dF/dkappa.
fn fresnel(cos2: &Number, n: f64, kappa: f64) -> [Number; 3] {
    let index = Complex {
        re: number(n),
        im: number(-kappa),
    };
    let s2 = Complex::real(&(number(1.0) - cos2));
    let c = Complex::real(&cos2.sqrt());
    let p = index.times(&index).minus(&s2).root();
    let (pc, two_c) = (p.times(&c), c.plus(&c));
    // r_s = (c - p)/(c + p), r_p = r_s t with t = (p c - s^2)/(p c + s^2).
    let (sum, t_sum) = (c.plus(&p), pc.plus(&s2));
    let r = c.minus(&p).over(&sum);
    let t = pc.minus(&s2).over(&t_sum);
    // d/dN through dp/dN = N/p.
    let slope = index.over(&p);
    let zero = Complex::real(&number(0.0));
    let d_r = zero.minus(&two_c).over(&sum.times(&sum)).times(&slope);
    let d_t = two_c.times(&s2).over(&t_sum.times(&t_sum)).times(&slope);
    let rt = r.times(&t);
    let d_rt = d_r.times(&t).plus(&r.times(&d_t));
    let d = r.conjugate().times(&d_r).plus(&rt.conjugate().times(&d_rt));
    // dN/dkappa = -i, and Re(-i d) = Im d.
    [(r.modulus2() + rt.modulus2()) / number(2.0), d.re, d.im]
}

/// tan^2 of the half angle of Eq. 13, and cos^2 of that of Eq. 12, from cos(2 theta_d).
fn half_angles(cos_2d: &Number, cos_sum: &Number) -> (Number, Number) {
    let cos2_d = (number(1.0) + cos_2d) / number(2.0);
    let cos2_h = square(cos_sum) / (number(4.0) * &cos2_d);
    (number(1.0) / cos2_h - number(1.0), cos2_d)
}

/// ln f (f in sr^-1) and its derivatives by rho_d, rho_s, rho_v, m, n and kappa, each rounded once to f64; NaN where f is 0.
pub fn gradient(sample: &Sample<f64>, [rho_d, rho_s, rho_v, m, n, kappa]: [f64; 6]) -> [f64; 7] {
    let (sin_i, cos_i) = number(sample.theta_i).sin_cos();
    let (sin_s, cos_s) = number(sample.theta_s).sin_cos();
    let cos_phi = if sample.delta_phi.abs() == f64::PI {
        number(-1.0)
    } else {
        number(sample.delta_phi).cos()
    };
    let pi = Number::pi(BITS);
    let (one, two) = (number(1.0), number(2.0));
    let (level, across) = (&cos_i * &cos_s, sin_i * sin_s * cos_phi);
    let cos_sum = &cos_i + &cos_s;
    let m = number(m);
    let m2 = square(&m);
    let mut sum = number(rho_d) / &pi;
    let mut d: [Number; 6] = std::array::from_fn(|k| if k == 0 { &one / &pi } else { number(0.0) });
    for (lobe, rho) in [rho_s, rho_v].into_iter().enumerate() {
        let cos_2d = if lobe == 0 { &level + &across } else { &level - &across };
        let (tan2_h, cos2_d) = half_angles(&cos_2d, &cos_sum);
        // Eq. 8 with 1 / cos^4 = (1 + tan^2)^2.
        let mut shape = (-(&tan2_h / &m2)).exp() * square(&(&one + &tan2_h)) / (&pi * &m2);
        if lobe == 0 {
            // Eq. 7 and 9, with cos theta_h / cos theta_d = (cos ti + cos ts) / (2 cos^2 theta_d).
            let lower = if cos_i < cos_s { &cos_i } else { &cos_s };
            let masking = &cos_sum * lower / &cos2_d;
            let masking = if masking < one { masking } else { one.clone() };
            shape = shape * masking / (number(4.0) * &level);
        }
        let rho = number(rho);
        let [f, d_n, d_kappa] = fresnel(&cos2_d, n, kappa);
        let unit = &shape * &f;
        let term = &rho * &unit;
        d[3] += &term * (&tan2_h / &m2 - &one) * &two / &m;
        d[4] += &rho * &shape * d_n;
        d[5] += &rho * &shape * d_kappa;
        d[1 + lobe] = unit;
        sum += term;
    }
    // A BRDF of 0 has no logarithm.
    if sum <= number(0.0) {
        return [f64::NAN; 7];
    }
    let round = |x: &Number| x.to_f64().value();
    std::array::from_fn(|q| match q {
        0 => round(&sum.ln()),
        q => round(&(&d[q - 1] / &sum)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_has_no_logarithm() {
        let sample = Sample::in_plane(0.5, 0.4, 1.0);
        for dark in [[0.0, 0.0, 0.0, 0.1, 2.0, 1.0], [0.0, 1.0, 1.0, 0.1, 1.0, 0.0]] {
            assert!(gradient(&sample, dark).iter().all(|x| x.is_nan()));
        }
    }

    /// Against the 60-digit values of another program, which cover extremes.
    ///
    /// The file's angles are decimal degrees, and f64 holds neither them nor all parameters exactly: rows are taken where that rounding moves nothing by more than 1e-12.
    #[test]
    fn agrees_with_sixty_digits() {
        let file = include_str!("../../../../tests/data/reference/model.csv");
        let mut compared = 0;
        for line in file.lines().skip(1).step_by(29) {
            let cells: Vec<&str> = line.split(',').collect();
            let x: Vec<f64> = cells[1..].iter().map(|cell| cell.parse().expect("a number")).collect();
            let params: [f64; 6] = std::array::from_fn(|k| x[3 + k]);
            // m from 0.05, and away from the horizon and from n = 1.
            if params[3] < 0.05 || x[0].max(x[1].abs()) > 85.0 || params[4] < 1.05 || params[0] == 0.0 {
                continue;
            }
            let sample = Sample {
                theta_i: x[0].to_radians(),
                theta_s: x[1].to_radians(),
                delta_phi: if x[2] == 180.0 { f64::PI } else { x[2].to_radians() },
                brdf: 1.0,
                weight: 1.0,
            };
            for (q, (got, want)) in gradient(&sample, params).into_iter().zip(&x[9..]).enumerate() {
                // The file's derivatives are differences of terms of order 1 with 60 digits.
                if want.abs() < 1e-45 {
                    continue;
                }
                let error = (got - want).abs() / want.abs().max(if q == 0 { 1.0 } else { 1e-300 });
                let exponent = want.abs().max(1e-300).recip();
                assert!(
                    error < 1e-12 * Real::portable_ln(exponent).abs().max(1.0),
                    "{line}: {q} is {got:e}"
                );
                compared += 1;
            }
        }
        assert!(compared > 100, "{compared}");
    }
}
