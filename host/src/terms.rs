//! The terms of the model by name.

use brdfit_core::brdf::{ABSORBING, ALL, DIFFUSE, SURFACE, VOLUME};

use crate::engine::TERM_SETS;
use crate::error::{Error, shown};

/// The terms of the model by name.
pub const TERMS: [(&str, u8); 4] = [
    ("diffuse", DIFFUSE),
    ("surface", SURFACE),
    ("volume", VOLUME),
    ("absorbing", ABSORBING),
];

/// The names in a set of terms.
pub fn term_names(terms: u8) -> Vec<&'static str> {
    let present = TERMS.iter().filter(|(_, bit)| terms & bit != 0);
    present.map(|&(name, _)| name).collect()
}

/// The set of terms in a list such as `diffuse,surface`, or `all`.
///
/// # Errors
/// An unknown name, or a set that is not compiled in.
pub fn terms(list: &str) -> Result<u8, Error> {
    let fail = |what: String| {
        let sets: Vec<String> = TERM_SETS.iter().map(|&set| term_names(set).join(",")).collect();
        Error::new(what).help(format!("--terms takes one of: {}", sets.join(" | ")))
    };
    if list == "all" {
        return Ok(ALL);
    }
    let mut set = 0;
    for name in list.split(',').map(str::trim) {
        match TERMS.iter().find(|(known, _)| *known == name) {
            Some((_, bit)) => set |= bit,
            None => return Err(fail(format!("there is no term '{}'", shown(name)))),
        }
    }
    if TERM_SETS.contains(&set) {
        Ok(set)
    } else {
        Err(fail(format!("there is no model of just the terms {list}")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_terms() {
        assert_eq!(terms("surface,diffuse").unwrap(), DIFFUSE | SURFACE);
        assert_eq!(terms("all").unwrap(), ALL);
        assert!(terms("volume").unwrap_err().to_string().contains("diffuse,surface |"));
        assert!(terms("shiny").is_err() && terms("").is_err());
        for set in TERM_SETS {
            assert_eq!(terms(&term_names(set).join(",")).unwrap(), set);
        }
    }
}
