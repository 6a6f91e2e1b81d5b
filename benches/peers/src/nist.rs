//! NIST's 54 runs: the core's solver, MINPACK and the crate `levenberg-marquardt`, all with exact derivatives.

use brdfit_core::lm::Options;
use brdfit_suite::dual::Dual;
use brdfit_suite::nist_models::{Residuals, Run, Solver, options, run_all};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};

use crate::outside;

/// MINPACK in Rust.
struct Crate;

impl Solver for Crate {
    type Stop = String;
    fn solve<const P: usize>(&self, residuals: Residuals<P>, start: [f64; P]) -> ([f64; P], f64, u32, String) {
        let problem = Problem {
            residuals,
            x: DVector::from_row_slice(&start),
            at: residuals(&Dual::variables(&start)),
        };
        let solver = LevenbergMarquardt::new()
            .with_ftol(1e-15)
            .with_xtol(1e-15)
            .with_gtol(0.0)
            .with_patience(10_000 / (P + 1));
        let (problem, report) = solver.minimize(problem);
        let stop = match report.termination {
            TerminationReason::Converged { ftol, .. } => if ftol { "ftol" } else { "xtol" }.to_string(),
            TerminationReason::NoImprovementPossible(which) => format!("no better ({which})"),
            TerminationReason::LostPatience => "evaluations".to_string(),
            other => format!("{other:?}"),
        };
        let x = std::array::from_fn(|k| problem.x[k]);
        let cost = problem.at.iter().map(|r| r.v * r.v).sum();
        (x, cost, report.number_of_evaluations as u32, stop)
    }
}

struct Problem<'a, const P: usize> {
    residuals: Residuals<'a, P>,
    x: DVector<f64>,
    at: Vec<Dual<P>>,
}

impl<const P: usize> LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_, P> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, x: &DVector<f64>) {
        self.x.copy_from(x);
        self.at = (self.residuals)(&Dual::variables(&std::array::from_fn(|k| x[k])));
    }
    fn params(&self) -> DVector<f64> {
        self.x.clone()
    }
    fn residuals(&self) -> Option<DVector<f64>> {
        Some(DVector::from_iterator(self.at.len(), self.at.iter().map(|r| r.v)))
    }
    fn jacobian(&self) -> Option<DMatrix<f64>> {
        Some(DMatrix::from_fn(self.at.len(), P, |row, column| self.at[row].d[column]))
    }
}

/// What all tables need of a run.
struct Entry {
    lre: f64,
    evaluations: u32,
    stop: String,
}

fn entries<S>(runs: &[Run<S>], stop: impl Fn(&S) -> String) -> Vec<Entry> {
    let entry = |run: &Run<S>| Entry {
        lre: run.lre,
        evaluations: run.passes,
        stop: stop(&run.stop),
    };
    runs.iter().map(entry).collect()
}

/// MINPACK's runs in the order of `runs`.
fn minpack<S>(runs: &[Run<S>]) -> Vec<Entry> {
    let rows = outside::rows(&outside::python(), &[&outside::beside("minpack.py")]);
    let find = |run: &Run<S>| {
        let same = |row: &&Vec<String>| row[0] == run.name && row[1] == run.start.to_string();
        let row = rows.iter().find(same)?;
        Some(Entry {
            lre: row[2].parse().ok()?,
            evaluations: row[3].parse().ok()?,
            stop: row[4].clone(),
        })
    };
    runs.iter().filter_map(find).collect()
}

/// The whole of benches/results/nist.md.
pub fn print() {
    let ours = run_all(&options());
    let kinds = [
        ("brdfit", entries(&ours, |stop| format!("{stop:?}"))),
        (
            "brdfit, default options",
            entries(&run_all(&Options::default()), |stop| format!("{stop:?}")),
        ),
        ("MINPACK", minpack(&ours)),
        ("`levenberg-marquardt` 0.15", entries(&run_all(&Crate), String::clone)),
    ];
    println!("# NIST StRD nonlinear regression, both certified starts\n");
    println!(
        "LRE: log relative error, -log10 of the relative distance from the certified value, the least over the parameters; at most 11, the digits that are certified."
    );
    println!("All have exact derivatives; evaluations are those of the residuals (brdfit: with J).");
    println!("brdfit: first damping 1e3, cost tolerance 1e-20, at most 10,000 evaluations.");
    println!(
        "Its default options (1e-3, 2.2e-16, 500) are made for starts that are not absurd, and miss three of the farther ones: BoxBOD after a bold first step, MGH17 and MGH10 for want of evaluations, of which they need 580 and 7700 with any first damping; MINPACK follows the valley of MGH10 in 300."
    );
    println!(
        "A first damping of 1e3 for all would serve both, but makes the default search of a BRDF a quarter to a third longer (test data 1 to 3, means of 40 seeds: 340, 312 and 281 passes; 1e-3 needs 245, 229 and 224)."
    );
    println!(
        "MINPACK (`scipy.optimize.leastsq`) and the crate `levenberg-marquardt`, which follows it: ftol = xtol = 1e-15, gtol = 0, at most 10,000 evaluations."
    );
    println!("Regenerate: `benches/peers/run nist > benches/results/nist.md`.\n");
    print!("| set | start | P |");
    kinds
        .iter()
        .for_each(|(name, _)| print!(" {name}: LRE | evaluations | stop |"));
    print!("\n|---|--:|--:|");
    kinds.iter().for_each(|_| print!("--:|--:|---|"));
    println!();
    for (place, run) in ours.iter().enumerate() {
        print!("| {} | {} | {} |", run.name, run.start, run.parameters);
        for (_, entries) in &kinds {
            match entries.get(place) {
                Some(Entry { lre, evaluations, stop }) => print!(" {lre:.1} | {evaluations} | {stop} |"),
                None => print!(" - | - | not run |"),
            }
        }
        println!();
    }
    println!(
        "\n| | LRE at least 6 | least LRE | median LRE | evaluations, sum | without MGH10 from start 1 |\n|---|--:|--:|--:|--:|--:|"
    );
    for (name, entries) in kinds.iter().filter(|(_, entries)| !entries.is_empty()) {
        let mut lre: Vec<f64> = entries.iter().map(|entry| entry.lre).collect();
        lre.sort_by(f64::total_cmp);
        let (half, all) = (lre.len() / 2, entries.iter().map(|e| e.evaluations).sum::<u32>());
        let long = ours
            .iter()
            .position(|run| (run.name, run.start) == ("MGH10", 1))
            .and_then(|k| entries.get(k));
        println!(
            "| {name} | {} of {} | {:.1} | {:.1} | {all} | {} |",
            lre.iter().filter(|lre| **lre >= 6.0).count(),
            lre.len(),
            lre[0],
            0.5 * (lre[half - 1] + lre[half]),
            all - long.map_or(0, |entry| entry.evaluations),
        );
    }
}
