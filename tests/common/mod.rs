//! Shared by the tests.
#![allow(
    clippy::disallowed_methods,
    reason = "oracles may use std's functions; the code under test may not"
)]

pub mod claims;
pub mod corners;
pub mod double_double;
pub mod dual;
pub mod hard_scenes;
pub mod interval_oracle;
pub mod literal;
pub mod mgh_problems;
pub mod missed;
pub mod nist_models;
pub mod program;
pub mod random_scenes;
pub mod reference;
pub mod scan;
pub mod tolerance;
pub mod valley;
pub mod written;
