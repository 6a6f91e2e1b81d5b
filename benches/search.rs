//! One fit from a candidate, and one default search, on each of the paper's sets (171 samples).

use std::hint::black_box;
use std::time::Duration;

use brdfit::analysis::paper_sets::{Subject, paper_scans};
use brdfit::engine::simd::{FastEq14, Simd};
use brdfit::engine::{FitOptions, Precision, blocks, fit};
use brdfit_core::brdf::ALL;
use brdfit_core::lm::{self, Options};
use brdfit_core::residuals::Scan;
use brdfit_core::search::{Region, Scene};
use criterion::{Criterion, criterion_group, criterion_main};

fn search(criterion: &mut Criterion) {
    for Subject { name, samples, .. } in paper_scans() {
        let mut group = criterion.benchmark_group(name);
        let limits = FitOptions::default();
        let bounds = Scan::<f64, ALL, 6>::usual_bounds();
        let blocks = blocks::<f64>(&samples).expect("the set is valid");
        let scene = FastEq14 {
            scan: Scan::<f64, ALL, 6>::new(&blocks),
            simd: Simd::best(),
        };
        let start = scene.candidate(&bounds, 0, 0, Region::Everywhere).x;
        let options = Options::default();
        group.bench_function("one LM fit", |b| {
            b.iter(|| lm::fit(&scene, &bounds, black_box(start), &options));
        });
        for (precision, label) in [(Precision::F64, "search f64"), (Precision::F32, "search f32")] {
            let options = FitOptions { precision, ..limits };
            group.bench_function(label, |b| b.iter(|| fit(black_box(&samples), &options)));
        }
        group.finish();
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(1)).sample_size(30);
    targets = search
}
criterion_main!(benches);
