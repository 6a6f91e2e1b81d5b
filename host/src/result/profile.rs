//! Profiles as text, JSON and SVG.

mod json;
mod text;

use crate::analysis::profile::calibrate::LEVELS;
use crate::analysis::profile::findings::Findings;
use crate::analysis::profile::{End, Profile};
use crate::plot;
pub use json::json;
pub use text::text;

/// One panel a profile.
pub fn svg(findings: &Findings) -> String {
    let panels: Vec<_> = findings.profiles.iter().map(panel).collect();
    plot::profile_svg(&findings.name, &panels)
}

/// A profile as it is drawn.
fn panel(profile: &Profile) -> plot::ProfilePanel {
    let end = |end: End| (!end.at_bound).then_some(end.value);
    plot::ProfilePanel {
        name: profile.name,
        best: profile.best.value,
        points: profile
            .points
            .iter()
            .map(|point| (point.value, profile.rise(point)))
            .collect(),
        levels: [0, 1].map(|k| (LEVELS[k], profile.limits[k])),
        ends: profile
            .intervals
            .map(|interval| [end(interval.low), end(interval.high)]),
    }
}
