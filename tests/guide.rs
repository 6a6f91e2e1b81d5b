//! The README and the guide: their commands run, and their links lead somewhere.

use std::fs;
use std::path::Path;

use brdfit_suite::program;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Names and texts: the README, then the pages in the order of the guide's table, as one may use what those before it wrote.
fn pages() -> Vec<(String, String)> {
    let read = |name: &str| {
        let text = fs::read_to_string(Path::new(ROOT).join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        (name.to_string(), text)
    };
    let guide = read("host/src/guide.rs").1;
    let listed = guide
        .lines()
        .filter_map(|line| line.strip_prefix("//! | [`")?.split('`').next());
    let mut pages = vec![read("README.md")];
    pages.extend(listed.map(|page| read(&format!("host/src/guide/{page}.md"))));
    let there = fs::read_dir(Path::new(ROOT).join("host/src/guide")).unwrap().count();
    assert_eq!(pages.len(), 1 + there, "the table of host/src/guide.rs has every page");
    pages
}

/// The lines of blocks of the shell; one that ends in a backslash goes on.
fn commands(page: &str) -> Vec<String> {
    let joined = page.replace("\\\n", " ");
    let mut inside = false;
    let mut lines = Vec::new();
    for line in joined.lines() {
        if line.starts_with("```") {
            inside = line == "```sh";
        } else if inside {
            lines.push(line.to_string());
        }
    }
    lines
}

/// Where measurements stand; a test does not write there.
const RESULTS: &str = "benches/results/";
/// The page whose commands make these measurements, which takes minutes.
const MEASURED: &str = "host/src/guide/accuracy.md";

/// Those of the program; of others there is one that compares files.
#[test]
fn every_command_runs() {
    std::env::set_current_dir(ROOT).unwrap();
    fs::create_dir_all("target").unwrap();
    let mut ran = 0;
    for (page, text) in pages().into_iter().filter(|(page, _)| page != MEASURED) {
        for command in commands(&text) {
            let words = shlex::split(&command).unwrap_or_else(|| panic!("{page}: {command}"));
            let words: Vec<String> = words.iter().map(|word| word.replace(RESULTS, "target/")).collect();
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            match &words[..] {
                ["cargo", "run", "--release", "--", arguments @ ..] | ["brdfit", arguments @ ..] => {
                    let done = program::brdfit(arguments, b"");
                    assert_eq!(done.code, 0, "{page}: {command}\n{}", done.errors);
                    let written = arguments
                        .windows(2)
                        .filter(|pair| ["-o", "--out", "--output", "--plot"].contains(&pair[0]));
                    let mut files = 0;
                    for pair in written {
                        let file = fs::read(pair[1]).unwrap_or_else(|error| panic!("{page}: {command}: {error}"));
                        let kept = command.contains(&pair[1].replace("target/", RESULTS));
                        let kept = kept.then(|| fs::read(pair[1].replace("target/", RESULTS)).unwrap());
                        assert!(
                            kept.is_none_or(|kept| kept == file),
                            "{page}: {command} gives another file"
                        );
                        files += 1;
                    }
                    assert!(files > 0 || !done.output.is_empty(), "{page}: {command}");
                    ran += 1;
                }
                ["cmp", one, other] => {
                    assert!(fs::read(one).unwrap() == fs::read(other).unwrap(), "{page}: {command}");
                }
                _ => (),
            }
        }
    }
    println!("{ran} commands");
    assert!(ran >= 20);
}

/// The last command of a page's shell block, and the text that the page says it prints.
fn samples(page: &str) -> Vec<(String, String)> {
    let mut command = None;
    let mut found = Vec::new();
    for (k, block) in page.split("```").enumerate().filter(|(k, _)| k % 2 == 1) {
        match block.split_once('\n') {
            Some(("sh", _)) => command = commands(&format!("```{block}```")).pop(),
            Some(("text", text)) => {
                let command = command
                    .clone()
                    .unwrap_or_else(|| panic!("block {k}: no command prints this:\n{text}"));
                found.push((command, text.to_string()));
            }
            _ => (),
        }
    }
    found
}

/// A line without the seconds in it, which differ from run to run.
fn timeless(line: &str) -> String {
    let words: Vec<&str> = line.trim_end().split(' ').collect();
    let is_second = |k: usize| {
        words
            .get(k + 1)
            .is_some_and(|next| next.trim_end_matches([')', ',', ';']) == "s")
    };
    let each = words.iter().enumerate();
    let each = each.map(|(k, word)| {
        if is_second(k) {
            word.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.')
        } else {
            word
        }
    });
    each.collect::<Vec<_>>().join(" ")
}

/// What README and guide say that their commands print, to the last digit; JSON has a test of its own.
#[test]
fn every_sample_is_what_the_program_prints() {
    std::env::set_current_dir(ROOT).unwrap();
    let mut compared = 0;
    for (page, text) in pages() {
        for (command, sample) in samples(&text)
            .into_iter()
            .filter(|(_, sample)| !sample.starts_with('{'))
        {
            let words = shlex::split(&command).unwrap_or_else(|| panic!("{page}: {command}"));
            let arguments: Vec<&str> = words.iter().map(String::as_str).collect();
            let arguments = match &arguments[..] {
                ["cargo", "run", "--release", "--", arguments @ ..] | ["brdfit", arguments @ ..] => arguments,
                _ => panic!("{page}: '{command}' is not a command of the program"),
            };
            let ran = program::brdfit(arguments, b"");
            assert_eq!(ran.code, 0, "{page}: {command}\n{}", ran.errors);
            let [said, printed] =
                [&sample, &ran.output].map(|text| text.lines().map(timeless).collect::<Vec<_>>().join("\n"));
            assert!(
                printed.contains(&said),
                "{page}: '{command}' does not print\n{said}\nbut\n{printed}"
            );
            compared += 1;
        }
    }
    assert!(compared >= 2, "{compared} samples");
}

/// Between its dots the JSON of the guide stands in what the program prints, piece by piece.
#[test]
fn json_of_the_guide_is_what_the_program_prints() {
    let squeezed = |text: &str| text.chars().filter(|c| !c.is_whitespace()).collect::<String>();
    let page = fs::read_to_string(Path::new(ROOT).join("host/src/guide/results.md")).unwrap();
    let sample = page
        .split("```text\n{")
        .nth(1)
        .and_then(|rest| rest.split("```").next());
    let sample = squeezed(sample.expect("a sample of JSON"));
    std::env::set_current_dir(ROOT).unwrap();
    let ran = program::brdfit(&["fit", "tests/data/testdata1_sym_seed1.csv", "--format", "json"], b"");
    let printed = squeezed(&ran.output);
    let mut at = 0;
    for piece in sample.split("...") {
        // Brackets and commas beside dots part what was left out.
        let piece = piece.trim_matches([',', '}', ']', '{', '[']);
        let found = printed[at..].find(piece);
        at += found.unwrap_or_else(|| panic!("the program does not print {piece}")) + piece.len();
    }
    assert!(sample.split("...").count() > 10 && at < printed.len());
}

#[test]
fn every_link_leads_to_a_file() {
    for (page, text) in pages() {
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let path = match link.strip_prefix("https://github.com/brdfit/brdfit/blob/main/") {
                Some(path) => path,
                None if link.starts_with("https://") || link.starts_with("super::") => continue,
                None => link,
            };
            let path = path.split('#').next().unwrap_or(path);
            assert!(Path::new(ROOT).join(path).exists(), "{page}: {link}");
        }
    }
}

#[test]
fn every_file_has_the_version() {
    let version = env!("CARGO_PKG_VERSION");
    let compiler = env!("CARGO_PKG_RUST_VERSION");
    for (file, start) in [
        ("CITATION.cff", format!("version: {version}")),
        ("host/matlab/DESCRIPTION", format!("Version: {version}")),
        (
            "Cargo.toml",
            format!("brdfit-core = {{ path = \"core\", version = \"{version}\" }}"),
        ),
        ("CHANGELOG.md", format!("## [{version}] - ")),
        ("README.md", format!("They need Rust {compiler} or later")),
    ] {
        let text = fs::read_to_string(Path::new(ROOT).join(file)).unwrap();
        assert!(text.lines().any(|line| line.starts_with(&start)), "{file}: {start}");
    }
}

/// Paths below the root and texts of the Rust files in a folder, without comments and those below `tests`.
fn sources(folder: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(Path::new(ROOT).join(folder)).unwrap() {
        let name = format!("{folder}/{}", entry.unwrap().file_name().into_string().unwrap());
        if Path::new(ROOT).join(&name).is_dir() {
            found.extend(sources(&name));
        } else if name.ends_with(".rs") {
            let text = fs::read_to_string(Path::new(ROOT).join(&name)).unwrap();
            let code: Vec<&str> = text
                .lines()
                .filter(|line| !line.trim_start().starts_with("//"))
                .collect();
            found.push((name, code.join("\n")));
        }
    }
    found
}

/// The files that have `word` as a word of its own.
fn having(word: &str, files: &[(String, String)]) -> Vec<String> {
    let part = |c: char| c.is_alphanumeric() || c == '_';
    let has = |text: &str| {
        text.match_indices(word)
            .any(|(at, _)| !text[..at].ends_with(part) && !text[at + word.len()..].starts_with(part))
    };
    let mut found: Vec<String> = files
        .iter()
        .filter(|(_, text)| has(text))
        .map(|(name, _)| name.clone())
        .collect();
    found.sort();
    found
}

/// What CONTRIBUTING says of additions: what is there is named in as many files.
#[test]
fn additions_touch_as_many_files_as_contributing_says() {
    let input = sources("host/src/input");
    let formats: Vec<&str> = input
        .iter()
        .filter(|(_, text)| text.contains("pub const FORMAT"))
        .filter_map(|(name, _)| name.strip_prefix("host/src/input/formats/")?.strip_suffix(".rs"))
        .collect();
    assert!(formats.len() >= 14, "{formats:?}");
    for format in formats {
        let named = having(&format!("{format}::FORMAT"), &input);
        assert_eq!(named, ["host/src/input/formats.rs"], "{format}");
    }
    let all: Vec<_> = ["core/src", "host/src", "host/engine/src"]
        .into_iter()
        .flat_map(sources)
        .collect();
    let own = |folder: &str| -> Vec<(String, String)> {
        let files = all.iter().filter(|(name, _)| name.starts_with(folder));
        let types = files.flat_map(|(name, text)| {
            let lines = text.lines().filter_map(|line| line.strip_prefix("pub struct "));
            lines.map(move |line| (name.clone(), line.trim_end_matches(';').to_string()))
        });
        types.collect()
    };
    let models = own("core/src/models/");
    assert!(models.len() >= 5, "{models:?}");
    for (file, model) in models {
        let named = having(&model, &all);
        assert_eq!(
            named,
            ["core/src/models.rs", file.as_str(), "host/engine/src/models.rs"],
            "{model}"
        );
    }
    let column = having("worst_theta_i_deg", &all);
    assert_eq!(column, ["host/src/result/columns.rs"]);
}
