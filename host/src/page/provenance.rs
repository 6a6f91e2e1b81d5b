//! What someone needs who wants to make the same page again.

use std::ffi::OsString;

use maud::{Markup, html};

use crate::engine::FitOptions;
use crate::input::source::Source;
use crate::names;
use crate::plain::plain;

/// The command and the program.
pub fn origin(command: &str) -> Markup {
    html! {
        tr { th.text { "command" } td.text { code { (command) } } }
        tr { th.text { "program" } td.text { "brdfit " (env!("CARGO_PKG_VERSION")) } }
    }
}

/// How was searched.
pub fn search(options: &FitOptions) -> Markup {
    html! {
        tr { th.text { "search" } td.text {
            (names::method(options.method)) " of " (options.starts()) " starts, seed " (options.seed) ", "
            (names::precision(options.precision)) @if options.robust { ", robust" }
        } }
    }
}

/// The files that were read.
pub fn sources(sources: &[Source]) -> Markup {
    html! {
        @for source in sources {
            tr { th.text { "input" } td.text { (plain(&source.file)) ", " (source.bytes) " bytes" } }
            tr { th.text { "SHA-256" } td.text { code { (source.sha256) } } }
        }
    }
}

/// The arguments as a line for a shell, the program by its plain name.
pub fn command(given: &[OsString]) -> String {
    let words = given.iter().skip(1).map(|word| {
        let word = word.to_string_lossy();
        // Only a NUL cannot be quoted, and no system passes one in an argument.
        shlex::try_quote(&word).map_or_else(|_| word.to_string(), |quoted| quoted.to_string())
    });
    std::iter::once("brdfit".to_string())
        .chain(words)
        .map(|word| plain(&word).into_owned())
        .collect::<Vec<_>>()
        .join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotes_for_a_shell() {
        let given = ["/usr/bin/brdfit", "report", "black paint.csv", "--mask-retro", "6"];
        assert_eq!(
            command(&given.map(OsString::from)),
            "brdfit report 'black paint.csv' --mask-retro 6"
        );
    }
}
