//! What is written of a fitted scan: pages for people, JSON and tables for programs.

pub mod beside;
pub mod cell;
pub mod columns;
pub mod compare;
pub mod converge;
mod csv;
pub mod inspect;
pub mod json;
pub mod profile;
pub mod repeats;
pub mod text;
pub mod words;

pub use csv::csv;
pub use json::json;
pub use text::text;
