//! Which files are a batch's own: its results, its parts, its finished fits.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use brdfit_core::brdf::NAMES;

use super::record;

/// Is this what a batch to `out` wrote? It has one of the names, and the contents too; an empty file is nobody's.
pub fn is_own(path: &Path, out: &Path) -> bool {
    let name = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned());
    let (Some(own), Some(result)) = (name(path), name(out)) else {
        return false;
    };
    let Some(suffix) = own.strip_prefix(&result) else {
        return false;
    };
    if folder(path) != folder(out) {
        return false;
    }
    match suffix {
        "" => begins_as(path, is_result),
        suffix if is_suffix(suffix) => begins_as(path, |begin| {
            record::head(&mut &*begin).is_ok_and(|head| head.is_some())
        }),
        _ => false,
    }
}

fn folder(path: &Path) -> Option<std::path::PathBuf> {
    let folder = path.parent()?;
    let folder = if folder == Path::new("") {
        Path::new(".")
    } else {
        folder
    };
    folder.canonicalize().ok()
}

/// `.partial`, `.2-of-4` or `.2-of-4.partial`.
fn is_suffix(suffix: &str) -> bool {
    let part = suffix.strip_suffix(".partial").unwrap_or(suffix);
    part.is_empty() || is_part(part)
}

/// `.2-of-4`
pub fn is_part(suffix: &str) -> bool {
    let numbers = suffix.strip_prefix('.').and_then(|numbers| numbers.split_once("-of-"));
    let number = |text: &str| text.parse::<u32>().is_ok();
    numbers.is_some_and(|(i, n)| number(i) && number(n))
}

fn begins_as(path: &Path, what: impl Fn(&[u8]) -> bool) -> bool {
    /// Heads and first rows are shorter.
    const ENOUGH: u64 = 1 << 18;
    let mut begin = Vec::new();
    let read = File::open(path).and_then(|file| BufReader::new(file).take(ENOUGH).read_to_end(&mut begin));
    read.is_ok() && (begin.is_empty() || what(&begin))
}

/// The results of a batch in one of its forms.
fn is_result(begin: &[u8]) -> bool {
    let text = String::from_utf8_lossy(begin);
    let head: Vec<&str> = text.lines().next().unwrap_or_default().split(',').collect();
    let is_table = ["file", "scan", "error"]
        .iter()
        .chain(&NAMES)
        .all(|name| head.contains(name));
    let is_array = text.trim_end() == "[]"
        || text.starts_with("[\n")
            && text.contains("\"file\"")
            && (text.contains("\"rho_d\"") || text.contains("\"error\""));
    is_table || is_array || begin.starts_with(b"PAR1")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_by_name_and_contents() {
        let root = tempfile::tempdir().unwrap();
        let out = root.path().join("out.csv");
        let own = |name: &str, contents: &str| {
            let path = root.path().join(name);
            std::fs::write(&path, contents).unwrap();
            is_own(&path, &out)
        };
        let results = format!("file,scan,{},error\n", NAMES.join(","));
        assert!(own("out.csv", &results) && own("out.csv", "") && own("out.csv", "[]\n"));
        assert!(!own("out.csv", "theta_i,theta_s,brdf\n45,1,1\n"));
        assert!(!own("other.csv", &results) && !own("out.csv.bak", &results));
        let records = record::line(&record::tests::head());
        for name in ["out.csv.partial", "out.csv.2-of-4", "out.csv.2-of-4.partial"] {
            assert!(own(name, &records) && own(name, ""), "{name}");
            assert!(
                !own(name, "theta_i,theta_s,brdf\n") && !own(name, &records[1..]),
                "{name}"
            );
        }
        for name in [
            "out.csv.x-of-4",
            "out.csv.2-of-4.partials",
            "out.csv2-of-4",
            "out.csvpartial",
        ] {
            assert!(!own(name, &records), "{name}");
        }
    }
}
