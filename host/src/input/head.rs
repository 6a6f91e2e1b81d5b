//! What the head of a column says: its name, its unit, its coverage factor.

use std::cell::RefCell;

use super::lately::Lately;
use super::unit::Unit;

/// The head of a column.
#[derive(Clone, Debug, PartialEq)]
pub struct Head {
    /// As it stands in the file.
    pub text: String,
    /// The name without unit, case, spaces and punctuation; Greek letters are spelt.
    pub plain: String,
    /// The places in that where something stood between two letters, or a capital began.
    pub breaks: Vec<usize>,
    /// The unit, if it names one.
    pub unit: Option<Unit>,
    /// The coverage factor in `U (k=2)`.
    pub coverage: Option<f64>,
}

impl Head {
    /// Takes a head apart: `Theta_i [deg]`, `lambda / nm`, `BRDF (1/sr)`, `wavelength_um`, `U (k=2)`.
    pub fn new(text: &str) -> Head {
        thread_local! {
            static LATELY: RefCell<Lately<String, Head>> = const { RefCell::new(Lately::new()) };
        }
        LATELY.with_borrow_mut(|lately| lately.of(text, || Head::taken_apart(text)))
    }

    fn taken_apart(text: &str) -> Head {
        let mut head = Head {
            text: text.trim().to_string(),
            plain: String::new(),
            breaks: Vec::new(),
            unit: None,
            coverage: None,
        };
        let mut name = String::new();
        let mut rest = text.trim();
        while let Some((before, inside, after)) = brackets(rest) {
            name.push_str(before);
            rest = after;
            if let Some(factor) = coverage(inside) {
                head.coverage = Some(factor);
            } else if let Some(unit) = Unit::parse(inside) {
                head.unit = Some(unit);
            } else {
                // Part of the name, as in `ln(BRDF)`, and perhaps with both, as in `U (k=2, %)`.
                let parts: Vec<&str> = inside.split([',', ';']).collect();
                let known = |part: &&str| coverage(part).is_some() || Unit::parse(part).is_some();
                if parts.len() > 1 && parts.iter().all(known) {
                    for part in parts {
                        head.coverage = coverage(part).or(head.coverage);
                        head.unit = Unit::parse(part).or(head.unit);
                    }
                } else {
                    name.push_str(&format!(" {inside} "));
                }
            }
        }
        name.push_str(rest);
        if head.coverage.is_none() {
            // Without brackets, as in `U k=2`.
            if let Some((before, factor)) = name
                .trim_end()
                .rsplit_once([' ', '_', ','])
                .and_then(|(a, b)| Some((a, coverage(b)?)))
            {
                head.coverage = Some(factor);
                name = before.to_string();
            }
        }
        if head.unit.is_none()
            && let Some(unit @ Unit::Length(..=1e3)) = Unit::parse(&name)
            && name.trim().chars().count() > 1
        {
            // A column called `nm` holds wavelengths.
            head.unit = Some(unit);
        } else if head.unit.is_none() {
            let (short, unit) = Unit::at_end(&name);
            head.unit = unit;
            name = short.to_string();
        }
        (head.plain, head.breaks) = with_breaks(&name);
        head
    }

    /// The same column with a unit from a line of units, which counts only where the name has none.
    pub fn with_unit(mut self, text: &str) -> Head {
        self.unit = self.unit.or_else(|| Unit::parse(text));
        self
    }
}

/// The text before the first brackets, inside them and after them.
fn brackets(text: &str) -> Option<(&str, &str, &str)> {
    let begin = text.find(['[', '('])?;
    let close = if text[begin..].starts_with('[') { ']' } else { ')' };
    let end = begin + text[begin..].find(close)?;
    Some((&text[..begin], &text[begin + 1..end], &text[end + 1..]))
}

/// The factor in `k=2` or `k = 1.96`.
fn coverage(text: &str) -> Option<f64> {
    let (name, factor) = text.split_once('=')?;
    let factor: f64 = factor.trim().parse().ok()?;
    (name.trim().eq_ignore_ascii_case("k") && factor > 0.0 && factor.is_finite()).then_some(factor)
}

/// A name without what people write differently: case, spaces, punctuation, a unit at the end; Greek letters are spelt.
pub fn plain(name: &str) -> String {
    with_breaks(name).0
}

/// The same with the places where something stood between two letters, or a capital began.
fn with_breaks(name: &str) -> (String, Vec<usize>) {
    if ["+-", "+/-"].contains(&name.trim()) {
        return ("sigma".to_string(), Vec::new());
    }
    let name = Unit::at_end(name).0;
    let mut plain = String::with_capacity(name.len());
    let mut breaks: Vec<usize> = Vec::new();
    let mut was_small = false;
    let minus = name.trim_start().strip_prefix(['-', '\u{2212}', '\u{2013}']);
    if minus.is_some_and(|rest| rest.starts_with(|c: char| c.is_alphabetic() || c == '(')) {
        // Such as `-log10(BRDF)`.
        plain.push_str("minus");
    }
    let mut letters = name.char_indices().peekable();
    while let Some((at, written)) = letters.next() {
        let next = letters.peek().map(|(_, next)| next);
        let begin = plain.len();
        let is_capital = written.is_uppercase() && was_small;
        was_small = written.is_lowercase();
        for c in written.to_lowercase() {
            match c {
                'θ' | 'ϑ' => plain.push_str("theta"),
                'φ' | 'ϕ' => plain.push_str("phi"),
                'δ' | '∆' => plain.push_str("delta"),
                'λ' => plain.push_str("lambda"),
                'σ' => plain.push_str("sigma"),
                '±' => plain.push_str("sigma"),
                // What is computed of a value is another.
                '√' | '∛' => plain.push_str("root"),
                '∂' => plain.push_str("delta"),
                '′' => plain.push_str("prime"),
                '/' | '÷' if plain == "1" || is_divisor(&name[at + c.len_utf8()..]) => plain.push_str("over"),
                'ᵢ' => plain.push('i'),
                'ᵣ' => plain.push('r'),
                'ₛ' => plain.push('s'),
                'ₒ' => plain.push('o'),
                '₀' => plain.push('0'),
                // A point counts within a number alone.
                '.' if next.is_some_and(char::is_ascii_digit) => plain.push(c),
                // The number of an angle in a list is no angle.
                '#' if begin > 0 => plain.push_str("no"),
                c if c.is_alphanumeric() => plain.push(c),
                _ => {}
            }
        }
        let is_break = is_capital || plain.len() == begin;
        if is_break && begin > 0 && breaks.last() != Some(&begin) {
            breaks.push(begin);
        }
    }
    (plain, breaks)
}

/// Does a text begin with what values are divided by?
fn is_divisor(text: &str) -> bool {
    let letters = || text.trim_start().chars().flat_map(char::to_lowercase);
    ["cos", "brdf"]
        .iter()
        .any(|word| letters().take(word.len()).eq(word.chars()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(text: &str) -> (String, Option<Unit>, Option<f64>) {
        let head = Head::new(text);
        (head.plain, head.unit, head.coverage)
    }

    #[test]
    fn name_unit_and_coverage_come_apart() {
        let angle = |name: &str| (name.to_string(), Some(Unit::Deg), None);
        for text in [
            "theta_i_deg",
            "Theta_i [deg]",
            "THETA I (degrees)",
            "θ_i / °",
            "θi (°)",
            "theta_i deg",
            "theta_i/deg",
        ] {
            assert_eq!(seen(text), angle("thetai"), "{text}");
        }
        for text in [
            "BRDF (1/sr)",
            "brdf_per_sr",
            "BRDF [sr^-1]",
            "brdf_sr-1",
            "BRDF (sr⁻¹)",
            "BRDF, 1/sr",
        ] {
            assert_eq!(seen(text), ("brdf".to_string(), Some(Unit::PerSr), None), "{text}");
        }
        assert_eq!(seen("BRF (%)"), ("brf".to_string(), Some(Unit::Percent), None));
        assert_eq!(seen("ln(BRDF)"), ("lnbrdf".to_string(), None, None));
        assert_eq!(seen("brdf*cos(theta_s)").0, "brdfcosthetas");
        for (text, name) in [
            ("-log10(BRDF)", "minuslog10brdf"),
            ("\u{2212}theta_s", "minusthetas"),
            ("√BRDF", "rootbrdf"),
            ("BRDF′", "brdfprime"),
            ("BRDF / cos(theta_s)", "brdfovercosthetas"),
            ("1/sigma", "1oversigma"),
            ("sigma / BRDF", "sigmaoverbrdf"),
            ("theta_s/theta_i", "thetasthetai"),
            ("- AOI -", "aoi"),
        ] {
            assert_eq!(seen(text).0, name, "{text}");
        }
        assert_eq!(seen("U (k=2)"), ("u".to_string(), None, Some(2.0)));
        assert_eq!(seen("U (k=2, %)"), ("u".to_string(), Some(Unit::Percent), Some(2.0)));
        assert_eq!(seen("U_BRDF k=1.96").2, Some(1.96));
        assert_eq!(seen("U, k=2 [%]"), ("u".to_string(), Some(Unit::Percent), Some(2.0)));
        assert_eq!(seen("wavelength_um").1, Some(Unit::Length(1e3)));
        assert_eq!(seen("550 nm"), ("550".to_string(), Some(Unit::Length(1.0)), None));
        assert_eq!(seen("signal (mV)").1, Some(Unit::Foreign));
        assert_eq!(seen("nm"), ("nm".to_string(), Some(Unit::Length(1.0)), None));
        assert_eq!(
            (seen("±").0, seen("+/- [%]").0),
            ("sigma".to_string(), "sigma".to_string())
        );
        assert_eq!(seen("m"), ("m".to_string(), None, None));
        assert_eq!(seen("brdf_m").1, None);
    }
}
