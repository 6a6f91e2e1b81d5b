//! Numbers for people.

/// Six significant digits, for reading.
pub fn digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    if rounded == 0.0 || (1e-3..1e6).contains(&rounded.abs()) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

/// Two significant digits.
pub fn short(x: f64) -> String {
    significant(x, 1)
}

/// Four significant digits.
pub fn four(x: f64) -> String {
    significant(x, 3)
}

/// One digit and `decimals` more.
pub fn significant(x: f64, decimals: usize) -> String {
    let text = format!("{x:.decimals$e}");
    let rounded: f64 = text.parse().unwrap_or(x);
    if rounded == 0.0 || (1e-4..1e4).contains(&rounded.abs()) {
        format!("{rounded}")
    } else {
        text
    }
}

/// A part with two significant digits, in percent.
pub fn percent(part: f64) -> String {
    let percent = 100.0 * part;
    let decimals = match percent {
        _ if percent >= 9.95 => 0,
        _ if percent >= 0.995 => 1,
        _ if percent >= 0.0995 => 2,
        _ => 3,
    };
    format!("{percent:.decimals$} %")
}
