//! Numbers as text: with all their digits for programs, with few for people.

/// The shortest decimal form that reads back as the same number.
pub fn shortest(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 || (1e-5..1e16).contains(&size) {
        format!("{x}")
    } else {
        format!("{x:e}")
    }
}

/// Rounded to this many significant digits, in its shortest form.
///
/// A power of ten stands where the number is below 1e-4, or where more digits than asked for (and more than four) would stand before the point.
pub fn significant(x: f64, digits: usize) -> String {
    let rounded: f64 = format!("{x:.*e}", digits.saturating_sub(1)).parse().unwrap_or(x);
    let plain = format!("{}", rounded.abs().trunc()).len() <= digits.max(4);
    if rounded == 0.0 || rounded.abs() >= 1e-4 && plain {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

/// Two significant digits, as an error has them.
pub fn two(x: f64) -> String {
    significant(x, 2)
}

/// Four significant digits.
pub fn four(x: f64) -> String {
    significant(x, 4)
}

/// Six significant digits.
pub fn six(x: f64) -> String {
    significant(x, 6)
}

/// A part with two significant digits, in percent.
pub fn percent(part: f64) -> String {
    format!("{:.*} %", decimals(100.0 * part), 100.0 * part)
}

/// The same rounded up, as a bound is; a percentage of few digits stays what it is.
pub fn percent_up(part: f64) -> String {
    let percent = 100.0 * part;
    let decimals = decimals(percent);
    let unit = [1.0, 10.0, 100.0, 1000.0][decimals];
    let up = (percent * unit * (1.0 - 1e-9)).ceil() / unit;
    format!("{up:.decimals$} %")
}

fn decimals(percent: f64) -> usize {
    match percent {
        _ if percent >= 9.95 => 0,
        _ if percent >= 0.995 => 1,
        _ if percent >= 0.0995 => 2,
        _ => 3,
    }
}

/// A number's text as it is set in print: with a true minus sign, and its exponent of ten apart.
pub fn set(text: &str) -> (String, Option<String>) {
    let minus = |text: &str| text.replace('-', "−");
    match text.split_once('e') {
        Some((mantissa, exponent)) => (minus(mantissa), Some(minus(exponent))),
        None => (minus(text), None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shortest_reads_back() {
        for x in [0.0, 45.0, -85.5, 0.1, 1e-33, 2.5e300, 1.0 / 3.0, f64::MIN_POSITIVE] {
            assert_eq!(shortest(x).parse::<f64>().unwrap(), x);
        }
        assert_eq!(shortest(45.0), "45");
        assert_eq!(shortest(1e-33), "1e-33");
    }

    #[test]
    fn digits_are_as_many_as_the_name_says() {
        let x = 0.123_456_789;
        assert_eq!([two(x), four(x), six(x)], ["0.12", "0.1235", "0.123457"]);
        for (x, digits, text) in [
            (0.0, 2, "0"),
            (1e-4, 2, "0.0001"),
            (9.96e-5, 2, "0.0001"),
            (9.94e-5, 2, "9.9e-5"),
            (-1234.0, 2, "-1200"),
            (12_345.0, 2, "1.2e4"),
            (9999.5, 4, "1e4"),
            (123_456.7, 6, "123457"),
            (1_234_567.0, 6, "1.23457e6"),
            (f64::INFINITY, 2, "inf"),
        ] {
            assert_eq!(significant(x, digits), text);
        }
        assert_eq!(set("-1.5e-7"), ("−1.5".into(), Some("−7".into())));
        assert_eq!([0.0994, 0.5, 0.00123].map(percent), ["9.9 %", "50 %", "0.12 %"]);
    }
}
