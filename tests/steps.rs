//! A search in steps: each makes at most one pass, and together they are the search in one call.

use std::cell::Cell;

use brdfit::engine::blocks;
use brdfit_core::brdf::ALL;
use brdfit_core::geometry::{Block, LANES};
use brdfit_core::list::Lent;
use brdfit_core::lm::{Bounds, Fit, Linearization, Options, Problem};
use brdfit_core::minima::Minimum;
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::saved::{self, SavedError};
use brdfit_core::search::{
    CANDIDATES, Candidate, FITS, Phase, Region, Scene, Search, SearchIn, Trial, search, search_from,
};
use brdfit_suite::random_scenes::{KINDS, scene};
use brdfit_suite::tolerance::{self, check};

const P: usize = 6;

fn bounds<R: Real>() -> Bounds<R, P> {
    Scan::<R, ALL, P>::usual_bounds()
}

/// Counts the passes of a scan.
struct Counted<'a, R> {
    scan: Scan<'a, R, ALL, P>,
    passes: Cell<u32>,
}

impl<R: Real> Counted<'_, R> {
    fn count(&self, passes: u32) {
        self.passes.set(self.passes.get() + passes);
    }
}

impl<R: Real> Problem<R, P> for Counted<'_, R> {
    fn cost(&self, x: &[R; P]) -> R {
        self.count(1);
        self.scan.cost(x)
    }
    fn linearize(&self, x: &[R; P]) -> Linearization<R, P> {
        self.count(1);
        self.scan.linearize(x)
    }
    fn bend(&self, x: &[R; P], step: &[R; P], to: [R; P]) -> [R; P] {
        self.scan.bend(x, step, to)
    }
}

impl<R: Real> Scene<R, P> for Counted<'_, R> {
    fn propose(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, region: Region<R, P>) -> Candidate<R, P> {
        self.scan.propose(bounds, seed, i, region)
    }
    fn weigh(&self, bounds: &Bounds<R, P>, candidate: &mut Candidate<R, P>) {
        let before = candidate.passes;
        self.scan.weigh(bounds, candidate);
        self.count(candidate.passes - before);
    }
    fn level(&self, bounds: &Bounds<R, P>, x: &[R; P]) -> ([R; P], R) {
        self.count(1);
        self.scan.level(bounds, x)
    }
    fn apart(&self, x: &[R; P], y: &[R; P], factor: R) -> bool {
        self.scan.apart(x, y, factor)
    }
}

/// Searches scene `k` in steps, resets now and then to what was saved, and compares with one call; how much the cost of the best rose where it is followed by its gradient alone, in epsilons.
fn in_steps<R: Real>(k: u64) -> f64 {
    let blocks = blocks::<R>(&scene(k)).unwrap();
    let counted = Counted {
        scan: Scan::new(&blocks),
        passes: Cell::new(0),
    };
    let (bounds, options) = (bounds::<R>(), Options::default());
    let whole = search(&counted.scan, &bounds, k, CANDIDATES, &options);
    let mut state = Search::<R, P, 4>::new();
    assert!(state.best().is_none());
    state.begin(&bounds, k, CANDIDATES, &options);
    let (mut phase, mut least, mut steps) = (0, R::MAX, 0);
    let mut risen = 0.0f64;
    let mut flash = [0; 8192];
    loop {
        let before = counted.passes.get();
        let goes_on = state.step(&counted);
        let passes = counted.passes.get() - before;
        assert!(passes <= 1, "{passes} passes in a step");
        let progress = state.progress();
        let evaluations = progress.evaluations;
        assert_eq!(evaluations.cost + evaluations.linearize, counted.passes.get());
        let now = [
            Phase::Known,
            Phase::Rounds,
            Phase::Variations,
            Phase::Last,
            Phase::Ended,
        ]
        .iter()
        .position(|&one| one == progress.phase)
        .unwrap();
        assert!(phase <= now);
        phase = now;
        if let Some(best) = state.best() {
            let rise = (best.at.cost.f64() / least.f64() - 1.0) / R::EPSILON.f64();
            assert!(
                rise <= 0.0 || matches!(progress.phase, Phase::Last | Phase::Ended),
                "the best became worse"
            );
            risen = risen.max(rise);
            least = least.min(best.at.cost);
        }
        steps += 1;
        if steps % 50 == 0 {
            let length = saved::save(&mut state, &mut flash).unwrap();
            state = Search::new();
            saved::restore(&mut state, &flash[..length]).unwrap();
        }
        if !goes_on {
            break;
        }
    }
    let best = state.best().unwrap();
    assert_eq!(
        (best.x, best.at, best.stop),
        (whole.best.x, whole.best.at, whole.best.stop)
    );
    assert_eq!(state.progress().evaluations, whole.evaluations);
    assert!(!state.step(&counted) && state.progress().phase == Phase::Ended);
    // A smaller table leaves out the worst.
    let minima = |list: &[brdfit_core::minima::Minimum<R, P>]| {
        let few = list.iter().take(4);
        few.map(|minimum| (minimum.x, minimum.cost)).collect::<Vec<_>>()
    };
    assert_eq!(minima(state.minima().as_slice())[0], minima(whole.minima.as_slice())[0]);
    assert!(state.minima().as_slice().len() <= 4);
    risen
}

#[test]
fn steps_make_one_pass_each_and_end_in_the_bits_of_one_call() {
    let mut worst = 0.0f64;
    for k in 0..2 * KINDS.len() as u64 {
        worst = worst.max(in_steps::<f64>(k)).max(in_steps::<f32>(k));
    }
    check(worst, tolerance::SETTLED_RISE);
}

#[test]
fn known_points_are_offered_one_after_the_other() {
    let blocks = blocks::<f64>(&scene(1)).unwrap();
    let scan = Scan::<f64, ALL, P>::new(&blocks);
    let (bounds, options) = (bounds::<f64>(), Options::default());
    let known = [[0.1, 1.0, 0.01, 0.2, 1.5, 0.5], [0.3, 2.0, 0.5, 0.4, 3.0, 9.0]];
    let whole = search_from(&scan, &bounds, 0, CANDIDATES, &known, &options);
    let mut state = Search::<f64, P>::new();
    state.begin(&bounds, 0, CANDIDATES, &options);
    assert!(state.offer(known[0]));
    assert!(!state.offer(known[1]), "the first is under way");
    while !state.offer(known[1]) {
        assert!(state.step(&scan));
        assert_eq!(state.progress().phase, Phase::Known);
    }
    while state.step(&scan) {}
    assert!(!state.offer(known[0]), "it has ended");
    assert_eq!(state.best().unwrap().x, whole.best.x);
    assert_eq!(state.progress().evaluations, whole.evaluations);
}

#[test]
fn an_aborted_search_keeps_its_best_and_can_begin_anew() {
    let blocks = blocks::<f64>(&scene(2)).unwrap();
    let scan = Scan::<f64, ALL, P>::new(&blocks);
    let (bounds, options) = (bounds::<f64>(), Options::default());
    let mut state = Search::<f64, P>::new();
    state.begin(&bounds, 0, CANDIDATES, &options);
    for _ in 0..100 {
        state.step(&scan);
    }
    let best = state.best().unwrap().at.cost;
    state.abort();
    assert!(!state.step(&scan));
    assert_eq!(state.best().unwrap().at.cost, best);
    state.begin(&bounds, 0, CANDIDATES, &options);
    assert!(state.best().is_none());
    while state.step(&scan) {}
    let whole = search(&scan, &bounds, 0, CANDIDATES, &options);
    assert_eq!(state.best().unwrap().x, whole.best.x);
    assert!(whole.best.at.cost <= best);
}

/// With room for fewer fits a search still finds what most scans have.
#[test]
fn room_for_fewer_fits_is_enough_for_most_scans() {
    let options = Options::default();
    let mut missed = 0;
    for k in 0..2 * KINDS.len() as u64 {
        let blocks = blocks::<f64>(&scene(k)).unwrap();
        let scan = Scan::<f64, ALL, P>::new(&blocks);
        let mut state = Search::<f64, P, 1, { FITS / 4 }>::new();
        state.begin(&bounds(), 0, CANDIDATES, &options);
        while state.step(&scan) {}
        let whole = search(&scan, &bounds(), 0, CANDIDATES, &options);
        let cost = state.best().unwrap().at.cost;
        missed += u32::from(cost > whole.best.at.cost * 1.001);
    }
    assert!(missed <= 2, "{missed} of 10");
}

#[test]
fn a_fit_and_a_scan_are_saved_and_go_on() {
    let blocks = blocks::<f32>(&scene(3)).unwrap();
    let mut flash = vec![0; 1 << 16];
    let mut copy = blocks.clone();
    let length = saved::save(&mut copy[..], &mut flash).unwrap();
    // Eight columns of sixteen numbers each, and the header.
    assert_eq!(length, saved::HEADER + blocks.len() * 8 * LANES * 4);
    let mut restored = vec![Block::<f32>::EMPTY; blocks.len()];
    saved::restore(&mut restored[..], &flash[..length]).unwrap();
    assert_eq!(restored, blocks);
    let scan = Scan::<f32, ALL, P>::new(&restored);
    let (bounds, options) = (bounds::<f32>(), Options::default());
    let mut fit = Fit::begin(&scan, &bounds, [0.1, 1.0, 0.01, 0.2, 1.5, 0.5], &options);
    fit.run(&scan, &bounds, &options, 5);
    let length = saved::save(&mut fit, &mut flash).unwrap();
    let mut later = Fit::begin(&scan, &bounds, bounds.lower, &options);
    saved::restore(&mut later, &flash[..length]).unwrap();
    for fit in [&mut fit, &mut later] {
        fit.run(&scan, &bounds, &options, u32::MAX);
    }
    assert_eq!(
        (fit.x, fit.at, fit.passes, fit.stop),
        (later.x, later.at, later.passes, later.stop)
    );
}

#[test]
fn memory_of_a_length_known_at_run_time_changes_nothing() {
    let (bounds, options) = (bounds::<f64>(), Options::default());
    for k in 0..4 {
        let blocks = blocks::<f64>(&scene(k)).unwrap();
        let scan = Scan::<f64, ALL, P>::new(&blocks);
        let mut whole = Search::<f64, P, 2>::new();
        whole.begin(&bounds, k, CANDIDATES, &options);
        while whole.step(&scan) {}
        // Memory of two searches.
        let mut places = [0, 1].map(|_| (vec![Minimum::EMPTY; 2], vec![Trial::EMPTY; FITS]));
        let [(minima, fits), (other_minima, other_fits)] = &mut places;
        let mut search = SearchIn::over(Lent::new(minima), Lent::new(fits));
        search.begin(&bounds, k, CANDIDATES, &options);
        for _ in 0..150 {
            search.step(&scan);
        }
        // What it is at that moment can go on in arrays too.
        let mut bytes = vec![0; saved::length(&mut search)];
        saved::save(&mut search, &mut bytes).unwrap();
        let mut arrays = Search::<f64, P, 2>::new();
        saved::restore(&mut arrays, &bytes).unwrap();
        let mut slices = SearchIn::over(Lent::new(other_minima), Lent::new(other_fits));
        saved::restore(&mut slices, &bytes).unwrap();
        while search.step(&scan) {}
        while arrays.step(&scan) {}
        while slices.step(&scan) {}
        let end = |best: &Fit<f64, P>| (best.x, best.at, best.passes);
        let expected = end(whole.best().unwrap());
        assert_eq!(end(search.best().unwrap()), expected);
        assert_eq!(end(arrays.best().unwrap()), expected);
        assert_eq!(end(slices.best().unwrap()), expected);
        let list = |minima: &[Minimum<f64, P>]| {
            let all = minima.iter().map(|one| (one.x, one.cost, one.hits, one.first_start));
            all.collect::<Vec<_>>()
        };
        let expected = list(whole.minima().as_slice());
        assert_eq!(list(search.minima().as_slice()), expected);
        assert_eq!(list(slices.minima().as_slice()), expected);
        assert_eq!(search.minima().capacity(), 2);
    }
    // Room for no fit: it ends, without a best.
    let blocks = blocks::<f64>(&scene(0)).unwrap();
    let mut minima = [Minimum::EMPTY; 1];
    let mut search = SearchIn::over(Lent::new(&mut minima), Lent::new(&mut []));
    search.begin(&bounds, 0, 30, &options);
    while search.step(&Scan::<f64, ALL, P>::new(&blocks)) {}
    assert!(search.best().is_none());
}

#[test]
fn what_was_not_saved_so_is_refused() {
    let mut state = Search::<f32, P, 4>::new();
    state.begin(&bounds(), 0, CANDIDATES, &Options::default());
    let length = saved::length(&mut state);
    let mut flash = vec![0xff; length];
    assert_eq!(saved::save(&mut state, &mut flash[1..]), Err(SavedError::Length));
    assert_eq!(saved::restore(&mut state, &flash), Err(SavedError::NotSaved));
    assert_eq!(saved::save(&mut state, &mut flash), Ok(length));
    assert_eq!(
        saved::restore(&mut Search::<f32, P, 5>::new(), &flash),
        Err(SavedError::Other)
    );
    assert_eq!(
        saved::restore(&mut Search::<f32, P, 4, 2>::new(), &flash),
        Err(SavedError::Other)
    );
    assert_eq!(
        saved::restore(&mut Search::<f64, P, 4>::new(), &flash),
        Err(SavedError::Other)
    );
    assert_eq!(
        saved::restore(&mut Search::<f32, 5, 4>::new(), &flash),
        Err(SavedError::Other)
    );
    for cut in [0, 3, saved::HEADER, length - 1] {
        assert_eq!(saved::restore(&mut state, &flash[..cut]), Err(SavedError::Length));
    }
    // Each damaged bit is seen.
    for place in 0..length {
        for bit in 0..8 {
            let mut damaged = flash.clone();
            damaged[place] ^= 1 << bit;
            assert!(
                saved::restore(&mut state, &damaged).is_err(),
                "bit {bit} of byte {place}"
            );
        }
    }
    assert_eq!(saved::restore(&mut state, &flash), Ok(()));
}
