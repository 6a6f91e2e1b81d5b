//! Fits, and standard errors.

use super::*;

#[test]
fn a_fit_in_pieces_gives_the_bits_of_one_at_once() {
    in_pieces_as_at_once::<Beckmann>(BRDFIT_MODEL_BECKMANN);
    in_pieces_as_at_once::<Ggx>(BRDFIT_MODEL_GGX);
}

fn in_pieces_as_at_once<D: Distribution>(model: u32) {
    let memory = with_samples();
    let start = brdfit_params::from(Params::from_array([0.1, 1.0, 0.01, 0.2, 1.5, 0.5]));
    let options = brdfit_options { model, ..usual() };
    let blocks = engine::blocks::<f32>(&samples()).unwrap();
    let scan = Residuals::<f32, Microfacet<ALL, D>, 6>::new(&blocks);
    let bounds = Scan::<f32, ALL, 6>::bounds(&options.lower.into(), &options.upper.into());
    let x = Scan::<f32, ALL, 6>::coordinates(&start.into());
    let expected = lm::fit(&scan, &bounds, x, &Options::default());
    for passes in [1, 7, u32::MAX] {
        // SAFETY: as above.
        let result = unsafe {
            let (mut fit, mut result): (_, brdfit_result<f32>) = (zeroed(), zeroed());
            assert_eq!(
                brdfit_fit_begin_f32(&mut fit, &memory.scan, &start, &options),
                Error::None
            );
            while {
                assert_eq!(brdfit_fit_result_f32(&fit, &mut result), Error::None);
                result.stop == brdfit_stop::None
            } {
                // A copy goes on as the original would.
                let mut copy = fit;
                let before = result.passes;
                assert_eq!(brdfit_fit_run_f32(&mut copy, &memory.scan, passes), Error::None);
                assert_eq!(brdfit_fit_result_f32(&copy, &mut result), Error::None);
                assert!(result.passes <= before.saturating_add(passes));
                fit = copy;
            }
            result
        };
        assert_eq!(Params::from(result.params), Scan::<f32, ALL, 6>::params(&expected.x));
        assert_eq!((result.cost, result.passes), (expected.at.cost, expected.passes));
        assert_eq!(result.stop, expected.stop.into());
    }
}

#[test]
fn standard_errors_are_those_of_the_core() {
    let memory = with_samples();
    let blocks = engine::blocks::<f32>(&samples()).unwrap();
    let scan = Scan::<f32, ALL, 6>::new(&blocks);
    let options = usual();
    let bounds = Scan::<f32, ALL, 6>::bounds(&options.lower.into(), &options.upper.into());
    // SAFETY: as above.
    let (params, known) = unsafe {
        let (mut found, mut known): (brdfit_found<f32>, brdfit_uncertainty<f32>) = (zeroed(), zeroed());
        assert_eq!(
            brdfit_search_f32(&memory.scan, null(), null_mut(), 0, &mut found),
            Error::None
        );
        let params = found.best.params;
        let done = brdfit_uncertainty_at_f32(&memory.scan, null(), &params, &mut known);
        assert_eq!(done, Error::None);
        assert_eq!(
            brdfit_uncertainty_at_f32(&memory.scan, null(), null(), &mut known),
            Error::Null
        );
        (params, known)
    };
    let x = Scan::<f32, ALL, 6>::coordinates(&params.into());
    let expected = Uncertainty::new(&scan.linearize(&x), &x, &bounds, samples().len());
    let axes = expected.held.transformed(&Scan::<f32, ALL, 6>::slopes(&x));
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
