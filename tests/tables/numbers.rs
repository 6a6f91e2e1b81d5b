//! Units, signs and heads as they are written.

use super::{assert_is, case, fit, folder, parameter, text_of};
use brdfit_suite::program::{self, fail, write};

#[test]
fn values_in_percent_and_in_no_unit_of_a_brdf() {
    let right = fit(&[&case("f04_percent.csv")]);
    assert_is(&right, "rho_d", 0.399, 0.0005);
    assert_is(&right, "m", 0.202, 0.0005);
    let text = text_of("f04_percent.csv");
    let folder = folder();
    for head in ["BRF [%]", "brf_percent", "reflectance factor (percent)", "BRF"] {
        let file = write(&folder, "scan.csv", text.replace("BRF (%)", head));
        let found = if head == "BRF" {
            let message = fail(&["fit", &file]);
            assert!(
                message.contains("in percent") && message.contains("--value-unit percent"),
                "{message}"
            );
            fit(&[&file, "--value-unit", "percent"])
        } else {
            fit(&[&file])
        };
        assert_eq!(found["parameters"], right["parameters"], "{head}");
    }
    for head in [
        "BRDF (mV)",
        "brdf [counts]",
        "BRDF (a.u.)",
        "brdf_mV",
        "BRDF (W/m2/sr)",
        "BRDF (10^-3 sr^-1)",
    ] {
        let file = write(&folder, "scan.csv", text.replace("BRF (%)", head));
        let message = fail(&["fit", &file]);
        assert!(
            message.contains(":1:3: ") && message.contains("--value-unit plain"),
            "{head}: {message}"
        );
    }
    // Of what R is the percentage, a person must say.
    let file = write(&folder, "scan.csv", text.replace("BRF (%)", "R (%)"));
    assert!(fail(&["fit", &file]).contains("--quantity brf"));
    assert_eq!(fit(&[&file, "--quantity", "brf"])["parameters"], right["parameters"]);
    // A mark where there was no measurement is no value.
    let file = write(&folder, "scan.csv", format!("{text}45,81,1e30\n"));
    let message = fail(&["fit", &file]);
    assert!(
        message.contains(":83:3: ") && message.contains("--max-value 1e30"),
        "{message}"
    );
    let found = fit(&[&file, "--max-value", "1e30"]);
    assert_eq!(found["left_out"][0]["samples"], 1);
    let unit = |unit: &str| {
        let rows: String = text.lines().skip(1).map(|row| format!("{row},{unit}\n")).collect();
        write(&folder, "unit.csv", format!("theta_i,theta_s,brf,unit\n{rows}"))
    };
    assert_eq!(fit(&[&unit("%")])["parameters"], right["parameters"]);
    assert!(fail(&["fit", &unit("mV")]).contains("not in sr^-1"));
}

#[test]
fn the_peak_tells_the_side() {
    let file = case("f05_forward_negative.csv");
    let message = fail(&["fit", &file]);
    assert!(
        message.contains("on the other side") && message.contains("--forward negative"),
        "{message}"
    );
    let found = fit(&[&file, "--forward", "negative"]);
    assert_is(&found, "rho_s", 0.79, 0.005);
    assert_is(&found, "rho_v", 0.0, 0.001);
    assert_eq!(program::brdfit(&["fit", &file, "--forward", "positive"], b"").code, 0);
    // Negative angles of incidence with the same signs of theta_s are the same scan, seen from the other side.
    let folder = folder();
    let turned = text_of("f05_forward_negative.csv")
        .replace("\n20,", "\n-20,")
        .replace("\n45,", "\n-45,");
    assert_eq!(
        fit(&[&write(&folder, "scan.csv", turned)])["parameters"],
        found["parameters"]
    );
    let turned = text_of("f05_forward_negative.csv")
        .replace("\n20,", "\n340,")
        .replace("\n45,", "\n315,");
    assert_eq!(
        fit(&[&write(&folder, "scan.csv", turned)])["parameters"],
        found["parameters"]
    );
}

#[test]
fn angles_of_a_full_turn_and_in_radians() {
    let right = fit(&[&case("f12_theta_0_to_360.csv")]);
    assert_eq!(right["samples"], 81);
    let folder = folder();
    let negative = |theta_s: &str| {
        let angle: f64 = theta_s.parse().expect("an angle");
        if angle > 180.0 { angle - 360.0 } else { angle }
    };
    let (mut signed, mut radians, mut wide) = (String::new(), String::new(), String::new());
    for row in text_of("f12_theta_0_to_360.csv").lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let theta_s = negative(cells[1]);
        signed += &format!("{},{theta_s},{}\n", cells[0], cells[2]);
        let theta_i: f64 = cells[0].parse().expect("an angle");
        radians += &format!("{},{},{}\n", theta_i.to_radians(), theta_s.to_radians(), cells[2]);
        wide += &format!("{},{},{}\n", cells[0], 1.5 * theta_s, cells[2]);
    }
    let with = |head: &str, rows: &str| write(&folder, "scan.csv", format!("{head}\n{rows}"));
    assert_eq!(
        fit(&[&with("theta_i,theta_s,brdf", &signed)])["parameters"],
        right["parameters"]
    );
    let file = with("theta_i_deg,theta_s_deg,brdf", &radians);
    let message = fail(&["fit", &file]);
    assert!(
        message.contains("are they radians?") && message.contains("--angles rad"),
        "{message}"
    );
    assert_is(&fit(&[&file, "--angles", "rad"]), "m", parameter(&right, "m"), 1e-9);
    let message = fail(&["fit", &with("theta_i_rad,theta_s_rad,brdf", &signed), "--drop-invalid"]);
    assert!(message.contains("are they degrees?"), "{message}");
    let message = fail(&["fit", &with("theta_i,theta_s,brdf", &wide), "--drop-invalid"]);
    assert!(message.contains("more than half a turn"), "{message}");
    let mut surface = String::new();
    for row in signed.lines() {
        let cells: Vec<&str> = row.split(',').collect();
        let theta_s: f64 = cells[1].parse().expect("an angle");
        surface += &format!("{},{},{}\n", cells[0], 90.0 + theta_s, cells[2]);
    }
    let message = fail(&["fit", &with("theta_i,theta_s,brdf", &surface), "--drop-invalid"]);
    assert!(message.contains("counted from the surface"), "{message}");
    let message = fail(&["fit", &case("f18_pivot_theta_phi.txt")]);
    assert!(message.contains("azimuths"), "{message}");
    let matrix = fit(&[&case("f18_pivot_theta_phi.txt"), "--theta-i", "30"]);
    assert_eq!(matrix["samples"], 9 * 25);
}

#[test]
fn heads_and_numbers_of_many_hands() {
    let right = fit(&[&case("f12_theta_0_to_360.csv")]);
    let numpy = fit(&[&case("f13_numpy_header.txt")]);
    assert_is(&numpy, "m", parameter(&right, "m"), 1e-3);
    let text = text_of("f12_theta_0_to_360.csv");
    let body = text.split_once('\n').expect("a head").1;
    let folder = folder();
    let comma = body
        .replace('.', ";")
        .replace(',', "|")
        .replace(';', ",")
        .replace('|', ";");
    for (head, body, options) in [
        ("sep=,\ntheta_i,theta_s,brdf\n", body.to_string(), &[][..]),
        ("theta_i;theta_s;brdf\n", comma.clone(), &[]),
        ("sep=;\ntheta_i;theta_s;brdf\n°;°;1/sr\n", comma.clone(), &[]),
        ("theta_i\ttheta_s\tbrdf\n", comma.replace(';', "\t"), &[]),
        ("theta_i,theta_s,brdf\ndeg,deg,sr^-1\n", body.to_string(), &[]),
        ("% theta_i theta_s brdf\n", body.replace(',', " "), &[]),
        (
            "Measured by nobody\nDate: 2026-01-01\n\ntheta_i,theta_s,brdf\n",
            body.to_string(),
            &[],
        ),
        // Remarks of instruments are no names, whatever stands in them.
        (
            "Instrument: none\nWavelength: 632.8 nm\nPolarization: s\ntheta_i,theta_s,brdf\n",
            body.to_string(),
            &[],
        ),
        (
            "Wavelength,632.8 nm,\nDetector angle,20 deg,\ntheta_i,theta_s,brdf\n",
            body.to_string(),
            &[],
        ),
        ("Columns: theta_i, theta_s, brdf\n", body.to_string(), &[]),
        (
            "[Header]\nFile=a.dat\n[Data]\ntheta_i,theta_s,brdf\n",
            body.to_string(),
            &[],
        ),
        ("[theta_i],[theta_s],[brdf]\n", body.to_string(), &[]),
        ("theta_i:deg,theta_s:deg,brdf:1/sr\n", body.to_string(), &[]),
        (
            "incidence angle in deg,scatter angle in deg,BRDF in 1/sr\n",
            body.to_string(),
            &[],
        ),
        ("theta_i|theta_s|brdf\n", body.replace(',', "|"), &[]),
        // Delimiters at the ends of rows, and a dash for a minus sign.
        ("theta_i,theta_s,brdf\n", body.replace('\n', ",,\n"), &[]),
        ("theta_i,theta_s,brdf\n", body.replace('-', "\u{2013}"), &[]),
        ("", body.to_string(), &["--columns", "theta_i=1,theta_s=2,brdf=3"]),
        (
            "Alpha,Beta,Reading\n",
            body.to_string(),
            &["--columns", "theta_i=Alpha,theta_s=Beta,brdf=Reading"],
        ),
        (
            "Alpha,Beta,Reading\n",
            body.to_string(),
            &["--columns", "theta_i=1,theta_s=2,brdf=3"],
        ),
    ] {
        let file = write(&folder, "scan.csv", format!("{head}{body}"));
        let found = fit(&[&[file.as_str()], options].concat());
        assert_eq!(found["parameters"], right["parameters"], "{head}");
    }
    // What stands where there is no number is left out with the row, if that is asked for.
    for missing in ["", "NaN", "N/A", "-", "#DIV/0!", "null"] {
        let file = write(
            &folder,
            "scan.csv",
            format!("theta_i,theta_s,brdf\n{body}45,81,{missing}\n"),
        );
        assert!(fail(&["fit", &file]).contains("--drop-invalid"), "{missing}");
        let found = fit(&[&file, "--drop-invalid"]);
        assert_eq!(found["parameters"], right["parameters"], "{missing}");
        assert_eq!(found["left_out"][0]["samples"], 1, "{missing}");
    }
    let file = write(&folder, "scan.csv", body);
    let message = fail(&["fit", &file]);
    assert!(
        message.contains(":1: ") && message.contains("--columns theta_i=1"),
        "{message}"
    );
    let message = fail(&["fit", &file, "--columns", "theta_i=1,theta_s=2,brdf=4"]);
    assert!(message.contains("no column 4"), "{message}");
}
