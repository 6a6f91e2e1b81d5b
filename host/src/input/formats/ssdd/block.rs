//! A block of an SSDD file: its keywords, and the scans in its grid of values.

use crate::error::{Error, shown};
use crate::input::direction;
use crate::input::formats::grid::{self, Azimuths};
use crate::input::raw::{RawScan, Row, Weight};
use crate::input::units::Angles;

/// The keywords of a block of data.
#[derive(Default)]
pub struct Block {
    /// What the data are.
    pub kind: String,
    /// The line that says so, from 1.
    pub line: u64,
    /// The model of its colours.
    pub colours: String,
    /// Wavelengths, nm.
    pub wavelengths: Vec<f64>,
    /// What the lists are angles of.
    pub parameters: String,
    /// The angles of the grid, degrees; the last list is of offsets.
    pub lists: [Vec<f64>; 5],
}

/// Values with their lines, of which binary ones have none.
pub type Values = Vec<(u64, f64)>;

/// Names of the colours, one for each value of a direction.
///
/// # Errors
/// The model of colours is not known, or its wavelengths are missing.
pub fn colours(block: &Block) -> Result<Vec<Option<String>>, Error> {
    let letters = |names: &str| names.chars().map(|name| Some(name.to_string())).collect();
    match block.colours.as_str() {
        "monochrome" => Ok(vec![None]),
        "rgb" => Ok(letters("RGB")),
        "xyz" => Ok(letters("XYZ")),
        "spectrum" if !block.wavelengths.is_empty() => {
            let name = |wavelength: &f64| Some(format!("{wavelength} nm"));
            Ok(block.wavelengths.iter().map(name).collect())
        }
        "spectrum" => Err(Error::new("COLOR_MODEL is spectrum, and there is no WAVELENGTH_LIST")
            .at_line(block.line)
            .help("give the wavelengths in nm")),
        other => Err(Error::new(format!("COLOR_MODEL is '{}'", shown(other)))
            .at_line(block.line)
            .help("this reads monochrome, rgb, xyz or spectrum")),
    }
}

/// What the lists of a block are angles of.
#[derive(Clone, Copy, PartialEq)]
enum Parameters {
    Spherical,
    Specular,
    HalfDifference,
}

/// The scans in a block.
///
/// # Errors
/// A list is missing, or the angles are of another kind.
pub fn brdf(block: &Block, values: &Values) -> Result<Vec<RawScan>, Error> {
    let parameters = match block.parameters.as_str() {
        "spherical_coordinate_system" => Parameters::Spherical,
        "specular_coordinate_system" => Parameters::Specular,
        "half_difference_coordinate_system" => Parameters::HalfDifference,
        other => {
            return Err(Error::new(format!("PARAM_TYPE is '{}'", shown(other)))
                .at_line(block.line)
                .help(
                    "this reads spherical, specular or half_difference_coordinate_system: export it as one of these",
                ));
        }
    };
    let [first, second, third, fourth, offsets] = &block.lists;
    for (place, list) in [(0, first), (2, third), (3, fourth)] {
        if list.is_empty() {
            return Err(Error::new(format!("there is no PARAM{place}_LIST"))
                .at_line(block.line)
                .help("a BRDF needs PARAM0_LIST, PARAM2_LIST and PARAM3_LIST"));
        }
    }
    if !offsets.is_empty() && offsets.len() != first.len() {
        return Err(Error::new("PARAM4_LIST and PARAM0_LIST differ in length")
            .at_line(block.line)
            .help("give one offset for each angle of incidence"));
    }
    let colours = colours(block)?;
    // Without it the material is isotropic.
    let around = if second.is_empty() { &[0.0][..] } else { second };
    let azimuths = Azimuths::new(fourth.clone());
    let mut scans = Vec::new();
    for &azimuth in around {
        for colour in &colours {
            let turned = (around.len() > 1).then(|| format!("azimuth {azimuth}"));
            scans.push(RawScan::new(
                turned.into_iter().chain(colour.clone()).collect(),
                Angles::Deg,
            ));
        }
    }
    for (a, &one) in first.iter().enumerate() {
        for (b, &two) in around.iter().enumerate() {
            for (c, &three) in third.iter().enumerate() {
                for colour in 0..colours.len() {
                    let place = |d: usize| {
                        let node = a + first.len() * (b + around.len() * (c + third.len() * d));
                        node * colours.len() + colour
                    };
                    let ring: Vec<f64> = (0..fourth.len()).map(|d| values[place(d)].1).collect();
                    for (d, &four) in fourth.iter().enumerate() {
                        if azimuths.repeats(three, d, &ring) {
                            continue;
                        }
                        let offset = offsets.get(a).copied().unwrap_or(0.0);
                        let (theta_i, theta_s, delta_phi) = directions(parameters, [one, two, three, four], offset);
                        let row = Row {
                            theta_i,
                            theta_s,
                            delta_phi,
                            value: ring[d],
                            weight: Weight::Unknown,
                            line: values[place(d)].0,
                        };
                        grid::add(&mut scans[b * colours.len() + colour], row);
                    }
                }
            }
        }
    }
    Ok(scans)
}

/// Angle of incidence, scattering angle and azimuth from incidence of a node, degrees.
fn directions(parameters: Parameters, [one, two, three, four]: [f64; 4], offset: f64) -> (f64, f64, Option<f64>) {
    match parameters {
        Parameters::Spherical => (one, three, Some(four - two)),
        Parameters::Specular => {
            // Azimuth 0 leads from the specular ray to the normal.
            let (theta_s, delta_phi) = direction::of_specular(one + offset, three, four);
            (one, theta_s, delta_phi)
        }
        Parameters::HalfDifference => {
            let (theta_i, theta_s, delta_phi) = direction::of_half_angles(one, three, four);
            (theta_i, theta_s, Some(delta_phi))
        }
    }
}
