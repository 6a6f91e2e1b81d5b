//! Modules import in one direction: there is no circle of them in any crate.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// What each module of a crate imports, by the path of its file below `src`; that a module shows what is below it is no import.
type Imports = BTreeMap<Vec<String>, BTreeSet<Vec<String>>>;

/// Files below a folder with their paths as modules; the crate itself is the empty path.
fn modules(folder: &Path, above: &[String], found: &mut BTreeMap<Vec<String>, String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_string();
        let below = |name: String| above.iter().cloned().chain([name]).collect::<Vec<_>>();
        if path.is_dir() {
            modules(&path, &below(name), found);
        } else if path.extension().is_some_and(|end| end == "rs") && name != "main" {
            let text = fs::read_to_string(&path).unwrap();
            let text = text.split("#[cfg(test)]").next().unwrap();
            let lines = text.lines().filter(|line| !line.trim_start().starts_with("//"));
            let module = if name == "lib" { Vec::new() } else { below(name) };
            found.insert(module, lines.collect::<Vec<_>>().join("\n"));
        }
    }
}

/// The paths of a tree of imports: `a::{b, c::d}` has two.
fn paths(tree: &str) -> Vec<String> {
    let tree = tree.trim();
    let Some((before, inside)) = tree.strip_suffix('}').and_then(|tree| tree.split_once('{')) else {
        return vec![tree.split(" as ").next().unwrap().to_string()];
    };
    let (mut parts, mut depth, mut begun) = (Vec::new(), 0, 0);
    for (place, letter) in inside.char_indices() {
        match letter {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&inside[begun..place]);
                begun = place + 1;
            }
            _ => {}
        }
    }
    parts.push(&inside[begun..]);
    let parts = parts.into_iter().filter(|part| !part.trim().is_empty());
    parts
        .flat_map(paths)
        .map(|part| match part.as_str() {
            "self" => before.trim_end_matches("::").to_string(),
            part => format!("{before}{part}"),
        })
        .collect()
}

/// A path from the root of the crate; none of another crate.
fn absolute(module: &[String], path: &str, all: &BTreeMap<Vec<String>, String>) -> Option<Vec<String>> {
    let words: Vec<String> = path.split("::").map(str::to_string).collect();
    let supers = words.iter().take_while(|word| *word == "super").count();
    let (from, rest) = match words[0].as_str() {
        "crate" => (&module[..0], &words[1..]),
        "self" => (module, &words[1..]),
        "super" => (&module[..module.len().checked_sub(supers)?], &words[supers..]),
        _ => (module, &words[..]),
    };
    let is_own = ["crate", "self", "super"].contains(&words[0].as_str());
    let child = [module, &words[..1]].concat();
    (is_own || all.contains_key(&child)).then(|| [from, rest].concat())
}

/// The imports of the crate below `src`, where what a module shows of others leads to where it stands.
fn imports(src: &Path) -> Imports {
    let mut all = BTreeMap::new();
    modules(src, &[], &mut all);
    let (mut used, mut shown) = (Vec::new(), BTreeMap::new());
    for (module, text) in &all {
        // What is written out in an expression is imported too.
        let mut rest = String::new();
        for statement in text.split_inclusive(';') {
            let line = statement.trim_start();
            let line = line.rfind("\nuse ").map_or(line, |place| &line[place + 1..]);
            let line = line.rfind("\npub use ").map_or(line, |place| &line[place + 1..]);
            let (is_shown, tree) = match line.strip_prefix("pub use ") {
                Some(tree) => (true, tree),
                None => match line
                    .strip_prefix("use ")
                    .or_else(|| line.strip_prefix("pub(crate) use "))
                {
                    Some(tree) => (false, tree),
                    None => {
                        rest.push_str(statement);
                        continue;
                    }
                },
            };
            for path in paths(tree.trim_end_matches(';')) {
                let Some(path) = absolute(module, &path, &all) else {
                    continue;
                };
                if let Some(name) = path.last().filter(|_| is_shown) {
                    shown.insert([&module[..], std::slice::from_ref(name)].concat(), path.clone());
                } else {
                    used.push((module, path));
                }
            }
        }
        for start in ["crate::", "super::"] {
            for (place, _) in rest.match_indices(start) {
                let end = rest[place..].find(|letter: char| !letter.is_alphanumeric() && !"_:".contains(letter));
                let path = rest[place..]
                    .split_at(end.unwrap_or(rest.len() - place))
                    .0
                    .trim_end_matches(':');
                used.extend(absolute(module, path, &all).map(|path| (module, path)));
            }
        }
    }
    let mut imports = Imports::new();
    for (module, mut path) in used {
        // The longest module that a path begins with; a name that it only shows leads on.
        for _ in 0..8 {
            let length = (0..=path.len()).rev().find(|&length| all.contains_key(&path[..length]));
            let length = length.expect("the crate itself begins every path");
            match shown.get(&path[..path.len().min(length + 1)]) {
                Some(shown) if length < path.len() => path = [&shown[..], &path[length + 1..]].concat(),
                _ => {
                    path.truncate(length);
                    break;
                }
            }
        }
        if *module != path {
            imports.entry(module.clone()).or_default().insert(path);
        }
    }
    imports
}

/// Modules that import themselves through others.
fn circle(imports: &Imports) -> Vec<Vec<String>> {
    let mut left: BTreeSet<&Vec<String>> = imports.keys().collect();
    // What imports nothing that is left is in no circle.
    while let Some(&free) = left
        .iter()
        .find(|module| !imports[**module].iter().any(|other| left.contains(other)))
    {
        left.remove(free);
    }
    left.into_iter().cloned().collect()
}

#[test]
fn no_crate_has_a_circle() {
    for crate_of in ["core", "host/engine", "host", "host/web", "host/python"] {
        let src = Path::new(env!("CARGO_MANIFEST_DIR")).join(crate_of).join("src");
        let imports = imports(&src);
        assert!(imports.len() > 3, "{crate_of}: {imports:?}");
        let left = circle(&imports);
        let names: Vec<String> = left.iter().map(|module| module.join("::")).collect();
        assert!(
            left.is_empty(),
            "{crate_of}: circles among {}, or above them",
            names.join(", ")
        );
    }
}

#[test]
fn a_circle_is_seen() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    fs::create_dir(folder.path().join("a")).unwrap();
    write("lib.rs", "pub mod a;\npub mod b;\npub use b::{B, other as another};\n");
    write("a.rs", "mod c;\npub use c::C;\nfn f() -> crate::B {}\n");
    write("a/c.rs", "use std::fmt;\n// use crate::b::B;\npub struct C;\n");
    write(
        "b.rs",
        "use brdfit_core::{real::Real, lm};\nuse std::{\n    io,\n};\npub struct B;\n",
    );
    assert_eq!(circle(&imports(folder.path())), Vec::<Vec<String>>::new());
    write("b.rs", "use crate::{\n    a::{C, self},\n};\npub struct B;\n");
    let names = |parts: &[&str]| parts.iter().map(|part| part.to_string()).collect::<Vec<_>>();
    assert_eq!(circle(&imports(folder.path())), [names(&["a"]), names(&["b"])]);
}
