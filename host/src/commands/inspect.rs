//! `brdfit inspect`: what was read of a file, before any fit.

mod json;
mod text;

use std::path::PathBuf;

use brdfit_core::geometry::Sample;
use clap::Args;

use crate::analysis::hints::{self, Hint};
use crate::error::Error;
use crate::input::{self, Measurement, ReadOptions, own, plane};
use crate::output::{self, Format, deliver};
use crate::plot::{self, picture};
use crate::streams::Streams;
use crate::target::Target;

/// Shows what is read of files: columns, units, scans, angles, what is left out, and hints
#[derive(Args, Debug)]
#[command(
    after_help = "Example:\n  brdfit inspect paint.csv --plot paint.svg\n  brdfit inspect scan_20.txt scan_45.txt --columns theta_s=1,brdf=2 --one-scan -o scan.csv"
)]
pub struct Arguments {
    /// Files with scans; - is standard input
    #[arg(required = true, value_name = "SCAN")]
    scans: Vec<PathBuf>,
    /// Form of the summary
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Writes the samples as the program's own table, which reads back to the same bits; with - to standard output, in place of the summary
    #[arg(short, long, visible_alias = "out", value_name = "FILE")]
    output: Option<PathBuf>,
    /// Draws the samples, as SVG or PNG; for one scan
    #[arg(long, value_name = "FILE", value_parser = picture::name)]
    plot: Option<PathBuf>,
    #[command(flatten)]
    read: ReadOptions,
}

/// Runs the subcommand.
///
/// # Errors
/// A file that cannot be read, or an output that cannot be written.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<(), Error> {
    let table = output::target(arguments.output.as_deref(), &arguments.scans)?;
    let picture = arguments.plot.as_deref();
    let picture = picture.map(|path| Target::new(path, &arguments.scans)).transpose()?;
    Target::differ(&table.iter().chain(&picture).collect::<Vec<_>>())?;
    let measurements = input::read(&arguments.scans, &arguments.read, streams.input)?;
    if let (Some(target), [measurement]) = (&picture, &measurements[..]) {
        let drawn = plot::scan_svg(&measurement.label(), &plot::Drawn::of_scan(measurement).data(), &[]);
        picture::save(target, &drawn)?;
    } else if picture.is_some() {
        return Err(Error::new("--plot draws one scan").help("give one scan, or choose one with --column"));
    }
    if arguments.output.is_some() {
        deliver(own::table(&measurements).as_bytes(), table.as_ref(), streams.output)?;
        if table.is_none() {
            return Ok(());
        }
    }
    let scans: Vec<Inspected> = measurements.iter().map(Inspected::new).collect();
    let summary = match arguments.format {
        Format::Text => text::text(&scans),
        Format::Json => json::json(&scans),
    };
    deliver(summary.as_bytes(), None, streams.output)
}

/// What is said of one scan.
struct Inspected<'a> {
    measurement: &'a Measurement,
    angles: Vec<Angle>,
    hints: Vec<Hint>,
}

/// The samples of one angle of incidence; angles in degrees, BRDF in sr^-1.
struct Angle {
    theta_i: f64,
    samples: usize,
    in_plane: usize,
    /// Least and largest scattering angle, signed in plane.
    theta_s: (f64, f64),
    /// Least and largest azimuth, if some samples are out of plane.
    delta_phi: Option<(f64, f64)>,
    brdf: (f64, f64),
    /// Scattering angle of the brightest sample in plane.
    brightest: Option<f64>,
}

impl<'a> Inspected<'a> {
    fn new(measurement: &'a Measurement) -> Self {
        let groups = plane::by_angle(&measurement.samples);
        Inspected {
            measurement,
            angles: groups
                .iter()
                .map(|(theta_i, group)| Angle::new(*theta_i, group))
                .collect(),
            hints: hints::of_scan(measurement),
        }
    }
}

impl Angle {
    fn new(theta_i: f64, group: &[&Sample<f64>]) -> Angle {
        let signed = |sample: &&&Sample<f64>| plane::signed_theta_s(sample);
        let in_plane: Vec<&&Sample<f64>> = group.iter().filter(|sample| signed(sample).is_some()).collect();
        let theta_s = group
            .iter()
            .map(|sample| plane::signed_theta_s(sample).unwrap_or(sample.theta_s.to_degrees()));
        let brightest = in_plane.iter().max_by(|a, b| a.brdf.total_cmp(&b.brdf));
        Angle {
            theta_i: tidy(theta_i.to_degrees()),
            samples: group.len(),
            in_plane: in_plane.len(),
            theta_s: range(theta_s.map(tidy)),
            delta_phi: (in_plane.len() < group.len())
                .then(|| range(group.iter().map(|sample| tidy(sample.delta_phi.to_degrees())))),
            brdf: range(group.iter().map(|sample| sample.brdf)),
            brightest: brightest.and_then(|sample| plane::signed_theta_s(sample)).map(tidy),
        }
    }
}

/// Degrees as they were measured, without what the way through radians adds.
fn tidy(degrees: f64) -> f64 {
    (degrees * 1e9).round() / 1e9
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    })
}
