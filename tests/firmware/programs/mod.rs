//! The programs. Each writes the same lines on a microcontroller and on the host: `X.out` beside `X.rs` holds them.
//!
//! A number is printed as its bits in hexadecimal, and after `~` to six decimals for the reader.

pub mod budget;
pub mod fit;
pub mod model;
pub mod own;
pub mod scan;
pub mod search;
pub mod small;
pub mod steps;
pub mod stream;
pub mod tabled;

use core::fmt::{self, Write};

use brdfit_core::brdf::{ALL, NAMES, Params, parameters};
use brdfit_core::lm::{Bounds, Fit, Stop};
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;

/// A program.
pub type Program = fn(&mut dyn Write) -> fmt::Result;

/// All of them, by name.
pub const PROGRAMS: [(&str, Program); 9] = [
    ("model", model::run),
    ("fit", fit::run),
    ("search", search::run),
    ("stream", stream::run),
    ("budget", budget::run),
    ("tabled", tabled::run),
    ("steps", steps::run),
    ("own", own::run),
    ("small", small::run),
];

/// Parameters of all terms.
pub const P: usize = parameters(ALL);

/// Table 1 of the paper.
pub fn table_1<R: Real>() -> Bounds<R, P> {
    let of = |array: [f64; 6]| Params::from_array(array.map(R::of));
    Scan::<R, ALL, P>::bounds(
        &of([0.0, 0.0, 0.0, 1e-5, 1.0, 0.0]),
        &of([1.0, 100.0, 100.0, 10.0, 100.0, 100.0]),
    )
}

/// A plain start: a bit of everything, glossy, glass.
pub fn plain_start<R: Real>() -> [R; P] {
    Scan::<R, ALL, P>::coordinates(&Params::from_array([0.1, 1.0, 0.01, 0.2, 1.5, 0.5].map(R::of)))
}

/// `name bits ~decimal`, a line.
pub fn number<R: Real>(out: &mut dyn Write, name: &str, x: R) -> fmt::Result {
    let digits = 2 * size_of::<R>();
    let sign = if x < R::ZERO { "-" } else { "" };
    // Without the formatting of floats, which takes more flash than the fit does.
    let millionths = (x.abs().f64() * 1e6 + 0.5) as u64;
    let (whole, part) = (millionths / 1_000_000, millionths % 1_000_000);
    writeln!(out, "  {name} {:0digits$x} ~{sign}{whole}.{part:06}", x.bits())
}

/// All of a fit.
pub fn report<R: Real>(out: &mut dyn Write, fit: &Fit<R, P>) -> fmt::Result {
    let stop = match fit.stop {
        None => "not ended",
        Some(Stop::Cost) => "cost",
        Some(Stop::Step) => "step",
        Some(Stop::Passes) => "passes",
        Some(Stop::NotFinite) => "not finite",
    };
    writeln!(out, "  passes {} stop {stop}", fit.passes)?;
    point(out, fit.at.cost, &fit.x)
}

/// Cost and parameters.
pub fn point<R: Real>(out: &mut dyn Write, cost: R, x: &[R; P]) -> fmt::Result {
    number(out, "cost", cost)?;
    let params = Scan::<R, ALL, P>::params(x).to_array();
    for (name, value) in NAMES.into_iter().zip(params) {
        number(out, name, value)?;
    }
    Ok(())
}
