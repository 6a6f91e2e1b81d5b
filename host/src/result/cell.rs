//! What stands in one column of one row.

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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
