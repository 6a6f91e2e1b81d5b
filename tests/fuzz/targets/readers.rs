//! Any bytes, read as a file of measurements: a scan whose samples are all valid, or one line of error.
//!
//! `BRDFIT_FORMAT` names the reader; without it the content does.
#![no_main]

use std::sync::LazyLock;

use brdfit::input::{self, ReadOptions};
use brdfit::plain::plain;
use libfuzzer_sys::fuzz_target;

static FORMAT: LazyLock<Option<String>> = LazyLock::new(|| std::env::var("BRDFIT_FORMAT").ok());

fuzz_target!(|data: &[u8]| {
    // The first byte chooses options.
    let Some((&choice, file)) = data.split_first() else {
        return;
    };
    let options = ReadOptions {
        input_format: FORMAT.clone(),
        drop_invalid: choice & 1 != 0,
        mask_retro: (choice & 2 != 0).then_some(6.0),
        merl_whole: choice & 4 != 0,
        sigma_floor: if choice & 8 != 0 { 0.01 } else { 0.0 },
        ..ReadOptions::default()
    };
    match input::parse("file", file, &options) {
        Err(error) => {
            let shown = error.to_string();
            assert_eq!(plain(&shown), shown, "more than a line");
            assert!(shown.len() < 4000, "{} bytes of error", shown.len());
        }
        Ok(scans) => {
            for scan in scans {
                assert!(!scan.samples.is_empty() && scan.samples.len() == scan.lines.len());
                let mut squares = 0.0;
                for sample in &scan.samples {
                    assert!(sample.brdf.is_normal() && sample.brdf > 0.0, "{sample:?}");
                    assert!(sample.weight.is_finite() && sample.weight >= 0.0, "{sample:?}");
                    assert!(
                        (0.0..std::f64::consts::FRAC_PI_2).contains(&sample.theta_i),
                        "{sample:?}"
                    );
                    assert!(sample.theta_s.abs() < std::f64::consts::FRAC_PI_2, "{sample:?}");
                    assert!(sample.delta_phi.is_finite(), "{sample:?}");
                    squares += sample.weight * sample.weight;
                }
                let mean = squares / scan.samples.len() as f64;
                assert!((mean - 1.0).abs() < 1e-9, "the mean of the squared weights is {mean}");
            }
        }
    }
});
