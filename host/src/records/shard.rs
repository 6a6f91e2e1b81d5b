//! Part i of n of a batch: every n-th file, from the i-th on.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Part `number` of `count`; the first is 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// Which part, from 1 to `count`.
    pub number: u32,
    /// How many parts there are.
    pub count: u32,
}

impl Shard {
    /// All of it.
    pub const WHOLE: Shard = Shard { number: 1, count: 1 };

    /// Does file `index`, counted from 0, belong to this part?
    pub fn has(self, index: usize) -> bool {
        index % self.count as usize == self.number as usize - 1
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (number, count) = text.split_once('/').ok_or("write it as i/n, such as 2/4")?;
        let whole = |text: &str| text.parse::<u32>().map_err(|_| "i and n are whole numbers".to_string());
        let shard = Shard {
            number: whole(number)?,
            count: whole(count)?,
        };
        if shard.number < 1 || shard.number > shard.count {
            return Err("i goes from 1 to n".into());
        }
        Ok(shard)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_disjoint_and_whole() {
        let parts: Vec<Shard> = (1..=3).map(|number| Shard { number, count: 3 }).collect();
        for index in 0..10 {
            assert_eq!(parts.iter().filter(|part| part.has(index)).count(), 1);
            assert!(Shard::WHOLE.has(index));
        }
        assert_eq!("2/3".parse(), Ok(parts[1]));
        for bad in ["", "2", "0/3", "4/3", "1/0", "a/b", "-1/2", "1/2/3"] {
            assert!(bad.parse::<Shard>().is_err(), "{bad}");
        }
    }
}
