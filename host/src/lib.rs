//! Finds the parameters of microfacet BRDF models from scatterometer scans.
//!
//! The mathematics is in [`brdfit_core`], the searches are compiled in [`engine`]; this crate reads files, chooses what to run, and writes what was found.
//!
//! Each room may import from those above it, and no file imports in a circle:
//!
//! | Room | What it holds |
//! |---|---|
//! | [`error`], [`plain`], [`streams`], [`target`], [`output`], [`interrupt`] | failures, foreign text as it may be shown, what a command reads and writes, whole-or-nothing files |
//! | [`terms`], [`parameters`], [`names`], [`number`] | words and numbers: terms, parameters and their ranges, methods, digits |
//! | [`input`] | a file becomes one or more [`input::Measurement`]s |
//! | [`analysis`] | a measurement becomes an [`analysis::fit::FittedScan`]; choice of terms, bootstrap, profiles, studies |
//! | [`result`](mod@result) | a fitted scan as text, JSON or CSV |
//! | [`records`] | fitted files kept one by one: finished fits, parts of a batch |
//! | [`plot`] | figures as SVG, from plain data |
//! | [`page`] | the HTML page on fitted scans |
//! | [`export`] | a fitted model for other programs |
//! | [`options`] | the options that several commands have |
//! | `commands` | one file or folder a command |
//! | [`cli`] | the command line, which strings the commands together |
//!
//! Every failure is an [`error::Error`]; [`guide`] has one page a task.

pub use brdfit_engine as engine;

pub mod analysis;
pub mod cli;
mod commands;
pub mod error;
pub mod export;
pub mod guide;
pub mod input;
pub mod interrupt;
pub mod names;
pub mod number;
pub mod options;
pub mod output;
pub mod page;
pub mod parameters;
pub mod plain;
pub mod plot;
pub mod records;
pub mod result;
pub mod streams;
pub mod target;
pub mod terms;
