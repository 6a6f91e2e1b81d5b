//! The host writes the lines that firmware writes, from the same source; `tests/firmware/run` compares microcontrollers with the same files.
//!
//! `BLESS=1 cargo test --test firmware` writes those files anew.

#[path = "firmware/programs/mod.rs"]
mod programs;

use std::path::Path;

use brdfit_core::geometry::Geometry;

#[test]
fn host_writes_the_lines_of_firmware() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/firmware/programs");
    for (name, program) in programs::PROGRAMS {
        let mut lines = String::new();
        program(&mut lines).unwrap();
        let file = folder.join(name).with_extension("out");
        if std::env::var_os("BLESS").is_some() {
            std::fs::write(&file, &lines).unwrap();
        }
        let expected = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        for (number, (ours, theirs)) in lines.lines().zip(expected.lines()).enumerate() {
            assert_eq!(ours, theirs, "{name}.out, line {}", number + 1);
        }
        assert_eq!(lines.len(), expected.len(), "{name}.out: number of lines");
    }
}

#[test]
fn table_is_what_the_host_computes() {
    let table: Vec<_> = programs::scan::samples::<f32>()
        .step_by(programs::tabled::STEP)
        .map(|sample| Geometry::new(sample.theta_i, sample.theta_s, sample.delta_phi).unwrap())
        .collect();
    if std::env::var_os("BLESS").is_some() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/firmware/programs/tabled.table");
        let rows: String = table.iter().map(|geometry| format!("    {geometry:?},\n")).collect();
        std::fs::write(file, format!("[\n{rows}]\n")).unwrap();
    }
    assert!(
        table == programs::tabled::TABLE,
        "BLESS=1 writes it anew; then once more, for what is compiled in"
    );
}

#[test]
fn a_search_in_steps_ends_as_one_in_one_call_on_every_machine() {
    // How it ended, its cost and its parameters.
    let ended = |text: &'static str| -> Vec<Vec<&str>> {
        let lines: Vec<_> = text.lines().collect();
        let fits = lines.windows(2 + programs::P);
        let converged = fits.filter(|fit| fit[0].ends_with("stop cost"));
        converged.map(<[_]>::to_vec).collect()
    };
    let in_steps = ended(include_str!("firmware/programs/steps.out"));
    assert_eq!(in_steps.len(), 2);
    assert_eq!(in_steps, ended(include_str!("firmware/programs/search.out")));
}

/// Name and version of each package of a lock file.
fn packages(lock: &str) -> Vec<(&str, &str)> {
    lock.split("[[package]]")
        .filter_map(|package| {
            let field = |key: &str| {
                let line = package.lines().find_map(|line| line.strip_prefix(key))?;
                Some(line.trim_start_matches(" = ").trim_matches('"'))
            };
            Some((field("name")?, field("version")?))
        })
        .collect()
}

#[test]
fn host_and_firmware_use_the_same_versions() {
    let host = packages(include_str!("../Cargo.lock"));
    let firmware = packages(include_str!("firmware/Cargo.lock"));
    for name in ["libm", "rand_xoshiro"] {
        let of = |list: &[(&str, &str)]| {
            list.iter()
                .find(|package| package.0 == name)
                .map(|package| package.1.to_owned())
        };
        assert!(of(&host).is_some(), "{name} is no longer there");
        assert_eq!(of(&host), of(&firmware), "{name}: run tests/firmware/run --bless");
    }
}

/// What a model of one's own takes: a formula and its parameters.
#[test]
fn a_model_of_ones_own_is_short() {
    let text = include_str!("firmware/programs/own.rs");
    let model = text
        .split_once("#[derive")
        .unwrap()
        .1
        .split_once("const ROWS")
        .unwrap()
        .0;
    let lines = model.lines().filter(|line| !line.trim().is_empty()).count();
    assert!(lines <= 25, "{lines} lines");
}
