//! Wrong usage as an error of the program, in clap's words.

use std::error::Error as _;

use clap::error::{ContextKind, ContextValue, ErrorKind};

use crate::error::Error;

/// What clap found wrong, as one line without its word `error`, its hints and its summary of the usage.
pub fn usage(error: &clap::Error) -> Error {
    let told = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => text.clone(),
        Some(ContextValue::Strings(texts)) => texts.join(" "),
        _ => String::new(),
    };
    let (argument, value) = (told(ContextKind::InvalidArg), told(ContextKind::InvalidValue));
    let mut what = match error.kind() {
        ErrorKind::InvalidValue if value.is_empty() => {
            format!("a value is required for '{argument}' but none was supplied")
        }
        ErrorKind::InvalidValue => format!("invalid value '{value}' for '{argument}'"),
        ErrorKind::ValueValidation => match error.source() {
            Some(source) => format!("invalid value '{value}' for '{argument}': {source}"),
            None => format!("invalid value '{value}' for '{argument}'"),
        },
        ErrorKind::UnknownArgument => format!("unexpected argument '{argument}' found"),
        ErrorKind::ArgumentConflict => match (told(ContextKind::PriorArg), error.get(ContextKind::PriorArg)) {
            (other, _) if other == argument => format!("the argument '{argument}' cannot be used multiple times"),
            (other, Some(ContextValue::Strings(_))) => {
                format!("the argument '{argument}' cannot be used with: {other}")
            }
            (other, _) => format!("the argument '{argument}' cannot be used with '{other}'"),
        },
        ErrorKind::MissingRequiredArgument => format!("the following required arguments were not provided: {argument}"),
        ErrorKind::InvalidSubcommand => {
            format!("unrecognized subcommand '{}'", told(ContextKind::InvalidSubcommand))
        }
        ErrorKind::NoEquals => format!("equal sign is needed when assigning values to '{argument}'"),
        ErrorKind::TooManyValues => {
            format!("unexpected value '{value}' for '{argument}' found; no more were expected")
        }
        kind => kind.as_str().unwrap_or("wrong usage").to_string(),
    };
    if let (ErrorKind::InvalidValue, Some(ContextValue::Strings(values))) =
        (error.kind(), error.get(ContextKind::ValidValue))
        && !values.is_empty()
    {
        what.push_str(&format!(" [possible values: {}]", values.join(", ")));
    }
    Error::new(what)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn says_what_clap_says() {
        let wrong = [
            "fit --method best",
            "fit --method",
            "fit --seed=x",
            "fit --bounds rho_d=2",
            "fit --colour",
            "fit --fix m=1 --quiet --quiet a.csv",
            "fit --terms",
            "export a.json",
            "export a.json --to blender",
            "fly",
            "report --out=",
            "completions",
            "completions fish too",
            "fit --drop-invalid=yes a.csv",
        ];
        for words in wrong {
            let words = std::iter::once("brdfit").chain(words.split(' '));
            let error = crate::cli::command().try_get_matches_from(words.clone()).map(drop);
            let error = match error {
                Err(error) => error,
                Ok(()) => panic!("{:?} is right", words.collect::<Vec<_>>()),
            };
            let text = error.to_string();
            let told: Vec<&str> = text.split("\n\n").next().unwrap().lines().map(str::trim).collect();
            assert_eq!(format!("error: {}", usage(&error).what), told.join(" "));
        }
    }
}
