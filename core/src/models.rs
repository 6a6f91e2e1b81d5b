//! Models that are not put together from Eq. 5: of polished and stray-light optics, scatter around the specular direction over |beta - beta_0|, the distance in direction cosines, on Lambert's floor; and of paints.
//!
//! Each is a [`crate::formula::Formula`], so that its derivatives are exact without being written down.

mod abg;
mod beard_maxwell;
mod harvey_shack;
mod k_correlation;

pub use abg::Abg;
pub use beard_maxwell::BeardMaxwell;
pub use harvey_shack::HarveyShack;
pub use k_correlation::{KCorrelation, KCorrelation2};

use crate::model::{Parameter, Role};

/// Lambert's floor.
const FLOOR: Parameter = Parameter::new("rho_d", "ρ_d", Role::Weight, 1.0).what("diffuse reflectance");
