//! Columns of values that are each of one angle, which their heads give: `brdf_20`, `BRDF (40 deg)`, `AOI 20, R`, `u_20deg`.

use super::columns::{Columns, Polar};
use super::find;
use super::head::Head;
use super::options::ReadOptions;
use super::part::{self, Part};
use super::role::{self, Role};
use super::unit::Unit;
use super::units::Angles;
use super::{channel, uncertainty};
use crate::error::{Error, shown};
use crate::number::shortest;
use crate::plain::some_of;

/// What a head gives.
#[derive(Clone, Debug, PartialEq)]
pub struct At {
    /// The angle, degrees.
    pub degrees: f64,
    /// The angle's name, if the head has it.
    pub polar: Option<Polar>,
    /// True if the head has the name or the unit of the angle; a bare number may be a wavelength, or count.
    pub sure: bool,
    /// What else it says, as the name of a column of its own.
    pub rest: Head,
}

/// The angle in a head, and what else it says; `None` of one that says anything but a value or its uncertainty.
pub fn at(text: &str) -> Option<At> {
    let whole = Head::new(text);
    let is_value = |of: String| of.is_empty() || role::quantity(&of).is_some();
    if !matches!(role::role(&whole), Role::Unknown(_)) || uncertainty::of(&whole).any(is_value) {
        return None;
    }
    let bytes = text.as_bytes();
    let mut begin = 0;
    let mut found: Option<At> = None;
    while let Some(digit) = text[begin..].find(|c: char| c.is_ascii_digit()) {
        let first = begin + digit;
        let end = text[first..]
            .find(|c: char| !c.is_ascii_digit() && c != '.')
            .map_or(text.len(), |length| first + length);
        begin = end;
        // A minus is a sign behind what is no name, and else parts the name from the number.
        let is_sign = first > 0
            && bytes[first - 1] == b'-'
            && !text[..first - 1].ends_with(|c: char| c.is_alphanumeric() || c == ')');
        let first = if is_sign { first - 1 } else { first };
        let number = text[first..end].trim_end_matches('.');
        let end = first + number.len();
        let one = number.parse().ok().and_then(|number| split(text, first, end, number));
        // What has the unit or the name goes before a bare number, and of these the last.
        if one
            .as_ref()
            .is_some_and(|one| one.sure || found.as_ref().is_none_or(|known| !known.sure))
        {
            found = one;
        }
    }
    found
}

/// The head without the number between `first` and `end`, if what is around that is the name and the unit of an angle, and the rest a value.
fn split(text: &str, first: usize, end: usize, number: f64) -> Option<At> {
    const MARKS: [char; 8] = ['_', '-', ' ', '=', '@', ',', ':', '/'];
    const OPEN: [char; 2] = ['(', '['];
    let is_mark = |c: char| MARKS.contains(&c) || OPEN.contains(&c);
    let before = text[..first].trim_end_matches(is_mark);
    let after = text[end..].trim_start_matches(['_', ' ']);
    // The unit, and what of the number's brackets is left.
    let letters = after
        .find(|c: char| !c.is_alphabetic() && c != '°')
        .unwrap_or(after.len());
    let (unit, beyond) = after.split_at(letters);
    let (factor, beyond) = match Unit::parse(unit) {
        Some(Unit::Deg) => (Some(1.0), beyond),
        Some(Unit::Rad) => (Some(1f64.to_degrees()), beyond),
        Some(_) => return None,
        None if text[end..].starts_with(|c: char| c.is_alphabetic()) => return None,
        None => (None, after),
    };
    let beyond = beyond.trim_start_matches([')', ']']).trim_start_matches(MARKS);
    // The name of the angle is one word before the number or two, as in `theta_i_20`; `at` is no part of a name.
    let words: Vec<(usize, &str)> = before
        .match_indices(|c: char| c.is_alphanumeric())
        .map(|(at, _)| at)
        .filter(|&at| !before[..at].ends_with(|c: char| c.is_alphanumeric()))
        .map(|at| (at, &before[at..]))
        .collect();
    let polar = |name: &str| match role::role(&Head::new(name)) {
        Role::ThetaI => Some(Polar::Incidence),
        Role::ThetaS => Some(Polar::Scattering),
        _ => None,
    };
    let named = words
        .iter()
        .rev()
        .take(3)
        .rev()
        .find_map(|&(at, name)| Some((at, polar(name)?)));
    let before = named.map_or(before, |(at, _)| &before[..at]).trim_end_matches(is_mark);
    let before = match before.rsplit_once(is_mark) {
        Some((short, last)) if ["at", "for"].iter().any(|word| last.eq_ignore_ascii_case(word)) => {
            short.trim_end_matches(is_mark)
        }
        _ => before,
    };
    let rest = match (before.is_empty(), beyond.is_empty()) {
        (true, true) => "brdf".to_string(),
        (true, false) => beyond.to_string(),
        (false, true) => before.to_string(),
        (false, false) => format!("{before} {beyond}"),
    };
    let sure = factor.is_some() || named.is_some();
    let degrees = number * factor.unwrap_or(1.0);
    let rest = Head::new(&rest);
    // A number alone is the head of a wavelength or of a matrix.
    let is_alone = !sure && before.is_empty() && beyond.is_empty();
    (!is_alone && degrees.abs() < 90.0 && is_value(&rest)).then_some(At {
        degrees,
        polar: named.map(|(_, polar)| polar),
        sure,
        rest,
    })
}

/// True of a value, and of its uncertainty or weight.
fn is_value(head: &Head) -> bool {
    let is_one = |head: &Head| role::quantity(&head.plain).is_some() || channel::is(head);
    is_one(head) || uncertainty::of(head).any(|of| of.is_empty() || is_one(&Head::new(&of)))
}

/// A table with one angle a column: which angle, and what each head gives.
#[derive(Debug)]
pub struct Wide {
    /// The angle.
    pub polar: Polar,
    /// Of each column; none of those that are the same for all.
    pub columns: Vec<Option<At>>,
}

impl Wide {
    /// The angles in these heads, if the table has no column of them.
    ///
    /// # Errors
    /// Bare numbers that may count or be wavelengths, or an angle that is given twice.
    pub fn of(heads: &[Head], options: &ReadOptions) -> Result<Option<Wide>, Error> {
        let mut given = Vec::new();
        for (part, column) in &options.columns {
            given.push((part::place(column, heads, "--columns")?, *part));
        }
        let has = |roles: &[Role]| {
            let named = heads
                .iter()
                .enumerate()
                .filter(|(place, _)| !given.iter().any(|(at, _)| at == place));
            let named = named.map(|(_, head)| role::role(head));
            let given = given.iter().filter_map(|(_, part)| match part {
                Part::Role(role) => Some(*role),
                _ => None,
            });
            named.chain(given).any(|role| roles.contains(&role))
        };
        let polar = match (has(&[Role::ThetaI]), has(&[Role::ThetaS, Role::Theta])) {
            (false, true) => Polar::Incidence,
            (true, false) => Polar::Scattering,
            _ => return Ok(None),
        };
        let is_free = |place: usize| {
            let ignored = options.ignore.iter().chain(&options.split);
            !given.iter().any(|(at, _)| *at == place)
                && !ignored
                    .filter_map(|name| part::place(name, heads, "").ok())
                    .any(|at| at == place)
        };
        let one = |(place, head): (usize, &Head)| at(&head.text).filter(|_| is_free(place));
        let columns: Vec<Option<At>> = heads.iter().enumerate().map(one).collect();
        let known: Vec<(usize, &At)> = columns
            .iter()
            .enumerate()
            .filter_map(|(place, at)| Some((place, at.as_ref()?)))
            .collect();
        // Columns that a wavelength's unit is asked for, or that only the user can name, are none.
        let is_other = known.is_empty() || given.iter().any(|(_, part)| part::quantity(*part).is_some());
        let bare = known.iter().filter(|(_, at)| !at.sure);
        if is_other || options.wavelength_unit.is_some() && bare.clone().count() == known.len() {
            return Ok(None);
        }
        if let Some((place, at)) = known
            .iter()
            .find(|(_, at)| at.polar.is_some_and(|named| named != polar))
        {
            let name = at.polar.map_or("an angle", Polar::name);
            return Err(Error::new(format!(
                "'{}' gives {name}, and so does another column",
                shown(&heads[*place].text)
            ))
            .at_column(*place as u64 + 1)
            .help("leave one out with --ignore"));
        }
        let names = || {
            some_of(
                &known
                    .iter()
                    .map(|(place, _)| shown(&heads[*place].text))
                    .collect::<Vec<_>>(),
            )
        };
        let theta_i = polar == Polar::Incidence && !options.theta_i.is_empty();
        if theta_i {
            return Err(Error::new(format!(
                "the columns {} are of angles of incidence, and --theta-i gives one",
                names()
            ))
            .help("leave --theta-i out, or say with --wavelength-unit um that they are wavelengths"));
        }
        let is_angle = |degrees: f64| degrees >= 0.0 && (2.0 * degrees).fract() == 0.0 || polar == Polar::Scattering;
        let largest = bare.clone().map(|(_, at)| at.degrees.abs()).fold(0.0, f64::max);
        if bare.clone().count() > 0 && (largest < 5.0 || !bare.clone().all(|(_, at)| is_angle(at.degrees))) {
            return Err(Error::new(format!(
                "the numbers in the columns {} may be angles, wavelengths or count",
                names()
            ))
            .at_column(known[0].0 as u64 + 1)
            .help("give them a unit, such as brdf_20deg or brdf_10.6um; if they count, give a column theta_i, or say which column is the values with --columns brdf=2"));
        }
        Ok(Some(Wide { polar, columns }))
    }

    /// The angles, each once, in the order of their columns.
    pub fn angles(&self) -> Vec<f64> {
        let mut all: Vec<f64> = Vec::new();
        for at in self.columns.iter().flatten() {
            if !all.contains(&at.degrees) {
                all.push(at.degrees);
            }
        }
        all
    }

    /// The heads as they would be in a table of this angle alone: those of other angles have no name.
    pub fn heads(&self, heads: &[Head], degrees: f64) -> Vec<Head> {
        let one = |(head, at): (&Head, &Option<At>)| match at {
            None => head.clone(),
            Some(at) if at.degrees == degrees => at.rest.clone(),
            Some(_) => Head::new(""),
        };
        heads.iter().zip(&self.columns).map(one).collect()
    }
}

/// Finds the columns of a table, also of one with an angle a column: as if each angle had a table of its own.
///
/// # Errors
/// As [`find::find`], and as [`Wide::of`].
pub fn find(heads: Vec<Head>, options: &ReadOptions) -> Result<Columns, Error> {
    let Some(wide) = Wide::of(&heads, options)? else {
        return find::find(heads, options);
    };
    let options = by_number(options, &heads)?;
    let mut merged: Option<Columns> = None;
    for degrees in wide.angles() {
        let mut own = wide.heads(&heads, degrees);
        // Its place is beyond the columns of the table.
        own.extend((wide.polar == Polar::Scattering).then(|| Head::new("theta_s")));
        let mut one = find::find(own, &options).map_err(|error| Error {
            what: format!("at {} degrees: {}", shortest(degrees), error.what),
            ..error
        })?;
        for value in &mut one.values {
            value.angle = Some((wide.polar, degrees));
        }
        match &mut merged {
            None => merged = Some(one),
            Some(all) => {
                all.values.extend(one.values);
                // What is used at one angle is used.
                all.unused.retain(|column| one.unused.contains(column));
            }
        }
    }
    let mut all = merged.ok_or_else(|| Error::new("there is no column of values"))?;
    let mut names: Vec<Option<String>> = Vec::new();
    for value in &mut all.values {
        let place = names.iter().position(|name| *name == value.name);
        value.scan = place.unwrap_or(names.len());
        if place.is_none() {
            names.push(value.name.clone());
        }
    }
    if wide.polar == Polar::Scattering {
        all.theta_s = None;
    }
    if all.angles == Angles::Rad {
        let angles = all.values.iter_mut().filter_map(|value| value.angle.as_mut());
        angles.for_each(|(_, angle)| *angle = angle.to_radians());
    }
    all.heads = heads;
    Ok(all)
}

/// The options with the numbers of columns in place of their names.
fn by_number(options: &ReadOptions, heads: &[Head]) -> Result<ReadOptions, Error> {
    let number = |name: &str, option: &str| Ok((part::place(name, heads, option)? + 1).to_string());
    let all = |names: &[String], option: &str| -> Result<Vec<String>, Error> {
        names.iter().map(|name| number(name, option)).collect()
    };
    let columns = options.columns.iter();
    let columns = columns.map(|(part, name)| Ok((*part, number(name, "--columns")?)));
    Ok(ReadOptions {
        columns: columns.collect::<Result<_, Error>>()?,
        ignore: all(&options.ignore, "--ignore")?,
        split: all(&options.split, "--split")?,
        ..options.clone()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_of_many_forms() {
        let is = |text: &str, degrees: f64, rest: &str, polar: Option<Polar>, sure: bool| {
            let at = at(text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!(
                (at.degrees, at.rest.plain.as_str(), at.polar, at.sure),
                (degrees, rest, polar, sure),
                "{text}"
            );
        };
        let incidence = Some(Polar::Incidence);
        is("brdf_20", 20.0, "brdf", None, false);
        is("BRDF 22.5", 22.5, "brdf", None, false);
        is("brdf20", 20.0, "brdf", None, false);
        is("R_20", 20.0, "r", None, false);
        is("20 R", 20.0, "r", None, false);
        is("brdf_-40", -40.0, "brdf", None, false);
        is("brdf-40", 40.0, "brdf", None, false);
        for text in [
            "brdf_20deg",
            "BRDF (20°)",
            "brdf(20 deg)",
            "BRDF @ 20 deg [1/sr]",
            "BRDF at 20 deg",
            "20deg brdf",
            "20 deg",
            "BRDF [1/sr] 20°",
        ] {
            is(text, 20.0, "brdf", None, true);
        }
        for text in [
            "brdf_theta_i_20",
            "BRDF, AOI 20",
            "AOI 20 brdf",
            "AOI=20",
            "theta_i = 20 deg, BRDF (1/sr)",
            "BRDF (theta_i = 20 deg)",
            "brdf angle of incidence 20",
        ] {
            is(text, 20.0, "brdf", incidence, true);
        }
        is("u_20deg", 20.0, "u", None, true);
        is("AOI 20 u", 20.0, "u", incidence, true);
        is("sigma_brdf_20", 20.0, "sigmabrdf", None, false);
        is("brdf_550nm_20deg", 20.0, "brdf550", None, true);
        is("brdf_450_20", 20.0, "brdf450", None, false);
        is("theta_s=-10", -10.0, "brdf", Some(Polar::Scattering), true);
        for text in [
            "brdf",
            "brdf_550",
            "brdf_550nm",
            "550",
            "20",
            "10.6 um",
            "brdf_10.6um",
            "temperature_20",
            "run 2",
            "theta_0",
            "phi_20",
            "log10_brdf",
            "U (k=2)",
            "brdf_sr-1",
            "brdf [sr^-1]",
            "note 20 deg",
            "2 sigma",
        ] {
            assert_eq!(at(text), None, "{text}");
        }
    }
}
