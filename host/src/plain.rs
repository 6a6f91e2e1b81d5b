//! Text from elsewhere, such as names of files and cells of tables, as it may be shown: none of it moves a cursor, turns a line round or begins a formula.

use std::borrow::Cow;
use std::io::{self, Write};

/// Is this a character without a picture of its own: a control character, a mark of direction or of layout, or a separator of lines?
///
/// These are the general categories Cc, Cf, Zl and Zp of Unicode 16.
fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c,
            '\u{ad}' | '\u{600}'..='\u{605}' | '\u{61c}' | '\u{6dd}' | '\u{70f}' | '\u{890}'..='\u{891}' | '\u{8e2}'
            | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{2064}'
            | '\u{2066}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{110bd}' | '\u{110cd}'
            | '\u{13430}'..='\u{1343f}' | '\u{1bca0}'..='\u{1bca3}' | '\u{1d173}'..='\u{1d17a}' | '\u{e0001}'
            | '\u{e0020}'..='\u{e007f}')
}

/// One line, with `\n`, `\u{1b}` and the like in place of each character that has no picture.
pub fn plain(text: &str) -> Cow<'_, str> {
    replaced(text, is_hidden, |c, to| to.extend(c.escape_default()))
}

/// The same, but line feeds stay.
pub fn lines(text: &str) -> Cow<'_, str> {
    replaced(
        text,
        |c| c != '\n' && is_hidden(c),
        |c, to| to.extend(c.escape_default()),
    )
}

/// The same for JSON, where such characters stand only inside strings: an escape there reads back as the character.
pub fn json(text: &str) -> Cow<'_, str> {
    let escape = |c: char, to: &mut String| {
        for unit in c.encode_utf16(&mut [0; 2]) {
            *to += &format!("\\u{unit:04x}");
        }
    };
    replaced(text, |c| c != '\n' && is_hidden(c), escape)
}

/// A cell of a table: without hidden characters, and with an apostrophe before what a spreadsheet would take for a formula.
pub fn cell(text: &str) -> Cow<'_, str> {
    let shown = plain(text);
    if is_formula(&shown) {
        Cow::Owned(format!("'{shown}"))
    } else {
        shown
    }
}

/// The text of a cell that [`cell`] made of one without hidden characters.
pub fn of_cell(cell: &str) -> &str {
    cell.strip_prefix('\'').filter(|rest| is_formula(rest)).unwrap_or(cell)
}

/// Numbers may begin with a sign, and a sign alone computes nothing.
fn is_formula(text: &str) -> bool {
    text.len() > 1 && text.starts_with(['=', '+', '-', '@']) && text.parse::<f64>().is_err()
}

fn replaced(text: &str, which: impl Fn(char) -> bool, put: impl Fn(char, &mut String)) -> Cow<'_, str> {
    let Some(first) = text.find(&which) else {
        return Cow::Borrowed(text);
    };
    let mut shown = text[..first].to_string();
    for c in text[first..].chars() {
        if which(c) {
            put(c, &mut shown);
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

/// Names with commas between them, at most ten, and how many more there are.
pub fn some_of(names: &[impl AsRef<str>]) -> String {
    const LISTED: usize = 10;
    let listed: Vec<Cow<str>> = names.iter().take(LISTED).map(|name| plain(name.as_ref())).collect();
    let listed = listed.join(", ");
    match names.len().saturating_sub(LISTED) {
        0 => listed,
        more => format!("{listed} and {more} more"),
    }
}

/// Writes lines of text on without hidden characters.
pub struct Lines<'a>(pub &'a mut dyn Write);

impl Write for Lines<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write_all(lines(&String::from_utf8_lossy(bytes)).as_bytes())?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hides_nothing_and_moves_nothing() {
        assert_eq!(
            plain("a\u{1b}[31mb\r\n\t\0\u{9b}\u{202e}c\u{2066}"),
            "a\\u{1b}[31mb\\r\\n\\t\\u{0}\\u{9b}\\u{202e}c\\u{2066}"
        );
        for kept in [
            "paint.csv",
            "Fläche 3 — 日本語　e\u{301}.csv",
            "C:\\scans\\a.csv",
            "10 °",
        ] {
            assert_eq!(plain(kept), kept);
        }
        assert_eq!(lines("a\nb\rc"), "a\nb\\rc");
    }

    #[test]
    fn json_reads_back() {
        for text in ["a\u{202e}b\u{1b}\n\"\\", "\u{e0041}\u{7f}\u{2028}"] {
            let written = serde_json::to_string_pretty(&[text]).unwrap();
            let safe = json(&written);
            assert!(!safe.contains(|c| c != '\n' && is_hidden(c)), "{safe}");
            assert_eq!(serde_json::from_str::<Vec<String>>(&safe).unwrap(), [text]);
        }
    }

    #[test]
    fn cells_are_no_formulas() {
        for (text, expected) in [
            ("=1+1", "'=1+1"),
            ("@SUM(A1)", "'@SUM(A1)"),
            ("-scan.csv", "'-scan.csv"),
            ("+cmd|' /C calc'!A0", "'+cmd|' /C calc'!A0"),
            ("-85.5", "-85.5"),
            ("-", "-"),
            ("+1e-3", "+1e-3"),
            ("'quoted'", "'quoted'"),
            ("a\tb", "a\\tb"),
        ] {
            assert_eq!(cell(text), expected);
            if plain(text) == text {
                assert_eq!(of_cell(&cell(text)), text);
            }
        }
    }

    #[test]
    fn long_lists_are_cut() {
        let names: Vec<String> = (0..5000).map(|k| format!("{k} nm")).collect();
        assert_eq!(some_of(&names[..2]), "0 nm, 1 nm");
        assert!(some_of(&names).ends_with(", 9 nm and 4990 more"));
    }
}
