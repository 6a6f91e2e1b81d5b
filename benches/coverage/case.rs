//! One kind of scan, and whether the intervals of its copies hold the truth.

use brdfit::analysis::choose::Wanted;
use brdfit::analysis::derived::{self, Derived, Value};
use brdfit::analysis::deviations::settled;
use brdfit::analysis::fit;
use brdfit::analysis::misfit::{coverage_factor, inflation};
use brdfit::analysis::profile::{calibrate::threshold, hold::hold};
use brdfit::engine::uncertainty::Uncertainty;
use brdfit::engine::{self, FitOptions, Material};
use brdfit::input::Measurement;
use rayon::prelude::*;

use crate::share::Share;

/// What is looked at, at one angle of incidence.
pub const NAMES: [&str; 6] = ["rho_d", "m", "rho_s F", "peak", "width", "reflectance"];

/// One in so many copies is profiled: profiles take most of the time.
const PROFILED: u64 = 5;

/// A simulated scan.
pub struct Copy {
    pub truth: Material,
    pub measurement: Measurement,
    pub options: FitOptions,
    /// Where what is derived is looked at, radians.
    pub theta_i: f64,
}

/// A kind of scan.
pub struct Case {
    pub scene: String,
    pub errors: String,
    /// Are there intervals of independent residuals and profiles beside those that are stated?
    pub beside: bool,
    pub make: Box<dyn Fn(u64) -> Copy + Sync>,
}

/// What came of all copies.
pub struct Shares {
    /// Of the intervals that `fit` states.
    pub stated: [Share; 6],
    /// Of those of independent residuals.
    pub independent: [Share; 6],
    /// Of those of profiles.
    pub profile: [Share; 6],
    /// Copies whose residuals are called correlated, independence being refuted.
    pub correlated: Share,
    /// Copies whose errors count a correlation, sure or not.
    pub counted: Share,
    /// Copies with a parameter on a bound.
    pub bound: Share,
    /// Standard errors over those of independent residuals, the median over copies of the largest of a parameter.
    pub factor: f64,
}

/// Of one copy: of each kind of interval whether it holds.
struct Held {
    kinds: [[Option<bool>; 6]; 3],
    correlated: bool,
    counted: bool,
    bound: bool,
    factor: f64,
}

/// Over so many copies.
pub fn shares(case: &Case, copies: u64) -> Shares {
    let one = |copy| held(&(case.make)(copy), case.beside, copy.is_multiple_of(PROFILED));
    let all: Vec<Held> = (0..copies).into_par_iter().map(one).collect();
    let kind = |kind: usize| std::array::from_fn(|k| Share::of(all.iter().filter_map(|held| held.kinds[kind][k])));
    let mut factors: Vec<f64> = all.iter().map(|held| held.factor).collect();
    factors.sort_by(f64::total_cmp);
    Shares {
        stated: kind(0),
        independent: kind(1),
        profile: kind(2),
        correlated: Share::of(all.iter().map(|held| held.correlated)),
        counted: Share::of(all.iter().map(|held| held.counted)),
        bound: Share::of(all.iter().map(|held| held.bound)),
        factor: factors.get(factors.len() / 2).copied().unwrap_or(f64::NAN),
    }
}

fn held(copy: &Copy, beside: bool, profiled: bool) -> Held {
    let wanted = Wanted::One(copy.options);
    let measurement = settled(copy.measurement.clone(), &wanted);
    let scan = fit::fit(&measurement, &wanted).expect("simulated scans are valid");
    let found = engine::fit(&measurement.samples, &copy.options).expect("simulated scans are valid");
    let (material, stated) = (scan.outcome.material(), &scan.outcome.uncertainty);
    let independent = without_bounds(&found.uncertainty);
    let actual = actual(copy, &found.uncertainty);
    let near = |at: &&Derived| (at.theta_i - copy.theta_i).abs();
    let at = scan.derived.iter().min_by(|a, b| near(a).total_cmp(&near(b)));
    let at = at.expect("a scan has an angle of incidence");
    let holds = |values: [Option<Value>; 6], factor: f64| -> [Option<bool>; 6] {
        std::array::from_fn(|k| {
            let (value, actual) = (values[k]?, actual[k]?);
            Some((value.value - actual).abs() <= factor * value.stderr)
        })
    };
    let none = [None; 6];
    let degrees = independent.degrees_of_freedom as f64;
    let plain = || {
        let at = derived::at(copy.theta_i, &material, &independent);
        holds(
            quantities(&material, &independent, &at),
            threshold(0.95, degrees).sqrt(),
        )
    };
    let profile = |k: usize| {
        let place = material.model.place(["rho_d", "m"].get(k)?)?;
        let mut value = material.values;
        value[place] = actual[k]?;
        let point = hold(&measurement.samples, &copy.options, &found, place, value[place]).ok()?;
        let rise = (point.cost - found.cost).max(0.0) / found.cost * degrees;
        Some(rise <= inflation(stated, &found.uncertainty, place) * threshold(0.95, stated.effective))
    };
    Held {
        kinds: [
            holds(quantities(&material, stated, at), coverage_factor(stated)),
            if beside { plain() } else { none },
            if beside && profiled {
                std::array::from_fn(profile)
            } else {
                none
            },
        ],
        correlated: stated.misfit.is_some_and(|misfit| misfit.sure),
        counted: stated.misfit.is_some(),
        bound: !scan.outcome.at_bound.is_empty(),
        factor: stated.misfit.map_or(1.0, |misfit| misfit.factor.1),
    }
}

/// The truth: of the surface where that is the same quantity in the model that is fitted, else the value that a fit has without noise.
fn actual(copy: &Copy, known: &Uncertainty) -> [Option<f64>; 6] {
    let of = |material: &Material| {
        let at = derived::at(copy.theta_i, material, known);
        quantities(material, known, &at).map(|value| value.map(|value| value.value))
    };
    let mut actual = of(&copy.truth);
    if copy.truth.model != copy.options.model {
        let mut samples = copy.measurement.samples.clone();
        for sample in &mut samples {
            sample.brdf = libm::exp(copy.truth.ln_f(sample).expect("above the horizon"));
        }
        let clean = engine::fit(&samples, &copy.options).expect("simulated scans are valid");
        let pseudo = of(&clean.material());
        (actual[1], actual[2]) = (pseudo[1], pseudo[2]);
    }
    actual
}

fn quantities(material: &Material, known: &Uncertainty, at: &Derived) -> [Option<Value>; 6] {
    let parameter = |name: &str| {
        let place = material.model.place(name)?;
        let (value, stderr) = (material.values[place], known.stderr[place]);
        Some(Value { value, stderr })
    };
    [
        parameter("rho_d"),
        parameter("m"),
        at.rho_s_f,
        at.peak.map(|peak| peak.f),
        at.peak.and_then(|peak| peak.width),
        Some(at.reflectance),
    ]
}

/// Errors with what is on a bound held there.
fn without_bounds(known: &Uncertainty) -> Uncertainty {
    let inside: Vec<usize> = known.inside().collect();
    let mut axes = known.axes.clone();
    for (place, axis) in axes.iter_mut().enumerate() {
        if !inside.contains(&place) {
            axis.iter_mut().for_each(|part| *part = 0.0);
        }
    }
    known.clone().with_axes(axes)
}
