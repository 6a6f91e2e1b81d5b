//! What someone needs who wants to make the same page again.

use std::ffi::OsString;
use std::fmt::Write;

use sha2::{Digest, Sha256};

use crate::plain::plain;

/// The file that a scan came from.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Its SHA-256 in hexadecimal digits.
    pub sha256: String,
    /// Its size in bytes.
    pub bytes: usize,
}

impl Source {
    /// Of a file with these bytes.
    pub fn new(bytes: &[u8]) -> Source {
        let mut sha256 = String::new();
        for byte in Sha256::digest(bytes) {
            let _ = write!(sha256, "{byte:02x}");
        }
        Source {
            sha256,
            bytes: bytes.len(),
        }
    }
}

/// The arguments as a line for a shell, the program by its plain name.
pub fn command(given: &[OsString]) -> String {
    let words = given.iter().skip(1).map(|word| {
        let word = word.to_string_lossy();
        // Only a NUL can not be quoted, and no system passes one in an argument.
        shlex::try_quote(&word).map_or_else(|_| word.to_string(), |quoted| quoted.to_string())
    });
    std::iter::once("brdfit".to_string())
        .chain(words)
        .map(|word| plain(&word).into_owned())
        .collect::<Vec<_>>()
        .join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_as_the_standard_says() {
        // FIPS 180-2, appendix B.1.
        let source = Source::new(b"abc");
        assert_eq!(
            source.sha256,
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
        assert_eq!(source.bytes, 3);
    }

    #[test]
    fn quotes_for_a_shell() {
        let given = ["/usr/bin/brdfit", "report", "black paint.csv", "--mask-retro", "6"];
        assert_eq!(
            command(&given.map(OsString::from)),
            "brdfit report 'black paint.csv' --mask-retro 6"
        );
    }
}
