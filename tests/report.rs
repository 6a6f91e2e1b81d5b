//! `brdfit report`, called in this process: a page that is well formed, whole, the same in every run, and needs nothing from elsewhere.

use std::fs;
use std::path::Path;

use brdfit_suite::program;

fn scan() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/testdata1_sym_seed1.csv");
    path.to_str().unwrap().to_string()
}

fn succeed(arguments: &[&str], input: &str) -> String {
    let all: Vec<&str> = ["report"].iter().chain(arguments).copied().collect();
    let ran = program::brdfit(&all, input.as_bytes());
    assert_eq!((ran.code, ran.errors.as_str()), (0, ""), "{arguments:?}");
    ran.output
}

/// The names of the elements in order; fails unless each is closed where it has to be.
fn well_formed(page: &str) -> Vec<String> {
    const VOID: [&str; 1] = ["meta"];
    let (mut open, mut seen) = (Vec::new(), Vec::new());
    for part in page
        .strip_prefix("<!DOCTYPE html>")
        .expect("a document")
        .split('<')
        .skip(1)
    {
        let (tag, text) = part.split_once('>').expect("a tag ends");
        assert!(!text.contains('>'), "{text}");
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name), "</{name}>");
            continue;
        }
        let name = tag.split([' ', '/', '\n']).next().expect("a name");
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        seen.push(name.to_string());
        if !tag.ends_with('/') && !VOID.contains(&name) {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "{open:?} stay open");
    seen
}

/// What stands between two marks.
fn between<'a>(page: &'a str, before: &str, after: &str) -> &'a str {
    let (_, rest) = page.split_once(before).unwrap_or_else(|| panic!("no {before}"));
    rest.split_once(after).unwrap_or_else(|| panic!("no {after}")).0
}

#[test]
fn is_one_whole_page() {
    let page = succeed(&[&scan()], "");
    let elements = well_formed(&page);
    let count = |name: &str| elements.iter().filter(|element| *element == name).count();
    assert_eq!((count("figure"), count("svg"), count("table")), (5, 5, 4));
    assert_eq!((count("script"), count("link"), count("img")), (0, 0, 0));
    for reference in ["http:", "https:", "src=", "@import", "url(http", "NaN", "inf "] {
        assert!(!page.contains(reference), "{reference}");
    }
    // Every clipping that is used is there once.
    for used in page.split("url(#").skip(1) {
        let name = used.split_once(')').unwrap().0;
        assert_eq!(page.matches(&format!("id=\"{name}\"")).count(), 1, "{name}");
    }
    assert!(page.len() < 300_000, "{} bytes", page.len());
}

#[test]
fn tells_what_the_fit_tells() {
    let page = succeed(&[&scan(), "--seed", "3"], "");
    let fit = program::brdfit(&["fit", &scan(), "--seed", "3", "--format", "json"], b"").output;
    let fit: serde_json::Value = serde_json::from_str(&fit).unwrap();
    let rows: Vec<&str> = between(&page, "Parameters of the best fit", "</table>")
        .split("<tr>")
        .skip(2)
        .collect();
    assert_eq!(rows.len(), 6);
    for (row, name) in rows.iter().zip(["rho_d", "rho_s", "rho_v", "m", "n", "kappa"]) {
        let cells: Vec<&str> = row
            .split("</td>")
            .map(|cell| cell.rsplit('>').next().unwrap())
            .collect();
        let exact = fit["parameters"][name].as_f64().unwrap();
        let rounded: f64 = format!("{exact:.4e}").parse().unwrap();
        assert_eq!(cells[2].parse(), Ok(rounded), "{name}");
    }
    assert!(page.contains("The scan tells of rho_s, rho_v, n and kappa only through"));
    // The paper's method with the same seed has these minima.
    let paper = program::brdfit(
        &["fit", &scan(), "--seed", "3", "--method", "paper", "--format", "json"],
        b"",
    )
    .output;
    let paper: serde_json::Value = serde_json::from_str(&paper).unwrap();
    let minima = paper["minima"].as_array().unwrap();
    let rows: Vec<&str> = between(&page, "Distinct minima of 250 fits", "</table>")
        .split("<tr>")
        .skip(2)
        .collect();
    assert_eq!(rows.len(), minima.len());
    for (row, minimum) in rows.iter().zip(minima) {
        let ends = format!("<td>{}</td><td>{}</td></tr>", minimum["hits"], minimum["first_start"]);
        assert!(row.starts_with("<td>") && row.contains(&ends), "{row} {ends}");
    }
}

#[test]
fn can_be_made_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("black paint.csv");
    fs::write(&path, fs::read(scan()).unwrap()).unwrap();
    let path = path.to_str().unwrap();
    let on = |threads: &str| {
        let page = succeed(&[path, "--quiet", "--mask-retro", "6", "--threads", threads], "");
        page.replace(&format!("--threads {threads}"), "--threads N")
    };
    let page = on("1");
    assert_eq!(page, on("3"));
    assert!(page.contains(&format!("brdfit report '{path}' --quiet --mask-retro 6 --threads N")));
    assert!(page.contains("near retro"));
}

#[test]
fn takes_several_scans_and_other_terms() {
    let text = fs::read_to_string(scan()).unwrap();
    let pages = [
        succeed(&["-", &scan(), "--terms", "diffuse,surface"], &text),
        succeed(&["-", &scan(), "--terms", "diffuse", "--precision", "f32"], &text),
    ];
    for page in pages {
        let elements = well_formed(&page);
        let figures = elements.iter().filter(|element| *element == "figure").count();
        assert_eq!(figures, 10);
        assert!(page.contains("href=\"#scan2\"") && page.contains("id=\"scan2\""));
        assert!(!page.contains("NaN"));
    }
}

#[test]
fn reports_results_of_earlier_fits() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_string();
    let bad = at("bad.csv");
    fs::write(&bad, "theta_i_deg,theta_s_deg,brdf_per_sr\n45,10,-1\n").unwrap();
    let options = ["--mask-retro", "6", "--seed", "2"];
    let direct = succeed(&[&[&scan()[..], "--quiet"], &options[..]].concat(), "");
    let made_by = |page: &str| page.replace(between(page, "<code>brdfit report", "</code>"), "");
    for name in ["results.json", "results.csv"] {
        let results = at(name);
        let good = scan();
        let all = [&["batch", &good, &bad, "--quiet", "--out", &results], &options[..]].concat();
        assert_eq!(program::brdfit(&all, b"").code, 1);
        let ran = program::brdfit(&[&["report", &results], &options[..]].concat(), b"");
        assert_eq!(ran.code, 0, "{}", ran.errors);
        assert!(
            ran.errors
                .contains(&format!("{results}: left out, as it has no fit: {bad}:2")),
            "{}",
            ran.errors
        );
        assert_eq!(made_by(&ran.output), made_by(&direct));
        // Another mask is another fit.
        let other = program::brdfit(&["report", &results], b"");
        assert_eq!((other.code, other.output.as_str()), (2, ""));
        assert!(
            other.errors.contains(" now, and ") && other.errors.contains("the options of the fit"),
            "{}",
            other.errors
        );
    }
    let one = program::brdfit(&["fit", &scan(), "--format", "json"], b"").output;
    assert_eq!(
        well_formed(&succeed(&["-"], &one)).len(),
        well_formed(&succeed(&[&scan()], "")).len()
    );
    let lost = one.replace("testdata1_sym_seed1.csv", "lost.csv");
    let ran = program::brdfit(&["report", "-"], lost.as_bytes());
    assert!(ran.code == 2 && ran.errors.contains("- names it"), "{}", ran.errors);
}

#[test]
fn writes_figures_in_each_form() {
    let folder = tempfile::tempdir().unwrap();
    let figures = folder.path().join("figures");
    succeed(&[&scan(), "--plot", figures.to_str().unwrap()], "");
    for name in ["curves", "residuals", "polar", "starts", "albedo"] {
        let svg = fs::read_to_string(figures.join(format!("1-{name}.svg"))).unwrap();
        let width: u32 = between(&svg, "width=\"", "\"").parse().unwrap();
        let png = figures.join(format!("1-{name}.png"));
        // Only a build with the feature draws PNG.
        if cfg!(feature = "png") {
            let png = fs::read(png).unwrap();
            assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
            // The header's width, twice the picture's.
            assert_eq!(u32::from_be_bytes(png[16..20].try_into().unwrap()), 2 * width);
        } else {
            assert!(!png.exists());
        }
    }
    let ran = program::brdfit(&["fit", &scan(), "--plot", "fit.pdf"], b"");
    assert_eq!(ran.code, 2);
    assert!(ran.errors.contains("let it end in .svg"), "{}", ran.errors);
    let ran = program::brdfit(&["fit", &scan(), "--plot", "/nowhere/fit.png"], b"");
    let what = if cfg!(feature = "png") {
        "/nowhere/fit.png: cannot be written: No such file or directory (os error 2); check that the folder is there"
    } else {
        "--features png"
    };
    assert!(ran.code == 2 && ran.errors.contains(what), "{}", ran.errors);
}

#[test]
fn writes_nothing_where_a_scan_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("report.html");
    let out = out.to_str().unwrap();
    let ran = program::brdfit(
        &["report", &scan(), "-", "-o", out],
        b"theta_i_deg,theta_s_deg,brdf_per_sr\n45,10,-1\n",
    );
    assert_eq!((ran.code, ran.errors.matches('\n').count()), (2, 1), "{}", ran.errors);
    assert!(ran.errors.starts_with("-:2"), "{}", ran.errors);
    assert!(!Path::new(out).exists());
    let twice = program::brdfit(&["report", "-", "-"], b"");
    assert_eq!(twice.code, 2);
    assert!(twice.errors.contains("only once"), "{}", twice.errors);
}
