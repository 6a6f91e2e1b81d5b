//! What a scan tells about the parameters of its fit, for people and for programs.

pub mod json;
pub mod text;
pub mod words;

pub use brdfit_engine::uncertainty::{Uncertainty, along};
