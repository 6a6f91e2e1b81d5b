//! The search in steps, aborted, and saved.

use super::*;

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
            let (mut whole, mut found): (brdfit_found<f32>, brdfit_found<f32>) = (zeroed(), zeroed());
            let (mut minima, mut others): ([brdfit_minimum<f32>; 32], [brdfit_minimum<f32>; 32]) = (zeroed(), zeroed());
            let done = brdfit_search_f32(&memory.scan, &options, minima.as_mut_ptr(), 32, &mut whole);
            assert_eq!(done, Error::None);
            let mut state: brdfit_search_state<f32> = zeroed();
            let mut flash = [0; BRDFIT_SAVED_SIZE];
            let (mut ended, mut length, mut steps) = (7, 0, 0);
            assert_eq!(brdfit_search_begin_f32(&mut state, &options), Error::None);
            while ended != 1 {
                let done = brdfit_search_step_f32(&mut state, &memory.scan, 1 + steps % 3, &mut ended);
                assert_eq!(done, Error::None);
                steps += 1;
                if steps % 16 == 0 {
                    let room = flash.len();
                    let done = brdfit_search_save_f32(&mut state, flash.as_mut_ptr(), room, &mut length);
                    assert_eq!(done, Error::None);
                    state = zeroed();
                    let done = brdfit_search_restore_f32(&mut state, &options, flash.as_ptr(), length);
                    assert_eq!(done, Error::None);
                }
            }
            let done = brdfit_search_found_f32(&state, others.as_mut_ptr(), 32, &mut found);
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
        let (mut state, mut before, mut after): (_, brdfit_found<f32>, brdfit_found<f32>) =
            (zeroed(), zeroed(), zeroed());
        let mut ended = 0;
        assert_eq!(brdfit_search_abort_f32(&mut state), Error::NotBegun);
        assert_eq!(brdfit_search_begin_f32(&mut state, null()), Error::None);
        let nothing = brdfit_search_found_f32(&state, null_mut(), 0, &mut before);
        assert_eq!(nothing, Error::NoFit);
        let done = brdfit_search_step_f32(&mut state, &memory.scan, 60, &mut ended);
        assert_eq!((done, ended), (Error::None, 0));
        assert_eq!(brdfit_search_found_f32(&state, null_mut(), 0, &mut before), Error::None);
        assert_eq!(brdfit_search_abort_f32(&mut state), Error::None);
        let done = brdfit_search_step_f32(&mut state, &memory.scan, 60, &mut ended);
        assert_eq!((done, ended), (Error::None, 1));
        assert_eq!(brdfit_search_found_f32(&state, null_mut(), 0, &mut after), Error::None);
        assert_eq!(before, after);
    }
}

#[test]
fn a_search_that_was_not_saved_so_is_refused() {
    // SAFETY: as above.
    unsafe {
        let mut state: brdfit_search_state<f32> = zeroed();
        let (mut flash, mut length, mut ended) = ([0; BRDFIT_SAVED_SIZE], 0, 0);
        let bytes = flash.as_mut_ptr();
        assert_eq!(
            brdfit_search_save_f32(&mut state, bytes, 1, &mut length),
            Error::NotBegun
        );
        assert_eq!(brdfit_search_begin_f32(&mut state, null()), Error::None);
        assert_eq!(
            brdfit_search_save_f32(&mut state, bytes, 99, &mut length),
            Error::Length
        );
        let done = brdfit_search_save_f32(&mut state, bytes, BRDFIT_SAVED_SIZE, &mut length);
        assert_eq!(done, Error::None);
        let less = brdfit_options {
            terms: BRDFIT_DIFFUSE,
            ..usual()
        };
        let restored = brdfit_search_restore_f32(&mut state, &less, bytes, length);
        assert_eq!(restored, Error::Saved);
        let memory = with_samples();
        let step = brdfit_search_step_f32(&mut state, &memory.scan, 1, &mut ended);
        assert_eq!(step, Error::NotBegun);
        *bytes.add(length - 1) ^= 1;
        let restored = brdfit_search_restore_f32(&mut state, null(), bytes, length);
        assert_eq!(restored, Error::Saved);
        let restored = brdfit_search_restore_f32(&mut state, null(), bytes, 5);
        assert_eq!(restored, Error::Length);
    }
}
