#![doc = include_str!("../README.md")]
//! # Map
//! The mathematics is in [`brdfit_core`], the searches are compiled in [`engine`]; this crate reads files, chooses what to run, and writes what was found.
//!
//! Each room may import from those above it, and no file imports in a circle:
//!
//! | Room | What it holds |
//! |---|---|
//! | [`error`], [`plain`], [`document`] | failures, foreign text as it may be shown, JSON and rows of tables |
//! | `streams`, `target`, `output`, `interrupt` | what a command reads and writes, whole-or-nothing files, signals |
//! | [`terms`], [`parameters`], [`names`], [`number`] | words and numbers: terms, parameters and their ranges, methods, digits |
//! | [`input`] | a file becomes one or more [`input::Measurement`]s |
//! | [`analysis`] | a measurement becomes an [`analysis::fit::FittedScan`]; choice of terms, bootstrap, profiles, studies |
//! | [`result`](mod@result) | a fitted scan as text, JSON or CSV |
//! | `records` | fitted files kept one by one: finished fits, parts of a batch |
//! | [`plot`] | figures as SVG, from plain data |
//! | [`page`] | the HTML page on fitted scans |
//! | [`export`] | a fitted model for other programs |
//! | [`until`](mod@until) | until when a thread's searches are wanted |
//! | [`options`], [`instrument`] | the options that several commands have |
//! | `commands` | one file or folder a command |
//! | `cli` | the command line, which strings the commands together |
//!
//! `streams`, `target`, `output`, `interrupt`, `records`, `commands`, `cli` and `plot::picture` are the program's own and come with the feature `cli`, which is on by default; the others read from bytes and write text, and build for WebAssembly too.
//!
//! Every failure is an [`error::Error`]; [`guide`] has one page a task.

pub use brdfit_engine as engine;

pub mod analysis;
#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "cli")]
mod commands;
pub mod document;
pub mod error;
pub mod export;
pub mod guide;
pub mod input;
pub mod instrument;
#[cfg(feature = "cli")]
pub mod interrupt;
pub mod names;
pub mod number;
pub mod options;
#[cfg(feature = "cli")]
pub mod output;
pub mod page;
pub mod parameters;
pub mod plain;
pub mod plot;
#[cfg(feature = "cli")]
pub mod records;
pub mod result;
#[cfg(feature = "cli")]
pub mod streams;
#[cfg(feature = "cli")]
pub mod target;
pub mod terms;
pub mod until;
