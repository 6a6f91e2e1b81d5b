//! A fit and a search that log through defmt: a line for each fit that ends, and one for the search.
#![no_std]
#![no_main]

#[path = "../programs/mod.rs"]
#[allow(dead_code)]
mod programs;

// Each brings what is linked by name alone: the critical section of one core, and the way of the log.
use cortex_m as _;
use defmt_semihosting as _;

use brdfit_core::brdf::ALL;
use brdfit_core::lm::{self, Options};
use brdfit_core::residuals::Scan;
use brdfit_core::search::{CANDIDATES, search};
use cortex_m_rt::entry;
use programs::{P, plain_start, scan, table_1};
use semihosting::process;

#[entry]
fn main() -> ! {
    let blocks = scan::blocks::<f32>();
    let scan = Scan::<f32, ALL, P>::new(&blocks);
    let (bounds, options) = (table_1(), Options::default());
    defmt::info!("one fit");
    let fit = lm::fit(&scan, &bounds, plain_start(), &options);
    defmt::info!("{}", Scan::<f32, ALL, P>::params(&fit.x));
    defmt::info!("a search");
    let found = search(&scan, &bounds, 0, CANDIDATES, &options);
    defmt::info!("{}", Scan::<f32, ALL, P>::params(&found.best.x));
    process::exit(0)
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    process::exit(101)
}
