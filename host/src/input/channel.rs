//! Columns of values that are channels: colours, wavelengths, polarisations.

use super::head::Head;
use super::options::ReadOptions;
use super::role;
use super::unit::Unit;
use super::units::Quantity;
use super::wavelength;
use crate::error::{Error, shown};
use crate::plain::some_of;

/// The name without the quantity in front of it, and that quantity.
fn tag(plain: &str) -> (&str, Quantity) {
    for (start, quantity) in [
        ("brdf", Quantity::Brdf),
        ("bsdf", Quantity::Brdf),
        ("brf", Quantity::Brf),
        ("lnbrdf", Quantity::LnBrdf),
    ] {
        if let Some(tag) = plain.strip_prefix(start).filter(|tag| !tag.is_empty()) {
            return (tag, quantity);
        }
    }
    (plain, Quantity::Brdf)
}

/// True of `R`, `G`, `B`, `550 nm`, `0.55 um` and, after `brdf`, of those and the polarisations `s` and `p`.
pub fn is(head: &Head) -> bool {
    let plain = head.plain.as_str();
    let (tag, _) = tag(plain);
    let prefixed = tag.len() < plain.len();
    let length = matches!(head.unit, Some(Unit::Length(_) | Unit::PerCm));
    let number = tag.strip_suffix("nm").unwrap_or(tag).parse::<f64>();
    // Without a unit and a name, a number is a wavelength if it can be one in nanometres or micrometres.
    let is_angle = matches!(head.unit, Some(Unit::Deg | Unit::Rad));
    let wavelength = number.is_ok_and(|number| {
        length
            || !is_angle && prefixed && number.is_finite()
            || !is_angle && wavelength::nanometres(number, None).is_ok() && (0.2..3e4).contains(&number)
    });
    // A radius has a length, and a colour none.
    matches!(tag, "r" | "g" | "b" | "red" | "green" | "blue" | "y") && (prefixed || tag != "y" && !length)
        || prefixed
            && matches!(
                tag,
                "s" | "p" | "spol" | "ppol" | "x" | "z" | "ss" | "sp" | "ps" | "pp" | "unpolarised" | "unpolarized"
            )
        || wavelength
}

/// Refuses a channel in percent whose name does not say of what.
///
/// # Errors
/// It is `R (%)`, which is most often a reflectance.
pub fn refuse_percent(head: &Head) -> Result<(), Error> {
    let is_named = role::quantity(&head.plain).is_some() || tag(&head.plain).0.len() < head.plain.len();
    if head.unit != Some(Unit::Percent) || is_named {
        return Ok(());
    }
    Err(Error::new(format!(
        "'{}' is in percent, and may be a reflectance factor or a BRDF",
        shown(&head.text)
    ))
    .help("say which: --quantity brf, or --quantity brdf"))
}

/// Refuses channels that are called by whole numbers alone which may be wavelengths in micrometres or count.
///
/// # Errors
/// All such numbers are, as in `1,2,3`, and no option says that they are wavelengths.
pub fn refuse_count(heads: &[Head], channels: &[usize], options: &ReadOptions) -> Result<(), Error> {
    let bare = channels.iter().filter_map(|&column| {
        let number: f64 = heads[column]
            .text
            .parse()
            .ok()
            .filter(|_| heads[column].unit.is_none())?;
        Some((column, number))
    });
    let is_count = |&(_, number): &(usize, f64)| number.fract() == 0.0 && number < 100.0;
    let bare: Vec<(usize, f64)> = bare.collect();
    if bare.is_empty() || options.wavelength_unit.is_some() || !bare.iter().all(is_count) {
        return Ok(());
    }
    let names: Vec<String> = bare.iter().map(|&(column, _)| shown(&heads[column].text)).collect();
    Err(Error::new(format!(
        "the numbers in the columns {} may be wavelengths in um or count",
        some_of(&names)
    ))
    .at_column(bare[0].0 as u64 + 1)
    .help("give them a unit, such as 1um, or say --wavelength-unit um; if they count, name them such as brdf_1, or say which column is the values with --columns brdf=3"))
}

/// Refuses a logarithm that does not say to which base.
///
/// # Errors
/// It is `log(BRDF)`: programs write ln so, and people log10.
pub fn refuse_log(head: &Head) -> Result<(), Error> {
    let is_ten = head.plain.starts_with("log10");
    if is_ten || !head.plain.starts_with("log") || role::quantity(&head.plain) != Some(Quantity::Log10Brdf) {
        return Ok(());
    }
    Err(Error::new(format!(
        "'{}' may be the natural logarithm or that to base 10",
        shown(&head.text)
    ))
    .help("say which: --quantity ln-brdf, or --quantity log10-brdf"))
}

/// What a channel's values are.
pub fn quantity(head: &Head) -> Quantity {
    tag(&head.plain).1
}

/// The polarisation of a channel such as `brdf_s`.
pub fn polarisation(head: &Head) -> Option<&'static str> {
    let (tag, _) = tag(&head.plain);
    match tag {
        "s" | "spol" if tag.len() < head.plain.len() => Some("s"),
        "p" | "ppol" if tag.len() < head.plain.len() => Some("p"),
        _ => None,
    }
}

/// What a channel is called.
pub fn name(head: &Head) -> String {
    match (head.unit, head.text.parse::<f64>()) {
        (None, Ok(number)) => match wavelength::nanometres(number, None) {
            Ok(nanometres) => wavelength::name(nanometres),
            Err(_) => head.text.clone(),
        },
        _ if role::quantity(&head.plain).is_some() => head.plain.clone(),
        _ => head.text.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_that_may_count_are_no_wavelengths() {
        let refused = |names: &[&str]| {
            let heads: Vec<Head> = names.iter().map(|name| Head::new(name)).collect();
            let all: Vec<usize> = (0..heads.len()).collect();
            refuse_count(&heads, &all, &ReadOptions::default()).is_err()
        };
        assert!(refused(&["1", "2", "3"]) && refused(&["R", "10"]));
        assert!(!refused(&["450", "550"]) && !refused(&["0.5", "1"]) && !refused(&["1um", "brdf_2", "R"]));
    }
}
