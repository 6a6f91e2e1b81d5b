//! Shared by the tests.

pub mod scan;
pub mod tolerance;
