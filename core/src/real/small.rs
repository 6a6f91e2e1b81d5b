//! The same bits from less code than libm's, for microcontrollers.

/// The nearest number to the square root, bit by bit, as FreeBSD's e_sqrtf.c: libm's takes half a kilobyte more.
pub(super) fn sqrt(x: f32) -> f32 {
    if !(x > 0.0 && x <= f32::MAX) {
        return if x < 0.0 { f32::NAN } else { x };
    }
    // x = mantissa 2^(exponent - 23), with the mantissa in [2^23, 2^24).
    let bits = x.to_bits();
    let shift = bits.leading_zeros().saturating_sub(8);
    let exponent = (bits >> 23) as i32 - 127 - shift as i32 + i32::from(shift > 0);
    let mantissa = bits << shift & 0x007f_ffff | 0x0080_0000;
    // An even exponent; the rest is what of the mantissa the root so far does not account for.
    let mut rest = mantissa << (1 + (exponent & 1));
    let (mut root, mut square) = (0, 0);
    let mut bit = 1 << 24;
    while bit != 0 {
        let next = square + bit;
        if next <= rest {
            square = next + bit;
            rest -= next;
            root += bit;
        }
        rest += rest;
        bit >>= 1;
    }
    // There are no ties: a root of 25 bits has a square of 49.
    let rounded = (root + (root & u32::from(rest != 0))) >> 1;
    f32::from_bits(
        rounded
            .wrapping_add(0x3f00_0000)
            .wrapping_add_signed((exponent >> 1) << 23),
    )
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_square_root_is_the_nearest() {
        let special = [
            0.0,
            -0.0,
            f32::INFINITY,
            f32::MAX,
            f32::MIN_POSITIVE,
            1e-45,
            1.0 - f32::EPSILON / 2.0,
        ];
        // All exponents, and more of the two binades that all others repeat.
        let all = (1..0x7f80_0000)
            .step_by(9_973)
            .chain((0x3f00_0000..0x4000_0000).step_by(7));
        for x in special.into_iter().chain(all.map(f32::from_bits)) {
            assert_eq!(super::sqrt(x).to_bits(), libm::sqrtf(x).to_bits(), "{x}");
        }
        assert!(super::sqrt(-1.0).is_nan() && super::sqrt(f32::NAN).is_nan());
    }
}
