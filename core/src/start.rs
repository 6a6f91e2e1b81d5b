//! Seeded starts: start i is a function of (seed, i, bounds) alone, so that starts can be made in any order and on any number of threads.

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::lm::Bounds;
use crate::real::Real;

/// xoshiro256++ (Blackman and Vigna 2021).
struct Generator(Xoshiro256PlusPlus);

impl Generator {
    /// That of start `i`: its state from `seed` and `i` through two rounds of SplitMix64's mixing.
    #[cfg_attr(target_os = "none", inline(never))]
    fn new(seed: u64, i: u64) -> Self {
        let mut z = seed ^ mix(i.wrapping_add(1));
        z = mix(z);
        // What `seed_from_u64` does, in less code.
        let mut state = [0; 32];
        for word in state.as_chunks_mut::<8>().0 {
            z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
            *word = mix(z).to_le_bytes();
        }
        Generator(Xoshiro256PlusPlus::from_seed(state))
    }

    #[cfg_attr(target_os = "none", inline(never))]
    fn next(&mut self) -> u64 {
        self.0.next_u64()
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
    use super::*;

    #[test]
    fn the_state_is_that_of_seed_from_u64() {
        for (seed, i) in [(0, 0), (1, 0), (0, u64::MAX), (u64::MAX, 7), (12345, 678_910)] {
            let expected = Xoshiro256PlusPlus::seed_from_u64(mix(seed ^ mix(i.wrapping_add(1))));
            assert_eq!(Generator::new(seed, i).0, expected, "{seed} {i}");
        }
    }
}
