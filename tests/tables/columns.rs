//! Columns by their names, and what two columns together mean.

use super::{assert_f02, assert_is, case, fit, fits, folder, parameter, text_of};
use brdfit_suite::program::{self, fail, write};

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
