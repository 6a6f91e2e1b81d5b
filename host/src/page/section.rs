//! One scan: its fit, the fits from all starts, and what is drawn of both.

use crate::analysis::choose::Wanted;
use crate::analysis::derived::{self, Derived};
use crate::analysis::fit::{FittedScan, fit, prove};
use crate::analysis::proof::Goal;
use crate::engine::robust;
use crate::engine::{self, FitOptions, Material, Method, Minimum, Outcome, Values, View};
use crate::error::Error;
use crate::input::{self, Measurement};
use crate::plot::{self, Albedo, Met};

/// The albedo is drawn up to this angle of incidence, degrees, in steps of two.
const STEEPEST: u32 = 88;

/// All that the page says of one scan.
pub struct Section {
    /// File and name of the scan.
    pub label: String,
    /// The fit, from the best start of the survey where the search had not found it.
    pub fit: FittedScan,
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
    /// The table that shows the same in numbers.
    pub table: Option<Table>,
}

/// A table beside a figure.
pub enum Table {
    /// The distinct minima.
    Minima,
    /// What is derived at each angle of incidence.
    Angles,
}

impl Section {
    /// Fits a scan with what is wanted, and by the paper's method if that is another; then a `goal` is proved.
    ///
    /// # Errors
    /// The scan cannot be fitted, or the model has no proof.
    pub fn new(measurement: &Measurement, wanted: &Wanted, goal: Option<&Goal>) -> Result<Section, Error> {
        let mut fit = fit(measurement, wanted)?;
        let searched = fit.outcome.material();
        let samples = robust::kept(&measurement.samples, &fit.outcome);
        let paper = FitOptions {
            method: Method::Paper,
            starts: None,
            ..fit.options.settled(&fit.outcome)
        };
        let (survey, starts) = if fit.options.method == Method::Paper {
            (fit.outcome.clone(), fit.options.starts())
        } else {
            let explain = |error| input::explain(measurement, error);
            let survey = engine::fit(&samples, &paper).map_err(explain)?;
            if survey.cost < fit.outcome.cost {
                fit = fit.improved(measurement, &samples, survey.params).map_err(explain)?;
            }
            (survey, paper.starts())
        };
        if let Some(goal) = goal {
            fit = prove(measurement, fit, goal)?;
        }
        Ok(Section {
            label: measurement.label(),
            figures: figures(
                &plot::Drawn::of_fit(measurement, &fit.outcome).data(),
                &fit,
                &survey.minima,
                starts,
            ),
            fit,
            searched,
            survey,
            starts,
        })
    }

    /// Did a start of the survey, or the proof, end lower than the search, by more than rounding?
    pub fn missed(&self) -> bool {
        self.fit
            .improved_from
            .is_some_and(|before| self.fit.outcome.cost < before * (1.0 - 1e-6))
    }
}

fn figures(data: &plot::Data, fit: &FittedScan, minima: &[Minimum], starts: u32) -> Vec<Figure> {
    let outcome = &fit.outcome;
    let other = |minimum: &&Minimum| (minimum.mse2 - outcome.mse2).abs() > 0.01 * outcome.mse2;
    let material = outcome.material();
    // The samples that are drawn stand where they are.
    let seen = View {
        offset: 0.0,
        ..outcome.view()
    };
    let with = |values: Values| Material { values, ..material };
    let others = minima.iter().filter(other).map(|minimum| with(minimum.params));
    let curves: Vec<Material> = std::iter::once(material).chain(others).collect();
    let albedo = |at: &Derived| Albedo {
        theta_i: at.theta_i.to_degrees(),
        value: at.reflectance.value,
        stderr: at.reflectance.stderr,
    };
    let angles = (0..=STEEPEST).step_by(2).map(|degrees| f64::from(degrees).to_radians());
    let line: Vec<Albedo> = angles
        .map(|theta_i| albedo(&derived::at(theta_i, &material, &outcome.uncertainty)))
        .collect();
    let measured: Vec<Albedo> = fit.derived.iter().map(albedo).collect();
    let met = |minimum: &Minimum| Met {
        mse2: minimum.mse2,
        hits: minimum.hits,
        first_start: minimum.first_start,
    };
    vec![
        Figure {
            name: "curves",
            svg: plot::scan_svg("", data, &curves),
            caption: "Measured BRDF (dots; grey crosses were left out), best fit (thick) and the other distinct minima (thin) over the scattering angle.",
            table: None,
        },
        Figure {
            name: "residuals",
            svg: plot::residuals_svg(data.samples, &seen, outcome.uncertainty.scale),
            caption: "Residuals, ln of the best fit over the measured BRDF, times the weight of the sample. The bands are one and two standard deviations of the residuals.",
            table: None,
        },
        Figure {
            name: "polar",
            svg: plot::polar_svg(data.samples, &material),
            caption: "BRDF in the plane of incidence on a logarithmic radius: measured (crosses), best fit (lines), direction of incidence (dashed).",
            table: None,
        },
        Figure {
            name: "starts",
            svg: plot::waterfall_svg(&minima.iter().map(met).collect::<Vec<_>>(), starts),
            caption: "Fits from uniform starts by the paper's method: left, the final error of each, sorted; right, the least error among the first of them. Each counts with the distinct minimum it ended in, whose error is its own to 1 %.",
            table: Some(Table::Minima),
        },
        Figure {
            name: "albedo",
            svg: plot::albedo_svg(&line, &measured),
            caption: "Directional-hemispherical reflectance (directional albedo) of the best fit, with one standard error; dots at the measured angles of incidence.",
            table: Some(Table::Angles),
        },
    ]
}
