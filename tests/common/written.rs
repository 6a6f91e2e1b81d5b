//! One scan in the text formats, as their programs would write it.

use brdfit_core::brdf::{ALL, Brdf, Params};
use brdfit_core::geometry::Geometry;
use brdfit_core::real::Real;

/// The parameters.
pub const TRUTH: [f64; 6] = [0.1, 10.0, 0.01, 0.1, 3.0, 1.0];
/// Angles of incidence, degrees.
pub const INCIDENT: [f64; 2] = [30.0, 60.0];

/// The BRDF of [`TRUTH`] at angles in degrees.
pub fn brdf(theta_i: f64, theta_s: f64, delta_phi: f64) -> f64 {
    let delta_phi = if delta_phi == 180.0 {
        f64::PI
    } else {
        delta_phi.to_radians()
    };
    let geometry = Geometry::new(theta_i.to_radians(), theta_s.to_radians(), delta_phi).expect("valid angles");
    Real::portable_exp(Brdf::<f64, ALL>::new(&Params::from_array(TRUTH)).ln_f(&geometry))
}

/// Scattering angles in plane.
pub fn scattered() -> impl Iterator<Item = f64> {
    (-20..=20).map(|k| f64::from(4 * k))
}

/// The scan of [`TRUTH`] in the text formats, by the name that the program has for each.
pub fn texts() -> Vec<(&'static str, String)> {
    let points: Vec<[f64; 2]> = INCIDENT
        .iter()
        .flat_map(|&i| scattered().map(move |s| [i, s]))
        .collect();
    let line = |write: &dyn Fn(f64, f64, f64) -> String| -> String {
        points.iter().map(|&[i, s]| write(i, s, brdf(i, s, 180.0))).collect()
    };
    let mut matrix = String::from("theta_s\t30\t60\n");
    for s in scattered() {
        matrix += &format!("{s}\t{}\t{}\n", brdf(30.0, s, 180.0), brdf(60.0, s, 180.0));
    }
    let polar = |s: f64| (s.abs(), if s < 0.0 { 0.0 } else { 180.0 });
    let list = |value: &dyn Fn(f64, f64) -> f64| -> String {
        let values: Vec<String> = points.iter().map(|&[i, s]| value(i, s).to_string()).collect();
        format!("[{}]", values.join(", "))
    };
    let bird = format!(
        "{{\"metadata\": {{}}, \"data\": {{\"theta_i\": {{\"unit\": \"deg\", \"values\": {}}},\n\
         \"phi_i\": {{\"unit\": \"deg\", \"values\": {}}},\n\"theta_r\": {{\"unit\": \"rad\", \"values\": {}}},\n\
         \"phi_r\": {{\"unit\": \"deg\", \"values\": {}}},\n\"BRDF\": {{\"unit\": \"1/sr\", \"values\": {}}}}}}}\n",
        list(&|i, _| i),
        list(&|_, _| 90.0),
        list(&|_, s| polar(s).0.to_radians()),
        list(&|_, s| (polar(s).1 + 90.0) % 360.0),
        list(&|i, s| brdf(i, s, 180.0)),
    );
    let block = |theta_i: f64| -> String {
        scattered()
            .map(|s| format!("{s} 0 {}\n", brdf(theta_i, s, 180.0) / 2.0))
            .collect()
    };
    // Angles from the specular ray: theta_s = theta_i - radial, then theta_i + radial.
    let radials: Vec<f64> = (0..=14).map(|k| f64::from(2 * k)).collect();
    let zemax_row = |theta_i: f64, side: f64| -> String {
        let values = radials
            .iter()
            .map(|radial| brdf(theta_i, theta_i + side * radial, 180.0).to_string());
        values.collect::<Vec<_>>().join("\t") + "\n"
    };
    let mut zemax = format!(
        "Source Measured\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterType BRDF\nSampleRotation 1\n0\n\
         AngleOfIncidence 2\n30 60\nScatterAzimuth 2\n0 180\nScatterRadial 15\n{}\n\nMonochrome\nDataBegin\n",
        radials.iter().map(f64::to_string).collect::<Vec<_>>().join(" ")
    );
    for theta_i in INCIDENT {
        zemax += &format!("TIS 0.1\n{}{}", zemax_row(theta_i, -1.0), zemax_row(theta_i, 1.0));
    }
    zemax += "DataEnd\n";
    vec![
        (
            "table",
            "theta_i;theta_s;brdf\n".to_string() + &line(&|i, s, f| format!("{i};{s};{f}\n")),
        ),
        ("matrix", matrix),
        (
            "astm",
            format!(
                "LAB_NAME none\nNUM_POINTS {}\nVARS theta_i,phi_i,theta_s,phi_s,Integrated\n\n",
                points.len()
            ) + &line(&|i, s, f| {
                let (theta_s, phi_s) = polar(s);
                format!(
                    "{},0,{},{:.6},{f}\n",
                    i.to_radians(),
                    theta_s.to_radians(),
                    phi_s.to_radians()
                )
            }),
        ),
        ("bird", bird),
        (
            "fred",
            format!(
                "type bsdf_data\nformat angles=deg bsdf=value scale=2\n30 0\n{}60 0\n{}",
                block(30.0),
                block(60.0)
            ),
        ),
        (
            "lumos",
            "# phi_i theta_i phi_o theta_o brdf\n".to_string() + &line(&|i, s, f| format!("{i} -180 {s} 0 {f}\n")),
        ),
        (
            "alta",
            "#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n#PARAM_OUT INV_STERADIAN_COSINE_FACTOR\n".to_string()
                + &line(&|i, s, f| {
                    let [view, light] = [s.abs(), i].map(f64::to_radians);
                    let azimuth = if s < 0.0 { 0.0 } else { f64::PI };
                    format!("{view} {light} {azimuth} {}\n", f * Real::portable_sin_cos(view).1)
                }),
        ),
        ("zemax", zemax),
        ("speos", speos()),
        ("lighttools", lighttools()),
        ("ssdd", ssdd()),
        ("pabopto", pabopto()),
        ("openmaterial", openmaterial()),
    ]
}

/// Scattering angles of a grid that has an azimuth for each side, and f at both: towards incidence, and forward.
fn sides(theta_i: f64) -> Vec<(f64, f64, f64)> {
    let angles = scattered().filter(|&angle| angle >= 0.0);
    angles
        .map(|s| (s, brdf(theta_i, s, 0.0), brdf(theta_i, s, 180.0)))
        .collect()
}

/// Azimuth 0 is forward; the reflectance is the integral by the trapezoidal rule, so that values are absolute.
fn speos() -> String {
    let mut text = String::from("OPTIS - brdf surface file v8.0\n0\nremark\n4\nnone\n1 0\n1\n2 1\n30 60\n550\n");
    for theta_i in INCIDENT {
        let rows = sides(theta_i);
        let ring = |&(theta, back, forward): &(f64, f64, f64)| {
            let (sin, cos) = Real::portable_sin_cos(theta.to_radians());
            f64::PI * (back + forward) * sin * cos
        };
        let steps = rows.windows(2);
        let reflectance: f64 = steps
            .map(|pair| 0.5 * (ring(&pair[0]) + ring(&pair[1])) * (pair[1].0 - pair[0].0).to_radians())
            .sum();
        text += &format!("{}\n{} 2\n\t0\t180\n", 100.0 * reflectance, rows.len());
        for (theta, back, forward) in rows {
            text += &format!("{theta}\t{forward}\t{back}\n");
        }
    }
    text + "End of file\n"
}

/// Azimuths are from incidence where there is a plane of symmetry.
fn lighttools() -> String {
    let joined = |values: Vec<f64>| values.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    let angles: Vec<f64> = sides(0.0).iter().map(|&(theta, _, _)| theta).collect();
    let mut text = format!(
        "Symmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterAzimuth 2\n0 180\nScatterRadial {}\n{}\nDataBegin\n",
        angles.len(),
        joined(angles)
    );
    for theta_i in INCIDENT {
        let rows = sides(theta_i);
        text += &format!(
            "AOI {theta_i}\nPOI 90\nSide Front\nWavelength 550\nScatterType BRDF\nTIS 0.1\n{}\n{}\n",
            joined(rows.iter().map(|row| row.1).collect()),
            joined(rows.iter().map(|row| row.2).collect())
        );
    }
    text + "DataEnd\n"
}

/// The angle of incidence runs fastest, then the scattering angle, then the azimuth, which is 0 towards incidence.
fn ssdd() -> String {
    let rows = INCIDENT.map(sides);
    let mut text = String::from(
        "VERSION 0.2\n\nDATA_TYPE brdf\nCOLOR_MODEL monochrome\nPARAM_TYPE spherical_coordinate_system\nPARAM0_LIST 30 60\nPARAM2_LIST",
    );
    rows[0].iter().for_each(|(theta, _, _)| text += &format!(" {theta}"));
    text += "\nPARAM3_LIST 0 180\nDATA ascii\n";
    for forward in [false, true] {
        for place in 0..rows[0].len() {
            for of_incidence in &rows {
                let (_, back, front) = of_incidence[place];
                text += &format!("{}\n", if forward { front } else { back });
            }
        }
    }
    text
}

/// Forward is half a turn from incidence, and a new direction of incidence is a remark.
fn pabopto() -> String {
    let mut text = String::from("#data written using none\n#sample_name \"none\"\n#format: theta phi DSF\n");
    for theta_i in INCIDENT {
        text += &format!("#incident_angle {theta_i} 90\n");
        for (theta, back, forward) in sides(theta_i) {
            let cos = Real::portable_sin_cos(theta.to_radians()).1;
            text += &format!("{theta} 270 {}\n", forward * cos);
            if theta > 0.0 {
                text += &format!("{theta} 90 {}\n", back * cos);
            }
        }
    }
    text
}

/// Radians, azimuth 0 towards incidence, wavelength in m.
fn openmaterial() -> String {
    let mut rows = Vec::new();
    for theta_i in INCIDENT {
        for (theta, back, forward) in sides(theta_i) {
            let (i, s) = (theta_i.to_radians(), theta.to_radians());
            rows.push(format!("[5.5e-07, {i}, {s}, 0.0, {back}]"));
            if theta > 0.0 {
                rows.push(format!("[5.5e-07, {i}, {s}, {}, {forward}]", f64::PI));
            }
        }
    }
    format!(
        "{{\"metadata\": {{\"name\": \"none\"}},\n\"brdf\": {{\"wavelengths\": [5.5e-07], \"lookupTable\": [\n{}\n]}}}}\n",
        rows.join(",\n")
    )
}
