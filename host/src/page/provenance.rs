//! What someone needs who wants to make the same page again.

use std::ffi::OsString;

use crate::plain::plain;

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
