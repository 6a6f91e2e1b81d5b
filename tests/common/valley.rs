//! How many passes a fit takes to the end of its valley, with and without bent steps.

use brdfit::engine::blocks;
use brdfit_core::brdf::ALL;
use brdfit_core::lm::{Linearization, Options, Problem, Stop, fit};
use brdfit_core::residuals::Scan;
use brdfit_core::search::{Region, Scene};

use crate::scan::{data, scan};

/// The draws of each of the paper's sets: without noise, and three with +-10 %.
pub const KINDS: [&str; 4] = ["ideal", "sym_seed1", "sym_seed2", "sym_seed3"];
/// One fit from each of this many candidates.
pub const FITS: u64 = 100;

/// Passes of these fits.
#[derive(Clone, Copy, Debug)]
pub struct Passes {
    pub median: u32,
    /// Nine tenths take at most this.
    pub p90: u32,
    pub most: u32,
    pub mean: f64,
    /// Fits that did not converge in 20,000.
    pub lost: usize,
}

/// The same problem with straight steps: the plain Levenberg-Marquardt method.
struct Straight<'a>(Scan<'a, f64, ALL, 6>);

impl Problem<f64, 6> for Straight<'_> {
    fn bend(&self, _x: &[f64; 6], _step: &[f64; 6], to: [f64; 6]) -> [f64; 6] {
        to
    }
    fn cost(&self, x: &[f64; 6]) -> f64 {
        self.0.cost(x)
    }
    fn linearize(&self, x: &[f64; 6]) -> Linearization<f64, 6> {
        self.0.linearize(x)
    }
}

/// Of one of the paper's sets (1 to 3) and one of [`KINDS`], with default options but for the number of passes.
pub fn passes_to_the_end(set: u32, kind: &str, bent: bool) -> Passes {
    let blocks = blocks::<f64>(&scan(&data(&format!("testdata{set}_{kind}.csv")))).expect("a valid scan");
    let scene = Scan::<f64, ALL, 6>::new(&blocks);
    let bounds = Scan::<f64, ALL, 6>::usual_bounds();
    // Beyond m = 3 a lobe is as wide as Lambert's law, and a fit from there may follow it for tens of thousands of passes; a search gives none of its fits so many.
    let mut peaked = bounds;
    peaked.upper[3] = 3.0;
    let options = Options {
        max_passes: 20_000,
        ..Options::default()
    };
    let mut lost = 0;
    let mut passes = Vec::new();
    for i in 0..FITS {
        let start = scene.candidate(&peaked, 0, i, Region::Everywhere).x;
        let fit = if bent {
            fit(&scene, &bounds, start, &options)
        } else {
            fit(&Straight(scene), &bounds, start, &options)
        };
        lost += usize::from(!fit.stop.is_some_and(Stop::converged));
        passes.push(fit.passes);
    }
    passes.sort_unstable();
    let at = |part: usize| passes[part * (passes.len() - 1) / 100];
    Passes {
        median: at(50),
        p90: at(90),
        most: at(100),
        mean: f64::from(passes.iter().sum::<u32>()) / passes.len() as f64,
        lost,
    }
}

/// All of them as a Markdown table.
pub fn table() -> String {
    let mut text = String::from(
        "| test data | noise | steps | median | 90 % | most | mean | not converged |\n|--:|---|---|--:|--:|--:|--:|--:|\n",
    );
    for set in 1..=3 {
        for kind in KINDS {
            for (bent, name) in [(false, "straight"), (true, "bent")] {
                let Passes {
                    median,
                    p90,
                    most,
                    mean,
                    lost,
                } = passes_to_the_end(set, kind, bent);
                text += &format!("| {set} | {kind} | {name} | {median} | {p90} | {most} | {mean:.0} | {lost} |\n");
            }
        }
    }
    text
}
