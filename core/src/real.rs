//! The scalar type `R`: `f32` or `f64`, and the elementary functions on the path of a fit.
//!
//! `exp` and `ln` are written with IEEE `+ - * /` and integer steps only, without branches: the compiler turns a loop over lanes into vector instructions, and every target gives the same bits.
//! Both are within 1 ulp of the exact value on their domain (tested against a 50-digit oracle).

use core::fmt::{Debug, Display};
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// `f32` or `f64`.
pub trait Real:
    Copy
    + Debug
    + Display
    + Default
    + PartialEq
    + PartialOrd
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// pi.
    const PI: Self;
    /// Distance from 1 to the next larger number.
    const EPSILON: Self;
    /// Smallest positive normal number.
    const MIN_POSITIVE: Self;
    /// Largest finite number.
    const MAX: Self;
    /// Small enough to vanish beside any cosine squared, with a square that is still positive.
    const TINY: Self;
    /// A diffuse term below this does not keep the lobes from underflow: see `brdf`.
    const FAINT: Self;
    /// A lobe with an exponent below this counts as 0: its square must still be normal, for subnormal numbers cost a hundredfold.
    const CUT: Self;
    /// Largest exponent in the derivative of an absent lobe, so that its square stays finite.
    const LIFT: Self;

    /// The nearest value of this type.
    fn of(x: f64) -> Self;
    /// The same value in `f64`.
    fn f64(self) -> f64;
    /// The bits, widened.
    fn bits(self) -> u64;
    /// A number in `[0, 1)` from the upper bits of a random word.
    fn unit(word: u64) -> Self;
    /// Exponential, at most 1 ulp; the argument is first limited to the range where the result is normal, -708 to 709 (`f64`) or -87 to 88 (`f32`).
    fn exp(self) -> Self;
    /// Natural logarithm of a positive normal number, at most 1 ulp; other arguments give an unspecified number.
    fn ln(self) -> Self;
    /// Reciprocal of the square root of a number from `MIN_POSITIVE` to its reciprocal, at most 1 ulp; other arguments, 0 among them, give an unspecified number or NaN.
    fn rsqrt(self) -> Self;
    /// Square root, by libm; not for the inner loop.
    fn sqrt(self) -> Self;
    /// Sine and cosine of an angle in radians, each at most 1 ulp up to 16; beyond that within 1e-4 (`f32`) of it, and an angle beyond 1000 counts as 1000.
    fn sin_cos(self) -> (Self, Self);
    /// False for NaN and infinities.
    fn is_finite(self) -> bool;

    /// The larger; the second if either is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    /// The smaller; the second if either is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    /// Absolute value.
    #[inline(always)]
    fn abs(self) -> Self {
        if self < Self::ZERO { -self } else { self }
    }
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const PI: Self = core::f64::consts::PI;
    const EPSILON: Self = f64::EPSILON;
    const MIN_POSITIVE: Self = f64::MIN_POSITIVE;
    const MAX: Self = f64::MAX;
    const TINY: Self = 1e-140;
    const FAINT: Self = 1e-60;
    const CUT: Self = -300.0;
    const LIFT: Self = 200.0;

    #[inline(always)]
    fn of(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn f64(self) -> f64 {
        self
    }
    #[inline(always)]
    fn bits(self) -> u64 {
        self.to_bits()
    }
    #[inline(always)]
    fn unit(word: u64) -> Self {
        (word >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    // e^x = 2^k e^r with |r| <= ln(2)/2; e^r = 1 + r + r^2 q(r), where q is a minimax polynomial.
    // Adding 1.5 * 2^52 rounds to the nearest integer and leaves it in the low bits.
    #[inline(always)]
    fn exp(self) -> Self {
        const SHIFT: f64 = 6755399441055744.0;
        const LN2_HI: f64 = f64::from_bits(0x3fe6_2e42_fee0_0000);
        const LN2_LO: f64 = f64::from_bits(0x3dea_39ef_3579_3c76);
        let x = Real::min(Real::max(self, -708.0), 709.0);
        let shifted = x * core::f64::consts::LOG2_E + SHIFT;
        let k = shifted - SHIFT;
        let hi = x - k * LN2_HI;
        let lo = k * LN2_LO;
        let r = hi - lo;
        // By Estrin's scheme: Horner's is one long chain, and the processor would wait for each link.
        let r2 = r * r;
        let r4 = r2 * r2;
        let q0 =
            (0.5 + r * 0.16666666666666670990656) + r2 * (0.041666666666666669754623 + r * 0.0083333333333261351257816);
        let q4 = (0.0013888888888883748304607 + r * 0.00019841269874820625271235)
            + r2 * (0.000024801587325547741216286 + r * 0.00000275572554002064244296801);
        let q8 =
            (0.00000027557273643110295327822 + r * 2.510521700472074516432927e-8) + r2 * 2.091468696808687723257074e-9;
        let q = q0 + r4 * (q4 + r4 * q8);
        let y = 1.0 + (hi + (r2 * q - lo));
        f64::from_bits(y.to_bits().wrapping_add(shifted.to_bits() << 52))
    }

    // x = 2^k (1 + f) with sqrt(2)/2 < 1 + f < sqrt(2), then the series of FreeBSD's e_log.c in s = f / (2 + f).
    #[inline(always)]
    fn ln(self) -> Self {
        const LN2_HI: f64 = f64::from_bits(0x3fe6_2e42_fee0_0000);
        const LN2_LO: f64 = f64::from_bits(0x3dea_39ef_3579_3c76);
        const SQRT_HALF: u64 = 0x3fe6_a09e_0000_0000;
        const TWO_52: u64 = 0x4330_0000_0000_0000;
        let bits = self.to_bits().wrapping_add(0x3ff0_0000_0000_0000 - SQRT_HALF);
        let k = f64::from_bits((bits >> 52) | TWO_52) - (4503599627370496.0 + 1023.0);
        let f = f64::from_bits((bits & 0x000f_ffff_ffff_ffff) + SQRT_HALF) - 1.0;
        let half_square = 0.5 * f * f;
        let s = f / (2.0 + f);
        let z = s * s;
        let w = z * z;
        let even = w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
        let odd = z
            * (6.666666666666735130e-01
                + w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
        s * (half_square + (even + odd)) + k * LN2_LO - half_square + f + k * LN2_HI
    }

    // An estimate from the exponent, good to 3.5 %, and two steps of fourth order.
    // Between them y is cut to 26 bits, so that y^2 is exact and only one rounding enters the last step.
    #[inline(always)]
    fn rsqrt(self) -> Self {
        let correction = |h: f64| h * 0.5 + (h * h) * (0.375 + h * 0.3125);
        let y = f64::from_bits(0x5fe6_eb50_c7b5_37a9 - (self.to_bits() >> 1));
        let y = y + y * correction(1.0 - self * y * y);
        let y = f64::from_bits(y.to_bits() & !0x07ff_ffff);
        y + y * correction(1.0 - self * (y * y))
    }
    fn sqrt(self) -> Self {
        libm::sqrt(self)
    }
    // x = k pi/2 + r, with pi/2 in three parts of which the first two times k are exact; the series are those of FreeBSD's k_sin.c and k_cos.c.
    fn sin_cos(self) -> (Self, Self) {
        const SHIFT: f64 = 6755399441055744.0;
        const HALF_PI: [f64; 3] = [
            f64::from_bits(0x3ff9_21fb_5440_0000),
            f64::from_bits(0x3dd0_b461_1a60_0000),
            f64::from_bits(0x3ba3_198a_2e03_7073),
        ];
        let x = Real::min(Real::max(self, -1000.0), 1000.0);
        let shifted = x * core::f64::consts::FRAC_2_PI + SHIFT;
        let r = remainder(x, shifted - SHIFT, HALF_PI);
        let z = r.0 * r.0;
        let sine = -1.66666666666666324348e-01
            + z * (8.33333333332248946124e-03
                + z * (-1.98412698298579493134e-04
                    + z * (2.75573137070700676789e-06
                        + z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10))));
        let cosine = 4.16666666666666019037e-02
            + z * (-1.38888888888741095749e-03
                + z * (2.48015872894767294178e-05
                    + z * (-2.75573143513906633035e-07
                        + z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11))));
        turned(r, sine, cosine, shifted.to_bits())
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
}

impl Real for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const PI: Self = core::f32::consts::PI;
    const EPSILON: Self = f32::EPSILON;
    const MIN_POSITIVE: Self = f32::MIN_POSITIVE;
    const MAX: Self = f32::MAX;
    const TINY: Self = 1e-16;
    const FAINT: Self = 1e-3;
    const CUT: Self = -38.0;
    const LIFT: Self = 20.0;

    #[inline(always)]
    fn of(x: f64) -> Self {
        x as f32
    }
    #[inline(always)]
    fn f64(self) -> f64 {
        self as f64
    }
    #[inline(always)]
    fn bits(self) -> u64 {
        self.to_bits() as u64
    }
    #[inline(always)]
    fn unit(word: u64) -> Self {
        (word >> 40) as u32 as f32 * (1.0 / (1u32 << 24) as f32)
    }

    #[inline(always)]
    fn exp(self) -> Self {
        const SHIFT: f32 = 12582912.0;
        const LN2_HI: f32 = f32::from_bits(0x3f31_7200);
        const LN2_LO: f32 = f32::from_bits(0x35bf_be8e);
        let x = Real::min(Real::max(self, -87.0), 88.0);
        let shifted = x * core::f32::consts::LOG2_E + SHIFT;
        let k = shifted - SHIFT;
        let hi = x - k * LN2_HI;
        let lo = k * LN2_LO;
        let r = hi - lo;
        let r2 = r * r;
        let q = (0.5 + r * 0.16666576989) + r2 * ((0.04166655462 + r * 0.00836317905) + r2 * 0.00139261836);
        let y = 1.0 + (hi + (r2 * q - lo));
        f32::from_bits(y.to_bits().wrapping_add(shifted.to_bits() << 23))
    }

    #[inline(always)]
    fn ln(self) -> Self {
        const LN2_HI: f32 = f32::from_bits(0x3f31_7180);
        const LN2_LO: f32 = f32::from_bits(0x3717_f7d1);
        const SQRT_HALF: u32 = 0x3f35_04f3;
        const TWO_23: u32 = 0x4b00_0000;
        let bits = self.to_bits().wrapping_add(0x3f80_0000 - SQRT_HALF);
        let k = f32::from_bits((bits >> 23) | TWO_23) - (8388608.0 + 127.0);
        let f = f32::from_bits((bits & 0x007f_ffff) + SQRT_HALF) - 1.0;
        let half_square = 0.5 * f * f;
        let s = f / (2.0 + f);
        let z = s * s;
        let w = z * z;
        let even = w * (0.40000972152 + w * 0.24279078841);
        let odd = z * (0.66666662693 + w * 0.28498786688);
        s * (half_square + (even + odd)) + k * LN2_LO - half_square + f + k * LN2_HI
    }

    #[inline(always)]
    fn rsqrt(self) -> Self {
        let correction = |h: f32| h * 0.5 + (h * h) * (0.375 + h * 0.3125);
        let y = f32::from_bits(0x5f37_59df - (self.to_bits() >> 1));
        let y = y + y * correction(1.0 - self * y * y);
        let y = f32::from_bits(y.to_bits() & !0x0fff);
        let h = 1.0 - self * (y * y);
        y + y * (h * (0.5 + h * 0.375))
    }
    fn sqrt(self) -> Self {
        libm::sqrtf(self)
    }
    // As in f64; the series have the least largest relative error, 4e-9 and 2e-10 of the result, by Remez's exchange.
    fn sin_cos(self) -> (Self, Self) {
        const SHIFT: f32 = 12582912.0;
        const HALF_PI: [f32; 3] = [
            f32::from_bits(0x3fc9_0f00),
            f32::from_bits(0x37da_a200),
            f32::from_bits(0x2e85_a309),
        ];
        let x = Real::min(Real::max(self, -1000.0), 1000.0);
        let shifted = x * core::f32::consts::FRAC_2_PI + SHIFT;
        let r = remainder(x, shifted - SHIFT, HALF_PI);
        let z = r.0 * r.0;
        let sine = -0.166666545731 + z * (0.00833215840813 + z * -0.000195149574311);
        let cosine = 0.0416666456188 + z * (-0.00138873130615 + z * 2.44327849494e-5);
        turned(r, sine, cosine, u64::from(shifted.to_bits()))
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        f32::is_finite(self)
    }
}

/// `x - k pi/2` as a sum of two numbers, of which the second is below the rounding of the first.
fn remainder<R: Real>(x: R, k: R, half_pi: [R; 3]) -> (R, R) {
    let near = x - k * half_pi[0];
    let less = k * half_pi[1];
    let high = near - less;
    let low = ((near - high) - less) - k * half_pi[2];
    let sum = high + low;
    (sum, (high - sum) + low)
}

/// Sine and cosine of `r + k pi/2`, from `sin r = r + r^3 sine` and `cos r = 1 - r^2/2 + r^4 cosine`; only the last two bits of `k` count.
fn turned<R: Real>((r, low): (R, R), sine: R, cosine: R, k: u64) -> (R, R) {
    let z = r * r;
    let half_z = z * R::of(0.5);
    let sin = r + (r * z * sine + (low - half_z * low));
    let one_less = R::ONE - half_z;
    let cos = one_less + (((R::ONE - one_less) - half_z) + (z * z * cosine - r * low));
    match k & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}
