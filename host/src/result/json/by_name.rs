//! Values of parameters as an object, in the order of the parameters.

use brdfit_core::brdf::NAMES;
use serde::{Serialize, Serializer};

/// One member a parameter.
pub struct ByName<T>(Vec<(&'static str, T)>);

/// Of values in the order of [`NAMES`].
pub fn by_name<T>(values: [T; 6]) -> ByName<T> {
    ByName(NAMES.into_iter().zip(values).collect())
}

impl<T: Serialize> Serialize for ByName<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}
