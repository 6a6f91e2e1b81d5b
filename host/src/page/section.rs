//! One scan: its fit, the fits from all starts, and what is drawn of both.

use super::provenance::Source;
use crate::analysis::derived::{self, Value};
use crate::analysis::fit::{FittedScan, fit};
use crate::engine::robust;
use crate::engine::{self, FitOptions, Material, Method, Minimum, Outcome, Values};
use crate::error::Error;
use crate::input::{self, Measurement};
use crate::plot;

/// The albedo is drawn up to this angle of incidence, degrees, in steps of two.
const STEEPEST: u32 = 88;

/// All that the page says of one scan.
pub struct Section {
    /// File and name of the scan.
    pub label: String,
    /// Its file.
    pub source: Source,
    /// The fit, from the best start of the survey where the search had not found it.
    pub report: FittedScan,
    /// What the search itself had found.
    pub searched: Material,
    /// The paper's method on the same samples: distinct minima and where all starts ended.
    pub survey: Outcome,
    /// The number of its starts.
    pub starts: u32,
    /// The figures.
    pub figures: Vec<Figure>,
}

/// A figure.
pub struct Figure {
    /// What its file is called.
    pub name: &'static str,
    /// The picture.
    pub svg: String,
    /// What stands below it.
    pub caption: &'static str,
}

impl Section {
    /// Fits a scan by `options`, and by the paper's method if that is another.
    ///
    /// # Errors
    /// The scan can not be fitted.
    pub fn new(measurement: &Measurement, source: &Source, options: &FitOptions) -> Result<Section, Error> {
        let mut report = fit(measurement, options)?;
        let searched = report.outcome.material();
        let samples = robust::kept(&measurement.samples, &report.outcome);
        let paper = FitOptions {
            method: Method::Paper,
            starts: None,
            robust: false,
            ..report.options
        };
        let (survey, starts) = if report.options.method == Method::Paper {
            (report.outcome.clone(), report.options.starts())
        } else {
            let explain = |error| input::explain(measurement, error);
            let survey = engine::fit(&samples, &paper).map_err(explain)?;
            if survey.cost < report.outcome.cost {
                report = report.improved(measurement, &samples, survey.params).map_err(explain)?;
            }
            (survey, paper.starts())
        };
        Ok(Section {
            label: measurement.label(),
            source: source.clone(),
            figures: figures(
                &plot::Drawn::of_fit(measurement, &report.outcome).data(),
                &report,
                &survey.minima,
                starts,
            ),
            report,
            searched,
            survey,
            starts,
        })
    }

    /// Did a start of the survey end lower than the search, by more than rounding?
    pub fn missed(&self) -> bool {
        self.report
            .improved_from
            .is_some_and(|before| self.report.outcome.cost < before * (1.0 - 1e-6))
    }
}

fn figures(data: &plot::Data, report: &FittedScan, minima: &[Minimum], starts: u32) -> Vec<Figure> {
    let outcome = &report.outcome;
    let other = |minimum: &&Minimum| (minimum.mse2 - outcome.mse2).abs() > 0.01 * outcome.mse2;
    let material = outcome.material();
    let with = |values: Values| Material { values, ..material };
    let others = minima.iter().filter(other).map(|minimum| with(minimum.params));
    let curves: Vec<Material> = std::iter::once(material).chain(others).collect();
    let albedo = |theta_i: f64| derived::at(theta_i, &material, &outcome.uncertainty).reflectance;
    let angles = (0..=STEEPEST).step_by(2).map(f64::from);
    let line: Vec<(f64, Value)> = angles.map(|degrees| (degrees, albedo(degrees.to_radians()))).collect();
    let measured = report
        .derived
        .iter()
        .map(|at| (at.theta_i.to_degrees(), at.reflectance));
    let measured: Vec<(f64, Value)> = measured.collect();
    vec![
        Figure {
            name: "curves",
            svg: plot::scan_svg("", data, &curves),
            caption: "Measured BRDF (dots; grey crosses were left out), best fit (thick) and the other distinct minima (thin) over the scattering angle.",
        },
        Figure {
            name: "residuals",
            svg: plot::residuals_svg(data.samples, &material, outcome.uncertainty.scale),
            caption: "Residuals, ln of the best fit over the measured BRDF, times the weight of the sample. The bands are one and two standard deviations of the residuals.",
        },
        Figure {
            name: "polar",
            svg: plot::polar_svg(data.samples, &material),
            caption: "BRDF in the plane of incidence on a logarithmic radius: measured (crosses), best fit (lines), direction of incidence (dashed).",
        },
        Figure {
            name: "starts",
            svg: plot::waterfall_svg(minima, starts),
            caption: "Fits from uniform starts by the paper's method: left, the final error of each, sorted; right, the least error among the first of them. Each counts with the distinct minimum it ended in, whose error is its own to 1 %.",
        },
        Figure {
            name: "albedo",
            svg: plot::albedo_svg(&line, &measured),
            caption: "Directional-hemispherical reflectance (directional albedo) of the best fit, with one standard error; dots at the measured angles of incidence.",
        },
    ]
}
