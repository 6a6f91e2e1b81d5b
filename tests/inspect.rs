//! `brdfit inspect`: what was read, the program's own table, and hints.

use std::fs;
use std::path::PathBuf;

use brdfit_suite::program::{fail, succeed, write};
use brdfit_suite::scan::{data, left_out, shared};
use serde_json::Value;

fn case(name: &str) -> String {
    data("read").join(name).to_str().expect("a path in UTF-8").to_string()
}

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&succeed(&[arguments, &["--format", "json"]].concat())).expect("JSON")
}

/// What the hints of a scan or a fit are about.
fn hints(found: &Value) -> Vec<String> {
    let hints = found["hints"].as_array().into_iter().flatten();
    hints
        .map(|hint| hint["about"].as_str().expect("a word").to_string())
        .collect()
}

fn files(folder: PathBuf) -> Vec<String> {
    let mut files: Vec<String> = fs::read_dir(folder)
        .expect("a folder")
        .filter_map(|entry| Some(entry.ok()?.path().to_str()?.to_string()))
        .filter(|path| path.ends_with(".csv"))
        .collect();
    files.sort();
    files
}

/// Files without a fault: those of the project, and measured ones where they are there.
fn good_files() -> Vec<String> {
    let mut good = files(data(""));
    good.retain(|path| path.contains("testdata"));
    let real = shared("real");
    if real.exists() {
        good.extend(files(real));
    } else {
        left_out("hints on measured files", &real);
    }
    good
}

#[test]
fn says_what_was_read() {
    let file = case("f02_phi_out_ignored.csv");
    let page = succeed(&["inspect", &file]);
    for line in [
        "  read as    table with named columns: the BRDF over degrees, specular peak at theta_s = +theta_i\n",
        "  columns      1 theta_in             theta_i\n",
        "               4 phi_out              phi_s\n",
        "  samples    442\n",
    ] {
        assert!(page.contains(line), "{page}");
    }
    let found = json(&["inspect", &file]);
    assert_eq!(
        (&found["samples"], &found["columns"][2]["holds"]),
        (&442.into(), &"theta_s".into())
    );
    let angle = &found["angles"][0];
    assert_eq!(
        (&angle["theta_i_deg"], &angle["theta_s_deg"][1]),
        (&20.0.into(), &80.0.into())
    );
    assert!(angle["in_plane"].as_u64() < angle["samples"].as_u64() && angle["delta_phi_deg"][1] == 180.0);
    let text = fs::read_to_string(&file)
        .expect("the case is there")
        .replace("phi_in", "note");
    let folder = tempfile::tempdir().expect("a folder");
    let page = succeed(&["inspect", &write(&folder, "scan.csv", text), "--max-angle", "70"]);
    assert!(
        page.contains("  not used   note\n") && page.contains("  left out   "),
        "{page}"
    );
}

#[test]
fn its_own_table_reads_back_to_the_same_bits() {
    let folder = tempfile::tempdir().expect("a folder");
    let parts = ["scan_20.txt", "scan_45.txt"].map(|name| case(&format!("f16_one_file_per_theta_i/{name}")));
    let cases: [(&[&str], usize); 6] = [
        (&[&case("f02_phi_out_ignored.csv")], 1),
        (&[&case("f03_wavelength_um_merged.csv")], 2),
        (&[&case("f04_percent.csv")], 1),
        (&[&case("f05_forward_negative.csv"), "--forward", "negative"], 1),
        (&[&case("f07_astm_vars_without_phi_s.astm")], 1),
        (
            &[
                &parts[0],
                &parts[1],
                "--one-scan",
                "--columns",
                "theta_s=1,brdf=2,sigma=3",
            ],
            1,
        ),
    ];
    for (arguments, scans) in cases {
        let table = folder.path().join("own.csv");
        let table = table.to_str().expect("a path in UTF-8");
        succeed(&[&["inspect"], arguments, &["--output", table]].concat());
        let fits = |arguments: &[&str]| -> Vec<Value> {
            let found = json(&[&["fit"], arguments].concat());
            found.as_array().cloned().unwrap_or_else(|| vec![found])
        };
        let (first, again) = (fits(arguments), fits(&[table]));
        assert_eq!((first.len(), again.len()), (scans, scans));
        for (first, again) in first.iter().zip(&again) {
            for key in ["scan", "samples", "mse2", "parameters", "uncertainty", "chi2", "minima"] {
                assert_eq!(first[key], again[key], "{arguments:?} {key}");
            }
        }
        // What is written of what was written is the same.
        let text = fs::read_to_string(table).expect("the table");
        let second = succeed(&["inspect", table, "--output", "-"]);
        let rows = |text: &str| -> Vec<String> {
            text.lines()
                .filter(|line| !line.starts_with("# from"))
                .map(String::from)
                .collect()
        };
        assert_eq!(rows(&second), rows(&text), "{arguments:?}");
    }
    let file = case("f04_percent.csv");
    assert!(fail(&["inspect", &file, "-o", &file]).contains("input"));
}

#[test]
fn draws_what_was_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = folder.path().join("scan.svg");
    let path = picture.to_str().expect("a path in UTF-8");
    succeed(&[
        "inspect",
        &case("f12_theta_0_to_360.csv"),
        "--plot",
        path,
        "--max-angle",
        "60",
    ]);
    let svg = fs::read_to_string(&picture).expect("a picture");
    let found = json(&["inspect", &case("f12_theta_0_to_360.csv"), "--max-angle", "60"]);
    let dropped: u64 = found["left_out"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(|one| one["samples"].as_u64())
        .sum();
    assert_eq!(found["samples"].as_u64().map(|kept| kept + dropped), Some(81));
    assert!(
        svg.contains(&format!("measured ({})", found["samples"])) && svg.contains(&format!("left out ({dropped})"))
    );
    assert!(fail(&["inspect", &case("f03_wavelength_um_merged.csv"), "--plot", path]).contains("one scan"));
}

#[test]
fn good_files_have_no_hints() {
    for file in good_files() {
        let found = json(&["inspect", &file]);
        let hints = hints(&found);
        assert!(hints.is_empty(), "{file}: {hints:?}");
    }
    // Another model does fit some of the measured ones better; nothing else is to be said of them.
    for file in good_files().iter().filter(|file| !file.contains("testdata")) {
        let found = json(&["fit", file]);
        let rms = found["rms_ln"].as_f64().expect("a number");
        let expected: &[&str] = if rms >= 0.3 { &["model"] } else { &[] };
        assert_eq!(hints(&found), expected, "{file}: {}", found["hints"]);
    }
    for name in [
        "f02_phi_out_ignored.csv",
        "f04_percent.csv",
        "f10_theta_i_rounded.csv",
        "f11_residual_axis.csv",
        "f17_out_of_plane_plot.csv",
    ] {
        assert!(hints(&json(&["fit", &case(name)])).is_empty(), "{name}");
    }
    for seed in 1..=3 {
        for set in 1..=3 {
            let file = data(&format!("testdata{set}_sym_seed{seed}.csv"));
            assert!(
                hints(&json(&["fit", file.to_str().expect("a path")])).is_empty(),
                "{file:?}"
            );
        }
    }
}

#[test]
fn an_offset_of_the_zero_is_seen_with_its_size() {
    let file = case("f09_angle_offset_3deg.csv");
    let found = json(&["fit", &file]);
    assert_eq!(hints(&found), ["offset"]);
    let text = found["hints"][0]["text"].as_str().expect("a text");
    let size: f64 = text
        .split_once("theta_i ")
        .and_then(|(_, rest)| rest.split(' ').next()?.parse().ok())
        .expect("a size");
    assert!((size + 3.0).abs() < 0.1, "{text}");
    assert_eq!(hints(&json(&["inspect", &file])), ["offset"]);
    // With the offset undone: m 0.0601, rms 1.2 %.
    let folder = tempfile::tempdir().expect("a folder");
    let moved = |by: f64| {
        let rows = fs::read_to_string(&file).expect("the case is there");
        let rows = rows.lines().skip(1).filter_map(|row| {
            let mut cells = row.split(',');
            let (theta_i, theta_s, brdf) = (cells.next()?, cells.next()?.parse::<f64>().ok()? + by, cells.next()?);
            (theta_s.abs() < 90.0).then(|| format!("{theta_i},{theta_s},{brdf}\n"))
        });
        write(
            &folder,
            "moved.csv",
            format!("theta_i,theta_s,brdf\n{}", rows.collect::<String>()),
        )
    };
    let right = json(&["fit", &moved(3.0)]);
    let m = right["parameters"]["m"].as_f64().expect("a number");
    assert!(
        (m - 0.0601).abs() < 5e-4 && hints(&right).is_empty(),
        "{m} {:?}",
        hints(&right)
    );
    for by in [-3.0, 1.0, 5.0] {
        assert_eq!(
            hints(&json(&["fit", &moved(by)])).first().map(String::as_str),
            Some("offset"),
            "{by}"
        );
    }
}

#[test]
fn a_shadow_around_retro_is_seen() {
    let raw = shared("real/raw");
    if !raw.exists() {
        left_out("shadows in measured files", &raw);
        return;
    }
    for name in [
        "rt300s_aeroglaze_z307_run1.csv",
        "rt300s_magic_black.csv",
        "rt300s_singularity_black_run1.csv",
    ] {
        let file = raw.join(name);
        let file = file.to_str().expect("a path in UTF-8");
        let found = json(&["inspect", file, "--drop-invalid"]);
        assert!(
            hints(&found).contains(&"shadow".to_string()),
            "{name}: {:?}",
            found["hints"]
        );
        let masked = json(&["inspect", file, "--drop-invalid", "--mask-retro", "6"]);
        assert!(!hints(&masked).contains(&"shadow".to_string()), "{name}");
    }
    let file = raw.join("rt300s_aeroglaze_z307_run1.csv");
    assert!(fail(&["inspect", file.to_str().expect("a path")]).contains("--mask-retro 6"));
}

#[test]
fn what_is_no_brdf_or_another_model_is_seen() {
    let folder = tempfile::tempdir().expect("a folder");
    // Reflectance factors of a bright diffuse sample under the name of a BRDF.
    let rows = |value: &dyn Fn(f64, f64) -> f64| -> String {
        let mut text = String::from("theta_i,theta_s,brdf\n");
        for theta_i in [15.0, 45.0] {
            for k in -20..=20 {
                let theta_s = 4.0 * f64::from(k);
                text += &format!("{theta_i},{theta_s},{}\n", value(theta_i, theta_s));
            }
        }
        text
    };
    let bright = write(&folder, "bright.csv", rows(&|_, theta_s| 0.6 + 0.001 * theta_s));
    let found = json(&["fit", &bright]);
    assert!(hints(&found).contains(&"quantity".to_string()), "{:?}", found["hints"]);
    assert!(found["hints"].to_string().contains("--quantity brf"));
    assert!(!hints(&json(&["fit", &bright, "--quantity", "brf"])).contains(&"quantity".to_string()));
    let strange = write(
        &folder,
        "strange.csv",
        rows(&|theta_i, theta_s| {
            0.1 + if (theta_s + 2.0 * theta_i) % 24.0 < 4.0 {
                0.4
            } else {
                0.0
            }
        }),
    );
    let found = json(&["fit", &strange]);
    assert!(hints(&found).contains(&"model".to_string()) && found["hints"].to_string().contains("brdfit compare"));
    let table = succeed(&["fit", &strange, "--format", "csv"]);
    let head: Vec<&str> = table.lines().next().expect("a head").split(',').collect();
    assert!(
        head.contains(&"left_out") && head.contains(&"hints") && table.contains("brdfit compare"),
        "{table}"
    );
    let page = succeed(&["fit", &strange]);
    assert!(page.contains("\n  hint       the residual is"), "{page}");
}

#[test]
fn tables_and_pictures_show_what_was_fitted() {
    let page = succeed(&["fit", &case("f10_theta_i_rounded.csv")]);
    let table = page.split_once("theta_i  rho_s F").expect("the table").1;
    for angle in ["22.3", "22.6", "41.4", "67.5"] {
        assert!(
            table.lines().any(|line| line.split_whitespace().next() == Some(angle)),
            "{table}"
        );
    }
    let folder = tempfile::tempdir().expect("a folder");
    let picture = folder.path().join("scan.svg");
    let path = picture.to_str().expect("a path in UTF-8");
    succeed(&["fit", &case("f17_out_of_plane_plot.csv"), "--plot", path]);
    let svg = fs::read_to_string(&picture).expect("a picture");
    let inspected = json(&["inspect", &case("f17_out_of_plane_plot.csv")]);
    let planes = inspected["angles"].as_array().expect("angles").len();
    // One panel in plane and one out of it for each angle of incidence.
    assert_eq!(svg.matches("<g transform=\"translate(").count(), 2 * planes);
    assert!(svg.contains("out of the plane of incidence"));
    let pictures = folder.path().join("figures");
    let page = folder.path().join("page.html");
    let [figures, page] = [&pictures, &page].map(|path| path.to_str().expect("a path in UTF-8"));
    succeed(&["report", &case("f11_residual_axis.csv"), "-o", page, "--plot", figures]);
    let residuals = fs::read_to_string(pictures.join("1-residuals.svg")).expect("a figure");
    // Labels of the vertical axis end at the left border; both panels share those of the first.
    assert!(residuals.matches("text-anchor=\"end\"").count() >= 3, "{residuals}");
}
