//! A thousand scans of 171 samples on one and on two threads.

use std::time::Duration;

use brdfit::analysis::paper_sets::paper_scans;
use brdfit::engine::{FitOptions, fit};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rayon::prelude::*;

const SCANS: u32 = 1000;

fn batch(criterion: &mut Criterion) {
    let sets = paper_scans();
    let mut group = criterion.benchmark_group("1000 scans");
    group.throughput(Throughput::Elements(u64::from(SCANS)));
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        group.bench_function(BenchmarkId::new("threads", threads), |b| {
            b.iter(|| {
                // The three sets under many seeds: the work of a scan depends on both.
                let one = |k: u32| {
                    let options = FitOptions {
                        seed: u64::from(k),
                        ..FitOptions::default()
                    };
                    let outcome = fit(&sets[k as usize % sets.len()].samples, &options);
                    outcome.expect("the sets are valid").cost
                };
                let costs: Vec<f64> = pool.install(|| (0..SCANS).into_par_iter().map(one).collect());
                costs
            });
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().warm_up_time(Duration::from_millis(100)).measurement_time(Duration::from_secs(8)).sample_size(10);
    targets = batch
}
criterion_main!(benches);
