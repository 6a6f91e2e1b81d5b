//! One fit of test data 1, from one start to convergence.

use core::fmt::{self, Write};

use brdfit_core::brdf::ALL;
use brdfit_core::lm::{self, Options};
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;

use super::{P, plain_start, report, scan, table_1};

pub fn run(out: &mut dyn Write) -> fmt::Result {
    writeln!(out, "f64")?;
    one::<f64>(out)?;
    writeln!(out, "f32")?;
    one::<f32>(out)
}

fn one<R: Real>(out: &mut dyn Write) -> fmt::Result {
    let blocks = scan::blocks::<R>();
    let scan = Scan::<R, ALL, P>::new(&blocks);
    let fit = lm::fit(&scan, &table_1(), plain_start(), &Options::default());
    report(out, &fit)
}
