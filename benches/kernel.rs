//! One pass over a scan of 171 samples: the sum of squares, the same with derivatives, and a candidate of the search.

use std::hint::black_box;
use std::time::Duration;

use brdfit::analysis::paper_sets::{Subject, paper_scans};
use brdfit::engine::blocks;
use brdfit::engine::simd::{FastEq14, Simd};
use brdfit_core::brdf::{ALL, DIFFUSE, Params, SURFACE};
use brdfit_core::geometry::Sample;
use brdfit_core::lm::Problem;
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::search::{Region, Scene};
use criterion::{Criterion, criterion_group, criterion_main};

fn passes<R: Real, const TERMS: u8, const P: usize>(
    criterion: &mut Criterion,
    name: &str,
    samples: &[Sample<f64>],
    truth: &Params<f64>,
) {
    let blocks = blocks::<R>(samples).expect("the set is valid");
    let real = |params: &Params<f64>| Params::from_array(params.to_array().map(R::of));
    let bounds = Scan::<R, TERMS, P>::usual_bounds();
    let x = Scan::<R, TERMS, P>::coordinates(&real(truth));
    for simd in Simd::available() {
        let scene = FastEq14 {
            scan: Scan::<R, TERMS, P>::new(&blocks),
            simd,
        };
        let mut group = criterion.benchmark_group(format!("{name}/{}", simd.name()));
        group.bench_function("cost", |b| b.iter(|| scene.cost(black_box(&x))));
        group.bench_function("linearize", |b| b.iter(|| scene.linearize(black_box(&x))));
        let mut i = 0;
        group.bench_function("candidate", |b| {
            b.iter(|| {
                i += 1;
                scene.candidate(&bounds, 0, black_box(i), Region::Everywhere)
            });
        });
        group.finish();
    }
}

fn kernel(criterion: &mut Criterion) {
    let Subject { samples, truth, .. } = paper_scans().swap_remove(0);
    let truth = truth.and_then(|material| material.eq_14());
    let truth = truth.expect("the paper's sets are synthetic");
    passes::<f64, ALL, 6>(criterion, "all/f64", &samples, &truth);
    passes::<f32, ALL, 6>(criterion, "all/f32", &samples, &truth);
    passes::<f64, { DIFFUSE | SURFACE }, 4>(criterion, "diffuse+surface/f64", &samples, &truth);
    passes::<f32, { DIFFUSE | SURFACE }, 4>(criterion, "diffuse+surface/f32", &samples, &truth);
}

criterion_group! {
    name = benches;
    config = Criterion::default().warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_millis(600)).sample_size(30);
    targets = kernel
}
criterion_main!(benches);
