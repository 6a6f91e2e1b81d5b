//! What a scan had and the fit does not see: why, and how many at which angle of incidence.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::number::shortest;

/// Why a row was left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Reason {
    /// It has no valid value or angle.
    NotValid,
    /// The value is 0 in a file that must fill a grid, and so was not measured.
    NotMeasured,
    /// A direction is at the horizon or below it in a file that must fill a grid.
    Horizon,
    /// It is of transmission.
    Transmission,
    /// It is the reflectance of a mirror, which is no BRDF.
    Mirror,
    /// It is near the direction of incidence.
    Retro,
    /// An angle is beyond the largest that is wanted.
    MaxAngle,
    /// The value is saturated.
    MaxValue,
    /// Its weight is 0.
    NoWeight,
    /// A mask covers it.
    Masked,
    /// It is far from the robust fit.
    Outlier,
}

impl Reason {
    /// What people call it.
    pub fn title(self) -> &'static str {
        match self {
            Reason::NotValid => "not valid",
            Reason::NotMeasured => "0, so not measured",
            Reason::Horizon => "at the horizon or below",
            Reason::Transmission => "of transmission",
            Reason::Mirror => "of a mirror's reflectance",
            Reason::Retro => "near retro",
            Reason::MaxAngle => "beyond the largest angle",
            Reason::MaxValue => "saturated",
            Reason::NoWeight => "of weight 0",
            Reason::Masked => "masked",
            Reason::Outlier => "far from the fit",
        }
    }
}

/// How many rows were left out for one reason, at one angle of incidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LeftOut {
    /// Why.
    pub reason: Reason,
    /// The angle of incidence, degrees; NaN (null in JSON) if the row has none.
    pub theta_i_deg: f64,
    /// How many.
    pub samples: usize,
}

/// Counts them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counts(BTreeMap<(Reason, u64), LeftOut>);

impl Counts {
    /// One more.
    pub fn add(&mut self, reason: Reason, theta_i_deg: f64) {
        self.add_many(reason, theta_i_deg, 1);
    }

    /// So many more.
    pub fn add_many(&mut self, reason: Reason, theta_i_deg: f64, samples: usize) {
        // The bits of numbers that are not negative are in their order.
        let entry = self.0.entry((reason, theta_i_deg.to_bits())).or_insert(LeftOut {
            reason,
            theta_i_deg,
            samples: 0,
        });
        entry.samples += samples;
    }

    /// Those of another part of the same scan.
    pub fn merge(&mut self, others: Counts) {
        for one in others.list() {
            self.add_many(one.reason, one.theta_i_deg, one.samples);
        }
    }

    /// In order of reason and angle.
    pub fn list(self) -> Vec<LeftOut> {
        self.0.into_values().collect()
    }
}

/// One line, such as `52 samples: 52 near retro (13 at theta_i = 10 deg, ...)`; none if nothing was left out.
pub fn summary(list: &[LeftOut]) -> Option<String> {
    const LISTED: usize = 8;
    let total = |list: &[LeftOut]| list.iter().map(|one| one.samples).sum::<usize>();
    if list.is_empty() {
        return None;
    }
    let reasons = list.chunk_by(|a, b| a.reason == b.reason).map(|group| {
        let angle = |one: &LeftOut| format!("{} at {}", one.samples, shortest((one.theta_i_deg * 1e4).round() / 1e4));
        let mut angles: Vec<String> = group.iter().take(LISTED).map(angle).collect();
        if group.len() > LISTED {
            angles.push("...".to_string());
        }
        format!(
            "{} {} ({} deg)",
            total(group),
            group[0].reason.title(),
            angles.join(", ")
        )
    });
    let reasons: Vec<String> = reasons.collect();
    let samples = if total(list) == 1 { "sample" } else { "samples" };
    Some(format!("{} {samples}: {}", total(list), reasons.join("; ")))
}
