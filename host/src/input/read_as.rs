//! What the numbers of a scan were taken for.

use std::fmt;

use serde::Serialize;

use super::format::Format;
use super::units::{Angles, Forward, Quantity};

/// What the numbers of a scan were taken for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReadAs {
    /// The file's format.
    pub format: Format,
    /// The unit of its angles.
    pub angles: Angles,
    /// What its values are.
    pub quantity: Quantity,
    /// The sign of theta_s towards the specular peak.
    pub forward: Forward,
    /// True if the samples have different weights.
    pub weighted: bool,
}

impl fmt::Display for ReadAs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let angles = match self.angles {
            Angles::Deg => "degrees",
            Angles::Rad => "radians",
        };
        let (sign, weights) = (
            match self.forward {
                Forward::Positive => '+',
                Forward::Negative => '-',
            },
            if self.weighted { ", weighted" } else { "" },
        );
        let (format, quantity) = (self.format.title, self.quantity.title());
        write!(
            f,
            "{format}: {quantity} over {angles}, specular peak at theta_s = {sign}theta_i{weights}"
        )
    }
}
