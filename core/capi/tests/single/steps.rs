//! The search in steps, aborted, and saved.

use super::*;

/// The memory of a search of so many minima and fits.
const fn units(minima: usize, fits: usize) -> usize {
    BRDFIT_SEARCH_BASE + BRDFIT_SEARCH_MINIMUM * minima + BRDFIT_SEARCH_FIT * fits
}

type Memory<const UNITS: usize> = [brdfit_search_state<f32>; UNITS];

/// Begins a search that remembers 4 minima and has 4 fits under way.
unsafe fn begin(memory: &mut Memory<{ units(4, 4) }>, options: *const brdfit_options<f32>) -> Error {
    // SAFETY: the memory is that large.
    unsafe { brdfit_search_begin_f32(memory.as_mut_ptr(), size_of_val(memory), 4, 4, options) }
}

/// The same from what was saved.
unsafe fn restore(
    memory: &mut Memory<{ units(4, 4) }>,
    options: *const brdfit_options<f32>,
    bytes: *const u8,
    length: usize,
) -> Error {
    let size = size_of_val(memory);
    // SAFETY: the memory is that large.
    unsafe { brdfit_search_restore_f32(memory.as_mut_ptr(), size, 4, 4, options, bytes, length) }
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
            let (mut whole, mut found): (brdfit_found<f32>, brdfit_found<f32>) = (zeroed(), zeroed());
            let (mut minima, mut others): ([brdfit_minimum<f32>; 32], [brdfit_minimum<f32>; 32]) = (zeroed(), zeroed());
            let done = brdfit_search_f32(&memory.scan, &options, minima.as_mut_ptr(), 32, &mut whole);
            assert_eq!(done, Error::None);
            let (mut memories, mut place): ([Memory<{ units(32, 4) }>; 2], _) = (zeroed(), 0);
            let size = size_of_val(&memories[0]);
            let mut flash = [0; size_of::<Memory<{ units(32, 4) }>>()];
            let (mut ended, mut length, mut steps) = (7, 0, 0);
            let mut state = memories[0].as_mut_ptr();
            assert_eq!(brdfit_search_begin_f32(state, size, 32, 4, &options), Error::None);
            while ended != 1 {
                let done = brdfit_search_step_f32(state, &memory.scan, 1 + steps % 3, &mut ended);
                assert_eq!(done, Error::None);
                steps += 1;
                if steps % 16 == 0 {
                    let room = flash.len();
                    let done = brdfit_search_save_f32(state, flash.as_mut_ptr(), room, &mut length);
                    assert_eq!(done, Error::None);
                    memories[place] = zeroed();
                    let done = brdfit_search_restore_f32(state, size, 32, 4, &options, flash.as_ptr(), length);
                    assert_eq!(done, Error::None);
                } else if steps % 16 == 8 {
                    // It goes on where it was copied to.
                    memories[1 - place] = memories[place];
                    memories[place] = zeroed();
                    place = 1 - place;
                    state = memories[place].as_mut_ptr();
                }
            }
            let done = brdfit_search_found_f32(state, others.as_mut_ptr(), 32, &mut found);
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
        let (mut states, mut before, mut after): (_, brdfit_found<f32>, brdfit_found<f32>) =
            (zeroed(), zeroed(), zeroed());
        let mut ended = 0;
        assert_eq!(begin(&mut states, null()), Error::None);
        states[0].opaque[0] = 0.0;
        let state = states.as_mut_ptr();
        assert_eq!(brdfit_search_abort_f32(state), Error::NotBegun);
        assert_eq!(begin(&mut states, null()), Error::None);
        let state = states.as_mut_ptr();
        let nothing = brdfit_search_found_f32(state, null_mut(), 0, &mut before);
        assert_eq!(nothing, Error::NoFit);
        let done = brdfit_search_step_f32(state, &memory.scan, 60, &mut ended);
        assert_eq!((done, ended), (Error::None, 0));
        assert_eq!(brdfit_search_found_f32(state, null_mut(), 0, &mut before), Error::None);
        assert_eq!(brdfit_search_abort_f32(state), Error::None);
        let done = brdfit_search_step_f32(state, &memory.scan, 60, &mut ended);
        assert_eq!((done, ended), (Error::None, 1));
        assert_eq!(brdfit_search_found_f32(state, null_mut(), 0, &mut after), Error::None);
        assert_eq!(before, after);
    }
}

#[test]
fn a_search_that_was_not_saved_so_is_refused() {
    // SAFETY: as above.
    unsafe {
        let mut states: Memory<{ units(4, 4) }> = zeroed();
        let (mut flash, mut length, mut ended) = ([0; size_of::<Memory<{ units(4, 4) }>>()], 0, 0);
        let room = flash.len();
        let bytes = flash.as_mut_ptr();
        assert_eq!(
            brdfit_search_save_f32(states.as_mut_ptr(), bytes, 1, &mut length),
            Error::NotBegun
        );
        assert_eq!(begin(&mut states, null()), Error::None);
        assert_eq!(
            brdfit_search_save_f32(states.as_mut_ptr(), bytes, 99, &mut length),
            Error::Length
        );
        let done = brdfit_search_save_f32(states.as_mut_ptr(), bytes, room, &mut length);
        assert_eq!(done, Error::None);
        let less = brdfit_options {
            terms: BRDFIT_DIFFUSE,
            ..usual()
        };
        let restored = restore(&mut states, &less, bytes, length);
        assert_eq!(restored, Error::Saved);
        // Of other capacities.
        let size = size_of_val(&states);
        for (minima, fits) in [(3, 4), (4, 3)] {
            let restored = brdfit_search_restore_f32(states.as_mut_ptr(), size, minima, fits, null(), bytes, length);
            assert_eq!(restored, Error::Saved);
        }
        let memory = with_samples();
        let step = brdfit_search_step_f32(states.as_mut_ptr(), &memory.scan, 1, &mut ended);
        assert_eq!(step, Error::NotBegun);
        *bytes.add(length - 1) ^= 1;
        let restored = restore(&mut states, null(), bytes, length);
        assert_eq!(restored, Error::Saved);
        let restored = restore(&mut states, null(), bytes, 5);
        assert_eq!(restored, Error::Length);
    }
}

#[test]
fn fewer_minima_change_the_table_alone_and_too_little_memory_is_refused() {
    let memory = with_samples();
    // SAFETY: as above.
    unsafe {
        let (mut whole, mut found): (brdfit_found<f32>, brdfit_found<f32>) = (zeroed(), zeroed());
        let mut minima: [brdfit_minimum<f32>; 32] = zeroed();
        let mut fewer: [brdfit_minimum<f32>; 32] = zeroed();
        // Terms with which it meets several minima: one would show nothing.
        let mut options = usual();
        for terms in TERM_SETS {
            options.terms = terms.into();
            let done = brdfit_search_f32(&memory.scan, &options, minima.as_mut_ptr(), 32, &mut whole);
            assert_eq!(done, Error::None);
            if whole.minima > 1 {
                break;
            }
        }
        assert!(whole.minima > 1);
        let mut large: Memory<{ units(32, 5) }> = zeroed();
        for (most, fits) in [(1, 4), (2, 4), (32, 5)] {
            let size = units(most, fits) * size_of::<brdfit_search_state<f32>>();
            // What lies behind is not the search's.
            let used = units(most, fits);
            for state in &mut large[used..] {
                state.opaque = [7.0; 2];
            }
            let state = large.as_mut_ptr();
            let mut ended = 0;
            let small = brdfit_search_begin_f32(state, size - 1, most as u32, fits as u32, &options);
            assert_eq!(small, Error::Small);
            let done = brdfit_search_begin_f32(state, size, most as u32, fits as u32, &options);
            assert_eq!(done, Error::None);
            let done = brdfit_search_step_f32(state, &memory.scan, u32::MAX, &mut ended);
            assert_eq!((done, ended), (Error::None, 1));
            let done = brdfit_search_found_f32(state, fewer.as_mut_ptr(), 32, &mut found);
            let written = whole.minima.min(most);
            assert_eq!((done, found.minima, found.best), (Error::None, written, whole.best));
            assert_eq!(fewer[..written], minima[..written]);
            assert!(large[used..].iter().all(|state| state.opaque == [7.0; 2]));
        }
        let state = large.as_mut_ptr();
        let size = size_of_val(&large);
        for (most, fits) in [(0, 4), (4, 0), (65536, 1), (1, 256)] {
            let done = brdfit_search_begin_f32(state, size, most, fits, null());
            assert_eq!(done, Error::Length);
        }
        let odd = state.cast::<u8>().add(4).cast();
        let done = brdfit_search_begin_f32(odd, size - 4, 4, 4, null());
        assert_eq!(done, Error::Misaligned);
    }
}
