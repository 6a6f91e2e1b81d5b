//! A whole default search on test data 1: every distinct minimum, and what it took.

use core::fmt::{self, Write};

use brdfit_core::brdf::ALL;
use brdfit_core::lm::Options;
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::search::{CANDIDATES, search};

use super::{P, point, report, scan, table_1};

pub fn run(out: &mut dyn Write) -> fmt::Result {
    writeln!(out, "f64")?;
    whole::<f64>(out)?;
    writeln!(out, "f32")?;
    whole::<f32>(out)
}

fn whole<R: Real>(out: &mut dyn Write) -> fmt::Result {
    let blocks = scan::blocks::<R>();
    let scan = Scan::<R, ALL, P>::new(&blocks);
    let found = search(&scan, &table_1(), 0, CANDIDATES, &Options::default());
    writeln!(
        out,
        " evaluations cost {} linearize {}",
        found.evaluations.cost, found.evaluations.linearize
    )?;
    report(out, &found.best)?;
    for minimum in found.minima.as_slice() {
        writeln!(
            out,
            " minimum hits {} first_start {}",
            minimum.hits, minimum.first_start
        )?;
        point(out, minimum.cost, &minimum.x)?;
    }
    Ok(())
}
