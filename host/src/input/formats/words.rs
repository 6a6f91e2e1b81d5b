//! A text as words, each with its line, for formats of keywords and numbers.

use crate::error::{Error, shown};

/// True if a line begins with this word, blanks before it aside.
pub fn begins_line(text: &str, word: &str) -> bool {
    let places = memchr::memmem::find_iter(text.as_bytes(), word);
    places.into_iter().any(|place| {
        let before = text[..place].trim_end_matches([' ', '\t', '\r']);
        let after = text[place + word.len()..].chars().next();
        (before.is_empty() || before.ends_with('\n')) && after.is_none_or(char::is_whitespace)
    })
}

/// The words of a text from here on; what follows a `#` in its line is a remark.
#[derive(Clone)]
pub struct Words<'a> {
    rest: &'a str,
    line: u64,
}

impl<'a> Words<'a> {
    /// All words of a text.
    pub fn new(text: &'a str) -> Words<'a> {
        Words { rest: text, line: 1 }
    }

    /// The line of the next word, or of the end.
    pub fn line(&mut self) -> u64 {
        self.skip();
        self.line
    }

    /// The next word, which stays.
    pub fn peek(&mut self) -> Option<&'a str> {
        self.skip();
        (!self.rest.is_empty()).then(|| &self.rest[..self.length()])
    }

    /// The next word and its line.
    ///
    /// # Errors
    /// The text ends; `wanted` is what should follow.
    pub fn word(&mut self, wanted: &str) -> Result<(u64, &'a str), Error> {
        self.skip();
        let (word, rest) = self.rest.split_at(self.length());
        self.rest = rest;
        if word.is_empty() {
            return Err(Error::new(format!("the file ends where {wanted} should follow")).help("is the file cut off?"));
        }
        Ok((self.line, word))
    }

    /// Takes a keyword, whatever its case.
    ///
    /// # Errors
    /// Another word stands there.
    pub fn keyword(&mut self, keyword: &str) -> Result<(), Error> {
        match self.word(keyword)? {
            (_, word) if word.eq_ignore_ascii_case(keyword) => Ok(()),
            (line, word) => Err(Error::new(format!("'{}' stands where {keyword} should", shown(word)))
                .at_line(line)
                .help("keep the order of the keywords, and the counts of numbers that the header promises")),
        }
    }

    /// A number and its line.
    ///
    /// # Errors
    /// Another word stands there, or the text ends.
    pub fn number(&mut self, wanted: &str) -> Result<(u64, f64), Error> {
        let (line, word) = self.word(wanted)?;
        let number = word.parse().map_err(|_| {
            Error::new(format!(
                "'{}' is not a number, where {wanted} should stand",
                shown(word)
            ))
            .at_line(line)
            .help("do the counts in the header agree with the numbers?")
        })?;
        Ok((line, number))
    }

    /// A count from 1 on.
    ///
    /// # Errors
    /// Another word stands there, or the count is none.
    pub fn count(&mut self, wanted: &str) -> Result<usize, Error> {
        const MOST: f64 = 1e6;
        let (line, count) = self.number(wanted)?;
        if (1.0..=MOST).contains(&count) && count.fract() == 0.0 {
            return Ok(count as usize);
        }
        Err(Error::new(format!("{count} stands where {wanted} should"))
            .at_line(line)
            .help("give a number from 1 on"))
    }

    /// So many numbers.
    ///
    /// # Errors
    /// Another word stands there, or the text ends.
    pub fn numbers(&mut self, count: usize, wanted: &str) -> Result<Vec<f64>, Error> {
        (0..count).map(|_| Ok(self.number(wanted)?.1)).collect()
    }

    /// The setting that stands there, as one of those that are known, whatever its case.
    ///
    /// # Errors
    /// It is none of them.
    pub fn setting(&mut self, keyword: &str, known: &[&'static str]) -> Result<&'static str, Error> {
        let (line, word) = self.word("a setting")?;
        let found = known.iter().find(|known| known.eq_ignore_ascii_case(word));
        found.copied().ok_or_else(|| {
            Error::new(format!("{keyword} is '{}'", shown(word)))
                .at_line(line)
                .help(format!("this reads {}", known.join(" or ")))
        })
    }

    /// What is left of this line, which ends here.
    pub fn rest_of_line(&mut self) -> &'a str {
        let (line, rest) = self.rest.split_once('\n').unwrap_or((self.rest, ""));
        self.line += u64::from(line.len() < self.rest.len());
        self.rest = rest;
        line.trim()
    }

    /// So many characters of any kind, and what is left of their last line.
    pub fn characters(&mut self, count: usize) {
        let end = self
            .rest
            .char_indices()
            .nth(count)
            .map_or(self.rest.len(), |(end, _)| end);
        self.line += self.rest[..end].bytes().filter(|&byte| byte == b'\n').count() as u64;
        self.rest = &self.rest[end..];
        self.rest_of_line();
    }

    /// Goes to the next word, over blanks and remarks.
    fn skip(&mut self) {
        loop {
            let blank = self.rest.bytes().take_while(u8::is_ascii_whitespace);
            let (bytes, lines) = blank.fold((0, 0), |(bytes, lines), byte| {
                (bytes + 1, lines + u64::from(byte == b'\n'))
            });
            self.rest = &self.rest[bytes..];
            self.line += lines;
            if !self.rest.starts_with('#') {
                return;
            }
            self.rest_of_line();
        }
    }

    /// The length of the word at hand.
    fn length(&self) -> usize {
        let end = self.rest.bytes().position(|byte| byte.is_ascii_whitespace());
        end.unwrap_or(self.rest.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_have_their_lines() {
        let mut words = Words::new("# remark\n\nkey 3 # more\n 1 2\r\n\t5\nAny Thing\nline\n");
        assert_eq!(words.peek(), Some("key"));
        words.keyword("KEY").unwrap();
        assert_eq!(words.count("a count").unwrap(), 3);
        assert_eq!(words.numbers(3, "a number").unwrap(), [1.0, 2.0, 5.0]);
        assert_eq!(words.line(), 6);
        assert_eq!(words.clone().number("x").unwrap_err().line, Some(6));
        assert_eq!(words.setting("key", &["any"]).unwrap(), "any");
        assert_eq!(words.rest_of_line(), "Thing");
        assert_eq!(words.word("x").unwrap(), (7, "line"));
        assert!(words.peek().is_none() && words.word("more").unwrap_err().what.contains("where more should"));
    }

    #[test]
    fn a_line_begins_with_a_whole_word() {
        let text = "# AOI\nx AOI\nAOIs\n\t KEY 3\nEnd";
        assert!(begins_line(text, "KEY") && begins_line(text, "End") && begins_line("AOI", "AOI"));
        assert!(!begins_line(text, "AOI") && !begins_line(text, "Data"));
    }

    #[test]
    fn characters_may_be_lines() {
        let mut words = Words::new("one\ntwo µ\n1 2\n");
        words.characters(9);
        assert_eq!(words.number("x").unwrap(), (3, 1.0));
        let mut words = Words::new("\n1");
        words.characters(0);
        assert_eq!(words.number("x").unwrap(), (2, 1.0));
    }
}
