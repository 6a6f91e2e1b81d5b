//! Any bytes, read as results of earlier fits, for a report and for an export.
#![no_main]

use brdfit::export::{bird, constants, glsl, mitsuba, model::Model};
use brdfit::page::results;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    for one in results::parse(data).into_iter().flatten() {
        if let Ok(material) = one.material {
            assert_eq!(material.values.len(), material.model.parameters.len());
        }
    }
    for index in [&[][..], &[1], &[1, usize::MAX]] {
        let models = Model::of_json(data, index).into_iter().flatten();
        for model in models {
            assert!(model.material.values.iter().all(|value| value.is_finite()));
            // Code has forms for some models only.
            let codes = [
                glsl::write(&model),
                mitsuba::write(&model),
                constants::c(&model),
                constants::rust(&model),
            ];
            let texts = codes.into_iter().flatten().chain([bird::write(&model)]);
            for text in texts {
                assert!(!text.contains(|c: char| c != '\n' && c.is_control()), "{text:?}");
            }
        }
    }
});
