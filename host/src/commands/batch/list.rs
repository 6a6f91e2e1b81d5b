//! Which files a batch has, and in which order.

use std::collections::HashSet;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::error::{Error, shown};
use crate::input::bytes::{self, STDIN};
use crate::records::own;

/// The files that the arguments name, in their order, each once: what a folder or a pattern stands for is sorted by name.
///
/// Results, parts and finished fits of batches to `out` are not scans, even if they are in a folder or match a pattern.
///
/// # Errors
/// A name that stands for no file, or a folder that cannot be listed.
pub fn files(arguments: &[PathBuf], out: &Path, input: &mut dyn Read) -> Result<Vec<PathBuf>, Error> {
    let mut all = Vec::new();
    for argument in arguments {
        let text = argument.to_string_lossy();
        if let Some(list) = name(argument) {
            all.extend(listed(list, input)?);
        } else if text == STDIN {
            return Err(Error::new("- alone does not name scans").help("give a list of files on standard input as @-"));
        } else if argument.is_dir() {
            all.extend(folder(argument, out)?);
        } else if argument.exists() || !text.contains(['*', '?', '[']) {
            all.push(argument.clone());
        } else {
            all.extend(matches(&text, out)?);
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

/// The file that `@LIST` names.
pub fn name(argument: &Path) -> Option<&Path> {
    argument.to_str()?.strip_prefix('@').map(Path::new)
}

/// One name a line; blank lines and those that begin with `#` do not count.
fn listed(list: &Path, input: &mut dyn Read) -> Result<Vec<PathBuf>, Error> {
    let bytes = if list.as_os_str() == STDIN {
        bytes::of_stdin(input)?
    } else {
        bytes::of_file(list)?
    };
    let text = String::from_utf8(bytes).map_err(|_| {
        Error::new("this is not a list of file names")
            .in_file(list.display().to_string())
            .help("write one name a line, in UTF-8")
    })?;
    let lines = text
        .lines()
        .map(str::trim)
        .filter(|line| !line.is_empty() && !line.starts_with('#'));
    Ok(lines.map(PathBuf::from).collect())
}

/// The files in a folder, without hidden ones, and without those in folders inside.
fn folder(path: &Path, out: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut files = Vec::new();
    for entry in path.read_dir().map_err(|error| unlisted(path, &error))? {
        let path = entry.map_err(|error| unlisted(path, &error))?.path();
        let hidden = path
            .file_name()
            .is_some_and(|name| name.to_string_lossy().starts_with('.'));
        if !hidden && may_be_scan(&path, out) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

fn matches(pattern: &str, out: &Path) -> Result<Vec<PathBuf>, Error> {
    let fail =
        |what: String| Error::new(what).help("in a pattern, * ? [] stand for other characters, and ** for folders");
    let paths = glob::glob(pattern).map_err(|error| fail(format!("'{}' is not a pattern: {error}", shown(pattern))))?;
    let mut files = Vec::new();
    for path in paths {
        let path = path.map_err(|error| unlisted(error.path(), error.error()))?;
        if may_be_scan(&path, out) {
            files.push(path);
        }
    }
    files.sort();
    if files.is_empty() {
        return Err(fail(format!("no file matches '{}'", shown(pattern))));
    }
    Ok(files)
}

fn unlisted(folder: &Path, error: &std::io::Error) -> Error {
    Error::file(format!("cannot be listed: {error}"))
        .in_file(folder.display().to_string())
        .help("check its permissions, or name the scans without it")
}

/// A file is a scan unless it is of this very batch; a link that leads nowhere has a row that says so.
fn may_be_scan(path: &Path, out: &Path) -> bool {
    path.metadata().map_or(true, |there| there.is_file()) && !own::is_own(path, out)
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
        // What only has the name of a result, or one that begins like it, is a scan.
        let likes = [
            "out.csv",
            "out.csv.partial",
            "out.csv.1-of-2",
            "out.csv.bak",
            "out.csv2",
        ];
        for name in likes {
            std::fs::write(path(name), "theta_i,theta_s,brdf\n").unwrap();
        }
        assert_eq!(names(&[""], "").len(), 8);
        for name in likes {
            std::fs::remove_file(path(name)).unwrap();
        }
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
