//! What of the residuals is the process, and not noise of each sample.

use super::process::{Process, step};

/// What each sample brings anew: its part of the sums that run backwards.
struct Fresh {
    expected: [f64; 2],
    /// Covariance of the state before the sample.
    variance: [f64; 3],
    /// What the sample is apart from what was expected, and its variance.
    apart: f64,
    total: f64,
    gain: [f64; 2],
    /// From the state before to this one.
    step: [[f64; 2]; 2],
}

/// The mean of the process at each of these ascending angles, given the residuals of all in units of their standard deviation: Kalman's filter, and the sums of Durbin and Koopman (2012, section 4.4) backwards.
pub fn smoothed(angles: &[f64], values: &[f64], process: Process) -> Vec<f64> {
    let mut mean = vec![0.0; values.len()];
    // What the samples behind say of the state.
    let mut behind = [0.0; 2];
    let list = filtered(angles, values, process);
    for (mean, here) in mean.iter_mut().zip(&list).rev() {
        let taken = here.gain[0] * behind[0] + here.gain[1] * behind[1];
        let from = [here.apart / here.total + behind[0] - taken, behind[1]];
        *mean = here.expected[0] + here.variance[0] * from[0] + here.variance[1] * from[1];
        let [[a, b], [c, d]] = here.step;
        behind = [a * from[0] + c * from[1], b * from[0] + d * from[1]];
    }
    mean
}

fn filtered(angles: &[f64], values: &[f64], process: Process) -> Vec<Fresh> {
    let part = process.part;
    let at_rest = [part, 0.0, if process.smooth { part } else { 0.0 }];
    let (mut state, mut variance) = ([0.0; 2], at_rest);
    let mut before: Option<f64> = None;
    let mut list = Vec::with_capacity(angles.len());
    for (&angle, &value) in angles.iter().zip(values) {
        let [[a, b], [c, d]] = before.map_or([[0.0; 2]; 2], |before| step(angle - before, process));
        before = Some(angle);
        let known: [f64; 3] = std::array::from_fn(|k| at_rest[k] - variance[k]);
        variance = [
            at_rest[0] - (a * a * known[0] + 2.0 * a * b * known[1] + b * b * known[2]),
            -(a * c * known[0] + (a * d + b * c) * known[1] + b * d * known[2]),
            at_rest[2] - (c * c * known[0] + 2.0 * c * d * known[1] + d * d * known[2]),
        ];
        let expected = [a * state[0] + b * state[1], c * state[0] + d * state[1]];
        let apart = value - expected[0];
        let total = variance[0] + 1.0 - part;
        let gain = [variance[0] / total, variance[1] / total];
        list.push(Fresh {
            expected,
            variance,
            apart,
            total,
            gain,
            step: [[a, b], [c, d]],
        });
        state = [expected[0] + gain[0] * apart, expected[1] + gain[1] * apart];
        variance = [
            variance[0] - gain[0] * variance[0],
            variance[1] - gain[0] * variance[1],
            variance[2] - gain[1] * variance[1],
        ];
    }
    list
}
