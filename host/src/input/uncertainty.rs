//! Which column says how sure the values of another are.

use std::collections::HashMap;

use super::columns::{Value, WeightKind};
use super::head::{Head, plain};
use super::options::ReadOptions;
use super::unit::Unit;
use crate::error::{Error, shown};

/// Names of a standard deviation; what contains another stands first.
const SIGMA: [&str; 21] = [
    "standarduncertainty",
    "expandeduncertainty",
    "combineduncertainty",
    "standarddeviation",
    "standarderror",
    "uncertainty",
    "deviation",
    "stddev",
    "stdev",
    "sigma",
    "error",
    "noise",
    "uncert",
    "delta",
    "std",
    "unc",
    "dev",
    "err",
    "sem",
    "sd",
    "se",
];

/// An uncertainty by its name alone.
struct Named {
    /// What is left of the name: that of the value, or nothing.
    of: String,
    relative: bool,
    /// True of a metrologist's U, which is a multiple of the standard deviation.
    expanded: bool,
    /// The coverage factor in a name such as `2 sigma`.
    times: Option<f64>,
    factor: bool,
}

/// Gives each value its uncertainty; with several values a column must name its own.
///
/// Returns the columns that are used.
///
/// # Errors
/// An expanded uncertainty without its coverage factor; percent of which it is not clear what they are of.
pub fn assign(
    heads: &[Head],
    taken: &[bool],
    values: &mut [Value],
    options: &ReadOptions,
) -> Result<Vec<usize>, Error> {
    let mut names: HashMap<String, usize> = HashMap::new();
    for (place, value) in values.iter().enumerate() {
        let plain = heads[value.column].plain.as_str();
        let tag = plain
            .strip_prefix("brdf")
            .filter(|tag| !tag.is_empty())
            .unwrap_or(plain);
        names.entry(plain.to_string()).or_insert(place);
        names.entry(tag.to_string()).or_insert(place);
    }
    let mut used = Vec::new();
    for (column, head) in heads.iter().enumerate() {
        if taken[column] {
            continue;
        }
        let of = |named: &Named| match named.of.as_str() {
            "" if values.len() == 1 => Some(0),
            of => names.get(of).copied(),
        };
        let Some((named, place)) =
            readings(head).find_map(|named| Some((of(&named)?, named)).map(|(place, named)| (named, place)))
        else {
            continue;
        };
        if values[place].weight.is_some() {
            continue;
        }
        let kind = kind(head, &named, &heads[values[place].column], column, options)
            .map_err(|error| error.at_column(column as u64 + 1))?;
        values[place].weight = Some((column, kind));
        used.push(column);
    }
    Ok(used)
}

/// What an uncertainty or a weight of this name may be of, as plain names; of nothing in particular the empty one.
pub fn of(head: &Head) -> impl Iterator<Item = String> + '_ {
    readings(head).map(|named| named.of)
}

/// The ways in which a name can be read as an uncertainty.
fn readings(head: &Head) -> impl Iterator<Item = Named> + '_ {
    let whole = head.plain.as_str();
    let (times, whole) = match ["1", "2", "3"]
        .into_iter()
        .find_map(|times| Some((times, whole.strip_prefix(times)?)))
    {
        Some((times, name)) if SIGMA.into_iter().any(|word| name.starts_with(word)) => (times.parse().ok(), name),
        _ => (None, whole),
    };
    let strip = |text: &str, word: &str| -> Option<String> {
        let rest = text.strip_prefix(word).or_else(|| text.strip_suffix(word))?;
        Some(plain(rest))
    };
    let relative = ["relative", "rel"].into_iter().find_map(|word| strip(whole, word));
    // Such as `sigma/BRDF`.
    let relative = relative.or_else(|| whole.strip_suffix("overbrdf").map(plain));
    let expanded = strip(relative.as_deref().unwrap_or(whole), "expanded");
    let rest = expanded
        .clone()
        .or(relative.clone())
        .unwrap_or_else(|| whole.to_string());
    let (relative, expanded) = (relative.is_some(), expanded.is_some() || whole.contains("expanded"));
    let named = move |of: String, expanded: bool| Named {
        of: of.strip_prefix("of").map_or(of.clone(), str::to_string),
        relative,
        expanded,
        times,
        factor: false,
    };
    let weight = ["weight", "weights"].into_iter().find_map(|word| strip(whole, word));
    let weight = weight.map(|of| Named {
        of,
        relative: false,
        expanded: false,
        times: None,
        factor: true,
    });
    let word = SIGMA.into_iter().find_map(|word| strip(&rest, word));
    let word = word.map(|of| named(of, expanded));
    // The metrologists' `u`, `u_BRDF` and, with a coverage factor, `U`.
    let letter = rest.strip_prefix('u').map(|of| {
        named(
            of.to_string(),
            expanded || head.text.contains('U') && !head.text.contains('u'),
        )
    });
    // An interval of 95 %, and the combined standard uncertainty.
    let interval = ["u95", "u0.95", "ci95", "95ci", "ci"]
        .into_iter()
        .find_map(|word| strip(&rest, word));
    let interval = interval.map(|of| named(of, true));
    let combined = strip(&rest, "uc").map(|of| named(of, expanded));
    weight
        .into_iter()
        .chain(word)
        .chain(interval)
        .chain(letter)
        .chain(combined)
}

/// Unit and coverage factor of an uncertainty.
fn kind(head: &Head, named: &Named, value: &Head, column: usize, options: &ReadOptions) -> Result<WeightKind, Error> {
    if named.factor {
        return Ok(WeightKind::Factor);
    }
    let name = shown(&head.text);
    // The length of `sigma_550nm` is a wavelength.
    let is_channel = named.of.contains(|c: char| c.is_ascii_digit());
    let is_other = match head.unit {
        None | Some(Unit::PerSr | Unit::One | Unit::Percent) => false,
        Some(Unit::Length(_) | Unit::PerCm) => !is_channel,
        Some(Unit::Multiple | Unit::Foreign | Unit::Deg | Unit::Rad) => true,
    };
    if is_other && options.value_unit.is_none() {
        return Err(
            Error::new(format!("'{name}' is in another unit than sr^-1")).help(format!(
                "give it in sr^-1, or leave it out with --ignore {}",
                column + 1
            )),
        );
    }
    let coverage = match head.coverage.or(named.times).or(options.coverage) {
        Some(factor) => factor,
        None if named.expanded => {
            return Err(Error::new(format!(
                "'{name}' is an expanded uncertainty without its coverage factor"
            ))
            .help("give it as in 'U (k=2)', or with --coverage 2"));
        }
        None => 1.0,
    };
    let percent = head.unit == Some(Unit::Percent);
    if percent && !named.relative && value.unit == Some(Unit::Percent) {
        return Err(
            Error::new(format!("'{name}' may be percent of the value or, like the value, of 1")).help(format!(
                "say which with --columns rel_sigma={0} or --columns sigma={0}",
                column + 1
            )),
        );
    }
    Ok(match (percent, named.relative) {
        (true, _) => WeightKind::PercentSigma(coverage),
        (false, true) => WeightKind::RelativeSigma(coverage),
        (false, false) => WeightKind::Sigma(coverage),
    })
}
