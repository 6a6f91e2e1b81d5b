//! A fitted model in the forms of the programs that use it, one file a form.

pub mod abg;
pub mod bird;
pub mod constants;
pub mod form;
pub mod glsl;
pub mod mitsuba;
pub mod model;
pub mod native;
pub mod openmaterial;
pub mod openpbr;
pub mod refit;
pub mod renderers;
pub mod rgl;
pub mod targets;
pub mod zemax;
