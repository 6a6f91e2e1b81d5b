//! The terms of the model by name.

use brdfit_core::brdf::{ABSORBING, ALL, DIFFUSE, SURFACE, VOLUME};

use crate::engine::{Model, TERM_SETS};
use crate::error::{Error, shown};

/// The word for all terms that a model has.
const ALL_TERMS: &str = "all";

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
    if list == ALL_TERMS {
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

/// The same for some models, of which one at least must have each term of the list; `all` is what there is.
///
/// # Errors
/// As [`terms`], and a term that none of the models has.
pub fn terms_of(models: &[&Model], list: &str) -> Result<u8, Error> {
    let chosen = terms(list)?;
    let has = models.iter().fold(0, |has, model| has | model.terms);
    if list == ALL_TERMS || chosen & !has == 0 {
        return Ok(chosen);
    }
    let names: Vec<&str> = models.iter().map(|model| model.name).collect();
    let (who, verb) = match names[..] {
        [one] => (format!("the model {one}"), "has"),
        _ => (format!("the models {}", names.join(", ")), "have"),
    };
    Err(match has {
        0 => Error::new(format!("{who} {verb} no terms that could be left out")).help("leave out --terms"),
        _ => Error::new(format!("{who} {verb} no term {}", term_names(chosen & !has).join(", ")))
            .help(format!("take some of --terms {}", term_names(has).join(","))),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_have_the_terms_that_are_asked_for() {
        let of = |names: &[&str], list: &str| {
            let models: Vec<&Model> = names.iter().map(|name| Model::find(name).unwrap()).collect();
            terms_of(&models, list)
        };
        assert_eq!(of(&["beckmann"], "diffuse"), Ok(DIFFUSE));
        assert_eq!(of(&["abg", "beckmann"], "diffuse,surface"), Ok(DIFFUSE | SURFACE));
        assert_eq!(of(&["abg"], "all"), Ok(ALL));
        for (models, list, what) in [
            (&["abg"][..], "diffuse", "the model abg has no terms"),
            (&["abg", "k-correlation"], "diffuse", "k-correlation have no terms"),
            (
                &["cook-torrance"],
                "diffuse,surface,volume",
                "cook-torrance has no term volume",
            ),
        ] {
            let message = of(models, list).unwrap_err().to_string();
            assert!(message.contains(what) && message.contains("; "), "{message}");
        }
    }

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
