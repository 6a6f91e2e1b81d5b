//! A value for each parameter, by name.

use serde::{Serialize, Serializer};

use crate::engine::Model;

/// One value for each parameter of a model, in their order.
pub struct ByName<T>(Vec<(&'static str, T)>);

impl<T> ByName<T> {
    /// The function of each place.
    pub fn new(model: &Model, of: impl Fn(usize) -> T) -> Self {
        let each = model.parameters.iter().enumerate();
        ByName(each.map(|(place, parameter)| (parameter.name, of(place))).collect())
    }
}

impl<T: Serialize> Serialize for ByName<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}
