//! Files and standard input as bytes, and bytes as text.

use std::borrow::Cow;
use std::fs;
use std::io::Read;
use std::path::Path;

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};

use crate::error::Error;

/// The name that stands for standard input.
pub const STDIN: &str = "-";

/// Reads the bytes of a file or a pipe.
///
/// # Errors
/// It is missing, a directory, a device, or not readable.
pub fn of_file(path: &Path) -> Result<Vec<u8>, Error> {
    let fail = |what: String| Error::file(what).in_file(path.display().to_string());
    // On some systems a directory opens like a file, and only reading it fails.
    if path.is_dir() {
        return Err(fail("this is a directory".into()).help("name the files in it"));
    }
    if is_device(path) {
        return Err(fail("this is a device, which may have no end".into()).help("give a file, or - for standard input"));
    }
    fs::read(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => fail("no such file".into()).help("check the name and the folder"),
        _ => fail(format!("cannot be read: {error}")).help("check its permissions"),
    })
}

#[cfg(unix)]
fn is_device(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;
    let there = path.metadata().map(|there| there.file_type());
    there.is_ok_and(|there| there.is_char_device() || there.is_block_device())
}

#[cfg(not(unix))]
fn is_device(_: &Path) -> bool {
    false
}

/// Reads all of standard input.
///
/// # Errors
/// The stream breaks.
pub fn of_stdin(stream: &mut dyn Read) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    match stream.read_to_end(&mut bytes) {
        Ok(_) => Ok(bytes),
        Err(error) => Err(Error::file(format!("cannot be read: {error}")).in_file(STDIN)),
    }
}

/// The text in the bytes of a file, with line feeds as its only line ends.
///
/// It may be UTF-8, UTF-16 with or without a byte order mark, or else Windows-1252, which holds Latin-1.
///
/// # Errors
/// There are no bytes, or they are not text.
pub fn text(bytes: &[u8]) -> Result<Cow<'_, str>, Error> {
    if bytes.is_empty() {
        return Err(Error::new("the file is empty").help("give a file with a header line and one row a sample"));
    }
    Ok(with_line_feeds(decoded(bytes)?))
}

/// The text in the bytes, by whatever encoding they have.
fn decoded(bytes: &[u8]) -> Result<Cow<'_, str>, Error> {
    let (wide, bytes) = match Encoding::for_bom(bytes) {
        Some((encoding, mark)) if encoding == UTF_8 => (None, &bytes[mark..]),
        Some((encoding, mark)) => (Some(encoding), &bytes[mark..]),
        None => (utf_16(bytes), bytes),
    };
    if let Some(encoding) = wide {
        let whole = encoding.decode_without_bom_handling_and_without_replacement(bytes);
        return whole
            .filter(|text| !text.contains('\0'))
            .ok_or_else(|| not_text(bytes, 0));
    }
    // Without an early end the bytes of a chunk are looked at together.
    let mut chunks = bytes.chunks(4096);
    if chunks.any(|chunk| chunk.iter().fold(false, |any, byte| any | is_binary(byte))) {
        let place = bytes.iter().position(is_binary);
        return Err(not_text(bytes, place.unwrap_or(0)));
    }
    Ok(match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => WINDOWS_1252.decode_without_bom_handling(bytes).0,
    })
}

/// The kind of UTF-16 that bytes without a mark are: digits, letters and commas have a zero byte each, all on one side.
fn utf_16(bytes: &[u8]) -> Option<&'static Encoding> {
    let head = &bytes[..bytes.len().min(64) & !1];
    let zeros = |side: usize| head.iter().skip(side).step_by(2).filter(|&&byte| byte == 0).count();
    // Nine in ten of the first characters are in the Latin alphabet.
    let most = |zeros: usize| zeros > 0 && zeros * 20 >= head.len() * 9;
    match (zeros(0), zeros(1)) {
        (0, low) if most(low) => Some(UTF_16LE),
        (high, 0) if most(high) => Some(UTF_16BE),
        _ => None,
    }
}

/// True of control characters that no text has; a form feed and the end mark of DOS may be there.
fn is_binary(byte: &u8) -> bool {
    *byte < b' ' && !matches!(byte, b'\t' | b'\n' | b'\r' | 0x0c | 0x1a)
}

fn not_text(bytes: &[u8], place: usize) -> Error {
    Error::new("this is not text")
        .at_line(line_at(bytes, place))
        .help("give a file of one of the formats of --input-format, or save it as CSV")
}

/// The text with a line feed for every carriage return that has none, as old instruments end their lines.
fn with_line_feeds(text: Cow<'_, str>) -> Cow<'_, str> {
    let bytes = text.as_bytes();
    let lone = |&place: &usize| bytes.get(place + 1) != Some(&b'\n');
    if memchr::memchr_iter(b'\r', bytes).any(|place| lone(&place)) {
        Cow::Owned(text.replace("\r\n", "\n").replace('\r', "\n"))
    } else {
        text
    }
}

/// The line of the byte at `end`; the first is 1.
fn line_at(bytes: &[u8], end: usize) -> u64 {
    1 + bytes[..end].iter().filter(|&&byte| byte == b'\n').count() as u64
}

/// Where the lines of a text begin.
pub struct Lines(Vec<usize>);

impl Lines {
    /// Finds them.
    pub fn new(text: &str) -> Lines {
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        Lines(std::iter::once(0).chain(ends.map(|(end, _)| end + 1)).collect())
    }

    /// Line and column of `part`, which is a part of `text`; the first are 1.
    pub fn place(&self, text: &str, part: &str) -> (u64, u64) {
        let at = part.as_ptr().addr().saturating_sub(text.as_ptr().addr());
        let line = self.0.partition_point(|&begin| begin <= at);
        (line as u64, (at - self.0[line - 1]) as u64 + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WORDS: &str = "# 45°, µm\ntheta_i,theta_s,brdf\n45,-10,0.25\n";

    #[test]
    fn every_encoding_is_the_same_text() {
        let utf_16 = |pair: fn(u16) -> [u8; 2]| -> Vec<u8> { WORDS.encode_utf16().flat_map(pair).collect() };
        let (little, big) = (utf_16(u16::to_le_bytes), utf_16(u16::to_be_bytes));
        let latin_1: Vec<u8> = WORDS.chars().map(|c| c as u8).collect();
        for (bytes, name) in [
            (WORDS.as_bytes().to_vec(), "UTF-8"),
            ([b"\xef\xbb\xbf", WORDS.as_bytes()].concat(), "UTF-8 with a mark"),
            ([b"\xff\xfe", &little[..]].concat(), "UTF-16LE with a mark"),
            ([b"\xfe\xff", &big[..]].concat(), "UTF-16BE with a mark"),
            (little, "UTF-16LE"),
            (big, "UTF-16BE"),
            (latin_1, "Latin-1"),
        ] {
            assert_eq!(text(&bytes).unwrap(), WORDS, "{name}");
        }
    }

    #[test]
    fn every_kind_of_line_end_is_one_line() {
        for end in ["\n", "\r\n", "\r"] {
            let whole = ["a", "b", "", "c"].join(end);
            let text = text(whole.as_bytes()).unwrap();
            assert_eq!(text.lines().collect::<Vec<_>>(), ["a", "b", "", "c"], "{end:?}");
        }
        assert!(matches!(text(b"a\r\nb\r\n"), Ok(Cow::Borrowed(_))));
        assert_eq!(text(b"a\rb\r\nc").unwrap(), "a\nb\nc");
    }

    #[test]
    fn what_is_no_text_is_refused_with_its_line() {
        for (bytes, line) in [
            (&b"a\nb\0"[..], 2),
            (b"\x89PNG\r\n\x1a\n\0\0", 3),
            (b"\xff\xfea\0\0\xd8", 1),
        ] {
            assert_eq!(text(bytes).unwrap_err().line, Some(line), "{bytes:?}");
        }
        assert!(text(b"").unwrap_err().what.contains("empty"));
        assert_eq!(text(b"a\x1a").unwrap(), "a\x1a");
    }
}
