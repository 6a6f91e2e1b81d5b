//! `brdfit-core` for C and C++: `include/brdfit.h`, which is made from this source.
//!
//! # Map
//!
//! | what | file |
//! |---|---|
//! | types, constants and error codes that C sees, with their sizes | `types.rs` |
//! | pointers of C -> references, or an error | `memory.rs` |
//! | what the functions do, for both number types | `options.rs`, `scan.rs`, `fit.rs`, `search.rs` |
//! | the functions themselves, by name | `names.rs`, `single.rs`, `double.rs` |
//!
//! `build.rs` makes of `single.rs` the same in `f64`, which `double.rs` takes in; a test holds the header to the source.
//!
//! # Panics
//! Nothing here panics; where the core is linked for a target without operating system, a panic that the optimiser could not rule out would stop in an endless loop.
#![no_std]
#![allow(non_camel_case_types)]

#[cfg(not(target_os = "none"))]
extern crate std;

mod double;
mod fit;
mod memory;
mod names;
mod options;
mod scan;
mod search;
mod single;
mod types;

pub use double::*;
pub use names::*;
pub use single::*;
pub use types::*;

type Done = Result<(), brdfit_error>;

#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
