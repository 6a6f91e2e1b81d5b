//! What was read, for programs.

use serde::Serialize;

use super::{Angle, Inspected};
use crate::analysis::hints::Hint;
use crate::document;
use crate::input::about::Used;
use crate::input::{LeftOut, ReadAs};
use crate::result::json::provenance::{Provenance, provenance};

#[derive(Serialize)]
struct JsonScan<'a> {
    file: &'a str,
    scan: Option<&'a str>,
    input: ReadAs,
    columns: &'a [Used],
    not_used: &'a [String],
    notes: &'a [String],
    samples: usize,
    angles: Vec<JsonAngle>,
    sigma_ln: Option<f64>,
    left_out: &'a [LeftOut],
    hints: &'a [Hint],
    provenance: Provenance<'a>,
}

#[derive(Serialize)]
struct JsonAngle {
    theta_i_deg: f64,
    samples: usize,
    in_plane: usize,
    theta_s_deg: (f64, f64),
    delta_phi_deg: Option<(f64, f64)>,
    brdf_per_sr: (f64, f64),
    brightest_deg: Option<f64>,
}

/// One object for one scan, an array for several.
pub fn json(scans: &[Inspected]) -> String {
    let objects: Vec<JsonScan> = scans.iter().map(scan).collect();
    match objects.as_slice() {
        [one] => document::json(one),
        several => document::json(&several),
    }
}

fn scan<'a>(scan: &'a Inspected) -> JsonScan<'a> {
    let measurement = scan.measurement;
    JsonScan {
        file: &measurement.file,
        scan: measurement.name.as_deref(),
        input: measurement.read_as,
        columns: &measurement.about.columns,
        not_used: &measurement.about.unused,
        notes: &measurement.about.notes,
        samples: measurement.samples.len(),
        angles: scan.angles.iter().map(angle).collect(),
        sigma_ln: measurement.sigma_ln,
        left_out: &measurement.left_out,
        hints: &scan.hints,
        provenance: provenance(&measurement.about, None),
    }
}

fn angle(angle: &Angle) -> JsonAngle {
    JsonAngle {
        theta_i_deg: angle.theta_i,
        samples: angle.samples,
        in_plane: angle.in_plane,
        theta_s_deg: angle.theta_s,
        delta_phi_deg: angle.delta_phi,
        brdf_per_sr: angle.brdf,
        brightest_deg: angle.brightest,
    }
}
