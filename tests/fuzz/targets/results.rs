//! Any bytes, read as results of earlier fits, for a report and for an export.
#![no_main]

use brdfit::export::{bird, constants, glsl, mitsuba, model::Model};
use brdfit::page::results;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    if let Some(fitted) = results::parse(data) {
        for one in fitted {
            assert!(one.params.is_ok() || one.params.is_err_and(|why| why.len() <= data.len() * 4));
        }
    }
    for index in [None, Some(1), Some(usize::MAX)] {
        let Ok(model) = Model::of_json(data, index) else { continue };
        assert!(model.params.to_array().iter().all(|value| value.is_finite()));
        for text in [
            glsl::write(&model),
            mitsuba::write(&model),
            constants::c(&model),
            constants::rust(&model),
            bird::write(&model),
        ] {
            assert!(!text.contains(|c: char| c != '\n' && c.is_control()), "{text:?}");
        }
    }
});
