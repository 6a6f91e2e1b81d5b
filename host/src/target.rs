//! A file that a command is to write: checked before the command does its work, and whole or not there afterwards.

use std::fs::{self, File, Metadata};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::input::STDIN;
use crate::interrupt;

/// Standard input as a file, where the system has that.
const STDIN_FILE: &str = "/dev/stdin";
/// Standard output as a file.
const STDOUT_FILE: &str = "/dev/stdout";

/// For a command that reads nothing.
pub const NO_INPUTS: [&Path; 0] = [];

/// A file that may be written: no input of the command, in a folder that takes files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Target {
    /// As the user named it.
    named: PathBuf,
    /// With links followed, so that these stay.
    file: PathBuf,
}

impl Target {
    /// Checks that a result can be written to `path`, which no command may find out only after its work.
    ///
    /// # Errors
    /// It is one of the `inputs`, also by another name; it is a folder or read-only; its folder is missing or not writable.
    pub fn new(path: &Path, inputs: &[impl AsRef<Path>]) -> Result<Target, Error> {
        let target = Target {
            named: path.to_path_buf(),
            file: followed(path).map_err(|error| denied(path, &error))?,
        };
        if is_one_of(&target.file, inputs) {
            return Err(Error::new("this is an input too, and the result would replace it")
                .in_file(path.display().to_string())
                .help("give the output another name"));
        }
        let there = target.there()?;
        if there.is_none_or(|there| there.is_file()) {
            new_file(&target.file).map_err(|error| denied(path, &error))?;
        }
        Ok(target)
    }

    /// Refuses targets that are one file.
    ///
    /// # Errors
    /// Two are the same, also by another name.
    pub fn differ(targets: &[&Target]) -> Result<(), Error> {
        for (place, target) in targets.iter().enumerate() {
            let before = &targets[..place];
            // A device, such as /dev/null, takes any number of results.
            let is_device = fs::metadata(&target.file).is_ok_and(|there| !there.is_file());
            let same = is_one_of(&target.file, before) || before.iter().any(|other| other.file == target.file);
            if same && !is_device {
                return Err(Error::new("two results would go to this file")
                    .in_file(target.named.display().to_string())
                    .help("give each a name of its own"));
            }
        }
        Ok(())
    }

    /// As the user named it.
    pub fn path(&self) -> &Path {
        &self.named
    }

    /// Writes the file: to a temporary one beside it, which is then renamed.
    ///
    /// # Errors
    /// The folder is gone or the disk is full; what stood there is then as before.
    pub fn write(&self, contents: &[u8]) -> Result<(), Error> {
        self.write_with(|file| file.write_all(contents))
    }

    /// The same for what is written bit by bit.
    ///
    /// # Errors
    /// As [`Target::write`], and what `write` fails with; an [`Error`] inside its failure comes out as it is.
    pub fn write_with(&self, write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>) -> Result<(), Error> {
        let _until_it_is_whole = interrupt::writing();
        let there = self.there()?;
        let all = || -> io::Result<()> {
            // A device or a pipe, such as /dev/null, is written to and not replaced.
            if there.as_ref().is_some_and(|there| !there.is_file()) {
                return buffered(&File::options().write(true).open(&self.file)?, write);
            }
            let file = new_file(&self.file)?;
            buffered(file.as_file(), write)?;
            if let Some(there) = &there {
                keep_owner_and_mode(file.as_file(), there)?;
            }
            file.as_file().sync_all()?;
            file.persist(&self.file)?;
            Ok(())
        };
        all().map_err(|error| match error.downcast::<Error>() {
            Ok(own) => own,
            Err(error) => denied(&self.named, &error),
        })
    }

    /// What stands there now.
    fn there(&self) -> Result<Option<Metadata>, Error> {
        let fail = |what: &str, help: &str| Err(Error::new(what).in_file(self.named.display().to_string()).help(help));
        match fs::metadata(&self.file) {
            Ok(there) if there.is_dir() => fail("this is a folder", "name a file in it"),
            Ok(there) if there.is_file() && there.permissions().readonly() => fail(
                "this file is read-only, so it is not replaced",
                "make it writable, or give the output another name",
            ),
            Ok(there) => Ok(Some(there)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(denied(&self.named, &error)),
        }
    }
}

impl AsRef<Path> for Target {
    fn as_ref(&self) -> &Path {
        &self.file
    }
}

/// Refuses a standard output that goes to one of the inputs, as `fit a.csv >> a.csv` would have it.
///
/// # Errors
/// It does.
pub fn stdout_is_no_input(inputs: &[impl AsRef<Path>]) -> Result<(), Error> {
    if is_one_of(STDOUT_FILE.as_ref(), inputs) {
        return Err(Error::new("standard output goes to an input").help("send it to another file"));
    }
    Ok(())
}

/// Is the file at `path` one of these, also by another name or through a link? `-` is what standard input is read from.
pub fn is_one_of(path: &Path, others: &[impl AsRef<Path>]) -> bool {
    let Some(own) = identity(path) else { return false };
    let read = |path: &Path| {
        identity(if path.as_os_str() == STDIN {
            STDIN_FILE.as_ref()
        } else {
            path
        })
    };
    others.iter().any(|other| read(other.as_ref()).as_ref() == Some(&own))
}

/// What tells a regular file from all others; `None` if there is none.
#[cfg(unix)]
fn identity(path: &Path) -> Option<impl PartialEq + use<>> {
    use std::os::unix::fs::MetadataExt;
    let there = fs::metadata(path).ok().filter(Metadata::is_file)?;
    Some((there.dev(), there.ino()))
}

#[cfg(not(unix))]
fn identity(path: &Path) -> Option<impl PartialEq + use<>> {
    path.canonicalize().ok().filter(|path| path.is_file())
}

/// The path of the file itself, which need not be there yet.
fn followed(path: &Path) -> io::Result<PathBuf> {
    /// As many as Linux follows.
    const LINKS: usize = 40;
    let mut path = path.to_path_buf();
    for _ in 0..LINKS {
        match fs::read_link(&path) {
            // A relative link counts from its own folder.
            Ok(to) => path = path.parent().map_or(to.clone(), |folder| folder.join(&to)),
            Err(_) => {
                let (Some(name), folder) = (path.file_name(), folder_of(&path)) else {
                    return Ok(path);
                };
                return Ok(folder.canonicalize()?.join(name));
            }
        }
    }
    Err(io::Error::other("its links lead in a circle"))
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// A file without a name that anyone knows, beside `path`.
fn new_file(path: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    // Private by default; a result is an ordinary file, so the user's mask decides.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.prefix(".brdfit-").tempfile_in(folder_of(path))
}

fn buffered(file: &File, write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>) -> io::Result<()> {
    let mut buffer = BufWriter::new(file);
    write(&mut buffer)?;
    buffer.flush()
}

fn keep_owner_and_mode(file: &File, of: &Metadata) -> io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::{MetadataExt, fchown};
        // Only the superuser may give a file away; others keep theirs.
        let _ = fchown(file, Some(of.uid()), Some(of.gid()));
    }
    file.set_permissions(of.permissions())
}

fn denied(path: &Path, error: &io::Error) -> Error {
    Error::file(format!("cannot be written: {error}"))
        .in_file(path.display().to_string())
        .help("check that the folder is there and writable")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> (tempfile::TempDir, impl Fn(&str) -> PathBuf) {
        let root = tempfile::tempdir().unwrap();
        let path = root.path().to_path_buf();
        (root, move |name| path.join(name))
    }

    #[test]
    fn an_input_is_no_target() {
        let (_root, path) = folder();
        fs::write(path("scan.csv"), "scan").unwrap();
        fs::hard_link(path("scan.csv"), path("hard.csv")).unwrap();
        fs::create_dir(path("inner")).unwrap();
        let mut names = vec!["scan.csv", "hard.csv", "inner/../scan.csv"];
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("scan.csv", path("link.csv")).unwrap();
            std::os::unix::fs::symlink("link.csv", path("far.csv")).unwrap();
            std::os::unix::fs::symlink("../far.csv", path("inner/further.csv")).unwrap();
            names.extend(["link.csv", "far.csv", "inner/further.csv"]);
        }
        for input in &names {
            for output in &names {
                let error = Target::new(&path(output), &[path(input)]).unwrap_err();
                assert!(error.what.contains("this is an input too"), "{input} {output}: {error}");
            }
        }
        assert!(Target::new(&path("other.csv"), &[path("scan.csv")]).is_ok());
        assert_eq!(fs::read(path("scan.csv")).unwrap(), b"scan");
    }

    #[test]
    fn what_cannot_be_written_is_known_before() {
        let (_root, path) = folder();
        fs::write(path("file"), "").unwrap();
        for (name, what) in [
            ("", "a folder"),
            ("none/x", "cannot be written"),
            ("file/x", "cannot be written"),
        ] {
            let error = Target::new(&path(name), &NO_INPUTS).unwrap_err();
            assert!(error.what.contains(what), "{name}: {error}");
        }
        let mut read_only = fs::metadata(path("file")).unwrap().permissions();
        read_only.set_readonly(true);
        fs::set_permissions(path("file"), read_only).unwrap();
        let error = Target::new(&path("file"), &NO_INPUTS).unwrap_err();
        assert!(error.what.contains("read-only"), "{error}");
        // Nothing is left behind.
        assert_eq!(fs::read_dir(path("")).unwrap().count(), 1);
    }

    #[test]
    fn two_results_need_two_files() {
        let (_root, path) = folder();
        fs::create_dir(path("inner")).unwrap();
        let target = |name: &str| Target::new(&path(name), &NO_INPUTS).unwrap();
        assert!(Target::differ(&[&target("a"), &target("b")]).is_ok());
        assert!(Target::differ(&[&target("a"), &target("inner/../a")]).is_err());
        fs::write(path("a"), "").unwrap();
        fs::hard_link(path("a"), path("b")).unwrap();
        assert!(Target::differ(&[&target("a"), &target("b")]).is_err());
    }

    #[test]
    fn a_failure_leaves_what_was_there() {
        let (_root, path) = folder();
        fs::write(path("file"), "before").unwrap();
        let target = Target::new(&path("file"), &NO_INPUTS).unwrap();
        let error = target.write_with(|file| {
            file.write_all(b"half")?;
            Err(io::Error::other(Error::new("mine")))
        });
        assert_eq!(error, Err(Error::new("mine")));
        assert_eq!(fs::read(path("file")).unwrap(), b"before");
        assert_eq!(fs::read_dir(path("")).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn mode_and_links_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let (_root, path) = folder();
        fs::create_dir(path("inner")).unwrap();
        for mode in [0o600, 0o664, 0o755] {
            fs::write(path("inner/file"), "before").unwrap();
            fs::set_permissions(path("inner/file"), PermissionsExt::from_mode(mode)).unwrap();
            let _ = fs::remove_file(path("link"));
            symlink("inner/file", path("link")).unwrap();
            Target::new(&path("link"), &NO_INPUTS).unwrap().write(b"after").unwrap();
            assert!(path("link").is_symlink());
            assert_eq!(fs::read(path("inner/file")).unwrap(), b"after");
            assert_eq!(
                fs::metadata(path("inner/file")).unwrap().permissions().mode() & 0o7777,
                mode
            );
        }
        // A link to what is not there yet makes it there.
        symlink("inner/new", path("dangling")).unwrap();
        Target::new(&path("dangling"), &NO_INPUTS)
            .unwrap()
            .write(b"new")
            .unwrap();
        assert_eq!(fs::read(path("inner/new")).unwrap(), b"new");
        symlink("b", path("a")).unwrap();
        symlink("a", path("b")).unwrap();
        assert!(Target::new(&path("a"), &NO_INPUTS).is_err());
    }
}
