//! What remarks say about a whole table: `Incident Angle: 20`, `# wavelength = 550 nm`.

use super::head::Head;
use super::role::{self, Role};
use super::rows;
use super::unit::Unit;
use super::wavelength;
use crate::error::{Error, shown};
use crate::plain::some_of;

/// What the remarks of a file say.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Facts {
    /// Line and angle of incidence in degrees, as often as it is named.
    pub theta_i: Vec<(u64, f64)>,
    /// Line of the first angle of incidence that has no unit, which is taken for degrees.
    pub theta_i_without_unit: Option<u64>,
    /// Line and azimuth in degrees, of whatever direction.
    pub azimuths: Vec<(u64, f64)>,
    /// Wavelength, nanometres.
    pub wavelength: Option<f64>,
    /// Polarisation.
    pub polarisation: Option<String>,
    /// Name of the scan, as the program writes it.
    pub scan: Option<String>,
    /// True if the program wrote the file.
    pub own: bool,
}

/// The first line of tables that the program writes.
pub const OWN: &str = "# written by brdfit inspect: units and signs are settled";

impl Facts {
    /// What the remarks say; each is a line with its number.
    pub fn of<'a>(remarks: impl Iterator<Item = (u64, &'a str)>) -> Facts {
        let mut facts = Facts::default();
        for (line, remark) in remarks {
            facts.own |= remark.trim_end() == OWN;
            for (key, value) in pairs(remark) {
                facts.add(line, key, value);
            }
        }
        facts
    }

    fn add(&mut self, line: u64, key: &str, value: &str) {
        let head = Head::new(key);
        if head.plain == "scan" {
            self.scan = Some(value.to_string());
        }
        match role::role(&head) {
            Role::ThetaI => {
                self.theta_i.extend(degrees(&head, value).map(|angle| (line, angle)));
                let has_unit = head.unit.is_some() || quantity(value).is_some_and(|(_, unit)| unit.is_some());
                self.theta_i_without_unit = self.theta_i_without_unit.or((!has_unit).then_some(line));
            }
            Role::PhiI | Role::PhiS | Role::DeltaPhi | Role::Phi => {
                self.azimuths.extend(degrees(&head, value).map(|angle| (line, angle)));
            }
            Role::Wavelength => {
                let named =
                    quantity(value).and_then(|(number, unit)| wavelength::nanometres(number, head.unit.or(unit)).ok());
                self.wavelength = self.wavelength.or(named);
            }
            Role::Polarisation => self.polarisation = Some(value.to_string()).filter(|name| !name.is_empty()),
            _ => {}
        }
    }

    /// The one angle of incidence that the remarks name, degrees, if they do.
    ///
    /// # Errors
    /// They name several.
    pub fn one_theta_i(&self) -> Result<Option<f64>, Error> {
        let Some(&(first_line, first)) = self.theta_i.first() else {
            return Ok(None);
        };
        match self.theta_i.iter().find(|(_, angle)| *angle != first) {
            None => Ok(Some(first)),
            Some((line, other)) => Err(Error::new(format!(
                "the remarks name two angles of incidence, {first} on line {first_line} and {other} here"
            ))
            .at_line(*line)
            .help("give each angle a file of its own, or the table a column theta_i")),
        }
    }
}

/// The pairs of a key and a value in a remark: one, or several between commas or semicolons.
fn pairs(remark: &str) -> Vec<(&str, &str)> {
    let remark = remark
        .trim()
        .trim_start_matches(['#', '%', '!', ';', '/', '"', ' '])
        .trim_end_matches([',', ';', '"', ' ', '\t']);
    let pair = |text: &'_ str| -> Option<(usize, usize)> {
        let at = text.find([':', '='])?;
        Some((at, at + 1))
    };
    let cut = |text| -> Option<(&str, &str)> {
        let text: &str = text;
        let (end, begin) = pair(text)?;
        Some((
            text[..end].trim(),
            text[begin..].trim().trim_matches([',', ';', '"', '\t', ' ']),
        ))
    };
    for mark in [';', ','] {
        let parts: Vec<&str> = remark.split(mark).collect();
        if parts.len() > 1 && parts.iter().all(|part| cut(part).is_some()) {
            return parts.into_iter().filter_map(cut).collect();
        }
    }
    if let Some(pair) = cut(remark) {
        return vec![pair];
    }
    // A cell each, as spreadsheets write them, or a number after the name.
    let number = || {
        let at = remark.find(|c: char| c.is_ascii_digit() || "+-−".contains(c))?;
        let (key, value) = remark.split_at(at);
        // `AOI # 3` is a number of a list.
        let key = key.strip_suffix(char::is_whitespace).filter(|key| !key.contains('#'))?;
        let role = role::role(&Head::new(key));
        matches!(role, Role::ThetaI | Role::Wavelength).then_some((key, value))
    };
    let cells = remark.split_once(['\t', ';', ',']).or_else(number);
    cells
        .map(|(key, value)| (key.trim(), value.trim_matches(['\t', ';', ',', ' '])))
        .into_iter()
        .collect()
}

/// The angle that a remark gives, degrees, unless it is in another unit than these and radians.
fn degrees(head: &Head, value: &str) -> Option<f64> {
    let (number, unit) = quantity(value)?;
    match head.unit.or(unit) {
        None | Some(Unit::Deg) => Some(number),
        Some(Unit::Rad) => Some(number.to_degrees()),
        Some(_) => None,
    }
}

/// The number at the beginning of a value, and its unit.
fn quantity(value: &str) -> Option<(f64, Option<Unit>)> {
    let end = value
        .find(|c: char| !(c.is_ascii_digit() || ".,+-−eE".contains(c)))
        .unwrap_or(value.len());
    // `20e` of a unit that begins so is no exponent.
    let number = value[..end].trim_end_matches(['e', 'E', ',']);
    let (text, unit) = (
        rows::parse(number, rows::Decimal::Comma).or_else(|| number.parse().ok())?,
        &value[number.len()..],
    );
    let unit = unit.trim();
    if unit.is_empty() {
        return Some((text, None));
    }
    Some((text, Some(Unit::parse(unit)?)))
}

/// The angle in a text such as `20°`, `20 deg`, `AOI=20` or `theta_i: 20 deg`, degrees.
pub fn angle_in(text: &str) -> Option<f64> {
    let (head, value) = pairs(text)
        .first()
        .map_or((None, text), |(key, value)| (Some(Head::new(key)), *value));
    let of_incidence = head.as_ref().is_none_or(|head| role::role(head) == Role::ThetaI);
    let (number, unit) = quantity(value).filter(|_| of_incidence)?;
    match head.and_then(|head| head.unit).or(unit) {
        None | Some(Unit::Deg) => Some(number).filter(|number| number.is_finite()),
        _ => None,
    }
}

/// What is shown of an angle of incidence that a file does not have in a column.
pub fn missing_theta_i(names: &[String]) -> Error {
    let named: Vec<String> = names
        .iter()
        .map(|name| shown(name))
        .filter(|name| !name.is_empty())
        .collect();
    let among = if named.is_empty() {
        String::new()
    } else {
        format!(" among the columns {}", some_of(&named))
    };
    Error::new(format!(
        "no column theta_i_deg{among}, and neither a remark nor the name of the file gives the angle of incidence"
    ))
    .help("give it in degrees with --theta-i 20, or say which column it is with --columns theta_i=1")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remarks_of_many_forms() {
        for remark in [
            "Incident Angle: 20",
            "# theta_i = 20 deg",
            "#AOI=20.0°",
            "% angle of incidence (deg): 20",
            "\"Incident angle [deg]\",20,,",
            "Incident Angle\t20",
            "Incident angle 20 deg",
            "# AOI 20",
            "! wavelength: 550 nm; AOI: 20 deg",
            "theta_i=0.3490658503988659 rad",
            "Incidence angle: +20,0 deg",
        ] {
            let facts = Facts::of(std::iter::once((1, remark)));
            let theta_i = facts.one_theta_i().unwrap().unwrap_or_else(|| panic!("{remark}"));
            assert!((theta_i - 20.0).abs() < 1e-12, "{remark} {theta_i}");
        }
        for remark in [
            "# made at 20 deg",
            "Name: 20",
            "theta_s: 20",
            "AOI: 20 mV",
            "# theta_i theta_s brdf",
        ] {
            assert_eq!(
                Facts::of(std::iter::once((1, remark))).one_theta_i().unwrap(),
                None,
                "{remark}"
            );
        }
        let facts = Facts::of(
            [
                (1, "Wavelength: 0.55 µm"),
                (2, "Polarization: s"),
                (3, "AOI: 20"),
                (9, "AOI: 45"),
            ]
            .into_iter(),
        );
        assert_eq!(
            (facts.wavelength, facts.polarisation.as_deref()),
            (Some(550.0), Some("s"))
        );
        let error = facts.one_theta_i().unwrap_err();
        assert_eq!(error.line, Some(9));
    }
}
