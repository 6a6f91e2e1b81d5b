//! Lines of an SSDD file, and the binary numbers between them.

/// Lines of text, between which binary numbers may stand; remarks are blank.
pub struct Lines<'a> {
    /// What is still to be read.
    pub rest: &'a [u8],
    line: u64,
}

impl<'a> Lines<'a> {
    /// The text of a file.
    pub fn new(file: &'a [u8]) -> Self {
        Lines { rest: file, line: 0 }
    }

    /// The next line, with its number from 1.
    pub fn next(&mut self) -> Option<(u64, String)> {
        if self.rest.is_empty() {
            return None;
        }
        let end = memchr::memchr(b'\n', self.rest).unwrap_or(self.rest.len());
        let line = String::from_utf8_lossy(&self.rest[..end]);
        let line = line.trim_start_matches('\u{feff}').trim();
        self.rest = &self.rest[(end + 1).min(self.rest.len())..];
        self.line += 1;
        Some((
            self.line,
            if line.starts_with('#') {
                String::new()
            } else {
                line.to_string()
            },
        ))
    }

    /// So many bytes; none if there are fewer.
    pub fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(count)?;
        self.rest = rest;
        Some(taken)
    }
}
