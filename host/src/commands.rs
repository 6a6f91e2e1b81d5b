//! The commands of the program: a module with `Arguments` and `run` each.

pub(crate) mod batch;
pub(crate) mod certify;
mod claim;
pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod converge;
pub(crate) mod export;
pub(crate) mod fit;
pub(crate) mod inspect;
pub(crate) mod joint;
pub(crate) mod man;
pub(crate) mod merge;
pub(crate) mod paper;
pub(crate) mod profile;
mod prove;
pub(crate) mod report;
pub(crate) mod simulate;
pub(crate) mod stability;
mod subject;
