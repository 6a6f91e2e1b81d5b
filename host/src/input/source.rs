//! The file that a scan came from, so that it is known again.

use std::fmt::Write;

use serde::Serialize;
use sha2::{Digest, Sha256};

/// A file as it was read.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Source {
    /// As the user named it.
    pub file: String,
    /// Its size in bytes.
    pub bytes: usize,
    /// Its SHA-256 in hexadecimal digits.
    pub sha256: String,
}

impl Source {
    /// Of a file with these bytes.
    pub fn new(file: &str, bytes: &[u8]) -> Source {
        let mut sha256 = String::new();
        for byte in Sha256::digest(bytes) {
            let _ = write!(sha256, "{byte:02x}");
        }
        Source {
            file: file.to_string(),
            bytes: bytes.len(),
            sha256,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_as_the_standard_says() {
        // FIPS 180-2, appendix B.1.
        let source = Source::new("abc.csv", b"abc");
        assert_eq!(
            source.sha256,
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
        assert_eq!(source.bytes, 3);
    }
}
