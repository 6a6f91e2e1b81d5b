//! Which processes the residuals may be of, by their likelihood.

use brdfit_core::real::Real;

use super::lanes::TOGETHER;
use super::likelihood::likelihoods;
use super::process::{Process, Residuals};
use super::sandwich::Common;
use crate::engine::threads;
use crate::until::until;

/// One process that the residuals may be of.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The process.
    pub process: Process,
    /// Its share of the likelihood of all.
    pub weight: f64,
    /// ln of its likelihood over that of independence.
    pub evidence: f64,
    /// Its variance, in units of that of the residuals.
    pub variance: f64,
    /// Covariance of the fit, in the coordinates of the rows, one of its rows after the other: 1 for independent residuals.
    pub covariance: Vec<f64>,
}

/// Parts of the variance that are correlated.
const PARTS: [f64; 9] = [0.1, 0.25, 0.45, 0.65, 0.8, 0.9, 0.96, 0.99, 0.999];
/// Those that are looked at first, with every second length.
const FIRST: [f64; 3] = [0.25, 0.65, 0.96];
/// Before the scan is seen a length x times another is likelier by x to this power: short scans tell less of long ones than there is.
const LONGER: f64 = 0.25;
/// No process is longer than this part of a line: beyond, it is a factor of all values, of which residuals say nothing.
const LONGEST: f64 = 0.34;
/// From so many residuals on the threads of the pool share the processes.
const MANY: usize = 4096;

/// A process with ln of its likelihood and the variance that fits best.
type Judged = (Process, (f64, f64));

/// The likeliest process; `None` if none is more likely than independence by a factor of e^`evidence`.
pub fn likeliest(all: &Residuals, degrees_of_freedom: usize, evidence: f64) -> Option<Process> {
    let list = judged(all, &lengths(all)?, degrees_of_freedom, evidence)?;
    let best = list.iter().max_by(|(_, (a, _)), (_, (b, _))| a.total_cmp(b))?;
    Some(best.0)
}

/// All processes of these lengths, and independence at their end; `None` if none of a few is more likely than that by a factor of e^`evidence`.
fn judged(all: &Residuals, lengths: &[f64], degrees_of_freedom: usize, evidence: f64) -> Option<Vec<Judged>> {
    let degrees = degrees_of_freedom as f64;
    let independent = Process {
        length: f64::MIN_POSITIVE,
        part: 0.0,
        smooth: false,
    };
    let processes = |step: usize, parts: &[f64]| -> Vec<Process> {
        let of = |length: f64| parts.iter().map(move |&part| (length, part));
        let pairs = lengths.iter().step_by(step).flat_map(|&length| of(length));
        let both = pairs.flat_map(|(length, part)| [false, true].map(|smooth| Process { length, part, smooth }));
        both.collect()
    };
    // Of a long scan this takes seconds; what it says once it is not wanted is thrown away.
    let until = until();
    let some = |processes: &[Process]| -> Vec<Judged> {
        let found = match until.is_over() {
            true => vec![(f64::NEG_INFINITY, f64::NAN); processes.len()],
            false => likelihoods(all, processes, degrees),
        };
        processes.iter().copied().zip(found).collect()
    };
    let judged_all = |processes: &[Process]| -> Vec<Judged> {
        match all.values.len() < MANY {
            true => some(processes),
            false => {
                let parts: Vec<&[Process]> = processes.chunks(TOGETHER).collect();
                threads::map(&parts, &|part| some(part)).concat()
            }
        }
    };
    let mut first = processes(2, &FIRST);
    first.push(independent);
    let mut first = judged_all(&first);
    let null = first.pop()?;
    let most = first.iter().map(|(_, (ln, _))| *ln).fold(f64::NEG_INFINITY, f64::max);
    if !(most > null.1.0 + evidence) {
        return None;
    }
    let mut list = judged_all(&processes(1, &PARTS));
    list.push(null);
    Some(list)
}

/// The processes that count, of shares above 1e-4; `None` if none is more likely than independence by a factor of e^`evidence`, or if nobody waits for them any more.
pub fn nodes(all: &Residuals, degrees_of_freedom: usize, evidence: f64) -> Option<Vec<Node>> {
    let lengths = lengths(all)?;
    let list = judged(all, &lengths, degrees_of_freedom, evidence)?;
    // Independence counts as much as all else together.
    let others = Real::portable_ln(list.len() as f64 - 1.0);
    let best = list.iter().map(|(_, (ln, _))| *ln).fold(f64::NEG_INFINITY, f64::max);
    let independent = list.last()?.1.0;
    let share = |(process, (ln, _)): &Judged| {
        let more = match process.part {
            0.0 => others,
            _ => LONGER * Real::portable_ln(process.length / lengths[0]),
        };
        Real::portable_exp(ln - best + more)
    };
    let mut shares: Vec<(&Judged, f64)> = list.iter().map(|one| (one, share(one))).collect();
    let total: f64 = shares.iter().map(|(_, share)| share).sum();
    shares.retain(|(_, share)| *share > 1e-4 * total);
    let total: f64 = shares.iter().map(|(_, share)| share).sum();
    let processes: Vec<(Process, f64)> = shares.iter().map(|(one, _)| (one.0, one.1.1)).collect();
    if until().is_over() {
        return None;
    }
    let covariances = Common::new(all).covariances(all, &processes)?;
    let node = |((one, share), covariance): (&(&Judged, f64), Vec<f64>)| Node {
        process: one.0,
        weight: share / total,
        evidence: one.1.0 - independent,
        variance: one.1.1,
        covariance,
    };
    Some(shares.iter().zip(covariances).map(node).collect())
}

/// Lengths from a step to a part of the longest line, each 1.6 times the last; `None` without lines of two.
fn lengths(all: &Residuals) -> Option<Vec<f64>> {
    let step = all.step()?;
    let span = all.lines().filter(|line| !line.is_empty());
    let span = span.map(|line| all.angles[line.end - 1] - all.angles[line.start]);
    let most = LONGEST * span.fold(0.0, f64::max);
    let grown = std::iter::successors(Some(0.7 * step), |length| Some(1.6 * length));
    Some(grown.take_while(|&length| length <= most).collect())
}
