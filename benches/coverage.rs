//! Prints how often the 95 % intervals hold the truth, as a Markdown page: `cargo run --release --example coverage > benches/results/coverage.md`; behind `--` the number of copies, and a part of the names of the scenes or errors that are wanted.

#[path = "coverage/case.rs"]
mod case;
#[path = "coverage/instrument.rs"]
mod instrument;
#[path = "coverage/noise.rs"]
mod noise;
#[path = "coverage/runs.rs"]
mod runs;
#[path = "coverage/scene.rs"]
mod scene;
#[path = "coverage/share.rs"]
mod share;

use case::{Case, NAMES, shares};
use share::{Share, WANTED};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let copies: u64 = arguments
        .next()
        .map_or(400, |count| count.parse().expect("a number of copies"));
    let only = arguments.next().unwrap_or_default();
    let mut all = Vec::new();
    introduction(copies);
    println!("## Noise and misfit\n");
    table(&scene::cases(), copies, &only, &mut all);
    println!("## Standard deviations of the file\n");
    println!("They are used, with weights from the fitted f and ln f without the bias of its noise, as `fit` does.\n");
    table(&instrument::deviations(), copies, &only, &mut all);
    println!("## The instrument\n");
    println!("Noise of 3 %; what the options tell is drawn anew for each copy.\n");
    table(&instrument::instruments(), copies, &only, &mut all);
    println!("## Repeats\n");
    println!(
        "The budget of `joint --repeats`: the spot changes rho_d by 5 %, rho_s by 3 % and m by 2 % from run to run, and the noise of each of 33 samples is 3 %; the truth is what is without an effect of the run.\n"
    );
    println!("| runs | {} | experiments |", NAMES.join(" | "));
    println!("|---|{}", "--:|".repeat(NAMES.len() + 1));
    for (runs, effect, name) in [(3, 1.0, "3"), (5, 1.0, "5"), (4, 0.0, "4, all alike")] {
        if "repeats".contains(&only) {
            let held = runs::held(runs, effect, copies);
            println!("| {name} | {} | {copies} |", cells(&held));
            all.extend(held);
        }
    }
    summary(&all);
}

fn introduction(copies: u64) {
    let chance = |count: usize| 100.0 * share::noise(0.95, count);
    let [low, high] = [WANTED.0, WANTED.1].map(|part| 100.0 * part);
    println!("# Coverage of the 95 % intervals\n");
    println!(
        "Share in % of simulated copies whose interval holds the truth: the parameters that the scan was made with, and what follows from them. Wanted are {low:.0} to {high:.0} %. A share of 95 % has a noise (95 %, binomial) of +-{:.1} with {copies} copies, and of +-{:.1} with the {} that have profiles; a share that is out of what is wanted by more than that is marked, - below and + above. Copies have their seeds: every run prints the same.\n",
        chance(copies as usize),
        chance(copies.div_ceil(5) as usize),
        copies.div_ceil(5)
    );
    println!(
        "Stated: value +- the coverage factor times the standard error that `fit` prints. Independent: value +- Student's t times the standard error of independent residuals, with bounds taken as known where a parameter is on one. Profile: the F test of `brdfit profile` does not refute the true value, for every fifth copy."
    );
    println!(
        "Correlated: copies whose residuals are called correlated, as independence is refuted; counted: copies whose errors count a correlation, which may be only likely; times: the median over copies of the largest standard error of a parameter over that of independent residuals; bound: copies with a parameter on a bound.\n"
    );
    println!(
        "GGX: surfaces with GGX's facets and random parameters, with noise of 1 %, fitted with Beckmann's. The truth of rho_d, peak, width and reflectance is the surface's. Its m and rho_s F mean something else in the other model; their truth is the value that the fit has without noise (White 1982), which noise alone hardly moves, so that errors which allow for misfit hold it always."
    );
    println!(
        "Other scenes have errors of 5 %; smooth ones are those of an instrument, and the truth is the model's.\n"
    );
    println!("Regenerate: `cargo run --release --example coverage > benches/results/coverage.md`.\n");
}

fn cells(shares: &[Share]) -> String {
    let shown: Vec<String> = shares.iter().map(|share| share.shown()).collect();
    shown.join(" | ")
}

fn table(cases: &[Case], copies: u64, only: &str, all: &mut Vec<Share>) {
    let head = NAMES.join(" | ");
    println!("| scene | errors | intervals | {head} | correlated | counted | times | bound |");
    println!("|---|---|---|{}", "--:|".repeat(NAMES.len() + 4));
    for case in cases {
        if !format!("{} {}", case.scene, case.errors).contains(only) {
            continue;
        }
        let shares = shares(case, copies);
        let percent = |share: Share| format!("{:.1}", 100.0 * share.part());
        let about = format!(
            "{} | {} | {:.2} | {}",
            percent(shares.correlated),
            percent(shares.counted),
            shares.factor,
            percent(shares.bound)
        );
        let row = |name: &str, list: &[Share], about: &str| {
            println!(
                "| {} | {} | {name} | {} | {about} |",
                case.scene,
                case.errors,
                cells(list)
            );
        };
        row("stated", &shares.stated, &about);
        if case.beside {
            row("independent", &shares.independent, " | | | ");
            row("profile", &shares.profile, " | | | ");
        }
        all.extend(shares.stated);
    }
    println!();
}

fn summary(all: &[Share]) {
    let told = all.iter().filter(|share| share.count > 0);
    let (count, within, below, above) = told.fold((0, 0, 0, 0), |(count, within, below, above), share| {
        let side = share.side();
        let one = |yes: bool| usize::from(yes);
        (
            count + 1,
            within + one(side == 0),
            below + one(side < 0),
            above + one(side > 0),
        )
    });
    println!(
        "\nOf {count} shares that are stated {within} are what is wanted, {below} are below it and {above} above."
    );
}
