//! Units as people write them in the heads of columns and in remarks.

/// A unit of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unit {
    /// Degrees.
    Deg,
    /// Radians.
    Rad,
    /// sr^-1.
    PerSr,
    /// A power of ten of sr^-1, as `10^-3 sr^-1` or per mille.
    Multiple,
    /// None, as of a ratio.
    One,
    /// Percent.
    Percent,
    /// A length, with the nanometres in it.
    Length(f64),
    /// cm^-1, of a wavenumber.
    PerCm,
    /// A known unit of something that no column here can hold, such as mV or counts.
    Foreign,
}

/// Units by their spelling, in lower case and without spaces, `^` and `*`.
const SPELLINGS: [(&str, Unit); 131] = [
    ("deg", Unit::Deg),
    ("degs", Unit::Deg),
    ("degree", Unit::Deg),
    ("degrees", Unit::Deg),
    ("grad", Unit::Foreign),
    ("gon", Unit::Foreign),
    ("°", Unit::Deg),
    ("º", Unit::Deg),
    ("rad", Unit::Rad),
    ("rads", Unit::Rad),
    ("radian", Unit::Rad),
    ("radians", Unit::Rad),
    ("mrad", Unit::Foreign),
    ("arcmin", Unit::Foreign),
    ("arcsec", Unit::Foreign),
    ("arcminute", Unit::Foreign),
    ("arcminutes", Unit::Foreign),
    ("arcsecond", Unit::Foreign),
    ("arcseconds", Unit::Foreign),
    ("'", Unit::Foreign),
    ("′", Unit::Foreign),
    ("’", Unit::Foreign),
    ("\"", Unit::Foreign),
    ("″", Unit::Foreign),
    ("”", Unit::Foreign),
    ("µrad", Unit::Foreign),
    ("urad", Unit::Foreign),
    ("1/sr", Unit::PerSr),
    ("/sr", Unit::PerSr),
    ("sr-1", Unit::PerSr),
    ("sr−1", Unit::PerSr),
    ("sr⁻¹", Unit::PerSr),
    ("sr1", Unit::PerSr),
    ("1sr", Unit::PerSr),
    ("persr", Unit::PerSr),
    ("per_sr", Unit::PerSr),
    ("per-sr", Unit::PerSr),
    ("invsr", Unit::PerSr),
    ("inv_sr", Unit::PerSr),
    ("1/steradian", Unit::PerSr),
    ("steradian-1", Unit::PerSr),
    ("persteradian", Unit::PerSr),
    ("per_steradian", Unit::PerSr),
    ("1", Unit::One),
    ("-", Unit::One),
    ("none", Unit::One),
    ("unitless", Unit::One),
    ("dimensionless", Unit::One),
    ("ratio", Unit::One),
    ("%", Unit::Percent),
    ("percent", Unit::Percent),
    ("percentage", Unit::Percent),
    ("pct", Unit::Percent),
    ("‰", Unit::Multiple),
    ("permille", Unit::Multiple),
    ("per_mille", Unit::Multiple),
    ("permil", Unit::Multiple),
    ("promille", Unit::Multiple),
    ("‱", Unit::Multiple),
    ("ppm", Unit::Multiple),
    ("ppb", Unit::Multiple),
    ("nm", Unit::Length(1.0)),
    ("nanometer", Unit::Length(1.0)),
    ("nanometers", Unit::Length(1.0)),
    ("nanometre", Unit::Length(1.0)),
    ("nanometres", Unit::Length(1.0)),
    ("um", Unit::Length(1e3)),
    // The sign of micro and the Greek letter are different characters.
    ("µm", Unit::Length(1e3)),
    ("μm", Unit::Length(1e3)),
    ("micron", Unit::Length(1e3)),
    ("microns", Unit::Length(1e3)),
    ("micrometer", Unit::Length(1e3)),
    ("micrometers", Unit::Length(1e3)),
    ("micrometre", Unit::Length(1e3)),
    ("micrometres", Unit::Length(1e3)),
    ("mm", Unit::Length(1e6)),
    ("m", Unit::Length(1e9)),
    ("meter", Unit::Length(1e9)),
    ("meters", Unit::Length(1e9)),
    ("metre", Unit::Length(1e9)),
    ("metres", Unit::Length(1e9)),
    ("å", Unit::Length(0.1)),
    ("å", Unit::Length(0.1)),
    ("aa", Unit::Length(0.1)),
    ("ang", Unit::Length(0.1)),
    ("angstrom", Unit::Length(0.1)),
    ("angstroms", Unit::Length(0.1)),
    ("ångström", Unit::Length(0.1)),
    ("ångstrom", Unit::Length(0.1)),
    ("cm-1", Unit::PerCm),
    ("cm−1", Unit::PerCm),
    ("cm⁻¹", Unit::PerCm),
    ("1/cm", Unit::PerCm),
    ("per_cm", Unit::PerCm),
    ("percm", Unit::PerCm),
    ("1/nm", Unit::Foreign),
    ("nm-1", Unit::Foreign),
    ("1/um", Unit::Foreign),
    ("um-1", Unit::Foreign),
    ("1/µm", Unit::Foreign),
    ("µm-1", Unit::Foreign),
    ("1/μm", Unit::Foreign),
    ("μm-1", Unit::Foreign),
    ("1/mm", Unit::Foreign),
    ("mm-1", Unit::Foreign),
    ("1/m", Unit::Foreign),
    ("m-1", Unit::Foreign),
    ("v", Unit::Foreign),
    ("mv", Unit::Foreign),
    ("µv", Unit::Foreign),
    ("uv", Unit::Foreign),
    ("volt", Unit::Foreign),
    ("volts", Unit::Foreign),
    ("a", Unit::Foreign),
    ("ma", Unit::Foreign),
    ("µa", Unit::Foreign),
    ("ua", Unit::Foreign),
    ("na", Unit::Foreign),
    ("pa", Unit::Foreign),
    ("w", Unit::Foreign),
    ("mw", Unit::Foreign),
    ("counts", Unit::Foreign),
    ("cts", Unit::Foreign),
    ("dn", Unit::Foreign),
    ("a.u.", Unit::Foreign),
    ("au", Unit::Foreign),
    ("arb.u.", Unit::Foreign),
    ("arb.units", Unit::Foreign),
    ("db", Unit::Foreign),
    ("thz", Unit::Foreign),
    ("ev", Unit::Foreign),
];

impl Unit {
    /// The unit that a text in brackets, or alone in a cell, names.
    pub fn parse(text: &str) -> Option<Unit> {
        let text = text.trim().trim_matches(['[', ']', '(', ')']);
        let spelt: String = text
            .chars()
            .filter(|c| !c.is_whitespace() && *c != '^' && *c != '*')
            .flat_map(char::to_lowercase)
            .collect();
        // Radiances and intensities, such as W/m2/sr, are no BRDF.
        let physical = ["w/", "cd/", "mw/", "w·", "lx", "lux", "cd", "lm/"];
        let known = SPELLINGS.iter().find(|(spelling, _)| *spelling == spelt);
        known
            .map(|&(_, unit)| unit)
            .or_else(|| is_multiple(&spelt).then_some(Unit::Multiple))
            .or_else(|| {
                physical
                    .iter()
                    .any(|start| spelt.starts_with(start))
                    .then_some(Unit::Foreign)
            })
    }

    /// A name without the unit that it ends in, and that unit: after a slash, a colon, a space or an underscore, or glued as in `thetadeg`.
    ///
    /// Units of one or two letters count only after a slash, for they may as well be an index.
    pub fn at_end(name: &str) -> (&str, Option<Unit>) {
        let name = name.trim();
        for (at, mark) in name
            .char_indices()
            .filter(|&(_, c)| matches!(c, '/' | ' ' | '_' | ',' | ':'))
        {
            let (before, after) = (&name[..at], &name[at + mark.len_utf8()..]);
            let before = before.trim_end_matches([' ', '_', ',', '/', ':']);
            let index = after.trim().chars().filter(|c| c.is_alphabetic()).count() <= 1 && mark != '/';
            if !before.contains(char::is_alphanumeric)
                || (index && !after.contains(['°', 'º', '%', '‰', 'Å', 'å']))
                || ambiguous(after, mark)
            {
                continue;
            }
            if let Some(unit) = Unit::parse(after) {
                // `theta in deg` may be the angle of incidence.
                let is_angle = matches!(unit, Unit::Deg | Unit::Rad);
                let shorter = before.strip_suffix(" in").filter(|_| !is_angle);
                return (shorter.unwrap_or(before).trim_end(), Some(unit));
            }
        }
        const GLUED: [&str; 9] = ["degrees", "degree", "deg", "°", "radians", "radian", "%", "‰", "nm"];
        for unit in GLUED {
            let cut = name
                .len()
                .checked_sub(unit.len())
                .filter(|&cut| cut > 0 && name.is_char_boundary(cut));
            if let Some(cut) = cut.filter(|&cut| name[cut..].eq_ignore_ascii_case(unit)) {
                return (name[..cut].trim_end(), Unit::parse(unit));
            }
        }
        // A wavelength as `0.55um` or `5500Å`.
        let digits = name.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
        if digits.len() < name.len()
            && !digits.is_empty()
            && let Some(unit @ (Unit::Length(_) | Unit::PerCm)) = Unit::parse(digits)
        {
            return (&name[..name.len() - digits.len()], Some(unit));
        }
        (name, None)
    }
}

/// True of a power of ten in front of sr^-1, or behind a sign of multiplication.
fn is_multiple(spelt: &str) -> bool {
    let marked = spelt.strip_prefix(['x', '×', '·']);
    let rest = marked.unwrap_or(spelt);
    let is_power = |c: char| c.is_ascii_digit() || "e+-−⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹·×".contains(c);
    let known = SPELLINGS.iter().filter(|(_, unit)| *unit == Unit::PerSr);
    let mut powers = known
        .filter_map(|(spelling, _)| rest.strip_suffix(spelling))
        .chain(marked);
    powers.any(|power| power.len() > 2 && power.starts_with('1') && power.chars().all(is_power))
}

/// True of a text that is a unit in brackets, and in a name may be another thing.
fn ambiguous(after: &str, mark: char) -> bool {
    let plain = after.trim().to_lowercase();
    mark != '/'
        && [
            "1", "-", "none", "ratio", "ang", "ma", "na", "pa", "dn", "au", "aa", "sr1", "1sr",
        ]
        .contains(&plain.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_at_the_end_of_a_name() {
        for (name, short, unit) in [
            ("theta_s_deg", "theta_s", Some(Unit::Deg)),
            ("thetasdeg", "thetas", Some(Unit::Deg)),
            ("brdf per sr", "brdf", Some(Unit::PerSr)),
            ("brdf:1/sr", "brdf", Some(Unit::PerSr)),
            ("BRDF in 1/sr", "BRDF", Some(Unit::PerSr)),
            ("wavelength in nm", "wavelength", Some(Unit::Length(1.0))),
            ("theta in deg", "theta in", Some(Unit::Deg)),
            ("lambda/m", "lambda", Some(Unit::Length(1e9))),
            ("wavenumber cm^-1", "wavenumber", Some(Unit::PerCm)),
            ("0.55um", "0.55", Some(Unit::Length(1e3))),
            ("signal_mV", "signal", Some(Unit::Foreign)),
            ("theta_m", "theta_m", None),
            ("brdf_R", "brdf_R", None),
            ("brdf_1", "brdf_1", None),
            ("deg", "deg", None),
        ] {
            assert_eq!(Unit::at_end(name), (short, unit), "{name}");
        }
        assert_eq!(Unit::parse("[1 / sr]"), Some(Unit::PerSr));
        for multiple in ["(10^-3 sr^-1)", "10⁻³ sr⁻¹", "x10^-3 1/sr", "1e-3 sr-1", "×10^3"] {
            assert_eq!(Unit::parse(multiple), Some(Unit::Multiple), "{multiple}");
        }
        assert_eq!(
            (Unit::parse("1e-3"), Unit::parse("x10"), Unit::parse("100")),
            (None, None, None)
        );
        assert_eq!(Unit::at_end("BRDF ‰"), ("BRDF", Some(Unit::Multiple)));
        for foreign in ["W/m^2/sr", "(1/um)", "[µm^-1]", "(')", "(″)", "arcseconds"] {
            assert_eq!(Unit::parse(foreign), Some(Unit::Foreign), "{foreign}");
        }
        assert_eq!(Unit::parse("sample"), None);
    }
}
