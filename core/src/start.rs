//! Seeded starts: start i is a function of (seed, i, bounds) alone, so that starts can be made in any order and on any number of threads.

use crate::lm::Bounds;
use crate::real::Real;

/// xoshiro256++ (Blackman and Vigna 2021).
struct Generator([u64; 4]);

impl Generator {
    /// That of start `i`: its state from `seed` and `i` through two rounds of SplitMix64's mixing.
    ///
    /// The state is never the one of zeros, which repeats itself: it mixes four different numbers, and only one number mixes to 0.
    #[cfg_attr(target_os = "none", inline(never))]
    fn new(seed: u64, i: u64) -> Self {
        let mut z = mix(seed ^ mix(i.wrapping_add(1)));
        Generator([(); 4].map(|()| {
            z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
            mix(z)
        }))
    }

    #[cfg_attr(target_os = "none", inline(never))]
    fn next(&mut self) -> u64 {
        let s = &mut self.0;
        let number = s[0].wrapping_add(s[3]).rotate_left(23).wrapping_add(s[0]);
        let shifted = s[1] << 17;
        s[2] ^= s[0];
        s[3] ^= s[1];
        s[1] ^= s[2];
        s[0] ^= s[3];
        s[2] ^= shifted;
        s[3] = s[3].rotate_left(45);
        number
    }
}

/// The finaliser of SplitMix64: a bijection in which each input bit changes half of the output bits.
#[cfg_attr(target_os = "none", inline(never))]
fn mix(x: u64) -> u64 {
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Uniform over the box (section 3 of the paper).
pub fn uniform<R: Real, const P: usize>(seed: u64, i: u64, bounds: &Bounds<R, P>) -> [R; P] {
    let u = unit::<R, P>(seed, i);
    core::array::from_fn(|k| {
        let (lower, upper) = (bounds.lower[k], bounds.upper[k]);
        (lower + (upper - lower) * u[k]).min(upper)
    })
}

/// `P` independent numbers in [0, 1).
pub fn unit<R: Real, const P: usize>(seed: u64, i: u64) -> [R; P] {
    let mut numbers = [R::ZERO; P];
    fill(seed, i, &mut numbers);
    numbers
}

#[cfg_attr(target_os = "none", inline(never))]
fn fill<R: Real>(seed: u64, i: u64, numbers: &mut [R]) {
    let mut random = Generator::new(seed, i);
    for number in numbers {
        *number = R::unit(random.next());
    }
}

/// Three numbers in [0, 1) for candidate `i`: Kronecker's sequence of the generalised golden ratio, shifted by the seed.
///
/// It fills the cube more evenly than random points: any `k` successive ones leave no gap much wider than `k^(-1/3)`.
pub fn even<R: Real>(seed: u64, i: u64) -> [R; 3] {
    // Steps 2^64 / g^k, where g = 1.2207440846... is the root of g^4 = g + 1.
    const STEPS: [u64; 3] = [0xd1b5_4a32_d192_ed03, 0xabc9_8388_fb8f_ac03, 0x8cb9_2ba7_2f3d_8dd7];
    let mut random = Generator::new(seed, u64::MAX);
    STEPS.map(|step| R::unit(random.next().wrapping_add(step.wrapping_mul(i))))
}

#[cfg(test)]
mod tests {
    use rand_xoshiro::Xoshiro256PlusPlus;
    use rand_xoshiro::rand_core::{Rng, SeedableRng};

    use super::*;

    #[test]
    fn numbers_are_those_of_the_published_generator() {
        for (seed, i) in [(0, 0), (1, 0), (0, u64::MAX), (u64::MAX, 7), (12345, 678_910)] {
            let mut expected = Xoshiro256PlusPlus::seed_from_u64(mix(seed ^ mix(i.wrapping_add(1))));
            let mut generator = Generator::new(seed, i);
            for place in 0..1000 {
                assert_eq!(generator.next(), expected.next_u64(), "{seed} {i} {place}");
            }
        }
    }
}
