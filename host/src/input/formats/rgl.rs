//! `.bsdf` of the RGL material database: a BRDF over directions that follow the material's own lobe, as a tensor file.
//!
//! Each sample is taken where it was measured, without interpolation: the nodes of the grid are mapped to half vectors by the distribution of visible normals in the file.
//! Source: Dupuy and Jakob, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", ACM TOG 37(6) (2018), and the reader that comes with the database.

use std::f64::consts::PI;

use super::grid;
use super::tensor::{self, Field};
use super::warp::{Table, Warp};
use crate::error::Error;
use crate::input::direction::{angles, sin_cos};
use crate::input::format::{Format, Reader};
use crate::input::head::plain;
use crate::input::options::ReadOptions;
use crate::input::raw::{RawScan, Row, Weight};
use crate::input::units::{Angles, Quantity};

/// This format.
pub const FORMAT: Format = Format {
    name: "rgl",
    title: "RGL tensor file",
    about: "RGL material database, .bsdf",
    reader: Reader::Bytes { is: tensor::is, read },
};

/// What the file holds of a material.
struct Material<'a> {
    /// Angles of incidence, radians.
    theta_i: Vec<f64>,
    /// Azimuths of incidence, radians; one of an isotropic material.
    phi_i: Vec<f64>,
    isotropic: bool,
    /// False if the colours are f cos theta_s themselves, and not over the distribution of normals.
    scaled: bool,
    ndf: Table,
    sigma: Table,
    vndf: Field<'a>,
    luminance: Field<'a>,
    /// Colours or wavelengths, with their names.
    colours: Field<'a>,
    names: Vec<String>,
}

/// Scans of luminance and of the wavelengths that `--column` names, or of R, G and B; one each for each azimuth of incidence of an anisotropic material.
///
/// # Errors
/// A field is missing, of another shape or outside of the file.
fn read(file: &[u8], options: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let material = material(file)?;
    let channels = channels(&material, &options.column);
    let mut scans = Vec::new();
    for (slice, phi_i) in material.phi_i.iter().enumerate() {
        let turned = (!material.isotropic).then(|| format!("phi_i {}", round(phi_i.to_degrees())));
        let scan = |(name, _): &(String, Option<usize>)| RawScan {
            quantity: Quantity::BrdfCos,
            ..RawScan::new(turned.clone().into_iter().chain([name.clone()]).collect(), Angles::Deg)
        };
        let mut group: Vec<RawScan> = channels.iter().map(scan).collect();
        for incidence in 0..material.theta_i.len() {
            take(&material, slice, incidence, &channels, &mut group);
        }
        scans.extend(group);
    }
    Ok(scans)
}

/// The names of the scans, and which colour each is; none is luminance.
///
/// A spectrum has hundreds of wavelengths, so only those that are asked for are taken.
fn channels(material: &Material, wanted: &[String]) -> Vec<(String, Option<usize>)> {
    let luminance = ("luminance".to_string(), None);
    let colours = material.names.iter().cloned().zip((0..).map(Some));
    let all: Vec<_> = [luminance.clone()].into_iter().chain(colours).collect();
    if wanted.is_empty() {
        return if material.names.len() == 3 {
            all[1..].to_vec()
        } else {
            vec![luminance]
        };
    }
    let asked = |name: &str| wanted.iter().any(|wanted| plain(wanted).ends_with(&plain(name)));
    let chosen: Vec<_> = all.iter().filter(|(name, _)| asked(name)).cloned().collect();
    // The error that names what is there comes later, from those that are.
    if chosen.is_empty() { all } else { chosen }
}

/// Adds the nodes at one direction of incidence.
fn take(
    material: &Material,
    slice: usize,
    incidence: usize,
    channels: &[(String, Option<usize>)],
    scans: &mut [RawScan],
) {
    let (theta_i, phi_i) = (material.theta_i[incidence], material.phi_i[slice]);
    let place = slice * material.theta_i.len() + incidence;
    let [.., ny, nx] = material.luminance.shape[..] else {
        return;
    };
    let [.., height, width] = material.vndf.shape[..] else {
        return;
    };
    let warp = Warp::new(material.vndf.numbers(place * width * height, width * height), width);
    let sigma = material.sigma.at(u_of_theta(theta_i), u_of_phi(phi_i));
    let theta_i_deg = theta_i.to_degrees();
    let (sin_i, cos_i) = sin_cos(theta_i_deg);
    // The first column is the normal in each row, and the last row is the first.
    let nodes = (0..ny - 1)
        .flat_map(|y| (0..nx).map(move |x| (x, y)))
        .filter(|&(x, y)| x > 0 || y == 0);
    for (x, y) in nodes {
        let [u, v] = warp.sample(x as f64 / (nx - 1) as f64, y as f64 / (ny - 1) as f64);
        let scale = if material.scaled {
            material.ndf.at(u, v) / (4.0 * sigma)
        } else {
            1.0
        };
        // The half vector, with x from the normal to incidence.
        let phi_m = if material.isotropic {
            phi_of_u(v)
        } else {
            phi_of_u(v) - phi_i
        };
        let ((sin_m, cos_m), (sin_p, cos_p)) = (sin_cos(theta_of_u(u).to_degrees()), sin_cos(phi_m.to_degrees()));
        let half = [sin_m * cos_p, sin_m * sin_p, cos_m];
        let twice = 2.0 * (half[0] * sin_i + half[2] * cos_i);
        let out = [twice * half[0] - sin_i, twice * half[1], twice * half[2] - cos_i];
        let (theta_s, delta_phi) = angles([-out[0], out[1], out[2]]);
        for ((_, colour), scan) in channels.iter().zip(&mut *scans) {
            let value = match colour {
                None => material.luminance.number((place * ny + y) * nx + x),
                Some(colour) => {
                    let count = material.names.len();
                    material.colours.number(((place * count + colour) * ny + y) * nx + x)
                }
            };
            let row = Row {
                theta_i: theta_i_deg,
                theta_s,
                delta_phi,
                value: value * scale,
                weight: Weight::Unknown,
                line: 0,
            };
            grid::add(scan, row);
        }
    }
}

/// The fields of the file, whose shapes agree.
fn material(file: &[u8]) -> Result<Material<'_>, Error> {
    let fields = tensor::fields(file)?;
    let find = |name: &str| fields.iter().find(|field| field.name == name);
    let field = |name: &str, dimensions: usize| -> Result<Field<'_>, Error> {
        let field = find(name).ok_or_else(|| fault(&format!("there is no field {name}")))?;
        let found = field.shape.len();
        if found != dimensions {
            return Err(fault(&format!(
                "the field {name} has {found} dimensions, and not {dimensions}"
            )));
        }
        if field.shape.contains(&0) {
            return Err(fault(&format!("the field {name} is empty")));
        }
        Ok(field.clone())
    };
    let list = |name: &str| Ok::<_, Error>(field(name, 1)?.all());
    let table = |name: &str| -> Result<Table, Error> {
        let field = field(name, 2)?;
        Table::new(field.all(), field.shape[1]).ok_or_else(|| fault(&format!("the field {name} is too small")))
    };
    let (theta_i, mut phi_i) = (list("theta_i")?, list("phi_i")?);
    let (colours, names) = if find("rgb").is_some() {
        (field("rgb", 5)?, ["R", "G", "B"].map(String::from).to_vec())
    } else {
        let names = list("wavelengths")?
            .into_iter()
            .map(|length| format!("{} nm", round(length)));
        (field("spectra", 5)?, names.collect())
    };
    let (vndf, luminance) = (field("vndf", 4)?, field("luminance", 4)?);
    let directions = [phi_i.len(), theta_i.len()];
    let agree = vndf.shape[..2] == directions
        && luminance.shape[..2] == directions
        && colours.shape[..2] == directions
        && colours.shape[2] == names.len()
        && colours.shape[3..] == luminance.shape[2..]
        && vndf.shape[2..]
            .iter()
            .chain(&luminance.shape[2..])
            .all(|&count| count >= 2);
    if !agree {
        return Err(fault(
            "the shapes of phi_i, theta_i, vndf, luminance and the colours do not agree",
        ));
    }
    let isotropic = phi_i.len() <= 2;
    if isotropic {
        phi_i.truncate(1);
    }
    Ok(Material {
        ndf: table("ndf")?,
        sigma: table("sigma")?,
        scaled: find("jacobian").is_none_or(|field| field.number(0) != 0.0),
        theta_i,
        phi_i,
        isotropic,
        vndf,
        luminance,
        colours,
        names,
    })
}

fn fault(what: &str) -> Error {
    Error::new(format!("as RGL tensor file: {what}")).help("is the file whole?")
}

/// Seven digits, which are those of the file.
fn round(x: f64) -> f64 {
    format!("{x:.6e}").parse().unwrap_or(x)
}

fn theta_of_u(u: f64) -> f64 {
    u * u * PI / 2.0
}

fn u_of_theta(theta: f64) -> f64 {
    (theta * 2.0 / PI).sqrt()
}

fn phi_of_u(u: f64) -> f64 {
    (2.0 * u - 1.0) * PI
}

fn u_of_phi(phi: f64) -> f64 {
    (phi + PI) / (2.0 * PI)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::direction::vectors;
    use crate::input::formats::tensor::Numbers;

    const NODES: [usize; 2] = [5, 4];

    /// A table of the bilinear function a + b u + c v + d u v, rows along u.
    fn table([width, height]: [usize; 2], [a, b, c, d]: [f64; 4]) -> Vec<f64> {
        let node = |k: usize| {
            let (u, v) = (
                (k % width) as f64 / (width - 1) as f64,
                (k / width) as f64 / (height - 1) as f64,
            );
            a + b * u + c * v + d * u * v
        };
        (0..width * height).map(node).collect()
    }

    /// A file of these azimuths of incidence, whose functions are bilinear, so that the tables are exact.
    fn file(phi_i: &[f64], colours: usize) -> Vec<u8> {
        file_with(phi_i, colours, 1)
    }

    fn file_with(phi_i: &[f64], colours: usize, jacobian: u8) -> Vec<u8> {
        let theta_i = [0.25, 1.0];
        let slices = phi_i.len() * theta_i.len();
        let [nx, ny] = NODES;
        let channel = |k: f64| table(NODES, [k, 1.0, 2.0, 3.0]);
        let mut all_colours = Vec::new();
        (0..slices).for_each(|_| (0..colours).for_each(|k| all_colours.extend(channel(k as f64 + 2.0))));
        let wavelengths: Vec<f64> = (0..colours).map(|k| 400.0 + 50.5 * k as f64).collect();
        let (name, shape) = if colours == 3 { ("rgb", 3) } else { ("spectra", colours) };
        let numbers = |values: Vec<f64>| Numbers::F32(values.into_iter().map(|value| value as f32).collect());
        tensor::write(&[
            ("theta_i", vec![2], numbers(theta_i.to_vec())),
            ("phi_i", vec![phi_i.len()], numbers(phi_i.to_vec())),
            ("ndf", vec![3, 6], numbers(table([6, 3], [1.0, 2.0, 0.5, 0.25]))),
            ("sigma", vec![2, 3], numbers(table([3, 2], [1.0, -0.5, 0.0, 0.0]))),
            (
                "vndf",
                vec![phi_i.len(), 2, 4, 6],
                numbers(table([6, 4], [1.0, 2.0, 3.0, 6.0]).repeat(slices)),
            ),
            (
                "luminance",
                vec![phi_i.len(), 2, ny, nx],
                numbers(channel(1.0).repeat(slices)),
            ),
            (name, vec![phi_i.len(), 2, shape, ny, nx], numbers(all_colours)),
            ("wavelengths", vec![colours], numbers(wavelengths)),
            ("jacobian", vec![1], Numbers::Bytes(vec![jacobian])),
        ])
    }

    fn read(file: &[u8], column: &str) -> Result<Vec<RawScan>, Error> {
        let column = column
            .split(',')
            .filter(|name| !name.is_empty())
            .map(String::from)
            .collect();
        super::read(
            file,
            &ReadOptions {
                column,
                ..ReadOptions::default()
            },
        )
    }

    /// f cos(theta_s) of the colour that begins with `first` at any direction, by the inverse map (the reader of the database).
    fn expected(row: &Row, phi_i: f64, isotropic: bool, first: f64) -> f64 {
        let [i, s] = vectors(row.theta_i, row.theta_s, row.delta_phi);
        let half: [f64; 3] = std::array::from_fn(|k| i[k] + s[k]);
        let across = libm::hypot(half[0], half[1]);
        let turn = if isotropic { 0.0 } else { phi_i };
        let u = u_of_theta(libm::atan2(across, half[2]));
        let v = u_of_phi(libm::atan2(half[1], half[0]) + turn).rem_euclid(1.0);
        // The density of the map is (1 + 2 u) (1 + 3 v).
        let (x, y) = ((u + u * u) / 2.0, (v + 1.5 * v * v) / 2.5);
        let ndf = 1.0 + 2.0 * u + 0.5 * v + 0.25 * u * v;
        let sigma = 1.0 - 0.5 * u_of_theta(row.theta_i.to_radians());
        (first + x + 2.0 * y + 3.0 * x * y) * ndf / (4.0 * sigma)
    }

    #[test]
    fn values_are_those_that_the_inverse_map_finds() {
        let isotropic = read(&file(&[0.0], 3), "").unwrap();
        let names: Vec<String> = isotropic.iter().map(|scan| scan.names.join(" ")).collect();
        assert_eq!(names, ["R", "G", "B"]);
        let turned = read(&file(&[-1.0, 0.5, 2.0], 3), "").unwrap();
        assert_eq!(
            (turned.len(), turned[4].names.join(" ")),
            (9, "phi_i 28.64789 G".into())
        );
        for (scan, phi_i, isotropic, first) in [
            (&isotropic[0], 0.0, true, 2.0),
            (&isotropic[2], 0.0, true, 4.0),
            (&turned[4], 0.5, false, 3.0),
        ] {
            assert!(scan.rows.len() > 12 && scan.quantity == Quantity::BrdfCos);
            for row in &scan.rows {
                // The normal as half vector has no azimuth: the first of its row stands for all.
                let specular = (row.theta_s - row.theta_i).abs() < 1e-5 && row.delta_phi.is_none();
                let ratio = row.value / expected(row, phi_i, isotropic, first);
                assert!(specular || (ratio - 1.0).abs() < 1e-5, "{row:?} {ratio}");
            }
        }
    }

    #[test]
    fn a_file_may_hold_the_values_themselves() {
        let [scaled, plain] = [1, 0].map(|jacobian| read(&file_with(&[0.0], 3, jacobian), "").unwrap());
        let node = |scans: &[RawScan]| scans[0].rows[0].value;
        // Where u and v are 0, the distribution of normals is 1, and sigma 1 - 0.5 u of the angle of incidence.
        let sigma = 1.0 - 0.5 * u_of_theta(0.25);
        assert!((node(&scaled) / node(&plain) * 4.0 * sigma - 1.0).abs() < 1e-6);
    }

    #[test]
    fn the_first_column_is_the_specular_direction_once() {
        let scan = &read(&file(&[0.0], 3), "").unwrap()[0];
        let specular = scan.rows.iter().filter(|row| (row.theta_s - row.theta_i).abs() < 1e-5);
        let angles: Vec<f64> = specular.map(|row| round(row.theta_i.to_radians())).collect();
        assert_eq!(angles, [0.25, 1.0]);
    }

    #[test]
    fn wavelengths_are_taken_by_name() {
        let file = file(&[0.0], 4);
        let names = |column: &str| -> Vec<String> {
            let scans = read(&file, column).unwrap();
            scans.iter().map(|scan| scan.names.join(" ")).collect()
        };
        assert_eq!(names(""), ["luminance"]);
        assert_eq!(names("450.5nm,luminance"), ["luminance", "450.5 nm"]);
        assert_eq!(
            names("green"),
            ["luminance", "400 nm", "450.5 nm", "501 nm", "551.5 nm"]
        );
    }

    #[test]
    fn a_file_without_a_field_or_of_another_shape_is_refused() {
        let whole = file(&[0.0], 3);
        let replaced = |from: &[u8], to: &[u8]| {
            let place = whole.windows(from.len()).position(|bytes| bytes == from).unwrap();
            [&whole[..place], to, &whole[place + from.len()..]].concat()
        };
        let many_dimensions = tensor::write(&[("theta_i", vec![1; 2000], Numbers::Bytes(vec![0]))]);
        for (file, what) in [
            (replaced(b"vndf", b"vndg"), "no field vndf"),
            (replaced(b"luminance", b"luminancy"), "no field luminance"),
            (replaced(b"ndf\x02\0", b"ndf\x01\0"), ""),
            (many_dimensions, "the field theta_i has 2000 dimensions, and not 1"),
            (whole[..whole.len() - 1].to_vec(), "not all there"),
        ] {
            let error = read(&file, "").unwrap_err();
            assert!(error.what.contains(what) && error.what.len() < 200, "{error}");
        }
    }
}
