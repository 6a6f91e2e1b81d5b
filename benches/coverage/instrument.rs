//! Scans with standard deviations in their files, and with what is known of the instrument.

use brdfit::analysis::bootstrap::Noise as Random;
use brdfit::engine::instrument::moved;
use brdfit::engine::{Material, Prior, View};
use brdfit::input::{Measurement, ReadOptions, parse};
use brdfit::instrument::ENERGY;
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use crate::case::{Case, Copy};
use crate::scene::few;

const PAINT: [f64; 6] = [0.1, 1.0, 0.0, 0.2, 1.5, 0.0];
/// Angles of incidence; what is derived is looked at for the second.
const ANGLES: [f64; 2] = [20.0, 50.0];
/// Of ln f, where the file tells no deviations.
const NOISE: f64 = 0.03;

/// Standard deviations in a column.
pub fn deviations() -> Vec<Case> {
    let one = |errors: &str, absolute: f64, relative: f64, asked: bool| Case {
        scene: "paint, two angles".into(),
        errors: errors.into(),
        beside: false,
        make: Box::new(move |copy| with_deviations(absolute, relative, asked, copy)),
    };
    vec![
        one("sigma 0.004/sr", 0.004, 0.0, false),
        one("sigma 20 % of f", 0.0, 0.2, false),
        one("sigma 5 % of f and a floor of 0.002/sr", 0.002, 0.05, false),
        one("sigma 10 % of f, --absolute-sigma", 0.0, 0.1, true),
    ]
}

fn with_deviations(absolute: f64, relative: f64, asked: bool, copy: u64) -> Copy {
    let truth = Material::paper(PAINT);
    let mut random = Random::new(5, copy);
    let mut text = String::from("theta_i_deg,theta_s_deg,brdf_per_sr,sigma\n");
    for sample in grid(&truth) {
        let sigma = libm::hypot(absolute, relative * sample.brdf);
        let value = sample.brdf + sigma * random.normal();
        if value > 0.0 {
            let (theta_i, theta_s) = (sample.theta_i.to_degrees(), sample.theta_s.to_degrees());
            text += &format!("{theta_i},{theta_s},{value},{sigma}\n");
        }
    }
    let read = ReadOptions {
        absolute_sigma: asked,
        ..ReadOptions::default()
    };
    let mut scans = parse("scan.csv", text.as_bytes(), &read).expect("a scan");
    Copy {
        truth,
        measurement: scans.remove(0),
        options: few(),
        theta_i: ANGLES[1].to_radians(),
    }
}

/// What `fit` has options for.
pub fn instruments() -> Vec<Case> {
    let one = |errors: &str, make: fn(u64) -> Copy| Case {
        scene: "paint, two angles".into(),
        errors: errors.into(),
        beside: false,
        make: Box::new(make),
    };
    vec![
        one(
            "--scale-uncertainty 3%, of a calibration that is off by as much",
            calibrated,
        ),
        one("--fit-offset, of a zero that is off by up to 3 deg", shifted),
        one("--aperture-half-angle 1.5, m = 0.04", through),
        one("--prior n=X+-0.02, X off by as much", known_index),
        one("--conserve-energy, reflectance 0.99", bright),
    ]
}

fn calibrated(copy: u64) -> Copy {
    let mut random = Random::new(6, copy);
    let factor = 1.0 + 0.03 * random.normal();
    let mut one = noisy(PAINT, &mut random);
    one.options.instrument.scale_uncertainty = 0.03;
    let samples = &mut one.measurement.samples;
    samples.iter_mut().for_each(|sample| sample.brdf *= factor);
    one
}

fn shifted(copy: u64) -> Copy {
    let mut random = Random::new(6, copy);
    let offset = (6.0 * random.unit() - 3.0).to_radians();
    let mut one = noisy(PAINT, &mut random);
    let limit = 10f64.to_radians();
    one.options.instrument.offsets = Some((-limit, limit));
    let samples = &mut one.measurement.samples;
    for sample in samples {
        // The other way round it is where the instrument reads it.
        *sample = moved(sample, -offset).expect("in plane");
    }
    one
}

fn through(copy: u64) -> Copy {
    let mut random = Random::new(6, copy);
    let mut one = noisy([0.1, 1.0, 0.0, 0.04, 1.5, 0.0], &mut random);
    one.options.instrument.aperture = 1.5f64.to_radians();
    let view = View {
        aperture: one.options.instrument.aperture,
        ..View::from(&one.truth)
    };
    for sample in &mut one.measurement.samples {
        let ln_f = view.ln_f(sample).expect("above the horizon");
        sample.brdf = Real::portable_exp(ln_f + NOISE * random.normal());
    }
    one
}

fn known_index(copy: u64) -> Copy {
    let mut random = Random::new(6, copy);
    let mean = 1.5 + 0.02 * random.normal();
    let mut one = noisy(PAINT, &mut random);
    let place = one.options.model.place("n").expect("Eq. 14 has an index");
    let (lower, upper) = (one.options.model.lower(), one.options.model.upper());
    (one.options.lower[place], one.options.upper[place]) = (lower[place], upper[place]);
    one.options.instrument.priors[place] = Some(Prior { mean, sigma: 0.02 });
    one
}

fn bright(copy: u64) -> Copy {
    let mut random = Random::new(6, copy);
    let mut one = noisy([0.93, 1.0, 0.0, 0.2, 1.5, 0.0], &mut random);
    one.options.instrument.limit = Some(ENERGY);
    one
}

fn noisy(parameters: [f64; 6], random: &mut Random) -> Copy {
    let truth = Material::paper(parameters);
    let mut samples = grid(&truth);
    for sample in &mut samples {
        sample.brdf *= Real::portable_exp(NOISE * random.normal());
    }
    Copy {
        truth,
        measurement: Measurement::of_samples("scan", samples, None),
        options: few(),
        theta_i: ANGLES[1].to_radians(),
    }
}

fn grid(truth: &Material) -> Vec<Sample<f64>> {
    let along = |theta_i: f64| (-80..=80).map(move |theta_s| (theta_i, f64::from(theta_s)));
    let all = ANGLES.into_iter().flat_map(along);
    all.map(|(theta_i, theta_s)| crate::scene::sample(truth, theta_i, theta_s, 0.0))
        .collect()
}
