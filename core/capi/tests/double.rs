//! In `f64`, C gets what the Rust host gets, to the bit, and mistakes are errors; `double.rs` is this in `f64`.

#![allow(clippy::unnecessary_cast, clippy::useless_conversion)]

use std::mem::zeroed;
use std::path::Path;
use std::ptr::{null, null_mut};

use brdfit::engine::{self, FitOptions, Model, Precision, TERM_SETS, Values};
use brdfit_capi::brdfit_error as Error;
use brdfit_capi::*;
use brdfit_core::brdf::{ALL, Brdf, Params};
use brdfit_core::geometry::{Geometry, Sample};
use brdfit_core::lm::{self, Options, Problem};
use brdfit_core::lobes::{Beckmann, Distribution, Ggx};
use brdfit_core::microfacet::Microfacet;
use brdfit_core::real::Real;
use brdfit_core::residuals::{Residuals, Scan, value};
use brdfit_core::uncertainty::Uncertainty;

/// Test data 1 with noise, each sample with a weight.
fn samples() -> Vec<Sample<f64>> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/testdata1_sym_seed1.csv");
    let text = std::fs::read_to_string(file).unwrap();
    let mut samples = Vec::new();
    for (row, line) in text.lines().skip(1).enumerate() {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        samples.push(Sample {
            weight: (row % 5 + 1) as f64 / 4.0,
            ..Sample::in_plane(cells[0].to_radians(), cells[1].to_radians(), cells[2])
        });
    }
    samples
}

/// The memory of a caller.
struct Memory {
    blocks: Vec<brdfit_block<f64>>,
    scan: brdfit_scan<f64>,
}

fn with_samples() -> Memory {
    let empty = brdfit_block {
        opaque: [7.0; BRDFIT_BLOCK_NUMBERS],
    };
    let mut memory = Memory {
        blocks: vec![empty; 12],
        // SAFETY: any bits are a value of it.
        scan: unsafe { zeroed() },
    };
    let samples: Vec<brdfit_sample<f64>> = samples()
        .iter()
        .map(|sample| brdfit_sample {
            theta_i: sample.theta_i as f64,
            theta_s: sample.theta_s as f64,
            delta_phi: BRDFIT_PI as f64,
            brdf: sample.brdf as f64,
            weight: sample.weight as f64,
        })
        .collect();
    // SAFETY: the pointers are of as many objects as is said.
    unsafe {
        let blocks = memory.blocks.as_mut_ptr();
        assert_eq!(brdfit_scan_init_f64(&mut memory.scan, blocks, 12), Error::None);
        let (one, others) = samples.split_first().unwrap();
        assert_eq!(brdfit_scan_add_f64(&mut memory.scan, one, 1), Error::None);
        let done = brdfit_scan_add_f64(&mut memory.scan, others.as_ptr(), others.len());
        assert_eq!(done, Error::None);
    }
    assert_eq!(memory.scan.samples, samples.len());
    memory
}

fn usual() -> brdfit_options<f64> {
    // SAFETY: any bits are a value of it, and the pointer is of it.
    unsafe {
        let mut options = zeroed();
        assert_eq!(brdfit_options_init_f64(&mut options), Error::None);
        options
    }
}

fn same(c: brdfit_params<f64>, host: Values) {
    let bits = Params::from(c).to_array().map(|value| f64::from(value).to_bits());
    let host: Vec<u64> = host.iter().map(|value| value.to_bits()).collect();
    assert_eq!(bits.as_slice(), host);
}

#[test]
fn a_search_gives_the_bits_of_the_host() {
    for terms in TERM_SETS {
        search_as_the_host(terms, BRDFIT_MODEL_BECKMANN, Model::paper());
    }
    search_as_the_host(ALL, BRDFIT_MODEL_GGX, Model::find("ggx").unwrap());
}

fn search_as_the_host(terms: u8, model: u32, of_host: &'static Model) {
    let memory = with_samples();
    let expected = FitOptions {
        terms,
        precision: Precision::F64,
        ..FitOptions::of(of_host)
    };
    let expected = engine::fit(&samples(), &expected).unwrap();
    let options = brdfit_options {
        terms: terms.into(),
        model,
        ..usual()
    };
    // SAFETY: any bits but those of `stop`, where 0 is right, are values; the pointers are of as many objects as is said.
    let (found, minima) = unsafe {
        let (mut found, mut minima) = (zeroed(), [zeroed(); 32]);
        let done = brdfit_search_f64(&memory.scan, &options, minima.as_mut_ptr(), 32, &mut found);
        assert_eq!(done, Error::None);
        (found, minima)
    };
    same(found.best.params, expected.params);
    assert_eq!(f64::from(found.best.cost), expected.cost);
    assert_eq!(found.best.stop, Some(expected.stop).into());
    let evaluations = expected.evaluations;
    assert_eq!(
        [found.cost_passes, found.linearize_passes],
        [evaluations.cost, evaluations.linearize]
    );
    assert_eq!(found.minima, expected.minima.len());
    for (minimum, expected) in minima.iter().zip(&expected.minima) {
        same(minimum.params, expected.params);
        assert_eq!(minimum.hits, expected.hits);
    }
}

#[test]
fn the_caller_decides_how_many_minima_are_kept() {
    let memory = with_samples();
    // SAFETY: as above.
    unsafe {
        let (mut found, mut without, mut minima) = (zeroed(), zeroed(), [zeroed(); 2]);
        let minima_of = minima.as_mut_ptr();
        let done = brdfit_search_f64(&memory.scan, &usual(), minima_of, 1, &mut found);
        assert_eq!((done, found.minima), (Error::None, 1));
        assert_eq!(minima[0].params, found.best.params);
        assert_eq!(minima[1], zeroed());
        // Null options are the usual ones.
        let done = brdfit_search_f64(&memory.scan, null(), null_mut(), 0, &mut without);
        assert_eq!((done, without.minima), (Error::None, 0));
        assert_eq!(without.best, found.best);
    }
}

#[test]
fn a_fit_in_pieces_gives_the_bits_of_one_at_once() {
    in_pieces_as_at_once::<Beckmann>(BRDFIT_MODEL_BECKMANN);
    in_pieces_as_at_once::<Ggx>(BRDFIT_MODEL_GGX);
}

fn in_pieces_as_at_once<D: Distribution>(model: u32) {
    let memory = with_samples();
    let start = brdfit_params::from(Params::from_array([0.1, 1.0, 0.01, 0.2, 1.5, 0.5]));
    let options = brdfit_options { model, ..usual() };
    let blocks = engine::blocks::<f64>(&samples()).unwrap();
    let scan = Residuals::<f64, Microfacet<ALL, D>, 6>::new(&blocks);
    let bounds = Scan::<f64, ALL, 6>::bounds(&options.lower.into(), &options.upper.into());
    let x = Scan::<f64, ALL, 6>::coordinates(&start.into());
    let expected = lm::fit(&scan, &bounds, x, &Options::default());
    for passes in [1, 7, u32::MAX] {
        // SAFETY: as above.
        let result = unsafe {
            let (mut fit, mut result): (_, brdfit_result<f64>) = (zeroed(), zeroed());
            assert_eq!(
                brdfit_fit_begin_f64(&mut fit, &memory.scan, &start, &options),
                Error::None
            );
            while {
                assert_eq!(brdfit_fit_result_f64(&fit, &mut result), Error::None);
                result.stop == brdfit_stop::None
            } {
                // A copy goes on as the original would.
                let mut copy = fit;
                let before = result.passes;
                assert_eq!(brdfit_fit_run_f64(&mut copy, &memory.scan, passes), Error::None);
                assert_eq!(brdfit_fit_result_f64(&copy, &mut result), Error::None);
                assert!(result.passes <= before.saturating_add(passes));
                fit = copy;
            }
            result
        };
        assert_eq!(Params::from(result.params), Scan::<f64, ALL, 6>::params(&expected.x));
        assert_eq!((result.cost, result.passes), (expected.at.cost, expected.passes));
        assert_eq!(result.stop, expected.stop.into());
    }
}

#[test]
fn the_model_gives_the_bits_of_the_host() {
    let params = Params::from_array([0.1, 10.0, 0.01, 0.1, 3.0, 1.0]);
    let x = Scan::<f64, ALL, 6>::coordinates(&params);
    let model = Brdf::<f64, ALL>::new(&params);
    for step in -15..=15 {
        let [theta_i, theta_s, delta_phi] = [0.75, step as f64 * 0.1, step as f64 * 0.3];
        let geometry = Geometry::new(theta_i, theta_s, delta_phi).unwrap();
        let beckmann = Real::portable_exp(model.ln_f(&geometry));
        let ggx = Real::portable_exp(value::<f64, Microfacet<ALL, Ggx>, 6, 6>(&x, geometry.into()));
        assert_ne!(beckmann, ggx);
        let params = params.into();
        // SAFETY: as above.
        unsafe {
            let mut brdf = 0.0;
            let done = brdfit_brdf_f64(theta_i, theta_s, delta_phi, &params, &mut brdf);
            assert_eq!((done, brdf), (Error::None, beckmann));
            for (model, expected) in [(BRDFIT_MODEL_BECKMANN, beckmann), (BRDFIT_MODEL_GGX, ggx)] {
                let done = brdfit_model_brdf_f64(model, theta_i, theta_s, delta_phi, &params, &mut brdf);
                assert_eq!((done, brdf), (Error::None, expected));
            }
        }
    }
}

#[test]
fn mistakes_with_samples_are_errors() {
    let good = brdfit_sample::<f64> {
        theta_i: 0.5,
        theta_s: 0.4,
        delta_phi: BRDFIT_PI as f64,
        brdf: 1.0,
        weight: 1.0,
    };
    let nan = f64::NAN;
    let infinite = f64::INFINITY;
    let bad = [
        (brdfit_sample { theta_i: nan, ..good }, Error::NotFinite),
        (brdfit_sample { theta_s: nan, ..good }, Error::NotFinite),
        (
            brdfit_sample {
                delta_phi: infinite,
                ..good
            },
            Error::NotFinite,
        ),
        (brdfit_sample { brdf: nan, ..good }, Error::NotFinite),
        (brdfit_sample { weight: nan, ..good }, Error::NotFinite),
        (brdfit_sample { theta_i: -0.1, ..good }, Error::BeyondHorizon),
        (brdfit_sample { theta_s: 1.6, ..good }, Error::BeyondHorizon),
        (brdfit_sample { brdf: 0.0, ..good }, Error::NotPositive),
        (brdfit_sample { brdf: -1.0, ..good }, Error::NotPositive),
        (brdfit_sample { weight: 0.0, ..good }, Error::NotPositive),
        (brdfit_sample { weight: -1.0, ..good }, Error::NotPositive),
    ];
    // SAFETY: as above; what is not so is null, misaligned, or said to be of impossible length.
    unsafe {
        let (mut scan, mut not_begun): (brdfit_scan<f64>, brdfit_scan<f64>) = (zeroed(), zeroed());
        let mut blocks: [brdfit_block<f64>; 2] = zeroed();
        let memory = blocks.as_mut_ptr();
        assert_eq!(brdfit_scan_init_f64(null_mut(), memory, 1), Error::Null);
        assert_eq!(brdfit_scan_init_f64(&mut scan, null_mut(), 1), Error::Null);
        assert_eq!(brdfit_scan_init_f64(&mut scan, memory, 0), Error::Length);
        assert_eq!(brdfit_scan_init_f64(&mut scan, memory, usize::MAX), Error::Length);
        let shifted = memory.byte_add(16);
        assert_eq!(brdfit_scan_init_f64(&mut scan, shifted, 1), Error::Misaligned);
        assert_eq!(scan.capacity, 0);
        assert_eq!(brdfit_scan_init_f64(&mut scan, memory, 1), Error::None);

        assert_eq!(brdfit_scan_add_f64(null_mut(), &good, 1), Error::Null);
        assert_eq!(brdfit_scan_add_f64(&mut not_begun, &good, 1), Error::NotBegun);
        assert_eq!(brdfit_scan_add_f64(&mut scan, null(), 1), Error::Null);
        assert_eq!(brdfit_scan_add_f64(&mut scan, &good, 0), Error::Length);
        assert_eq!(brdfit_scan_add_f64(&mut scan, &good, usize::MAX), Error::Length);
        for (sample, error) in bad {
            let two = [good, sample];
            let before = scan.samples;
            assert_eq!(brdfit_scan_add_f64(&mut scan, two.as_ptr(), 2), error, "{sample:?}");
            assert_eq!(scan.samples, before + 1);
        }
        let many = [good; 16];
        assert_eq!(brdfit_scan_add_f64(&mut scan, many.as_ptr(), 16), Error::Full);
        assert_eq!(scan.samples, 16);
    }
}

#[test]
fn mistakes_with_fits_are_errors() {
    let memory = with_samples();
    let scan = &memory.scan;
    let start = brdfit_params::<f64>::from(Params::from_array([0.1, 1.0, 0.01, 0.2, 1.5, 0.5]));
    // SAFETY: as above.
    unsafe {
        let (mut fit, mut result): (brdfit_fit<f64>, brdfit_result<f64>) = (zeroed(), zeroed());
        let none = zeroed();
        let few = brdfit_scan { samples: 5, ..*scan };
        let wrong = brdfit_scan { samples: 500, ..*scan };
        assert_eq!(brdfit_fit_begin_f64(null_mut(), scan, &start, null()), Error::Null);
        assert_eq!(brdfit_fit_begin_f64(&mut fit, null(), &start, null()), Error::Null);
        assert_eq!(brdfit_fit_begin_f64(&mut fit, scan, null(), null()), Error::Null);
        assert_eq!(brdfit_fit_begin_f64(&mut fit, &none, &start, null()), Error::NotBegun);
        assert_eq!(brdfit_fit_begin_f64(&mut fit, &wrong, &start, null()), Error::NotBegun);
        assert_eq!(brdfit_fit_begin_f64(&mut fit, &few, &start, null()), Error::TooFew);
        let bad = brdfit_params { m: f64::NAN, ..start };
        assert_eq!(brdfit_fit_begin_f64(&mut fit, scan, &bad, null()), Error::NotFinite);
        // None of these began it.
        assert_eq!(brdfit_fit_run_f64(&mut fit, scan, 1), Error::NotBegun);
        assert_eq!(brdfit_fit_result_f64(&fit, &mut result), Error::NotBegun);
        assert_eq!(brdfit_fit_begin_f64(&mut fit, scan, &start, null()), Error::None);
        assert_eq!(brdfit_fit_run_f64(null_mut(), scan, 1), Error::Null);
        assert_eq!(brdfit_fit_run_f64(&mut fit, null(), 1), Error::Null);
        assert_eq!(brdfit_fit_run_f64(&mut fit, &few, 1), Error::TooFew);
        assert_eq!(brdfit_fit_result_f64(null(), &mut result), Error::Null);
        assert_eq!(brdfit_fit_result_f64(&fit, null_mut()), Error::Null);

        let (mut found, mut x, mut value): (brdfit_found<f64>, _, _) = (zeroed(), start, 0.0);
        assert_eq!(
            brdfit_search_f64(null(), null(), null_mut(), 0, &mut found),
            Error::Null
        );
        assert_eq!(brdfit_search_f64(scan, null(), null_mut(), 1, &mut found), Error::Null);
        assert_eq!(brdfit_search_f64(scan, null(), null_mut(), 0, null_mut()), Error::Null);
        assert_eq!(
            brdfit_search_f64(&few, null(), null_mut(), 0, &mut found),
            Error::TooFew
        );
        assert_eq!(brdfit_candidate_f64(null(), null(), 0, &mut x), Error::Null);
        assert_eq!(brdfit_candidate_f64(scan, null(), 0, null_mut()), Error::Null);
        assert_eq!(brdfit_candidate_f64(&few, null(), 0, &mut x), Error::TooFew);

        assert_eq!(brdfit_brdf_f64(0.1, 0.1, 0.0, null(), &mut value), Error::Null);
        assert_eq!(brdfit_brdf_f64(0.1, 0.1, 0.0, &start, null_mut()), Error::Null);
        assert_eq!(
            brdfit_brdf_f64(f64::NAN, 0.1, 0.0, &start, &mut value),
            Error::NotFinite
        );
        assert_eq!(brdfit_brdf_f64(1.6, 0.1, 0.0, &start, &mut value), Error::BeyondHorizon);
        assert_eq!(brdfit_brdf_f64(0.1, 0.1, 0.0, &bad, &mut value), Error::NotFinite);
        let bad = brdfit_params { n: 0.5, ..start };
        assert_eq!(brdfit_brdf_f64(0.1, 0.1, 0.0, &bad, &mut value), Error::Params);
        assert_eq!(
            brdfit_model_brdf_f64(2, 0.1, 0.1, 0.0, &start, &mut value),
            Error::Terms
        );
        assert_eq!(brdfit_options_init_f64(null_mut()), Error::Null);
    }
}

#[test]
fn mistakes_with_options_are_errors() {
    let memory = with_samples();
    let wrong = |change: &dyn Fn(&mut brdfit_options<f64>)| {
        let mut options = usual();
        change(&mut options);
        // SAFETY: as above.
        unsafe {
            let mut found = zeroed();
            brdfit_search_f64(&memory.scan, &options, null_mut(), 0, &mut found)
        }
    };
    assert_eq!(wrong(&|options| options.lower.m = f64::NAN), Error::Bounds);
    assert_eq!(wrong(&|options| options.lower.rho_d = 2.0), Error::Bounds);
    assert_eq!(wrong(&|options| options.lower.n = 0.5), Error::Bounds);
    assert_eq!(wrong(&|options| options.upper.kappa = f64::INFINITY), Error::Bounds);
    assert_eq!(wrong(&|options| options.terms = BRDFIT_VOLUME), Error::Terms);
    assert_eq!(wrong(&|options| options.terms = 0), Error::Terms);
    assert_eq!(wrong(&|options| options.terms = 16), Error::Terms);
    assert_eq!(wrong(&|options| options.model = 2), Error::Terms);
    assert_eq!(
        wrong(&|options| (options.model, options.terms) = (BRDFIT_MODEL_GGX, BRDFIT_DIFFUSE)),
        Error::Terms
    );
    assert_eq!(wrong(&|options| options.candidates = 0), Error::Options);
    assert_eq!(wrong(&|options| options.max_passes = 0), Error::Options);
    assert_eq!(wrong(&|options| options.cost_tolerance = f64::NAN), Error::Options);
    assert_eq!(wrong(&|options| options.step_tolerance = -1.0), Error::Options);
    assert_eq!(wrong(&|options| options.damping = 0.0), Error::Options);
}

#[test]
fn a_search_in_steps_gives_the_bits_of_one_at_once() {
    let memory = with_samples();
    for (model, terms) in [
        (BRDFIT_MODEL_BECKMANN, BRDFIT_ALL),
        (BRDFIT_MODEL_BECKMANN, BRDFIT_DIFFUSE | BRDFIT_SURFACE),
        (BRDFIT_MODEL_GGX, BRDFIT_ALL),
    ] {
        let options = brdfit_options {
            model,
            terms,
            ..usual()
        };
        // SAFETY: as above.
        unsafe {
            let (mut whole, mut found): (brdfit_found<f64>, brdfit_found<f64>) = (zeroed(), zeroed());
            let (mut minima, mut others): ([brdfit_minimum<f64>; 32], [brdfit_minimum<f64>; 32]) = (zeroed(), zeroed());
            let done = brdfit_search_f64(&memory.scan, &options, minima.as_mut_ptr(), 32, &mut whole);
            assert_eq!(done, Error::None);
            let mut state: brdfit_search_state<f64> = zeroed();
            let mut flash = [0; BRDFIT_SAVED_SIZE];
            let (mut ended, mut length, mut steps) = (7, 0, 0);
            assert_eq!(brdfit_search_begin_f64(&mut state, &options), Error::None);
            while ended != 1 {
                let done = brdfit_search_step_f64(&mut state, &memory.scan, 1 + steps % 3, &mut ended);
                assert_eq!(done, Error::None);
                steps += 1;
                if steps % 16 == 0 {
                    let room = flash.len();
                    let done = brdfit_search_save_f64(&mut state, flash.as_mut_ptr(), room, &mut length);
                    assert_eq!(done, Error::None);
                    state = zeroed();
                    let done = brdfit_search_restore_f64(&mut state, &options, flash.as_ptr(), length);
                    assert_eq!(done, Error::None);
                }
            }
            let done = brdfit_search_found_f64(&state, others.as_mut_ptr(), 32, &mut found);
            assert_eq!((done, found), (Error::None, whole));
            assert_eq!(minima, others);
        }
    }
}

#[test]
fn an_aborted_search_keeps_what_it_found() {
    let memory = with_samples();
    // SAFETY: as above.
    unsafe {
        let (mut state, mut before, mut after): (_, brdfit_found<f64>, brdfit_found<f64>) =
            (zeroed(), zeroed(), zeroed());
        let mut ended = 0;
        assert_eq!(brdfit_search_abort_f64(&mut state), Error::NotBegun);
        assert_eq!(brdfit_search_begin_f64(&mut state, null()), Error::None);
        let nothing = brdfit_search_found_f64(&state, null_mut(), 0, &mut before);
        assert_eq!(nothing, Error::NoFit);
        let done = brdfit_search_step_f64(&mut state, &memory.scan, 60, &mut ended);
        assert_eq!((done, ended), (Error::None, 0));
        assert_eq!(brdfit_search_found_f64(&state, null_mut(), 0, &mut before), Error::None);
        assert_eq!(brdfit_search_abort_f64(&mut state), Error::None);
        let done = brdfit_search_step_f64(&mut state, &memory.scan, 60, &mut ended);
        assert_eq!((done, ended), (Error::None, 1));
        assert_eq!(brdfit_search_found_f64(&state, null_mut(), 0, &mut after), Error::None);
        assert_eq!(before, after);
    }
}

#[test]
fn a_search_that_was_not_saved_so_is_refused() {
    // SAFETY: as above.
    unsafe {
        let mut state: brdfit_search_state<f64> = zeroed();
        let (mut flash, mut length, mut ended) = ([0; BRDFIT_SAVED_SIZE], 0, 0);
        let bytes = flash.as_mut_ptr();
        assert_eq!(
            brdfit_search_save_f64(&mut state, bytes, 1, &mut length),
            Error::NotBegun
        );
        assert_eq!(brdfit_search_begin_f64(&mut state, null()), Error::None);
        assert_eq!(
            brdfit_search_save_f64(&mut state, bytes, 99, &mut length),
            Error::Length
        );
        let done = brdfit_search_save_f64(&mut state, bytes, BRDFIT_SAVED_SIZE, &mut length);
        assert_eq!(done, Error::None);
        let less = brdfit_options {
            terms: BRDFIT_DIFFUSE,
            ..usual()
        };
        let restored = brdfit_search_restore_f64(&mut state, &less, bytes, length);
        assert_eq!(restored, Error::Saved);
        let memory = with_samples();
        let step = brdfit_search_step_f64(&mut state, &memory.scan, 1, &mut ended);
        assert_eq!(step, Error::NotBegun);
        *bytes.add(length - 1) ^= 1;
        let restored = brdfit_search_restore_f64(&mut state, null(), bytes, length);
        assert_eq!(restored, Error::Saved);
        let restored = brdfit_search_restore_f64(&mut state, null(), bytes, 5);
        assert_eq!(restored, Error::Length);
    }
}

#[test]
fn a_table_of_geometry_gives_the_bits_of_angles() {
    let memory = with_samples();
    let mut blocks = memory.blocks.clone();
    // SAFETY: as above.
    unsafe {
        let (mut scan, mut geometry): (_, brdfit_geometry<f64>) = (zeroed(), zeroed());
        let (mut found, mut known): (brdfit_found<f64>, brdfit_found<f64>) = (zeroed(), zeroed());
        assert_eq!(brdfit_scan_add_at_f64(&mut scan, &geometry, 1.0, 1.0), Error::NotBegun);
        assert_eq!(
            brdfit_scan_init_f64(&mut scan, blocks.as_mut_ptr(), blocks.len()),
            Error::None
        );
        assert_eq!(
            brdfit_scan_add_at_f64(&mut scan, &geometry, 1.0, 1.0),
            Error::BeyondHorizon
        );
        for sample in samples() {
            let (theta_i, theta_s) = (sample.theta_i as f64, sample.theta_s as f64);
            let done = brdfit_geometry_init_f64(theta_i, theta_s, BRDFIT_PI as f64, &mut geometry);
            assert_eq!(done, Error::None);
            assert_eq!(
                brdfit_scan_add_at_f64(&mut scan, &geometry, 0.0, 1.0),
                Error::NotPositive
            );
            let (brdf, weight) = (sample.brdf as f64, sample.weight as f64);
            assert_eq!(brdfit_scan_add_at_f64(&mut scan, &geometry, brdf, weight), Error::None);
        }
        for (scan, found) in [(&memory.scan, &mut found), (&scan, &mut known)] {
            assert_eq!(brdfit_search_f64(scan, null(), null_mut(), 0, found), Error::None);
        }
        assert_eq!(found, known);
    }
}

#[test]
fn standard_errors_are_those_of_the_core() {
    let memory = with_samples();
    let blocks = engine::blocks::<f64>(&samples()).unwrap();
    let scan = Scan::<f64, ALL, 6>::new(&blocks);
    let options = usual();
    let bounds = Scan::<f64, ALL, 6>::bounds(&options.lower.into(), &options.upper.into());
    // SAFETY: as above.
    let (params, known) = unsafe {
        let (mut found, mut known): (brdfit_found<f64>, brdfit_uncertainty<f64>) = (zeroed(), zeroed());
        assert_eq!(
            brdfit_search_f64(&memory.scan, null(), null_mut(), 0, &mut found),
            Error::None
        );
        let params = found.best.params;
        let done = brdfit_uncertainty_at_f64(&memory.scan, null(), &params, &mut known);
        assert_eq!(done, Error::None);
        assert_eq!(
            brdfit_uncertainty_at_f64(&memory.scan, null(), null(), &mut known),
            Error::Null
        );
        (params, known)
    };
    let x = Scan::<f64, ALL, 6>::coordinates(&params.into());
    let expected = Uncertainty::new(&scan.linearize(&x), &x, &bounds, samples().len());
    let axes = expected.held.transformed(&Scan::<f64, ALL, 6>::slopes(&x));
    let errors = Params::from(known.standard_errors).to_array();
    for i in 0..6 {
        assert_eq!(errors[i], axes.standard_error(i));
        // n is on its bound.
        assert!(
            (i == 4) == (errors[i] == 0.0) && (0.0..1.0).contains(&errors[i]),
            "{errors:?}"
        );
        for j in 0..6 {
            assert_eq!(known.correlations[6 * i + j], axes.correlation(i, j));
        }
    }
    assert_eq!(
        (known.scale, known.condition),
        (expected.scale, expected.held.condition)
    );
}
