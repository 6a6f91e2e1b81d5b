#![doc = include_str!("../README.md")]
//! # Map
//! Apart from the program that reads files and reports, because it takes most of the time to compile, and seldom changes.
//!
//! [`FitOptions`] and samples go into [`fit`], an [`Outcome`] comes out; what it says does not depend on threads or instructions.

mod averaged;
mod bind;
mod compiled;
mod error;
mod fit;
mod layout;
mod least_squares;
mod material;
mod model;
mod options;
mod outcome;
mod passes;
mod search;

mod values;
mod with_instrument;

pub mod certify;
pub mod clock;
pub mod instrument;
pub mod joint;
pub mod models;
pub mod robust;
pub mod scale;
pub mod simd;
pub mod threads;
pub mod trace;
pub mod uncertainty;
pub mod until;

pub use error::FitError;
pub use fit::{fit, fit_from};
pub use instrument::{Instrument, Limit, Offset, Prior, View};
pub use least_squares::descend;
pub use material::Material;
pub use model::Model;
pub use options::{FitOptions, Method, Precision, TERM_SETS};
pub use outcome::{Minimum, Outcome};
pub use passes::{Both, Kernel, blocks, blocks_of};
pub use until::Until;
pub use values::{MOST, Values};
