//! What is computed beyond a search. Nothing here prints, reads options, or draws.

pub mod bootstrap;
pub mod chance;
pub mod choose;
pub mod converge;
mod copies;
pub mod criteria;
pub mod curved;
pub mod derived;
pub mod deviations;
pub mod fit;
pub mod hints;
pub mod joint;
pub mod misfit;
pub mod paper;
pub mod paper_sets;
pub mod profile;
pub mod proof;
mod quadrature;
pub mod range;
pub mod reflectance;
pub mod repeats;
pub mod stability;
pub mod undetermined;
pub mod unseen;
mod weighed;
