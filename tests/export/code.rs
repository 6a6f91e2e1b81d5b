//! Forms that are code or the parameters themselves.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::{LIST, NAMES, PARAMETERS, brdfit, export};
use brdfit_suite::literal;
use brdfit_suite::program;
use brdfit_suite::scan::left_out;
use brdfit_suite::tolerance::{self, check};

/// OpticStudio and FRED have ABg themselves: what they are given adds up to the model.
#[test]
fn abg_goes_to_programs_that_have_it() {
    let list = "rho_d=0.05,A=0.01,B=0.001,g=1.8";
    let export = |to: &str| {
        let arguments = [
            "export",
            "--model",
            "abg",
            "--params",
            list,
            "--name",
            "a \"b\".csv",
            "--to",
            to,
        ];
        program::succeed(&arguments)
    };
    let f = |a: f64, b: f64, g: f64, shift: f64| a / (b + libm::pow(shift, g));
    let shift = 0.3;
    let expected = 0.05 / std::f64::consts::PI + f(0.01, 0.001, 1.8, shift);
    let text = export("zemax-abg");
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split('\t').collect()).collect();
    let rows = rows.iter().filter(|row| row.len() == 6 && row[0] != "Name");
    let values = rows.map(|row| {
        let [a, b, g] = [3, 4, 5].map(|place| row[place].parse::<f64>().unwrap());
        f(a, b, g, shift)
    });
    let sum: f64 = values.sum();
    assert!((sum / expected - 1.0).abs() < 1e-14, "{text}");
    assert!(text.ends_with("2 1\nA__B__LOBE 1\nA__B__FLOOR 1\n"), "{text}");

    let text = export("fred");
    let value = |name: &str| -> f64 {
        let line = text.lines().find(|line| line.trim().starts_with(name)).unwrap();
        line.split_once(" = ").unwrap().1.parse().unwrap()
    };
    let sum = value("lambert.Refl") / std::f64::consts::PI
        + f(value("lobe.Acoef"), value("lobe.Bcoef"), value("lobe.G"), shift);
    assert!((sum / expected - 1.0).abs() < 1e-14, "{text}");
    assert!(text.contains("lobe.Name = \"a \"\"b\"\".csv ABg\""), "{text}");

    for (to, list, model, what) in [
        ("zemax-abg", LIST, "beckmann", "cannot hold the model beckmann"),
        ("fred", LIST, "ggx", "cannot hold the model ggx"),
        (
            "zemax-abg",
            "rho_d=0.05,A=0.01,B=1e-13,g=1.8",
            "abg",
            "takes no B of 1e-13",
        ),
        (
            "mitsuba",
            "rho_d=0.05,A=0.01,B=1e-3,g=1.8",
            "abg",
            "cannot hold the model abg",
        ),
        ("rust", LIST, "ggx", "cannot hold the model ggx"),
    ] {
        let message = program::fail(&["export", "--model", model, "--params", list, "--to", to]);
        assert!(message.contains(what), "{message}");
    }
}

#[test]
fn constants_have_every_bit() {
    let third = format!("rho_d={},rho_s=1e-300,rho_v=0,m=1e-6,n=1,kappa=1000000", 1.0 / 3.0);
    let expected: [f64; 6] = [1.0 / 3.0, 1e-300, 0.0, 1e-6, 1.0, 1e6];
    let export = |to: &str| brdfit(&["export", "--params", &third, "--to", to, "--name", "8 mm/Paint-a.csv"]).output;
    let header = export("c");
    let defined = |name: &str| {
        let start = format!("#define PAINT_A_{} ", name.to_uppercase());
        header
            .lines()
            .find_map(|line| line.strip_prefix(&start))
            .unwrap()
            .parse::<f64>()
            .unwrap()
    };
    let constant = export("rust");
    assert!(
        constant.contains("pub const PAINT_A: brdfit_core::brdf::Params<f64> ="),
        "{constant}"
    );
    let field = |name: &str| {
        let start = format!("    {name}: ");
        let value = constant.lines().find_map(|line| line.strip_prefix(&start)).unwrap();
        value.strip_suffix(',').unwrap().parse::<f64>().unwrap()
    };
    for (name, value) in NAMES.into_iter().zip(expected) {
        assert_eq!(
            (defined(name).to_bits(), field(name).to_bits()),
            (value.to_bits(), value.to_bits()),
            "{name}"
        );
    }
}

/// What GLSL has and C++ has not, as far as the shader uses it; in double, so that formulas are compared and not roundings.
const GLSL: &str = "
#include <algorithm>
#include <cmath>
#include <cstdio>
#define float double
using std::exp; using std::max; using std::min; using std::sqrt;
struct vec3 { double x, y, z; vec3(double a) : x(a), y(a), z(a) {} vec3(double a, double b, double c) : x(a), y(b), z(c) {} };
static vec3 operator+(vec3 a, vec3 b) { return vec3(a.x + b.x, a.y + b.y, a.z + b.z); }
static vec3 operator-(vec3 a, vec3 b) { return vec3(a.x - b.x, a.y - b.y, a.z - b.z); }
static vec3 operator*(double s, vec3 a) { return vec3(s * a.x, s * a.y, s * a.z); }
static double dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
";

const MAIN: &str = r#"
int main() {
    double i, s, p;
    while (std::scanf("%lf %lf %lf", &i, &s, &p) == 3) {
        vec3 L(std::sin(i), 0.0, std::cos(i));
        vec3 V(std::sin(s) * std::cos(p), std::sin(s) * std::sin(p), std::cos(s));
        std::printf("%.17g\n", BRDF(L, V, vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0)).x);
    }
}
"#;

#[test]
fn the_shader_is_the_model() {
    let text = export("glsl", "paint");
    assert!(text.starts_with("analytic\n"));
    let between = |begin: &str, end: &str| text.split_once(begin).unwrap().1.split_once(end).unwrap().0.to_string();
    let mut program = String::from(GLSL);
    for (line, expected) in between("::begin parameters\n", "::end parameters")
        .lines()
        .zip(PARAMETERS)
    {
        let [_, name, least, largest, value] = line.split(' ').collect::<Vec<_>>()[..] else {
            panic!("{line}")
        };
        let [least, largest, value] = [least, largest, value].map(|word| word.parse::<f64>().unwrap());
        assert!(value == expected && least <= value && value <= largest);
        program += &format!("static const double {name} = {value:?};\n");
    }
    program += &between("::begin shader", "::end shader");
    program += MAIN;
    let folder = tempfile::tempdir().unwrap();
    let (source, binary) = (folder.path().join("shader.cpp"), folder.path().join("shader"));
    fs::write(&source, program).unwrap();
    let compiled = Command::new("c++").arg(&source).arg("-o").arg(&binary).output();
    let Ok(compiled) = compiled else {
        left_out("the BRDF Explorer shader", Path::new("c++"));
        return;
    };
    assert!(
        compiled.status.success(),
        "{}",
        String::from_utf8_lossy(&compiled.stderr)
    );
    let mut directions = Vec::new();
    for i in (0..=80).step_by(10) {
        for s in (2..=82).step_by(8) {
            for p in (0..=180).step_by(18) {
                directions.push([i, s, p].map(|degrees| f64::from(degrees).to_radians()));
            }
        }
    }
    let list: String = directions
        .iter()
        .map(|[i, s, p]| format!("{i:?} {s:?} {p:?}\n"))
        .collect();
    fs::write(folder.path().join("in"), list).unwrap();
    let input = fs::File::open(folder.path().join("in")).unwrap();
    let output = Command::new(&binary).stdin(input).output().unwrap();
    let values = String::from_utf8(output.stdout).unwrap();
    let values: Vec<f64> = values.lines().map(|line| line.parse().unwrap()).collect();
    assert_eq!(values.len(), directions.len());
    let each = values
        .iter()
        .zip(directions)
        .map(|(value, at)| (value / literal::f(at, PARAMETERS) - 1.0).abs());
    check(each.fold(0.0, f64::max), tolerance::SHADER);
}

#[test]
fn mitsuba_has_every_bit_and_tells_its_deviation() {
    let exact = export("mitsuba", "My paint.csv");
    assert!(exact.contains("NAME = \"my_paint\"\n"));
    for (name, value) in NAMES.into_iter().zip(PARAMETERS) {
        assert!(exact.contains(&format!("    \"{name}\": {value:?},\n")));
    }
    let native = |list: &str| {
        let ran = brdfit(&["export", "--params", list, "--to", "mitsuba-native"]);
        assert_eq!(ran.code, 0);
        assert!(ran.output.contains(ran.errors.trim_end()));
        let words: Vec<&str> = ran.errors.split(' ').collect();
        let number = |place: usize| words[place].parse::<f64>().unwrap();
        (number(4), number(6), ran.output)
    };
    let (least, largest, text) = native(LIST);
    // It has no volume lobe: there it is far off, so that it is near everywhere else.
    assert!(
        -88.0 < least && least < -82.0 && 20.0 < largest && largest < 27.0,
        "{text}"
    );
    let half = text.split_once("half within ").unwrap().1.split_once(' ').unwrap().0;
    assert!(half.parse::<f64>().unwrap() < 4.0, "{half}");
    let alpha = text.split_once("\"alpha\": ").unwrap().1;
    let alpha: f64 = alpha.split_once(',').unwrap().0.parse().unwrap();
    assert!((alpha / 0.1 - 1.0).abs() < 0.05, "{alpha}");
    // Without lobes that differ, nothing does.
    let (least, largest, _) = native("rho_d=0.5,rho_s=0,rho_v=0,m=0.1,n=1.5,kappa=0");
    assert_eq!((least, largest), (0.0, 0.0));
    // Rougher facets are masked, and so differ in another way than smooth ones.
    let (smooth, rough) = (
        native("rho_d=0,rho_s=1,rho_v=0,m=0.01,n=1.5,kappa=0"),
        native("rho_d=0,rho_s=1,rho_v=0,m=0.5,n=1.5,kappa=0"),
    );
    assert!(smooth.1 < rough.1, "{} {}", smooth.1, rough.1);
}
