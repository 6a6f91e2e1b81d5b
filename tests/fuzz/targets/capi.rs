//! The C interface with any numbers: every function returns a code, and what it writes is whole.
#![no_main]

use std::mem::MaybeUninit;
use std::ptr;

use brdfit_capi::*;
use libfuzzer_sys::fuzz_target;

/// Numbers of any kind from the bytes, and 0 at their end.
struct Source<'a>(&'a [u8]);

impl Source<'_> {
    fn bytes<const N: usize>(&mut self) -> [u8; N] {
        let (now, rest) = self.0.split_at(N.min(self.0.len()));
        self.0 = rest;
        let mut bytes = [0; N];
        bytes[..now.len()].copy_from_slice(now);
        bytes
    }

    fn byte(&mut self) -> u8 {
        self.bytes::<1>()[0]
    }

    /// Now and then any bits, else a number of the size that belongs here.
    fn number(&mut self, low: f64, high: f64) -> f64 {
        match self.byte() {
            0 => f64::from_bits(u64::from_le_bytes(self.bytes())),
            1 => f64::INFINITY,
            2 => f64::NAN,
            3 => low,
            4 => high,
            _ => low + (high - low) * f64::from(u16::from_le_bytes(self.bytes())) / 65535.0,
        }
    }

    fn params(&mut self) -> brdfit_params<f64> {
        brdfit_params {
            rho_d: self.number(0.0, 1.0),
            rho_s: self.number(0.0, 100.0),
            rho_v: self.number(0.0, 100.0),
            m: self.number(1e-5, 10.0),
            n: self.number(1.0, 100.0),
            kappa: self.number(0.0, 100.0),
        }
    }
}

fn is_within(params: &brdfit_params<f64>, options: &brdfit_options<f64>) -> bool {
    let list = |p: &brdfit_params<f64>| [p.rho_d, p.rho_s, p.rho_v, p.m, p.n, p.kappa];
    let (low, high) = (list(&options.lower), list(&options.upper));
    // kappa goes through its square, and what the terms leave out is 0 or 1.
    let held = |x: f64, k: usize| x >= low[k] * (1.0 - 1e-12) && x <= high[k] * (1.0 + 1e-12) || x == 0.0 || x == 1.0;
    list(params)
        .into_iter()
        .enumerate()
        .all(|(k, x)| held(x, k) || !x.is_finite() && options.terms != BRDFIT_ALL)
}

fuzz_target!(|data: &[u8]| {
    let mut source = Source(data);
    let mut options = MaybeUninit::<brdfit_options<f64>>::uninit();
    // SAFETY: the memory is there and aligned.
    assert_eq!(
        unsafe { brdfit_options_init_f64(options.as_mut_ptr()) },
        brdfit_error::None
    );
    // SAFETY: it was just written.
    let mut options = unsafe { options.assume_init() };
    let changes = source.byte();
    if changes & 1 != 0 {
        options.terms = u32::from(source.byte()) % 17;
    }
    if changes & 32 != 0 {
        options.model = u32::from(source.byte()) % 3;
    }
    if changes & 2 != 0 {
        (options.lower, options.upper) = (source.params(), source.params());
    }
    if changes & 4 != 0 {
        options.cost_tolerance = source.number(0.0, 1.0);
        options.step_tolerance = source.number(0.0, 1.0);
        options.damping = source.number(1e-9, 1e9);
    }
    // Enough for every branch, and few enough for a thousand searches a second.
    options.candidates = u32::from(source.byte() % 3);
    options.max_passes = u32::from(source.byte() % 30);

    let mut blocks: [MaybeUninit<brdfit_block<f64>>; 2] = [const { MaybeUninit::uninit() }; 2];
    let mut scan = MaybeUninit::<brdfit_scan<f64>>::zeroed();
    let scan = scan.as_mut_ptr();
    let mut fit = MaybeUninit::<brdfit_fit<f64>>::zeroed();
    let fit = fit.as_mut_ptr();
    let mut result = MaybeUninit::<brdfit_result<f64>>::zeroed();
    let mut found = MaybeUninit::<brdfit_found<f64>>::zeroed();
    let mut minima = [const { MaybeUninit::<brdfit_minimum<f64>>::zeroed() }; 4];
    // SAFETY: all pointers below are null or to memory of this function of the size that the header asks for.
    unsafe {
        // Nothing was begun yet.
        assert_eq!(brdfit_fit_run_f64(fit, scan, 1), brdfit_error::NotBegun);
        assert_eq!(
            brdfit_search_f64(scan, &options, ptr::null_mut(), 0, found.as_mut_ptr()),
            brdfit_error::NotBegun
        );
        let count = usize::from(changes >> 6);
        if brdfit_scan_init_f64(scan, blocks[0].as_mut_ptr(), count.min(2)) != brdfit_error::None {
            return;
        }
        for _ in 0..usize::from(source.byte() % 40) {
            let sample = brdfit_sample {
                theta_i: source.number(0.0, 1.57),
                theta_s: source.number(-1.57, 1.57),
                delta_phi: source.number(0.0, std::f64::consts::PI),
                brdf: source.number(1e-6, 100.0),
                weight: source.number(0.1, 10.0),
            };
            let _ = brdfit_scan_add_f64(scan, &sample, 1);
        }
        let mut brdf = f64::NAN;
        let params = source.params();
        let at = [
            source.number(0.0, 1.57),
            source.number(-1.57, 1.57),
            source.number(0.0, 3.2),
        ];
        if brdfit_model_brdf_f64(options.model, at[0], at[1], at[2], &params, &mut brdf) == brdfit_error::None {
            assert!(brdf >= f64::MIN_POSITIVE, "{brdf}");
        }
        let mut start = MaybeUninit::zeroed();
        let index = u64::from_le_bytes(source.bytes());
        if brdfit_candidate_f64(scan, &options, index, start.as_mut_ptr()) == brdfit_error::None {
            let begun = brdfit_fit_begin_f64(fit, scan, start.as_ptr(), &options);
            assert!(
                matches!(begun, brdfit_error::None | brdfit_error::NotFinite),
                "{begun:?}"
            );
        }
        if brdfit_fit_begin_f64(fit, scan, &params, &options) == brdfit_error::None {
            let mut cost = f64::INFINITY;
            for _ in 0..3 {
                assert_eq!(brdfit_fit_run_f64(fit, scan, 4), brdfit_error::None);
                assert_eq!(brdfit_fit_result_f64(fit, result.as_mut_ptr()), brdfit_error::None);
                let result = result.assume_init();
                assert!(
                    result.cost <= cost || !result.cost.is_finite(),
                    "{} after {cost}",
                    result.cost
                );
                assert!(is_within(&result.params, &options), "{:?}", result.params);
                cost = result.cost;
            }
        }
        let capacity = usize::from(changes >> 3 & 3);
        let searched = brdfit_search_f64(scan, &options, minima[0].as_mut_ptr(), capacity, found.as_mut_ptr());
        if searched == brdfit_error::None {
            let found = found.assume_init();
            assert!(found.minima <= capacity && found.best.cost.is_finite());
            assert!(is_within(&found.best.params, &options), "{:?}", found.best.params);
        }
    }
});
