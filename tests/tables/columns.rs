//! Columns by their names, and what two columns together mean.

use std::fs;

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

/// Rows of so many wavelengths in two polarisations at three angles, and those of each scan are to be found again.
fn many_wavelengths(order: impl Fn(u32) -> [u32; 3]) -> String {
    let mut text = String::from("wavelength_nm,polarisation,theta_i,theta_s,brdf\n");
    for row in 0..3 * 2 * MANY {
        let [k, polarisation, angle] = order(row);
        // One in seven is written in another way, and is the same wavelength.
        let wavelength = if row % 7 == 0 {
            format!("{}.50", 400 + k)
        } else {
            format!("{}.5", 400 + k)
        };
        let (name, theta_s) = (["s", "p"][polarisation as usize], [-40, -20, 30][angle as usize]);
        text += &format!(
            "{wavelength},{name},30,{theta_s},{}.{angle}\n",
            1 + k + MANY * polarisation
        );
    }
    text
}

/// So many that each must have its own place.
const MANY: u32 = 1000;

#[test]
fn thousands_of_scans_keep_their_rows_in_any_order() {
    let folder = folder();
    let read = |name: &str, text: &str, more: &[&str]| -> Vec<Vec<String>> {
        let path = folder.path().join(name);
        fs::write(&path, text).expect("a file");
        let path = path.to_str().expect("a path in UTF-8");
        let ran = program::brdfit(&[&["inspect", path, "--output", "-"], more].concat(), b"");
        assert_eq!(ran.code, 0, "{name}: {}", ran.errors);
        let rows = ran.output.lines().filter(|line| !line.starts_with('#')).skip(1);
        rows.map(|row| row.split(',').map(String::from).collect()).collect()
    };
    let sweeps = many_wavelengths(|row| [row / 6, row / 3 % 2, row % 3]);
    let by_angle = many_wavelengths(|row| [row % MANY, row / MANY % 2, row / (2 * MANY)]);
    let mixed = many_wavelengths(|row| {
        let row = row * 7919 % (6 * MANY);
        [row % MANY, row / MANY % 2, row / (2 * MANY)]
    });
    let sorted = |mut rows: Vec<Vec<String>>| {
        rows.sort();
        rows
    };
    let first = read("sweeps.csv", &sweeps, &[]);
    assert_eq!(first.len(), 6 * MANY as usize);
    for (k, scan) in first.chunks(3).enumerate() {
        let (k, polarisation) = (k as u32 / 2, k as u32 % 2);
        let name = format!("{}.5 nm {}", 400 + k, ["s", "p"][polarisation as usize]);
        for (angle, row) in scan.iter().enumerate() {
            let value = format!("{}.{angle}", 1 + k + MANY * polarisation);
            assert_eq!(row[0], name);
            assert_eq!(
                row[3].parse::<f64>().expect("a number"),
                value.parse::<f64>().expect("a number")
            );
        }
    }
    let first = sorted(first);
    assert_eq!(sorted(read("by_angle.csv", &by_angle, &[])), first);
    assert_eq!(sorted(read("mixed.csv", &mixed, &[])), first);
    let means = sorted(read("by_angle.csv", &by_angle, &["--polarisation", "mean"]));
    assert_eq!(means, sorted(read("sweeps.csv", &sweeps, &["--polarisation", "mean"])));
    assert_eq!(means.len(), 3 * MANY as usize);
}

#[test]
fn a_name_that_is_not_there_does_not_list_thousands() {
    let folder = folder();
    let path = folder.path().join("many.csv");
    fs::write(&path, many_wavelengths(|row| [row / 6, row / 3 % 2, row % 3])).expect("a file");
    let path = path.to_str().expect("a path in UTF-8");
    let ran = program::brdfit(&["fit", path, "--column", "399 nm"], b"");
    assert_eq!(ran.code, 2, "{}", ran.errors);
    assert!(
        ran.errors.contains("and 1990 more") && ran.errors.len() < 1000,
        "{}",
        ran.errors
    );
    // A name may be as long as a cell.
    let long = "x".repeat(5000);
    fs::write(
        path,
        format!("sample,theta_i,theta_s,brdf\n{long}1,30,20,1\n{long}2,30,20,1\n"),
    )
    .expect("a file");
    for more in [&["--column", "y"][..], &["--sample", "y"]] {
        let ran = program::brdfit(&[&["inspect", path][..], more].concat(), b"");
        assert_eq!(ran.code, 2, "{}", ran.errors);
        assert!(ran.errors.len() < 1000, "{} bytes", ran.errors.len());
    }
}

#[test]
fn remarks_that_say_other_than_the_columns_are_named() {
    let folder = folder();
    let read = |remark: &str, table: &str| {
        let path = folder.path().join("scan.csv");
        fs::write(&path, format!("{remark}\n{table}")).expect("a file");
        let path = path.to_str().expect("a path in UTF-8").to_string();
        let ran = program::brdfit(&["inspect", &path], b"");
        assert_eq!(ran.code, 0, "{remark}: {}", ran.errors);
        let fit = program::brdfit(&["fit", "--fix", "m=0.3", "--starts", "1", &path], b"");
        let said = ran.output.contains("a remark");
        assert_eq!(fit.errors.contains("a remark"), said, "{remark}: {}", fit.errors);
        ran.output
            .lines()
            .filter(|line| line.contains("a remark"))
            .map(String::from)
            .collect::<Vec<_>>()
    };
    let rows = |theta_i: i32, more: &str| -> String {
        let each = (-4..=4).map(|k| format!("{more}{theta_i},{},{}\n", 15 * k, if k == 2 { 0.5 } else { 0.1 }));
        each.collect()
    };
    let table = format!("theta_i,theta_s,brdf\n{}{}", rows(20, ""), rows(45, ""));
    for (remark, says) in [
        (
            "# theta_i = 30",
            "theta_i is 30 degrees, and the column 'theta_i' has 20 to 45",
        ),
        (
            "Incident Angle: 20",
            "theta_i is 20 degrees, and the column 'theta_i' has 20 to 45",
        ),
        ("AOI [rad]: 0.2", "theta_i is 11.45"),
        ("# phi_s = 45 deg", "names an azimuth of 45 degrees"),
    ] {
        let said = read(remark, &table);
        assert!(matches!(&said[..], [line] if line.contains(says)), "{remark}: {said:?}");
    }
    let spectral = format!(
        "wavelength_nm,theta_i,theta_s,brdf\n{}{}",
        rows(20, "550,"),
        rows(20, "633,")
    );
    let said = read("# wavelength = 550 nm", &spectral);
    assert!(
        said.len() == 2 && said[0].contains("the wavelength is 550 nm"),
        "{said:?}"
    );
    // What agrees, or says nothing of these, is no news.
    let by_block = format!(
        "theta_i,theta_s,brdf\n# theta_i = 20\n{}# theta_i = 45\n{}",
        rows(20, ""),
        rows(45, "")
    );
    let one = format!("theta_i,theta_s,brdf\n{}", rows(20, ""));
    for (remark, table) in [
        ("# made up", &table),
        ("# phi_s = 180 deg", &table),
        ("# made up", &by_block),
        ("# theta_i = 20 deg", &one),
        ("# wavelength = 550 nm", &one),
    ] {
        assert_eq!(read(remark, table), [""; 0], "{remark}");
    }
}

#[test]
fn units_stand_in_the_cells_of_angles() {
    let folder = folder();
    let path = folder.path().join("scan.csv");
    let read = |head: &str, row: &dyn Fn(f64, f64) -> String| {
        let rows: String = (-4..=4)
            .map(|k| row(f64::from(15 * k), if k == 2 { 0.5 } else { 0.1 }))
            .collect();
        fs::write(&path, format!("{head}\n{rows}")).expect("a file");
        program::brdfit(
            &["inspect", path.to_str().expect("a path in UTF-8"), "--output", "-"],
            b"",
        )
    };
    let right = read("theta_i,theta_s,brdf", &|theta_s, f| format!("20,{theta_s},{f}\n"));
    assert_eq!(right.code, 0, "{}", right.errors);
    let rows = |text: &str| {
        text.lines()
            .filter(|line| !line.starts_with('#'))
            .map(String::from)
            .collect::<Vec<_>>()
    };
    for ran in [
        read("theta_i,theta_s,brdf", &|theta_s, f| format!("20°,{theta_s}°,{f}\n")),
        read("theta_i;theta_s;brdf", &|theta_s, f| {
            format!("20 deg;{theta_s} deg;{f}\n").replace('.', ",")
        }),
        read("Einfallswinkel;Streuwinkel;BRDF", &|theta_s, f| {
            format!("20 °;{theta_s:.1} °;{f}\n").replace('.', ",")
        }),
        read("angle d'incidence,angle de diffusion,BRDF", &|theta_s, f| {
            format!("20,{theta_s},{f}\n")
        }),
    ] {
        assert_eq!(ran.code, 0, "{}", ran.errors);
        assert_eq!(rows(&ran.output), rows(&right.output));
    }
    // Another unit than the column's is no number, and a value has its unit in its name.
    for (ran, says) in [
        (
            read("theta_i,theta_s,brdf", &|theta_s, f| format!("0.3 rad,{theta_s},{f}\n")),
            "'0.3 rad' is not a number",
        ),
        (
            read("theta_i,theta_s,brf", &|theta_s, f| format!("20,{theta_s},{f}%\n")),
            "write the unit in the name of the column",
        ),
        (
            read("theta_i,theta_s,brdf", &|theta_s, f| {
                format!("20,{theta_s},\"1,000.{}\"\n", 10.0 * f)
            }),
            "without marks between their thousands",
        ),
        (
            read("theta_i;theta_s;brdf", &|theta_s, f| {
                format!("20;{theta_s};1'000.{}\n", 10.0 * f)
            }),
            "without marks between their thousands",
        ),
    ] {
        assert_eq!((ran.code, ran.output.as_str()), (2, ""));
        assert!(ran.errors.contains(says), "{}", ran.errors);
    }
}
