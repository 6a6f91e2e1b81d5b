//! The search in one call.

use super::*;

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
        precision: Precision::F32,
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
        let done = brdfit_search_f32(&memory.scan, &options, minima.as_mut_ptr(), 32, &mut found);
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
        let done = brdfit_search_f32(&memory.scan, &usual(), minima_of, 1, &mut found);
        assert_eq!((done, found.minima), (Error::None, 1));
        assert_eq!(minima[0].params, found.best.params);
        assert_eq!(minima[1], zeroed());
        // Null options are the usual ones.
        let done = brdfit_search_f32(&memory.scan, null(), null_mut(), 0, &mut without);
        assert_eq!((done, without.minima), (Error::None, 0));
        assert_eq!(without.best, found.best);
    }
}
