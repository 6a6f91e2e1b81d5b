//! Numbers of twice f64's precision as unevaluated sums, about 31 digits (Dekker 1971, Knuth): an oracle fast enough for a million points.

/// `hi + lo`, where `lo` is at most half an ulp of `hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wide {
    pub hi: f64,
    pub lo: f64,
}

fn two_sum(a: f64, b: f64) -> Wide {
    let hi = a + b;
    let part = hi - a;
    Wide {
        hi,
        lo: (a - (hi - part)) + (b - part),
    }
}

fn two_product(a: f64, b: f64) -> Wide {
    let hi = a * b;
    Wide {
        hi,
        lo: a.mul_add(b, -hi),
    }
}

impl Wide {
    pub fn new(x: f64) -> Self {
        Wide { hi: x, lo: 0.0 }
    }
    pub fn plus(self, other: Self) -> Self {
        let sum = two_sum(self.hi, other.hi);
        let low = two_sum(self.lo, other.lo);
        let sum = two_sum(sum.hi, sum.lo + low.hi);
        two_sum(sum.hi, sum.lo + low.lo)
    }
    pub fn times(self, other: Self) -> Self {
        let product = two_product(self.hi, other.hi);
        two_sum(product.hi, product.lo + (self.hi * other.lo + self.lo * other.hi))
    }
    /// Times a power of 2.
    pub fn scaled(self, power: f64) -> Self {
        Wide {
            hi: self.hi * power,
            lo: self.lo * power,
        }
    }

    /// e^x 2^-k with the k it returns, so that nothing underflows.
    pub fn exp(self) -> (Self, i32) {
        // ln 2 as three numbers, of which the first two times k are exact.
        const LN2: [f64; 3] = [
            f64::from_bits(0x3fe6_2e42_fefa_3800),
            f64::from_bits(0x3d2e_f357_93c7_6000),
            f64::from_bits(0x3a8c_c01f_97b5_7a08),
        ];
        let k = (self.hi / std::f64::consts::LN_2).round();
        let mut r = self;
        for part in LN2 {
            r = r.plus(two_product(-k, part));
        }
        // Taylor's series at r / 16, then four squarings of e^r - 1.
        let r = r.scaled(1.0 / 16.0);
        let mut series = Wide::new(0.0);
        for i in (1..=15).rev() {
            // series = r / i (1 + series)
            let quotient = r.times(reciprocal(f64::from(i)));
            series = quotient.times(Wide::new(1.0).plus(series));
        }
        for _ in 0..4 {
            series = series.scaled(2.0).plus(series.times(series));
        }
        (Wide::new(1.0).plus(series), k as i32)
    }

    /// ln x of a positive number, from `near`, which is right to some 1e-8.
    pub fn ln(x: f64, near: f64) -> Self {
        let (inverse, k) = Wide::new(-near).exp();
        // x e^-near = 1 + e.
        let (half, rest) = (k / 2, k - k / 2);
        let product = two_product_scaled(x, inverse, half, rest);
        let e = product.plus(Wide::new(-1.0));
        let e2 = e.times(e);
        let cubic = e2.times(e).times(reciprocal(3.0));
        Wide::new(near).plus(e).plus(e2.scaled(-0.5)).plus(cubic)
    }

    /// Sine and cosine.
    pub fn sin_cos(x: f64) -> (Self, Self) {
        const HALF_PI: [f64; 3] = [
            f64::from_bits(0x3ff9_21fb_5444_2d18),
            f64::from_bits(0x3c91_a626_3314_5c07),
            f64::from_bits(0xb91f_1976_b7ed_8fbc),
        ];
        let k = (x / HALF_PI[0]).round();
        let mut r = Wide::new(x);
        for part in HALF_PI {
            r = r.plus(two_product(-k, part));
        }
        // Taylor's series, from the end: term i is the one before it times -r^2 / (i (i - 1)).
        let less_r2 = r.times(r).scaled(-1.0);
        let one = Wide::new(1.0);
        let series = |last: i32| {
            (2..=last).rev().step_by(2).fold(one, |sum, i| {
                let quotient = less_r2.times(reciprocal(f64::from(i * (i - 1))));
                one.plus(quotient.times(sum))
            })
        };
        let (sin, cos) = (r.times(series(29)), series(28));
        match (k as i64).rem_euclid(4) {
            0 => (sin, cos),
            1 => (cos, sin.scaled(-1.0)),
            2 => (sin.scaled(-1.0), cos.scaled(-1.0)),
            _ => (cos.scaled(-1.0), sin),
        }
    }

    /// 1 / sqrt(x) of a number whose square neither over- nor underflows, from `near`.
    pub fn rsqrt(x: f64, near: f64) -> Self {
        let h = Wide::new(1.0).plus(two_product(near, near).times(Wide::new(-x)));
        // y (1 + h/2 + 3 h^2 / 8 + ...)
        let h2 = h.times(h);
        let factor = h.scaled(0.5).plus(h2.scaled(0.375));
        Wide::new(near).plus(factor.times(Wide::new(near)))
    }
}

fn reciprocal(x: f64) -> Wide {
    let hi = 1.0 / x;
    Wide {
        hi,
        lo: (-hi).mul_add(x, 1.0) / x,
    }
}

fn two_product_scaled(x: f64, wide: Wide, half: i32, rest: i32) -> Wide {
    // By two factors, for 2^k alone may be out of range.
    let x = x * 2f64.powi(half);
    let x = x * 2f64.powi(rest);
    wide.times(Wide::new(x))
}

/// |got - exact| in units in the last place of `exact`, a number of a type with `digits` binary digits.
pub fn ulps(got: f64, exact: Wide, digits: i32) -> f64 {
    let exponent = ((exact.hi.to_bits() >> 52) & 0x7ff) as i32 - 1022;
    let difference = (got - exact.hi) - exact.lo;
    (difference * 2f64.powi(digits - exponent)).abs()
}
