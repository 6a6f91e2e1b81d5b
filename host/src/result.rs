//! What is written of a fitted scan: pages for people, JSON and tables for programs.

pub mod beside;
pub mod cell;
pub mod columns;
mod csv;
pub mod json;
pub mod text;
pub mod words;

pub use csv::csv;
pub use json::json;
pub use text::text;
