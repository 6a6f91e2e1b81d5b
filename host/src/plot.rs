//! Figures of plain data as SVG, and these as PNG.

mod albedo;
mod axis;
mod converge;
mod curve;
mod drawn;
mod frame;
mod marks;
mod overlay;
mod panels;
#[cfg(feature = "cli")]
pub mod picture;
mod polar;
mod profile;
mod residuals;
mod scan;
mod svg;
mod waterfall;

pub use albedo::{Albedo, albedo_svg};
pub use converge::{Line as ConvergeLine, Panel as ConvergePanel, converge_svg};
pub use curve::{LnF, of};
pub use drawn::Drawn;
pub use marks::Data;
pub use overlay::{Overlay, overlay_svg};
pub use polar::polar_svg;
pub use profile::{Panel as ProfilePanel, profile_svg};
pub use residuals::residuals_svg;
pub use scan::scan_svg;
pub use waterfall::{Met, waterfall_svg};
