//! Which files a batch has, and in which order.

use std::collections::HashSet;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::error::{Error, shown};
use crate::input::bytes::{self, STDIN};

/// The files that the arguments name, in their order, each once: what a folder or a pattern stands for is sorted by name.
///
/// `leave_out` is the name of the results: files that begin with it are no scans, even if they are in a folder that is.
///
/// # Errors
/// A name that stands for no file.
pub fn files(arguments: &[PathBuf], leave_out: &Path, input: &mut dyn Read) -> Result<Vec<PathBuf>, Error> {
    let mut all = Vec::new();
    for argument in arguments {
        let text = argument.to_string_lossy();
        if let Some(list) = text.strip_prefix('@') {
            all.extend(listed(list, input)?);
        } else if text == STDIN {
            return Err(Error::new("- is no batch").help("give a list of files on standard input as @-"));
        } else if argument.is_dir() {
            all.extend(folder(argument, leave_out)?);
        } else if argument.exists() || !text.contains(['*', '?', '[']) {
            all.push(argument.clone());
        } else {
            all.extend(matches(&text, leave_out)?);
        }
    }
    let mut seen = HashSet::with_capacity(all.len());
    all.retain(|path| seen.insert(path.clone()));
    if all.is_empty() {
        return Err(
            Error::new("there are no scans to fit").help("name a folder that has files, or a list that names some")
        );
    }
    Ok(all)
}

/// One name a line; blank lines and those that begin with `#` do not count.
fn listed(list: &str, input: &mut dyn Read) -> Result<Vec<PathBuf>, Error> {
    let bytes = if list == STDIN {
        bytes::of_stdin(input)?
    } else {
        bytes::of_file(Path::new(list))?
    };
    let text = String::from_utf8(bytes).map_err(|_| {
        Error::new("this is no list of file names")
            .in_file(list)
            .help("write one name a line, in UTF-8")
    })?;
    let lines = text
        .lines()
        .map(str::trim)
        .filter(|line| !line.is_empty() && !line.starts_with('#'));
    Ok(lines.map(PathBuf::from).collect())
}

/// The files in a folder, without hidden ones, and without those in folders inside.
fn folder(path: &Path, leave_out: &Path) -> Result<Vec<PathBuf>, Error> {
    let fail = |error: std::io::Error| {
        Error::new(format!("can not be listed: {error}"))
            .in_file(path.display().to_string())
            .help("check its permissions")
    };
    let mut files = Vec::new();
    for entry in path.read_dir().map_err(fail)? {
        let path = entry.map_err(fail)?.path();
        let hidden = path
            .file_name()
            .is_some_and(|name| name.to_string_lossy().starts_with('.'));
        if !hidden && path.is_file() && !is_result(&path, leave_out) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

fn matches(pattern: &str, leave_out: &Path) -> Result<Vec<PathBuf>, Error> {
    let fail =
        |what: String| Error::new(what).help("in a pattern, * ? [] stand for other characters, and ** for folders");
    let paths = glob::glob(pattern).map_err(|error| fail(format!("'{}' is no pattern: {error}", shown(pattern))))?;
    let mut files: Vec<PathBuf> = paths
        .flatten()
        .filter(|path| path.is_file() && !is_result(path, leave_out))
        .collect();
    files.sort();
    if files.is_empty() {
        return Err(fail(format!("no file matches '{}'", shown(pattern))));
    }
    Ok(files)
}

/// Is this the file of results of this very batch, or one of its parts?
fn is_result(path: &Path, results: &Path) -> bool {
    let beside = |path: &Path| {
        path.parent().and_then(|folder| {
            if folder == Path::new("") {
                Path::new(".")
            } else {
                folder
            }
            .canonicalize()
            .ok()
        })
    };
    let name = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned());
    match (name(path), name(results)) {
        (Some(path_name), Some(result)) => path_name.starts_with(&result) && beside(path) == beside(results),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_patterns_and_lists_in_a_fixed_order() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for name in [
            "b.csv",
            "a.csv",
            "c.txt",
            ".hidden",
            "out.csv",
            "out.csv.partial",
            "out.csv.1-of-2",
        ] {
            std::fs::write(path(name), "").unwrap();
        }
        std::fs::create_dir(path("inner")).unwrap();
        std::fs::write(path("inner/d.csv"), "").unwrap();
        let out = path("out.csv");
        let names = |arguments: &[&str], input: &str| -> Vec<String> {
            let arguments: Vec<PathBuf> = arguments
                .iter()
                .map(|name| match name.strip_prefix('@') {
                    Some("-") => PathBuf::from("@-"),
                    Some(list) => PathBuf::from(format!("@{}", path(list).display())),
                    None => path(name),
                })
                .collect();
            let found = files(&arguments, &out, &mut input.as_bytes()).unwrap();
            found
                .iter()
                .map(|file| file.strip_prefix(folder.path()).unwrap().display().to_string())
                .collect()
        };
        assert_eq!(names(&[""], ""), ["a.csv", "b.csv", "c.txt"]);
        assert_eq!(names(&["c.txt", "*.csv", "a.csv"], ""), ["c.txt", "a.csv", "b.csv"]);
        assert_eq!(names(&["**/*.csv"], ""), ["a.csv", "b.csv", "inner/d.csv"]);
        let list = format!(
            "# remark\n\n{}\r\n{}\n",
            path("inner/d.csv").display(),
            path("gone.csv").display()
        );
        assert_eq!(names(&["@-"], &list), ["inner/d.csv", "gone.csv"]);
        std::fs::write(path("c.txt"), list).unwrap();
        assert_eq!(names(&["@c.txt"], ""), ["inner/d.csv", "gone.csv"]);
        for bad in ["x*.csv", "a[.csv", "@missing", "-", "inner/.."] {
            let argument = if bad.len() > 1 && !bad.starts_with('@') {
                path(bad)
            } else {
                PathBuf::from(bad)
            };
            let result = files(&[argument], &out, &mut std::io::empty());
            assert_eq!(result.is_err(), bad != "inner/..", "{bad}");
        }
    }
}
