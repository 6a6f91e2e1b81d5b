//! A search in steps: between the samples of an acquisition, under a watchdog; until a deadline; and over a reset.

use core::cell::Cell;
use core::fmt::{self, Write};

use brdfit_core::brdf::ALL;
use brdfit_core::geometry::{Block, LANES, Observation};
use brdfit_core::lm::{Bounds, Linearization, Options, Problem};
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::saved;
use brdfit_core::search::{CANDIDATES, Candidate, Phase, Region, Scene, Search};

use super::{P, point, report, scan, table_1};

/// Rows that a pass goes through, empty ones too.
const PASS: u32 = (scan::BLOCKS * LANES) as u32;
/// The goniometer moves to the next angle for as long as so many rows take.
const MOVE: u32 = 40 * PASS;
/// Room for four minima and three fits.
type State<R> = Search<R, P, 4, 3>;

/// A scan with a clock that counts rows, the same on every machine, and a watchdog. An instrument reads its cycle counter, and its watchdog resets it.
struct Timed<'a, R> {
    scan: Scan<'a, R, ALL, P>,
    clock: Cell<u32>,
    /// When the watchdog was fed, and whether it would have reset.
    fed: Cell<u32>,
    reset: Cell<bool>,
}

impl<'a, R: Real> Timed<'a, R> {
    fn new(blocks: &'a [Block<R>]) -> Self {
        Timed {
            scan: Scan::new(blocks),
            clock: Cell::new(0),
            fed: Cell::new(0),
            reset: Cell::new(false),
        }
    }
    fn feed(&self) {
        self.fed.set(self.clock.get());
    }
    fn pass(&self) {
        self.clock.set(self.clock.get() + PASS);
        if self.clock.get() - self.fed.get() > PASS {
            self.reset.set(true);
        }
    }
}

impl<R: Real> Problem<R, P> for Timed<'_, R> {
    fn cost(&self, x: &[R; P]) -> R {
        self.pass();
        self.scan.cost(x)
    }
    fn linearize(&self, x: &[R; P]) -> Linearization<R, P> {
        self.pass();
        self.scan.linearize(x)
    }
    fn bend(&self, x: &[R; P], step: &[R; P], to: [R; P]) -> [R; P] {
        self.scan.bend(x, step, to)
    }
}

impl<R: Real> Scene<R, P> for Timed<'_, R> {
    fn propose(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, region: Region<R, P>) -> Candidate<R, P> {
        self.scan.propose(bounds, seed, i, region)
    }
    fn weigh(&self, bounds: &Bounds<R, P>, candidate: &mut Candidate<R, P>) {
        self.pass();
        self.scan.weigh(bounds, candidate);
    }
    fn level(&self, bounds: &Bounds<R, P>, x: &[R; P]) -> ([R; P], R) {
        self.pass();
        self.scan.level(bounds, x)
    }
    fn apart(&self, x: &[R; P], y: &[R; P], factor: R) -> bool {
        self.scan.apart(x, y, factor)
    }
}

pub fn run(out: &mut dyn Write) -> fmt::Result {
    writeln!(out, "f64")?;
    all::<f64>(out)?;
    writeln!(out, "f32")?;
    all::<f32>(out)
}

fn all<R: Real>(out: &mut dyn Write) -> fmt::Result {
    let blocks = scan::blocks::<R>();
    let whole = between_samples(out, &blocks)?;
    until_a_deadline(out, &blocks)?;
    over_a_reset(out, &blocks, &whole)
}

fn begun<R: Real>() -> State<R> {
    let mut state = State::new();
    state.begin(&table_1(), 0, CANDIDATES, &Options::default());
    state
}

/// While the next scan arrives sample by sample, the last one is searched; the watchdog allows one pass at a time. The search that has ended.
fn between_samples<R: Real>(out: &mut dyn Write, last: &[Block<R>]) -> Result<State<R>, fmt::Error> {
    let timed = Timed::new(last);
    let mut state = begun::<R>();
    let mut next = [Block::<R>::EMPTY; scan::BLOCKS];
    let mut rows = 0;
    for (row, sample) in scan::samples().enumerate() {
        let arrives = timed.clock.get() + MOVE;
        while timed.clock.get() + PASS <= arrives {
            timed.feed();
            if !state.step(&timed) {
                break;
            }
        }
        if let (Some(block), Ok(observation)) = (next.get_mut(row / LANES), Observation::new(&sample)) {
            block.set(row % LANES, &observation);
            rows += 1;
        }
        if state.progress().phase == Phase::Ended {
            break;
        }
    }
    writeln!(out, " searched between {rows} samples")?;
    writeln!(
        out,
        "  watchdog: {}",
        if timed.reset.get() { "reset" } else { "content" }
    )?;
    best(out, &state)?;
    Ok(state)
}

/// When the time is over, the best so far counts.
fn until_a_deadline<R: Real>(out: &mut dyn Write, blocks: &[Block<R>]) -> fmt::Result {
    let timed = Timed::new(blocks);
    let mut state = begun::<R>();
    for deadline in [20 * PASS, 100 * PASS] {
        while timed.clock.get() < deadline && state.step(&timed) {}
        writeln!(out, " at {} rows, deadline {deadline}", timed.clock.get())?;
        best(out, &state)?;
    }
    state.abort();
    let goes_on = state.step(&timed);
    writeln!(out, "  aborted: {}", if goes_on { "no" } else { "yes" })
}

/// Saved after each twenty steps; after a reset the search goes on from there, and ends as one that was not interrupted.
fn over_a_reset<R: Real>(out: &mut dyn Write, blocks: &[Block<R>], whole: &State<R>) -> fmt::Result {
    let scan = Scan::<R, ALL, P>::new(blocks);
    let mut flash = [0; 6144];
    let mut state = begun::<R>();
    let mut length = 0;
    for step in 0..150 {
        if step % 20 == 0 {
            length = saved::save(&mut state, &mut flash).map_err(|_| fmt::Error)?;
        }
        state.step(&scan);
    }
    // The reset.
    state = State::new();
    let bytes = flash.get(..length).unwrap_or_default();
    saved::restore(&mut state, bytes).map_err(|_| fmt::Error)?;
    while state.step(&scan) {}
    writeln!(out, " resumed from {length} bytes")?;
    let (Some(resumed), Some(whole)) = (state.best(), whole.best()) else {
        return Err(fmt::Error);
    };
    report(out, resumed)?;
    let same = resumed.x == whole.x;
    writeln!(out, "  as without a reset: {}", if same { "yes" } else { "no" })
}

fn best<R: Real>(out: &mut dyn Write, state: &State<R>) -> fmt::Result {
    let progress = state.progress();
    writeln!(
        out,
        "  rounds {} candidates {} passes {} and {}",
        progress.rounds, progress.candidates, progress.evaluations.cost, progress.evaluations.linearize
    )?;
    match state.best() {
        Some(best) => point(out, best.at.cost, &best.x),
        None => writeln!(out, "  nothing yet"),
    }
}
