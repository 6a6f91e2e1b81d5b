//! A fit is stopped by a budget of time and gives the best so far; continued, it ends as if it had never been stopped.

use core::cell::Cell;
use core::fmt::{self, Write};

use brdfit_core::brdf::ALL;
use brdfit_core::lm::{self, Fit, Linearization, Options, Problem};
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;

use super::{P, number, plain_start, report, scan, table_1};

/// A scan with a clock that counts rows: the same on every machine. An instrument reads its cycle counter instead.
struct Timed<'a, R> {
    scan: Scan<'a, R, ALL, P>,
    clock: Cell<u32>,
}

impl<R: Real> Timed<'_, R> {
    fn tick(&self) {
        self.clock.set(self.clock.get() + scan::SAMPLES as u32);
    }
}

impl<R: Real> Problem<R, P> for Timed<'_, R> {
    fn cost(&self, x: &[R; P]) -> R {
        self.tick();
        self.scan.cost(x)
    }
    fn linearize(&self, x: &[R; P]) -> Linearization<R, P> {
        self.tick();
        self.scan.linearize(x)
    }
    // Without it a fit takes about twice the passes.
    fn bend(&self, x: &[R; P], step: &[R; P], to: [R; P]) -> [R; P] {
        self.scan.bend(x, step, to)
    }
}

pub fn run(out: &mut dyn Write) -> fmt::Result {
    writeln!(out, "f64")?;
    stopped::<f64>(out)?;
    writeln!(out, "f32")?;
    stopped::<f32>(out)
}

fn stopped<R: Real>(out: &mut dyn Write) -> fmt::Result {
    let (bounds, options) = (table_1(), Options::default());
    let blocks = scan::blocks::<R>();
    let scan = Timed {
        scan: Scan::new(&blocks),
        clock: Cell::new(0),
    };
    let mut fit = Fit::begin(&scan, &bounds, plain_start(), &options);
    for deadline in [1000, 2000, 3000, 4000] {
        // The clock is read between steps, so a fit ends at most one step after its deadline.
        while fit.stop.is_none() && scan.clock.get() < deadline {
            fit.step(&scan, &bounds, &options);
        }
        writeln!(
            out,
            " deadline {deadline} clock {} passes {}",
            scan.clock.get(),
            fit.passes
        )?;
        number(out, "cost", fit.at.cost)?;
    }
    writeln!(out, " best so far")?;
    report(out, &fit)?;
    fit.run(&scan, &bounds, &options, u32::MAX);
    writeln!(out, " continued")?;
    report(out, &fit)?;
    let whole = lm::fit(&scan, &bounds, plain_start(), &options);
    let same = whole.x == fit.x && whole.at.cost == fit.at.cost && whole.passes == fit.passes;
    writeln!(out, " as without a stop: {}", if same { "yes" } else { "no" })
}
