//! Who takes part in the race, and how each goes about it.

use brdfit::engine::trace::{passes, trace};
use brdfit::engine::{FitOptions, Method};
use brdfit_core::brdf::{ALL, Params};
use brdfit_core::geometry::Block;
use brdfit_core::lm::Bounds;
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::search::{Region, Scene};
use brdfit_core::start;

use crate::course::Course;
use crate::fits;
use crate::globals::{self, box_of};
use crate::octave::Octave;

/// Searches until the course is over; the number is the seed.
type Run<'a> = Box<dyn Fn(&Course, u64) + 'a>;

/// One who takes part.
pub struct Racer<'a> {
    pub name: String,
    pub run: Run<'a>,
}

fn racer<'a>(name: impl Into<String>, run: impl Fn(&Course, u64) + 'a) -> Racer<'a> {
    Racer {
        name: name.into(),
        run: Box::new(run),
    }
}

/// A local solver twice: from random starts, and from our candidates.
fn local<'a>(name: &str, fit: impl Fn(&Course, &[f64; 6]) + Copy + 'a) -> [Racer<'a>; 2] {
    [
        racer(format!("{name}, multistart"), move |course, seed| {
            multistart(course, seed, fit);
        }),
        racer(format!("{name} from our candidates"), move |course, seed| {
            candidates(course, seed, fit);
        }),
    ]
}

/// All in the order of the table, ours first; and the names of those left out, as they are not installed.
pub fn all(octave: Option<&Octave>) -> (Vec<Racer<'_>>, Vec<&'static str>) {
    let mut all = vec![
        racer("**brdfit**, default search", ours),
        racer("brdfit, the paper's method", papers),
    ];
    let mut left_out = Vec::new();
    all.extend(local("`rmpfit` 2.0", fits::rmpfit));
    all.extend(local("`basin` 3.2 BoundedLevenbergMarquardt", fits::basin));
    all.extend(local("`levenberg-marquardt` 0.15", fits::levenberg_marquardt));
    #[cfg(ceres)]
    all.extend(local("Ceres", crate::ceres::ceres));
    #[cfg(not(ceres))]
    left_out.push("Ceres (Debian's libceres-dev)");
    match octave {
        Some(octave) => {
            let name = format!("Octave {} lsqnonlin (optim {})", octave.versions[0], octave.versions[1]);
            all.extend(local(&name, |course, start| octave.lsqnonlin(course, start)));
        }
        None => left_out.push("Octave's lsqnonlin (octave-cli with the package optim)"),
    }
    all.extend([
        racer("NLopt 2.9 MLSL_LDS with L-BFGS", globals::mlsl_lbfgs),
        racer("NLopt 2.9 MLSL_LDS with SLSQP", globals::mlsl_slsqp),
        racer("`basin` 3.2 differential evolution", globals::differential_evolution),
        racer("`basin` 3.2 CMA-ES, restarted", globals::cma_es),
    ]);
    (all, left_out)
}

/// The searches one after the other, by further seeds, to the end of the race.
fn searches(course: &Course, seed: u64, method: Method) {
    for further in 0.. {
        let options = FitOptions {
            method,
            seed: seed + (further << 32),
            lower: course.lower.into(),
            upper: course.upper.into(),
            ..FitOptions::default()
        };
        let before = course.passes();
        let trace = trace(&course.samples, &options).expect("a valid scene");
        for record in &trace.records {
            course.note_at(before + passes(record.evaluations), record.cost);
        }
        course.spend(passes(trace.evaluations));
        if course.is_over() {
            return;
        }
    }
}

fn ours(course: &Course, seed: u64) {
    searches(course, seed, Method::Default);
}

fn papers(course: &Course, seed: u64) {
    searches(course, seed, Method::Paper);
}

/// Start `k`, uniform in the logarithm of each parameter.
pub fn log_uniform(course: &Course, seed: u64, k: u64) -> [f64; 6] {
    let [lower, upper] = box_of(course).map(|side| std::array::from_fn(|k| side[k]));
    start::uniform::<f64, 6>(seed, k, &Bounds { lower, upper }).map(Real::portable_exp)
}

fn multistart(course: &Course, seed: u64, local: impl Fn(&Course, &[f64; 6])) {
    (0..)
        .take_while(|_| !course.is_over())
        .for_each(|k| local(course, &log_uniform(course, seed, k)));
}

/// From the candidates of the default search, one after the other; what they cost counts too.
fn candidates(course: &Course, seed: u64, local: impl Fn(&Course, &[f64; 6])) {
    let mut blocks = vec![Block::EMPTY; course.rows().div_ceil(16)];
    for (row, sample) in course.samples.iter().enumerate() {
        let observation = brdfit_core::geometry::Observation::new(sample).expect("a valid scene");
        blocks[row / 16].set(row % 16, &observation);
    }
    let scan = Scan::<f64, ALL, 6>::new(&blocks);
    let bounds = Scan::<f64, ALL, 6>::bounds(&Params::from_array(course.lower), &Params::from_array(course.upper));
    for k in 0.. {
        if course.is_over() {
            return;
        }
        let candidate = scan.candidate(&bounds, seed, k, Region::Everywhere);
        course.spend(0.5 * f64::from(candidate.passes));
        local(course, &Scan::<f64, ALL, 6>::params(&candidate.x).to_array());
    }
}
