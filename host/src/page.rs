//! The HTML page on fitted scans, with figures, for people and for print.

pub mod budget;
pub mod html;
pub mod provenance;
pub mod results;
pub mod section;
