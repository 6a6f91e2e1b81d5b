//! `brdfit simulate`: the model at given angles, as a scan that `brdfit fit` reads.

use std::path::PathBuf;

use brdfit_core::geometry::{Geometry, Sample};
use brdfit_core::real::Real;
use clap::{Args, ValueEnum};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

use crate::engine::Material;
use crate::error::{Error, shown};
use crate::input::azimuth;
use crate::number::shortest;
use crate::options::fixed;
use crate::output::{deliver, target};
use crate::parameters;
use crate::streams::Streams;
use crate::target::NO_INPUTS;

/// Computes the BRDF at given angles and parameters
#[derive(Args, Debug)]
#[command(
    allow_negative_numbers = true,
    after_help = "Example:\n  brdfit simulate --theta-i 30,60 --theta-s -85:85:1 --rho-d 0.1 --rho-s 10 --m 0.1 --n 3 --kappa 1"
)]
pub struct Arguments {
    /// Angles of incidence in degrees: a,b,c or start:stop:step
    #[arg(long, value_name = "ANGLES", allow_hyphen_values = true)]
    theta_i: String,
    /// Scattering angles in degrees, positive forward
    #[arg(long, value_name = "ANGLES", allow_hyphen_values = true)]
    theta_s: String,
    /// Azimuths in degrees, 180 is forward; adds a column [default: in plane]
    #[arg(long, value_name = "ANGLES", allow_hyphen_values = true)]
    delta_phi: Option<String>,
    /// The model, one of those that brdfit compare shows
    #[arg(long, value_name = "NAME", default_value = "beckmann")]
    model: String,
    /// Parameters of the model, in place of the options below [default: 0 for weights and kappa, 0.1 for m, 1.5 for n, the least value that a fit may have for others]
    #[arg(long, value_name = "NAME=X,...")]
    params: Option<String>,
    /// Diffuse reflectance
    #[arg(long, conflicts_with = "params")]
    rho_d: Option<f64>,
    /// Weight of the surface lobe
    #[arg(long, conflicts_with = "params")]
    rho_s: Option<f64>,
    /// Weight of the volume lobe
    #[arg(long, conflicts_with = "params")]
    rho_v: Option<f64>,
    /// Slope of the facets
    #[arg(long, conflicts_with = "params")]
    m: Option<f64>,
    /// Index of refraction, real part
    #[arg(long, conflicts_with = "params")]
    n: Option<f64>,
    /// Index of refraction, imaginary part
    #[arg(long, conflicts_with = "params")]
    kappa: Option<f64>,
    /// Relative noise: each BRDF is multiplied by 1 + noise * u
    #[arg(long, value_name = "X", default_value_t = 0.0)]
    noise: f64,
    /// u is uniform in -1 to 1 (sym) or in 0 to 1 (pos)
    #[arg(long, value_enum, default_value = "sym")]
    noise_kind: NoiseKind,
    /// Seed of the noise
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Gives ln of the BRDF, right also where the BRDF itself underflows
    #[arg(long)]
    ln: bool,
    /// Writes the table to a file, or with - to standard output
    #[arg(short, long, visible_alias = "out", value_name = "FILE")]
    output: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum NoiseKind {
    Sym,
    Pos,
}

/// Rows of one table, which is made in memory: half a gigabyte.
const MOST_ROWS: u128 = 10_000_000;

/// Runs the subcommand.
///
/// # Errors
/// Angles or parameters that have no BRDF.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<(), Error> {
    let target = target(arguments.output.as_deref(), &NO_INPUTS)?;
    let material = material(arguments)?;
    let theta_i = angles("theta-i", &arguments.theta_i)?;
    let theta_s = angles("theta-s", &arguments.theta_s)?;
    let delta_phi = arguments.delta_phi.as_deref();
    let delta_phi = delta_phi.map(|list| angles("delta-phi", list)).transpose()?;
    let azimuths = delta_phi.as_ref().map_or(1, Vec::len);
    let rows = theta_i.len() as u128 * theta_s.len() as u128 * azimuths as u128;
    if rows > MOST_ROWS {
        return Err(Error::new(format!("these angles make {rows} rows")).help(format!(
            "take at most {MOST_ROWS} in one table: fewer angles, or several calls"
        )));
    }
    let column = if delta_phi.is_some() { "delta_phi_deg," } else { "" };
    let value = if arguments.ln { "ln_brdf" } else { "brdf_per_sr" };
    let mut table = format!("theta_i_deg,theta_s_deg,{column}{value}\n");
    let mut noise = Xoshiro256PlusPlus::seed_from_u64(arguments.seed);
    for &angle_i in &theta_i {
        for &phi in delta_phi.as_deref().unwrap_or(&[180.0]) {
            for &angle_s in &theta_s {
                let factor = noise_factor(arguments, &mut noise);
                let value = value_at(&material, [angle_i, angle_s, phi], factor, arguments.ln)?;
                table += &format!("{},{},", shortest(angle_i), shortest(angle_s));
                if delta_phi.is_some() {
                    table += &format!("{},", shortest(phi));
                }
                table += &shortest(value);
                table.push('\n');
            }
        }
    }
    deliver(table.as_bytes(), target.as_ref(), streams.output)
}

fn material(arguments: &Arguments) -> Result<Material, Error> {
    let model = parameters::model(&arguments.model)?;
    let values = model.parameters.iter().map(|parameter| match parameter.name {
        "m" => 0.1,
        "n" => 1.5,
        _ => parameter.bounds.0,
    });
    let mut material = Material {
        model,
        values: values.collect(),
    };
    let named = [
        ("rho_d", arguments.rho_d),
        ("rho_s", arguments.rho_s),
        ("rho_v", arguments.rho_v),
        ("m", arguments.m),
        ("n", arguments.n),
        ("kappa", arguments.kappa),
    ];
    for (name, value) in named {
        if let Some(value) = value {
            let index = parameters::parameter(model, name)?;
            parameters::check(model, index, value)?;
            material.values[index] = value;
        }
    }
    for member in arguments.params.iter().flat_map(|list| list.split(',')) {
        let one = fixed(model, member, "--params")?;
        material.values[one.index] = one.lower;
    }
    let get = |name: &str| material.get(name);
    let mirror = get("n") != Some(1.0) || get("kappa").is_some_and(|kappa| kappa != 0.0);
    let weights = || model.parameters.iter().filter(|parameter| parameter.is_weight());
    let shines = |name: &str| get(name).is_some_and(|weight| weight > 0.0) && (name == "rho_d" || mirror);
    // A model without weights is never dark.
    if weights().next().is_some() && !weights().any(|parameter| shines(parameter.name)) {
        let names: Vec<&str> = weights().map(|parameter| parameter.name).collect();
        return Err(Error::new("the BRDF of these parameters is 0 everywhere").help(format!(
            "give one of {} above 0, and n other than 1 for the lobes",
            names.join(", ")
        )));
    }
    if !(0.0 <= arguments.noise && arguments.noise < 1.0) {
        return Err(Error::new(format!("the noise cannot be {}", shortest(arguments.noise)))
            .help("take a number from 0 to below 1"));
    }
    Ok(material)
}

fn noise_factor(arguments: &Arguments, noise: &mut Xoshiro256PlusPlus) -> f64 {
    let unit = f64::unit(noise.next_u64());
    let u = match arguments.noise_kind {
        NoiseKind::Sym => 2.0 * unit - 1.0,
        NoiseKind::Pos => unit,
    };
    1.0 + u * arguments.noise
}

/// The BRDF times `factor`, or ln of it, at theta_i, theta_s and Delta phi in degrees.
fn value_at(material: &Material, degrees: [f64; 3], factor: f64, ln: bool) -> Result<f64, Error> {
    // Below this the exponential is not a normal number.
    const LEAST_LN: f64 = -708.0;
    let [angle_i, angle_s, phi] = degrees;
    let at = format!("theta_i = {}, theta_s = {}", shortest(angle_i), shortest(angle_s));
    let (theta_i, theta_s, delta_phi) = (angle_i.to_radians(), angle_s.to_radians(), azimuth(phi));
    Geometry::new(theta_i, theta_s, delta_phi).map_err(|error| {
        Error::new(format!("{error} at {at} degrees")).help("take 0 <= theta_i < 90 and -90 < theta_s < 90")
    })?;
    let sample = Sample {
        theta_i,
        theta_s,
        delta_phi,
        brdf: 1.0,
        weight: 1.0,
    };
    let ln_f = material.ln_f(&sample).unwrap_or(f64::NAN);
    if ln {
        return Ok(if factor == 1.0 {
            ln_f
        } else {
            ln_f + Real::portable_ln(factor)
        });
    }
    if ln_f.is_nan() || ln_f <= LEAST_LN {
        return Err(Error::new(format!(
            "the BRDF at {at} degrees is too small for a number (ln f = {})",
            shortest(ln_f)
        ))
        .help("use --ln, or give a diffuse term"));
    }
    Ok(Real::portable_exp(ln_f) * factor)
}

/// The angles of a list whose members are numbers or `start:stop:step`; a step too far never adds up, for each angle is `start + index * step`.
fn angles(name: &str, list: &str) -> Result<Vec<f64>, Error> {
    const MOST: usize = 1_000_000;
    let fail = |what: String| {
        Err(Error::new(format!("--{name}: {what}")).help("write a,b,c or start:stop:step, such as -85:85:1"))
    };
    let mut angles = Vec::new();
    for member in list.split(',') {
        let mut numbers = Vec::new();
        for part in member.split(':') {
            match part.trim().parse::<f64>() {
                Ok(number) if number.is_finite() => numbers.push(number),
                _ => return fail(format!("'{}' is not a number", shown(part))),
            }
        }
        match numbers[..] {
            [angle] => angles.push(angle),
            [start, stop, step] => {
                let steps = (stop - start) / step;
                if !(0.0..=MOST as f64).contains(&steps) {
                    return fail(format!("'{}' does not lead from start to stop", shown(member)));
                }
                // Rounding must neither lose the last angle nor pass it.
                let last = (steps + 1e-9) as usize;
                angles.extend((0..=last).map(|index| {
                    let angle = start + index as f64 * step;
                    if step > 0.0 { angle.min(stop) } else { angle.max(stop) }
                }));
            }
            _ => return fail(format!("'{}' is neither a number nor start:stop:step", shown(member))),
        }
        if angles.len() > MOST {
            return fail(format!("these are more than {MOST} angles"));
        }
    }
    Ok(angles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_do_not_drift() {
        let list = angles("x", "-85:85:0.1").unwrap();
        assert_eq!((list.len(), list[0], list[1700]), (1701, -85.0, 85.0));
        assert_eq!(list[850], -85.0 + 850.0 * 0.1);
        assert_eq!(angles("x", "5,10:30:10,80").unwrap(), [5.0, 10.0, 20.0, 30.0, 80.0]);
        assert_eq!(angles("x", "0:0.3:0.1").unwrap().last(), Some(&0.3));
        assert_eq!(angles("x", "3:1:-1").unwrap(), [3.0, 2.0, 1.0]);
        for bad in [
            "",
            "a",
            "1:2",
            "1:2:0",
            "1:2:-1",
            "1:2:1e-9",
            "0:1:1e-6,0:1:1e-6",
            "1:1:0",
            "nan",
            "1:2:3:4",
        ] {
            assert!(angles("x", bad).is_err(), "{bad}");
        }
    }
}
