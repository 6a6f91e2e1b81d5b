//! What is refused.

use super::*;

#[test]
fn mistakes_with_samples_are_errors() {
    let good = brdfit_sample::<f32> {
        theta_i: 0.5,
        theta_s: 0.4,
        delta_phi: BRDFIT_PI as f32,
        brdf: 1.0,
        weight: 1.0,
    };
    let nan = f32::NAN;
    let infinite = f32::INFINITY;
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
        let (mut scan, mut not_begun): (brdfit_scan<f32>, brdfit_scan<f32>) = (zeroed(), zeroed());
        let mut blocks: [brdfit_block<f32>; 2] = zeroed();
        let memory = blocks.as_mut_ptr();
        assert_eq!(brdfit_scan_init_f32(null_mut(), memory, 1), Error::Null);
        assert_eq!(brdfit_scan_init_f32(&mut scan, null_mut(), 1), Error::Null);
        assert_eq!(brdfit_scan_init_f32(&mut scan, memory, 0), Error::Length);
        assert_eq!(brdfit_scan_init_f32(&mut scan, memory, usize::MAX), Error::Length);
        let shifted = memory.byte_add(16);
        assert_eq!(brdfit_scan_init_f32(&mut scan, shifted, 1), Error::Misaligned);
        assert_eq!(scan.capacity, 0);
        assert_eq!(brdfit_scan_init_f32(&mut scan, memory, 1), Error::None);

        assert_eq!(brdfit_scan_add_f32(null_mut(), &good, 1), Error::Null);
        assert_eq!(brdfit_scan_add_f32(&mut not_begun, &good, 1), Error::NotBegun);
        assert_eq!(brdfit_scan_add_f32(&mut scan, null(), 1), Error::Null);
        assert_eq!(brdfit_scan_add_f32(&mut scan, &good, 0), Error::Length);
        assert_eq!(brdfit_scan_add_f32(&mut scan, &good, usize::MAX), Error::Length);
        for (sample, error) in bad {
            let two = [good, sample];
            let before = scan.samples;
            assert_eq!(brdfit_scan_add_f32(&mut scan, two.as_ptr(), 2), error, "{sample:?}");
            assert_eq!(scan.samples, before + 1);
        }
        let many = [good; 16];
        assert_eq!(brdfit_scan_add_f32(&mut scan, many.as_ptr(), 16), Error::Full);
        assert_eq!(scan.samples, 16);
    }
}

#[test]
fn mistakes_with_fits_are_errors() {
    let memory = with_samples();
    let scan = &memory.scan;
    let start = brdfit_params::<f32>::from(Params::from_array([0.1, 1.0, 0.01, 0.2, 1.5, 0.5]));
    // SAFETY: as above.
    unsafe {
        let (mut fit, mut result): (brdfit_fit<f32>, brdfit_result<f32>) = (zeroed(), zeroed());
        let none = zeroed();
        let few = brdfit_scan { samples: 5, ..*scan };
        let wrong = brdfit_scan { samples: 500, ..*scan };
        assert_eq!(brdfit_fit_begin_f32(null_mut(), scan, &start, null()), Error::Null);
        assert_eq!(brdfit_fit_begin_f32(&mut fit, null(), &start, null()), Error::Null);
        assert_eq!(brdfit_fit_begin_f32(&mut fit, scan, null(), null()), Error::Null);
        assert_eq!(brdfit_fit_begin_f32(&mut fit, &none, &start, null()), Error::NotBegun);
        assert_eq!(brdfit_fit_begin_f32(&mut fit, &wrong, &start, null()), Error::NotBegun);
        assert_eq!(brdfit_fit_begin_f32(&mut fit, &few, &start, null()), Error::TooFew);
        let bad = brdfit_params { m: f32::NAN, ..start };
        assert_eq!(brdfit_fit_begin_f32(&mut fit, scan, &bad, null()), Error::NotFinite);
        // None of these began it.
        assert_eq!(brdfit_fit_run_f32(&mut fit, scan, 1), Error::NotBegun);
        assert_eq!(brdfit_fit_result_f32(&fit, &mut result), Error::NotBegun);
        assert_eq!(brdfit_fit_begin_f32(&mut fit, scan, &start, null()), Error::None);
        assert_eq!(brdfit_fit_run_f32(null_mut(), scan, 1), Error::Null);
        assert_eq!(brdfit_fit_run_f32(&mut fit, null(), 1), Error::Null);
        assert_eq!(brdfit_fit_run_f32(&mut fit, &few, 1), Error::TooFew);
        assert_eq!(brdfit_fit_result_f32(null(), &mut result), Error::Null);
        assert_eq!(brdfit_fit_result_f32(&fit, null_mut()), Error::Null);

        let (mut found, mut x, mut value): (brdfit_found<f32>, _, _) = (zeroed(), start, 0.0);
        assert_eq!(
            brdfit_search_f32(null(), null(), null_mut(), 0, &mut found),
            Error::Null
        );
        assert_eq!(brdfit_search_f32(scan, null(), null_mut(), 1, &mut found), Error::Null);
        assert_eq!(brdfit_search_f32(scan, null(), null_mut(), 0, null_mut()), Error::Null);
        assert_eq!(
            brdfit_search_f32(&few, null(), null_mut(), 0, &mut found),
            Error::TooFew
        );
        assert_eq!(brdfit_candidate_f32(null(), null(), 0, &mut x), Error::Null);
        assert_eq!(brdfit_candidate_f32(scan, null(), 0, null_mut()), Error::Null);
        assert_eq!(brdfit_candidate_f32(&few, null(), 0, &mut x), Error::TooFew);

        assert_eq!(brdfit_brdf_f32(0.1, 0.1, 0.0, null(), &mut value), Error::Null);
        assert_eq!(brdfit_brdf_f32(0.1, 0.1, 0.0, &start, null_mut()), Error::Null);
        assert_eq!(
            brdfit_brdf_f32(f32::NAN, 0.1, 0.0, &start, &mut value),
            Error::NotFinite
        );
        assert_eq!(brdfit_brdf_f32(1.6, 0.1, 0.0, &start, &mut value), Error::BeyondHorizon);
        assert_eq!(brdfit_brdf_f32(0.1, 0.1, 0.0, &bad, &mut value), Error::NotFinite);
        let bad = brdfit_params { n: 0.5, ..start };
        assert_eq!(brdfit_brdf_f32(0.1, 0.1, 0.0, &bad, &mut value), Error::Params);
        assert_eq!(
            brdfit_model_brdf_f32(2, 0.1, 0.1, 0.0, &start, &mut value),
            Error::Terms
        );
        assert_eq!(brdfit_options_init_f32(null_mut()), Error::Null);
    }
}

#[test]
fn mistakes_with_options_are_errors() {
    let memory = with_samples();
    let wrong = |change: &dyn Fn(&mut brdfit_options<f32>)| {
        let mut options = usual();
        change(&mut options);
        // SAFETY: as above.
        unsafe {
            let mut found = zeroed();
            brdfit_search_f32(&memory.scan, &options, null_mut(), 0, &mut found)
        }
    };
    assert_eq!(wrong(&|options| options.lower.m = f32::NAN), Error::Bounds);
    assert_eq!(wrong(&|options| options.lower.rho_d = 2.0), Error::Bounds);
    assert_eq!(wrong(&|options| options.lower.n = 0.5), Error::Bounds);
    assert_eq!(wrong(&|options| options.upper.kappa = f32::INFINITY), Error::Bounds);
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
    assert_eq!(wrong(&|options| options.cost_tolerance = f32::NAN), Error::Options);
    assert_eq!(wrong(&|options| options.step_tolerance = -1.0), Error::Options);
    assert_eq!(wrong(&|options| options.damping = 0.0), Error::Options);
}
