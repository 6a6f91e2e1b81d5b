//! How many rows of a scan tell something of their own.

use std::collections::HashSet;

use brdfit_core::geometry::Sample;

/// The bits of the numbers of a direction, and of one with its value.
type Direction = [u64; 3];

fn direction(sample: &Sample<f64>) -> Direction {
    // 0 and -0 are the same angle.
    [sample.theta_i, sample.theta_s, sample.delta_phi].map(|angle| (angle + 0.0).to_bits())
}

/// Different directions of the samples that count, up to `most`, beyond which nobody asks.
pub fn directions(samples: &[Sample<f64>], most: usize) -> usize {
    let mut seen = HashSet::new();
    for sample in samples.iter().filter(|sample| sample.weight != 0.0) {
        seen.insert(direction(sample));
        if seen.len() >= most {
            break;
        }
    }
    seen.len()
}

/// Samples with the direction and the value of another before them.
pub fn copies(samples: &[Sample<f64>]) -> usize {
    /// Up to so many samples it takes less time to compare each two.
    const FEW: usize = 64;
    let counted = samples.iter().filter(|sample| sample.weight != 0.0);
    let key = |sample: &Sample<f64>| (direction(sample), sample.brdf.to_bits());
    if samples.len() > FEW {
        let mut seen = HashSet::with_capacity(samples.len());
        return counted.filter(|sample| !seen.insert(key(sample))).count();
    }
    let (mut seen, mut count) = ([Default::default(); FEW], 0);
    let again = |sample: &&Sample<f64>| {
        let key = key(sample);
        let is_known = seen[..count].contains(&key);
        if !is_known {
            seen[count] = key;
            count += 1;
        }
        is_known
    };
    counted.filter(again).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_has_the_direction_and_the_value_of_another() {
        let at = |theta_s: f64, brdf: f64| Sample::in_plane(0.5, theta_s, brdf);
        let samples = [at(0.0, 1.0), at(-0.0, 1.0), at(0.1, 1.0), at(0.1, 1.1), at(0.1, 1.0)];
        assert_eq!((directions(&samples, 9), copies(&samples)), (2, 2));
        assert_eq!(directions(&samples, 1), 1);
    }
}
