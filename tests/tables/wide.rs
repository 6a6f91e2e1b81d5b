//! One angle a column, and names in two lines.

use super::*;

/// Angles of incidence, scattering angles, and the BRDF at each pair.
const ANGLES: [u32; 2] = [20, 40];
const ROWS: [(i32, [f64; 2]); 5] = [
    (-40, [0.1, 0.12]),
    (0, [0.11, 0.13]),
    (20, [0.3, 0.14]),
    (40, [0.12, 0.4]),
    (60, [0.115, 0.2]),
];

/// The name of a scan, and its samples.
type Read = (String, Vec<[f64; 3]>);

/// The samples of each scan in a table, as the program writes them: theta_i, theta_s and BRDF, sorted.
fn read(name: &str, text: &str, more: &[&str]) -> Result<Vec<Read>, String> {
    let folder = folder();
    let path = folder.path().join(name);
    fs::write(&path, text).expect("a file");
    let path = path.to_str().expect("a path in UTF-8");
    let ran = program::brdfit(&[&["inspect", path, "--output", "-"], more].concat(), b"");
    if ran.code != 0 {
        assert_eq!((ran.code, ran.output.as_str()), (2, ""), "{name}");
        return Err(ran.errors);
    }
    let rows = ran.output.lines().filter(|line| !line.starts_with('#')).skip(1);
    let mut scans: Vec<Read> = Vec::new();
    for row in rows {
        let cells: Vec<&str> = row.split(',').collect();
        let numbers: Vec<f64> = cells.iter().filter_map(|cell| cell.parse().ok()).collect();
        let scan = if numbers.len() < cells.len() { cells[0] } else { "" };
        let place = scans.iter().position(|(name, _)| name == scan).unwrap_or_else(|| {
            scans.push((scan.to_string(), Vec::new()));
            scans.len() - 1
        });
        scans[place].1.push([numbers[0], numbers[1], numbers[2]]);
    }
    for (_, samples) in &mut scans {
        samples.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    }
    Ok(scans)
}

fn right() -> Vec<[f64; 3]> {
    let mut all = Vec::new();
    for (k, theta_i) in ANGLES.into_iter().enumerate() {
        all.extend(ROWS.map(|(theta_s, values)| [f64::from(theta_i), f64::from(theta_s), values[k]]));
    }
    all
}

/// Rows of a table below its head.
fn rows(row: impl Fn(i32, [f64; 2]) -> String) -> String {
    ROWS.map(|(theta_s, values)| row(theta_s, values)).join("\n") + "\n"
}

#[test]
fn an_angle_a_column_is_read_by_all_its_names() {
    let commas = rows(|theta_s, [a, b]| format!("{theta_s},{a},{b}"));
    let spaces = rows(|theta_s, [a, b]| format!("{theta_s} {a} {b}"));
    let semicolons = rows(|theta_s, [a, b]| format!("{theta_s};{a};{b}").replace('.', ","));
    let deviations = rows(|theta_s, [a, b]| format!("{theta_s},{a},0.01,{b},0.02"));
    for head in [
        "theta_s,brdf_20,brdf_40",
        "theta_s,BRDF 20,BRDF 40",
        "Scattering angle [deg],BRDF at 20 deg [1/sr],BRDF at 40 deg [1/sr]",
        "theta_s,BRDF (theta_i = 20°),BRDF (theta_i = 40°)",
        "theta_s,AOI 20,AOI 40",
        "theta_s,brdf_20deg,brdf_40deg",
        // Names in two lines: units and angles, merged cells, names that go on.
        "theta_s,BRDF,BRDF\ndeg,20,40",
        "theta_s,BRDF,\n,20,40",
        "Scattering,BRDF at,BRDF at\nangle,20 deg,40 deg",
        ",20,40\ntheta_s,brdf,brdf",
        ",AOI 20,AOI 40\ntheta_s,brdf,brdf",
        "# theta_s,brdf,brdf\n# deg,20,40",
        "theta_s\nbrdf_20,brdf_40",
    ] {
        let scans =
            read("paint.csv", &format!("{head}\n{commas}"), &[]).unwrap_or_else(|error| panic!("{head}: {error}"));
        assert_eq!(scans, [(String::new(), right())], "{head}");
    }
    for text in [
        format!("theta_s brdf_20 brdf_40\n{spaces}"),
        format!("theta_s\nbrdf_20 brdf_40\n{spaces}"),
        format!("theta_s;BRDF (20°);BRDF (40°)\n{semicolons}"),
        format!("theta_s,brdf_20deg,u_20deg,brdf_40deg,u_40deg\n{deviations}"),
        format!(",AOI 20,,AOI 40,\ntheta_s,brdf,u,brdf,u\n{deviations}"),
    ] {
        let scans = read("paint.csv", &text, &["--weights", "equal"]).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(scans, [(String::new(), right())], "{text}");
    }
    // Scattering angles in the columns, a row for each angle of incidence.
    let mut text = String::from("theta_i");
    ROWS.iter().for_each(|(theta_s, _)| text += &format!(",brdf_{theta_s}"));
    for (k, theta_i) in ANGLES.into_iter().enumerate() {
        text += &format!("\n{theta_i}");
        ROWS.iter().for_each(|(_, values)| text += &format!(",{}", values[k]));
    }
    assert_eq!(read("paint.csv", &text, &[]).unwrap(), [(String::new(), right())]);
}

#[test]
fn channels_at_an_angle_each_are_a_scan_each() {
    let body = rows(|theta_s, [a, b]| format!("{theta_s},{a},{},{b},{}", 2.0 * a, 2.0 * b));
    let twice: Vec<[f64; 3]> = right().into_iter().map(|[i, s, f]| [i, s, 2.0 * f]).collect();
    for head in [
        ",20,20,40,40\ntheta_s,R,G,R,G",
        "theta_s,R_20,G_20,R_40,G_40",
        "theta_s,R 20deg,G 20deg,R 40deg,G 40deg",
    ] {
        let scans =
            read("paint.csv", &format!("{head}\n{body}"), &[]).unwrap_or_else(|error| panic!("{head}: {error}"));
        let expected = [("R".to_string(), right()), ("G".to_string(), twice.clone())];
        assert_eq!(scans, expected, "{head}");
    }
}

#[test]
fn names_go_on_in_a_second_line() {
    let body = "20,-40,0.1\n20,0,0.11\n20,20,0.3\n20,40,0.12\n20,60,0.115\n";
    let expected: Vec<[f64; 3]> = right().into_iter().filter(|sample| sample[0] == 20.0).collect();
    for head in [
        "Angle of,Scattering,BRDF\nincidence,angle,(1/sr)",
        "theta_i,theta_s,brdf\ndeg,deg,1/sr",
        "theta,theta,BRDF\ni,s,",
        "# Angle of,Scattering,BRDF\n# incidence,angle,(1/sr)",
    ] {
        let scans =
            read("paint.csv", &format!("{head}\n{body}"), &[]).unwrap_or_else(|error| panic!("{head}: {error}"));
        assert_eq!(scans, [(String::new(), expected.clone())], "{head}");
    }
}

#[test]
fn numbers_that_may_be_something_else_are_refused() {
    let body = rows(|theta_s, [a, b]| format!("{theta_s},{a},{b}"));
    for (name, head, more, says) in [
        // Counts, wavelengths in micrometres, or angles.
        ("paint_20.csv", "theta_s,brdf_1,brdf_2", &[][..], "brdf_20deg"),
        ("paint_20.csv", "theta_s,brdf_0.55,brdf_10.6", &[], "brdf_10.6um"),
        (
            "paint.csv",
            "theta_s,brdf_20,brdf_40",
            &["--theta-i", "30"],
            "--theta-i",
        ),
        ("paint.csv", "# AOI: 30\ntheta_s,brdf_20,brdf_40", &[], "remark"),
        ("paint.csv", "theta_s,brdf_20,x_40", &[], "x_40"),
    ] {
        match read(name, &format!("{head}\n{body}"), more) {
            Err(error) => assert!(error.contains(says) && error.lines().count() == 1, "{head}: {error}"),
            // A column that is no value is only named.
            Ok(scans) => assert!(says == "x_40" && scans[0].1.len() == ROWS.len(), "{head}"),
        }
    }
    // The name of the file is none of their business, and wavelengths stay wavelengths.
    let scans = read("paint_30.csv", &format!("theta_s,brdf_20,brdf_40\n{body}"), &[]).unwrap();
    assert_eq!(scans, [(String::new(), right())]);
    let scans = read("paint_30.csv", &format!("theta_s,brdf_450,brdf_550\n{body}"), &[]).unwrap();
    assert_eq!(scans.len(), 2);
    let scans = read(
        "paint_30.csv",
        &format!("theta_s,brdf_0.55,brdf_10.6\n{body}"),
        &["--wavelength-unit", "um"],
    )
    .unwrap();
    assert_eq!(scans.len(), 2);
    // Radians beside angles that heads give in degrees are radians.
    let radians = rows(|theta_s, [a, b]| format!("{:.6},{a},{b}", f64::from(theta_s).to_radians()));
    let error = read("paint.csv", &format!("theta_s,brdf_20deg,brdf_40deg\n{radians}"), &[]).unwrap_err();
    assert!(error.contains("radians") && error.contains("--angles"), "{error}");
    let scans = read(
        "paint.csv",
        &format!("theta_s_rad,brdf_20deg,brdf_40deg\n{radians}"),
        &[],
    )
    .unwrap();
    assert!((scans[0].1[0][0].to_degrees() - 20.0).abs() < 1e-9 || scans[0].1[0][0] == 20.0);
}

#[test]
fn cells_that_are_filled_once_are_told() {
    let text = "theta_i,theta_s,brdf\n20,-40,0.1\n,0,0.11\n,20,0.3\n40,-40,0.12\n,0,0.13\n";
    let error = read("paint.csv", text, &[]).unwrap_err();
    assert!(error.contains(":3:1: ") && error.contains("merged cells"), "{error}");
}
