//! The guide: one page a task.
//!
//! The commands are for a clone of the project: where `brdfit` is installed, write it in place of `cargo run --release --`.
//! They run as they stand, and write into the folder `target`.
//!
//! | page | tells |
//! |---|---|
//! | [`reading`] | which files are read, and what their numbers are taken for |
//! | [`models`] | models, terms, bounds, and several scans together |
//! | [`instrument`] | priors, offset, aperture, calibration, energy, outliers, repeats |
//! | [`uncertainty`] | what a scan tells of the parameters |
//! | [`certificates`] | a proof that no parameters fit better |
//! | [`results`] | reports, JSON, the shell, exit codes |
//! | [`batch`] | many scans, on one machine or several |
//! | [`exports`] | the model in other programs |
//! | [`lsqcurvefit`] | the same in the words of MATLAB's lsqcurvefit |
//! | [`firmware`] | the fit in an instrument |
//! | [`determinism`] | the same bits everywhere |
//! | [`accuracy`] | what the fit reaches, and how fast |
//! | [`how_it_works`] | from a sample to the optimum |

#[doc = include_str!("guide/accuracy.md")]
pub mod accuracy {}
#[doc = include_str!("guide/batch.md")]
pub mod batch {}
#[doc = include_str!("guide/certificates.md")]
pub mod certificates {}
#[doc = include_str!("guide/determinism.md")]
pub mod determinism {}
#[doc = include_str!("guide/exports.md")]
pub mod exports {}
#[doc = include_str!("guide/firmware.md")]
pub mod firmware {}
#[doc = include_str!("guide/how_it_works.md")]
pub mod how_it_works {}
#[doc = include_str!("guide/instrument.md")]
pub mod instrument {}
#[doc = include_str!("guide/lsqcurvefit.md")]
pub mod lsqcurvefit {}
#[doc = include_str!("guide/models.md")]
pub mod models {}
#[doc = include_str!("guide/reading.md")]
pub mod reading {}
#[doc = include_str!("guide/results.md")]
pub mod results {}
#[doc = include_str!("guide/uncertainty.md")]
pub mod uncertainty {}
