//! Texts that are told apart.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::hash::{BuildHasher, RandomState};

/// Different texts, numbered from 0 in the order in which they came; all in one buffer, for thousands of scans have one each.
#[derive(Default)]
pub struct Texts {
    all: String,
    /// Where each ends.
    ends: Vec<usize>,
    /// Their numbers by their hashes; one whose hash is taken has the next that is free.
    numbers: HashMap<u64, usize>,
    hash: RandomState,
}

impl Texts {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.ends.len()
    }

    /// Has this text that number?
    pub fn is(&self, number: usize, text: &str) -> bool {
        let Some(&to) = self.ends.get(number) else { return false };
        let from = number.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.all[from..to] == text
    }

    /// The number of a text; one that was not seen before gets the next.
    pub fn number(&mut self, text: &str) -> usize {
        let count = self.ends.len();
        let mut hash = self.hash.hash_one(text);
        let known = loop {
            match self.numbers.entry(hash) {
                Entry::Occupied(number) => {
                    let number = *number.get();
                    if self.is(number, text) {
                        break number;
                    }
                }
                Entry::Vacant(free) => break *free.insert(count),
            }
            hash = hash.wrapping_add(1);
        };
        if known == count {
            self.all.push_str(text);
            self.ends.push(self.all.len());
        }
        known
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_text_has_one_number() {
        let mut texts = Texts::default();
        let words = ["550", "", "55", "0550", "5500"];
        for _ in 0..2 {
            for (number, word) in words.iter().enumerate() {
                assert_eq!(texts.number(word), number, "{word:?}");
                assert!(texts.is(number, word) && !texts.is(number + 1, word), "{word:?}");
            }
        }
        assert_eq!(texts.count(), words.len());
    }

    #[test]
    fn texts_of_one_hash_are_told_apart() {
        let mut texts = Texts::default();
        assert_eq!(texts.number("a"), 0);
        // As if "b" and "c" had the hash of "a".
        let taken = texts.numbers[&texts.hash.hash_one("a")];
        for word in ["b", "c"] {
            let hash = texts.hash.hash_one(word);
            texts.numbers.insert(hash, taken);
        }
        assert_eq!([texts.number("b"), texts.number("c"), texts.number("b")], [1, 2, 1]);
    }
}
