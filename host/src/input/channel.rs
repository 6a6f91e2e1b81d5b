//! Columns of values that are channels: colours, wavelengths, polarisations.

use super::head::Head;
use super::role;
use super::unit::Unit;
use super::units::Quantity;
use super::wavelength;
use crate::error::{Error, shown};

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
    matches!(tag, "r" | "g" | "b" | "red" | "green" | "blue" | "y") && (prefixed || tag != "y")
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
