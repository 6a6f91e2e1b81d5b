//! Tables as people have them: read right, or refused with the option that settles the doubt.

use std::fs;

use brdfit_suite::program::{self, fail, write};
use brdfit_suite::scan::data;
use serde_json::Value;
use tempfile::TempDir;

/// A file of tests/data/read.
fn case(name: &str) -> String {
    data("read").join(name).to_str().expect("a path in UTF-8").to_string()
}

fn text_of(name: &str) -> String {
    fs::read_to_string(case(name)).expect("the case is there")
}

/// The fits of what is read, a list.
fn fits(arguments: &[&str]) -> Vec<Value> {
    let ran = program::brdfit(&[&["fit", "--format", "json"], arguments].concat(), b"");
    assert_eq!(ran.code, 0, "{arguments:?}: {}", ran.errors);
    match serde_json::from_str(&ran.output).expect("JSON") {
        Value::Array(fits) => fits,
        one => vec![one],
    }
}

/// The fit of the one scan that is read.
fn fit(arguments: &[&str]) -> Value {
    let mut fits = fits(arguments);
    assert_eq!(fits.len(), 1, "{arguments:?}");
    fits.remove(0)
}

fn parameter(fit: &Value, name: &str) -> f64 {
    fit["parameters"][name].as_f64().expect("a number")
}

/// Is a value the right one, to the digits that it is given with?
fn assert_is(fit: &Value, name: &str, right: f64, half_a_digit: f64) {
    let found = parameter(fit, name);
    assert!((found - right).abs() <= half_a_digit, "{name} is {found}, not {right}");
}

/// The scattering of f02: m 0.200, rho_d 0.300, rms 0.58 %.
fn assert_f02(fit: &Value) {
    assert_is(fit, "m", 0.200, 0.001);
    assert_is(fit, "rho_d", 0.300, 0.001);
    let rms = fit["rms_ln"].as_f64().expect("a number");
    assert!((rms - 0.0058).abs() < 0.0001, "{rms}");
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a folder")
}

#[test]
fn azimuths_by_all_their_names() {
    let text = text_of("f02_phi_out_ignored.csv");
    assert_f02(&fit(&[&case("f02_phi_out_ignored.csv")]));
    let folder = folder();
    for (incidence, scattering) in [
        ("azimuth_i", "azimuth_r"),
        ("phi_inc [deg]", "phi_refl [deg]"),
        ("SAA", "VAA"),
        ("azimuth of incidence", "azimuth of scattering"),
        ("phi_i", "phi"),
        ("note", "raa"),
        ("note", "relative_azimuth"),
        ("note", "delta_azimuth (°)"),
        ("note", "phi_rel"),
        ("note", "phi_diff"),
        ("note", "azimuth"),
        ("note", "azimut [deg]"),
        ("note", "varphi_r"),
        ("note", "phi_r - phi_i"),
    ] {
        let renamed = text.replace("phi_in", incidence).replace("phi_out", scattering);
        assert_f02(&fit(&[&write(&folder, "scan.csv", renamed)]));
    }
    // What is no name of an azimuth is refused where it could be one, and can be told.
    let file = write(
        &folder,
        "scan.csv",
        text.replace("phi_out", "turn (deg)").replace(",phi_in", ",note"),
    );
    let message = fail(&["fit", &file]);
    assert!(
        message.contains(":1:4: ") && message.contains("'turn (deg)' looks like an angle"),
        "{message}"
    );
    assert_f02(&fit(&[&file, "--columns", "phi_s=4"]));
    assert_f02(&fit(&[&file, "--columns", "delta_phi=turn"]));
    let plane = program::brdfit(&["fit", &file, "--ignore", "4", "--repeats"], b"");
    assert_eq!(plane.code, 0, "{}", plane.errors);
}

#[test]
fn columns_that_could_matter_are_refused_or_named() {
    let folder = folder();
    let rows = |head: &str, other: &dyn Fn(i32) -> String| {
        let rows = (-20..=20).map(|k| format!("30,{},{},{}\n", 4 * k, 0.1 + 0.002 * f64::from(k), other(k)));
        write(
            &folder,
            "scan.csv",
            format!("theta_i,theta_s,brdf,{head}\n{}", rows.collect::<String>()),
        )
    };
    for head in [
        "tilt_deg",
        "sample rotation",
        "elevation",
        "theta_h",
        "filter wavelength centre",
        "polariser position",
        "incident_pol",
        "sample batch",
        "x (rad)",
        "units of signal",
    ] {
        let file = rows(head, &|k| (k + 30).to_string());
        let message = fail(&["fit", &file]);
        assert!(
            message.starts_with(&format!("{file}:1:4: ")) && message.contains("--ignore 4"),
            "{head}: {message}"
        );
        let ignored = fit(&[&file, "--ignore", "4"]);
        assert_eq!(ignored["not_used"], serde_json::json!([head]));
    }
    // These are harmless, and named.
    for (head, cell) in [
        ("note", ""),
        ("temperature", "x"),
        ("tilt_deg", "0"),
        ("sample batch", "A"),
        ("run", ""),
    ] {
        let file = rows(head, &|k| if cell == "x" { k.to_string() } else { cell.to_string() });
        let page = program::brdfit(&["fit", &file], b"").output;
        assert!(page.contains(&format!("not used   {head}")), "{head}: {page}");
    }
}

#[test]
fn rows_of_wavelengths_polarisations_and_samples_are_scans() {
    let found = fits(&[&case("f03_wavelength_um_merged.csv")]);
    let names: Vec<_> = found.iter().map(|fit| fit["scan"].as_str().expect("a name")).collect();
    assert_eq!(names, ["550 nm", "1064 nm"]);
    assert_is(&found[0], "rho_d", 0.400, 0.0005);
    assert_is(&found[1], "rho_d", 0.0995, 0.0005);
    let text = text_of("f03_wavelength_um_merged.csv");
    let folder = folder();
    let same = |text: String, options: &[&str]| {
        let file = write(&folder, "scan.csv", text);
        let again = fits(&[&[file.as_str()], options].concat());
        assert_eq!(again.len(), 2, "{options:?}");
        for (one, other) in found.iter().zip(&again) {
            assert_eq!(
                (&one["scan"], &one["parameters"]),
                (&other["scan"], &other["parameters"])
            );
        }
    };
    let other = |head: &str, short: &str, long: &str| {
        text.replace("wavelength_um", head)
            .replace("\n0.55,", &format!("\n{short},"))
            .replace("\n1.064,", &format!("\n{long},"))
    };
    same(other("wavelength", "0.55", "1.064"), &[]);
    same(other("lambda [nm]", "550", "1064"), &[]);
    same(other("wavelength/m", "5.5e-7", "1.064e-6"), &[]);
    same(other("wavelength (µm)", "5.5e-1", "1.0640"), &[]);
    same(other("λ (Å)", "5500", "10640"), &[]);
    same(other("wavenumber (cm^-1)", "18181.81818", "9398.496241"), &[]);
    same(other("colour", "0.55", "1.064"), &["--columns", "wavelength=1"]);
    // 550 and 550.0 are one.
    let mixed = other("nm", "550", "1064")
        .replacen("nm,", "wavelength_nm,", 1)
        .replacen("\n550,", "\n550.0,", 5)
        .replacen("\n1064,", "\n1.064e3,", 5);
    same(mixed, &[]);
    let wrong = write(&folder, "wrong.csv", other("wavelength_nm", "5.5e-7", "1.064e-6"));
    let message = fail(&["fit", &wrong]);
    assert!(
        message.contains(":2:1: ") && message.contains("--wavelength-unit m"),
        "{message}"
    );
    assert_eq!(fits(&[&wrong, "--wavelength-unit", "m"]).len(), 2);
    for (head, short, long) in [("pol", "s", "p"), ("Sample", "A", "B"), ("specimen id", "7", "8")] {
        let file = write(&folder, "rows.csv", other(head, short, long));
        let names: Vec<String> = fits(&[&file])
            .iter()
            .map(|fit| fit["scan"].as_str().expect("a name").to_string())
            .collect();
        assert_eq!(names, [short, long]);
    }
    let split = write(&folder, "split.csv", other("side", "left", "right"));
    let message = fail(&["fit", &split]);
    assert!(
        message.contains("twice at different values") && message.contains("--split 1"),
        "{message}"
    );
    assert_eq!(fits(&[&split, "--split", "side"]).len(), 2);
    assert_eq!(fits(&[&split, "--repeats"]).len(), 1);
    let run = write(&folder, "run.csv", other("run", "1", "2"));
    assert_eq!(fits(&[&run]).len(), 1);
}

#[test]
fn the_mean_of_polarisations() {
    let plain = text_of("f12_theta_0_to_360.csv");
    let right = fit(&[&case("f12_theta_0_to_360.csv")]);
    let folder = folder();
    let (mut rows, mut columns) = (
        String::from("theta_i,theta_s,pol,brdf\n"),
        String::from("theta_i,theta_s,brdf_s,brdf_p\n"),
    );
    for row in plain.lines().skip(1) {
        let (angles, value) = row.rsplit_once(',').expect("a row");
        let value: f64 = value.parse().expect("a number");
        rows += &format!("{angles},S,{}\n{angles},P,{}\n", 1.25 * value, 0.75 * value);
        columns += &format!("{angles},{},{}\n", 1.25 * value, 0.75 * value);
    }
    for text in [rows.clone(), columns] {
        let file = write(&folder, "scan.csv", text);
        assert_eq!(fits(&[&file]).len(), 2);
        let mean = fit(&[&file, "--polarisation", "mean"]);
        for name in ["rho_d", "m"] {
            assert_is(&mean, name, parameter(&right, name), 1e-9);
        }
        assert_eq!(mean["samples"], 81);
    }
    let (short, _) = rows.trim_end().rsplit_once('\n').expect("rows");
    let file = write(&folder, "short.csv", short);
    let message = fail(&["fit", &file, "--polarisation", "mean"]);
    assert!(message.contains("only s polarisation"), "{message}");
}

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
    for head in ["BRDF (mV)", "brdf [counts]", "BRDF (a.u.)", "brdf_mV", "BRDF (W/m2/sr)"] {
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

#[test]
fn one_file_per_angle_of_incidence() {
    let folder = folder();
    let [first, second] = ["scan_20.txt", "scan_45.txt"].map(|name| case(&format!("f16_one_file_per_theta_i/{name}")));
    let columns = ["--columns", "theta_s=1,brdf=2,sigma=3", "--one-scan"];
    let right = fit(&[&[first.as_str(), &second], &columns[..]].concat());
    assert_is(&right, "rho_d", 0.399, 0.0005);
    assert_is(&right, "m", 0.202, 0.0005);
    assert_eq!(
        (right["samples"].as_u64(), right["scan"].as_str()),
        (Some(162), Some("550 nm"))
    );
    // The third column is named as not used where nobody says what it is.
    let plain = fit(&[&first, &second, "--columns", "theta_s=1,brdf=2", "--one-scan"]);
    assert_eq!(plain["not_used"], serde_json::json!(["column 3"]));
    let apart = fits(&[&first, &second, "--columns", "theta_s=1,brdf=2"]);
    assert_eq!(apart.len(), 2);
    let bare = |name: &str, path: &str| {
        let text = fs::read_to_string(path)
            .expect("a file")
            .replace("Incident Angle", "Serial");
        write(&folder, name, text)
    };
    let unnamed = [bare("a.txt", &first), bare("b.txt", &second)];
    let message = fail(&[&["fit", &unnamed[0], &unnamed[1]], &columns[..]].concat());
    assert!(message.contains("--theta-i"), "{message}");
    let given = fit(&[&[unnamed[0].as_str(), &unnamed[1], "--theta-i", "20,45"], &columns[..]].concat());
    let named = [bare("aoi20_run7.txt", &first), bare("aoi45_run8.txt", &second)];
    let by_name = fit(&[&[named[0].as_str(), &named[1]], &columns[..]].concat());
    for found in [given, by_name] {
        assert_eq!(found["parameters"], right["parameters"]);
    }
    let message = fail(
        &[
            &["fit", &unnamed[0], &unnamed[1], "--theta-i", "20,45,60"],
            &columns[..],
        ]
        .concat(),
    );
    assert!(message.contains("3 angles for 2 files"), "{message}");
    // What is of several files is not ignored where each is read alone.
    let out = folder.path().join("out.csv");
    let out = out.to_str().expect("a path in UTF-8");
    let message = fail(&["batch", &first, &second, "--out", out, "--one-scan"]);
    assert!(
        message.contains("--one-scan is for several files together"),
        "{message}"
    );
    assert!(fail(&["report", &first, "--theta-i", "20,45"]).contains("reads each alone"));
    // An option that another format has no use for is not ignored.
    let other = write(&folder, "x.astm", "VARS theta_i,theta_s,R\n\n0.1,0.2,0.3\n");
    assert!(fail(&["fit", &other, "--theta-i", "20"]).contains("--theta-i is for tables"));
}

#[test]
fn uncertainties_and_their_coverage() {
    let folder = folder();
    let table = |head: &str, of: &dyn Fn(f64) -> f64| {
        let mut text = format!("theta_i,theta_s,brdf,{head}\n");
        for row in text_of("f12_theta_0_to_360.csv").lines().skip(1) {
            let value: f64 = row
                .rsplit(',')
                .next()
                .and_then(|cell| cell.parse().ok())
                .expect("a number");
            text += &format!("{row},{}\n", of(value));
        }
        write(&folder, "scan.csv", text)
    };
    let chi2 = |head: &str, of: &dyn Fn(f64) -> f64, options: &[&str]| {
        let file = table(head, of);
        fit(&[&[file.as_str()], options].concat())["chi2"]
            .as_f64()
            .expect("a number")
    };
    let right = chi2("sigma", &|f| 0.02 * f, &[]);
    for (head, factor, options) in [
        ("u", 0.02, &[][..]),
        ("U (k=2)", 0.04, &[]),
        ("U_BRDF (k = 2) [1/sr]", 0.04, &[]),
        ("std", 0.02, &[]),
        ("expanded uncertainty", 0.06, &["--coverage", "3"]),
        ("U95", 0.04, &["--coverage", "2"]),
        ("2 sigma", 0.04, &[]),
        ("u_c", 0.02, &[]),
        ("+/-", 0.02, &[]),
    ] {
        let found = chi2(head, &|f| factor * f, options);
        assert!((found / right - 1.0).abs() < 1e-9, "{head}: {found} {right}");
    }
    for (head, value) in [("u (%)", 2.0), ("rel. uncertainty", 0.02), ("\"U (k=2, %)\"", 4.0)] {
        let found = chi2(head, &|_| value, &[]);
        // The deviations above are parts of the measured f, and weigh with the fitted one.
        assert!((found / right - 1.0).abs() < 0.01, "{head}: {found} {right}");
    }
    for head in ["U", "U95", "CI 95"] {
        let message = fail(&["fit", &table(head, &|f| 0.04 * f)]);
        assert!(
            message.contains("coverage factor") && message.contains("--coverage"),
            "{head}: {message}"
        );
    }
}
