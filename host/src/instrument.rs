//! What the options of the command line tell of instrument and sample beside the samples.

use serde::Deserialize;

use crate::analysis::reflectance::reflectance;
use crate::engine::{FitOptions, Instrument, Limit, Material, Model, Precision, Prior, Values};
use crate::error::{Error, shown};
use crate::number::shortest;
use crate::parameters::check;
use crate::terms::term_names;

/// Offsets of theta_s that are looked for, degrees to both sides.
const OFFSETS: f64 = 10.0;

/// What is known beside the samples: the options that every command has which fits scans of an instrument.
#[cfg_attr(feature = "cli", derive(clap::Args))]
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct InstrumentArguments {
    /// What a parameter is known to be from elsewhere, such as n from ellipsometry, with its standard uncertainty, in every model that has it; repeatable
    #[cfg_attr(feature = "cli", arg(long, value_name = "NAME=MEAN+-SIGMA"))]
    pub prior: Vec<String>,
    /// Fits the offset of the zero of theta_s too, up to 10 degrees; for scans in the plane of incidence
    #[cfg_attr(feature = "cli", arg(long))]
    pub fit_offset: bool,
    /// Half-angle of the cone that the detector sees from the sample, degrees: the model is averaged over it
    #[cfg_attr(feature = "cli", arg(long, value_name = "DEG"))]
    pub aperture_half_angle: Option<f64>,
    /// Standard uncertainty of the calibration, as 3% or 0.03: adds to the errors of weights and of what is derived, and changes no value
    #[cfg_attr(feature = "cli", arg(long, value_name = "PART", value_parser = part))]
    pub scale_uncertainty: Option<f64>,
    /// Holds the reflectance to at most 1 at the angles of incidence of the scan
    #[cfg_attr(feature = "cli", arg(long))]
    pub conserve_energy: bool,
}

impl InstrumentArguments {
    /// Tells the options of a fit; a prior of a parameter that the model has not is passed over.
    ///
    /// # Errors
    /// Priors that make no sense, or options that do not go together.
    pub fn apply(&self, options: &mut FitOptions) -> Result<(), Error> {
        let model = options.model;
        if let Some(degrees) = self
            .aperture_half_angle
            .filter(|degrees| !(0.0 < *degrees && *degrees <= 20.0))
        {
            return Err(Error::new(format!(
                "an aperture cannot have a half-angle of {} deg",
                shortest(degrees)
            ))
            .help("take an angle above 0 and up to 20 degrees"));
        }
        if let Some(part) = self.scale_uncertainty.filter(|part| !(0.0 < *part && *part < 1.0)) {
            return Err(
                Error::new(format!("a calibration cannot be uncertain by {}", shortest(part)))
                    .help("write 3% or 0.03; it must be above 0 and below 100 %"),
            );
        }
        for text in &self.prior {
            let Some(place) = model.place(name(text)) else { continue };
            let known = prior(model, place, text)?;
            let name = model.parameters[place].name;
            if options.lower[place] == options.upper[place] {
                return Err(Error::new(format!("{name} is fixed, and a prior of it has no effect"))
                    .help("keep --fix or --prior"));
            }
            if model.left_out(options.terms, place) {
                let names = term_names(options.terms).join(",");
                return Err(Error::new(format!("{name} is not a parameter of the terms {names}"))
                    .help("leave out its --prior, or take more --terms"));
            }
            if options.instrument.priors[place].replace(known).is_some() {
                return Err(Error::new(format!("{name} has two priors")).help("give one"));
            }
        }
        let range = OFFSETS.to_radians();
        options.instrument = Instrument {
            aperture: self.aperture_half_angle.map_or(0.0, f64::to_radians),
            offsets: self.fit_offset.then_some((-range, range)),
            scale_uncertainty: self.scale_uncertainty.unwrap_or(0.0),
            limit: self.conserve_energy.then_some(ENERGY),
            ..options.instrument
        };
        let together = |a: &str, b: &str, help: &str| Err(Error::new(format!("{a} does not go with {b}")).help(help));
        if self.fit_offset && options.robust {
            return together(
                "--fit-offset",
                "--robust",
                "find outliers without it, mask them, and fit the offset then",
            );
        }
        if options.instrument.aperture > 0.0 && options.precision == Precision::F32 {
            return together("--aperture-half-angle", "--precision f32", "take f64");
        }
        Ok(())
    }

    /// Refuses to fit an offset where `command` has none.
    ///
    /// # Errors
    /// `--fit-offset` is given.
    pub fn refuse_offset(&self, command: &str) -> Result<(), Error> {
        match self.fit_offset {
            false => Ok(()),
            true => Err(Error::new(format!("{command} does not fit an offset"))
                .help("find it with brdfit fit --fit-offset, and take it off theta_s in the file")),
        }
    }
}

/// Reflectance of at most 1.
pub const ENERGY: Limit = Limit(of_material);

fn of_material(material: &Material, theta_i: f64) -> (f64, Values) {
    reflectance(material, theta_i)
}

/// What stands before the equals sign.
fn name(text: &str) -> &str {
    text.split('=').next().unwrap_or_default().trim()
}

/// Reads `NAME=MEAN+-SIGMA` of the parameter in this place.
fn prior(model: &Model, place: usize, text: &str) -> Result<Prior, Error> {
    let form = || {
        Error::new(format!("'{}' gives no value with its uncertainty", shown(text)))
            .help("write --prior NAME=MEAN+-SIGMA, such as n=1.50+-0.02")
    };
    let (_, value) = text.split_once('=').ok_or_else(form)?;
    let (mean, sigma) = value
        .split_once("+-")
        .or_else(|| value.split_once('±'))
        .ok_or_else(form)?;
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| form());
    let known = Prior {
        mean: number(mean)?,
        sigma: number(sigma)?,
    };
    check(model, place, known.mean)?;
    if !(known.sigma > 0.0 && known.sigma.is_finite()) {
        return Err(
            Error::new(format!("an uncertainty of {} is not above 0", shortest(known.sigma)))
                .help("take a positive one, or --fix for a value that is known exactly"),
        );
    }
    Ok(known)
}

#[cfg(feature = "cli")]
fn part(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let part = match text.strip_suffix('%') {
        Some(percent) => percent.trim().parse().map(|percent: f64| percent / 100.0),
        None => text.parse(),
    };
    part.map_err(|_| "write it like 3% or 0.03".to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arguments(priors: &[&str]) -> InstrumentArguments {
        InstrumentArguments {
            prior: priors.iter().map(|text| text.to_string()).collect(),
            ..InstrumentArguments::default()
        }
    }

    #[test]
    fn priors_are_read() {
        let read = |priors: &[&str]| {
            let mut options = FitOptions::default();
            arguments(priors)
                .apply(&mut options)
                .map(|()| options.instrument.priors)
        };
        let known = |mean, sigma| Some(Prior { mean, sigma });
        let [.., n, kappa] = read(&["n=1.5+-0.02", " kappa = 0.3 ± 0.1"]).unwrap()[..6] else {
            panic!("six parameters")
        };
        assert_eq!((n, kappa), (known(1.5, 0.02), known(0.3, 0.1)));
        for bad in [
            "n=1.5",
            "n",
            "n=1.5+-0",
            "n=1.5+--1",
            "n=1.5+-nan",
            "n=0.2+-0.1",
            "n=a+-b",
        ] {
            assert!(read(&[bad]).is_err(), "{bad}");
        }
        assert!(read(&["n=1.5+-0.1", "n=1.6+-0.1"]).is_err());
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let refused = |change: fn(&mut InstrumentArguments)| {
            let mut arguments = arguments(&[]);
            change(&mut arguments);
            arguments.apply(&mut FitOptions::default()).is_err()
        };
        assert!(
            refused(|one| one.aperture_half_angle = Some(0.0)) && refused(|one| one.aperture_half_angle = Some(21.0))
        );
        assert!(
            refused(|one| one.scale_uncertainty = Some(3.0)) && refused(|one| one.scale_uncertainty = Some(f64::NAN))
        );
        assert!(
            !refused(|one| one.scale_uncertainty = Some(0.03)) && !refused(|one| one.aperture_half_angle = Some(0.5))
        );
    }

    #[cfg(feature = "cli")]
    #[test]
    fn parts_are_read() {
        assert_eq!(
            (part("3%"), part(" 0.03 "), part("3 %")),
            (Ok(0.03), Ok(0.03), Ok(0.03))
        );
        assert!(part("x").is_err() && part("x%").is_err());
    }
}
