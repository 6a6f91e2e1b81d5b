//! One scan in several files, and what files say of their uncertainty.

use std::fs;

use super::{assert_is, case, fit, fits, folder, text_of};
use brdfit_suite::program::{fail, write};

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
        ("\"U, k=2 [1/sr]\"", 0.04, &[]),
    ] {
        let found = chi2(head, &|f| factor * f, options);
        assert!((found / right - 1.0).abs() < 1e-9, "{head}: {found} {right}");
    }
    for (head, value) in [
        ("u (%)", 2.0),
        ("rel. uncertainty", 0.02),
        ("\"U (k=2, %)\"", 4.0),
        ("rel. expanded uncertainty k=2 [%]", 4.0),
    ] {
        let found = chi2(head, &|_| value, &[]);
        // The deviations above are parts of the measured f, and weigh with the fitted one.
        assert!((found / right - 1.0).abs() < 0.01, "{head}: {found} {right}");
    }
    for head in ["u (10^-3 sr^-1)", "sigma [mV]"] {
        let message = fail(&["fit", &table(head, &|f| 20.0 * f)]);
        assert!(
            message.contains("is in another unit than sr^-1") && message.contains("--ignore 4"),
            "{message}"
        );
    }
    for head in ["U", "U95", "CI 95"] {
        let message = fail(&["fit", &table(head, &|f| 0.04 * f)]);
        assert!(
            message.contains("coverage factor") && message.contains("--coverage"),
            "{head}: {message}"
        );
    }
}
