//! What stands in one column of one row.

use std::fmt;

use serde::de::{Deserializer, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};

use crate::number::shortest;

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A word or a sentence, or several words.
    Text,
    /// A whole number from 0 on.
    Whole,
    /// A number.
    Number,
    /// True or false.
    Flag,
}

/// A value; as JSON it is that value alone.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Cell {
    /// There is none.
    Empty,
    /// Of [`Kind::Flag`].
    Flag(bool),
    /// Of [`Kind::Whole`].
    Whole(u64),
    /// Of [`Kind::Number`], finite.
    Number(f64),
    /// Of [`Kind::Text`].
    Text(String),
    /// Of [`Kind::Text`] too: several words, a list in JSON.
    Words(Vec<String>),
}

impl Cell {
    /// Has it nothing to show, as a list of no words?
    pub fn is_empty(&self) -> bool {
        match self {
            Cell::Empty => true,
            Cell::Text(text) => text.is_empty(),
            Cell::Words(words) => words.is_empty(),
            _ => false,
        }
    }

    /// As a cell of CSV: numbers in their shortest form, words with + between, nothing where nothing is.
    pub fn text(&self) -> String {
        match self {
            Cell::Empty => String::new(),
            Cell::Flag(flag) => flag.to_string(),
            Cell::Whole(whole) => whole.to_string(),
            Cell::Number(number) => shortest(*number),
            Cell::Text(text) => text.clone(),
            Cell::Words(words) => words.join("+"),
        }
    }
}

/// By the kind of the JSON value: serde's own way tries one variant after the other, and makes an error of each.
impl<'de> Deserialize<'de> for Cell {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(OfJson)
    }
}

struct OfJson;

impl<'de> Visitor<'de> for OfJson {
    type Value = Cell;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a cell")
    }
    fn visit_unit<E>(self) -> Result<Cell, E> {
        Ok(Cell::Empty)
    }
    fn visit_bool<E>(self, flag: bool) -> Result<Cell, E> {
        Ok(Cell::Flag(flag))
    }
    fn visit_u64<E>(self, whole: u64) -> Result<Cell, E> {
        Ok(Cell::Whole(whole))
    }
    fn visit_i64<E>(self, number: i64) -> Result<Cell, E> {
        Ok(Cell::Number(number as f64))
    }
    fn visit_f64<E>(self, number: f64) -> Result<Cell, E> {
        Ok(Cell::Number(number))
    }
    fn visit_str<E>(self, text: &str) -> Result<Cell, E> {
        Ok(Cell::Text(text.into()))
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Cell, A::Error> {
        let mut words = Vec::new();
        while let Some(word) = list.next_element()? {
            words.push(word);
        }
        Ok(Cell::Words(words))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_back_from_json() {
        let cells = [
            Cell::Empty,
            Cell::Flag(true),
            Cell::Whole(u64::MAX),
            Cell::Number(45.0),
            Cell::Number(1.0 / 3.0),
            Cell::Text("45".into()),
            Cell::Words(["diffuse", "surface"].map(String::from).into()),
        ];
        let json = serde_json::to_string(&cells).unwrap();
        assert_eq!(serde_json::from_str::<Vec<Cell>>(&json).unwrap(), cells);
        assert_eq!(
            cells.map(|cell| cell.text()).join(","),
            ",true,18446744073709551615,45,0.3333333333333333,45,diffuse+surface"
        );
    }
}
