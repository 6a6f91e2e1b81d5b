//! Which variables of ASTM text are values, what they are, and how sure they are.

use crate::error::{Error, shown};
use crate::input::columns::Value;
use crate::input::head::Head;
use crate::input::options::ReadOptions;
use crate::input::role::{self, Look, Role};
use crate::input::unit::Unit;
use crate::input::units::Quantity;
use crate::input::{channel, find, finder, uncertainty};

/// What `MEAS_NAME` says of the values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Said {
    /// What they are, if it is one of the quantities.
    pub quantity: Option<Quantity>,
    /// Their unit, if it names one beside that.
    pub unit: Option<Unit>,
}

/// The values among the variables, each with its uncertainty; `angles` are the places of the angles, and `said` is what `MEAS_NAME` says.
///
/// # Errors
/// A variable is neither an angle nor a value nor the uncertainty of one, or `MEAS_NAME` and `VARS` differ.
pub fn of(heads: &[Head], angles: &[usize], said: Said, options: &ReadOptions) -> Result<Vec<Value>, Error> {
    let mut taken: Vec<bool> = (0..heads.len()).map(|place| angles.contains(&place)).collect();
    let free: Vec<usize> = (0..heads.len()).filter(|&place| !taken[place]).collect();
    let mut values = Vec::new();
    for &column in &free {
        let at = |error: Error| error.at_column(column as u64 + 1);
        let head = &heads[column];
        let others = || free.iter().filter(|&&other| other != column);
        let is_of = |of: String| of.is_empty() || others().any(|&other| heads[other].plain == of);
        if uncertainty::of(head).any(is_of) {
            continue;
        }
        taken[column] = true;
        values.push(Value {
            column,
            name: Some(head.text.clone()),
            quantity: quantity(head, said.quantity).map_err(at)?,
            divisor: {
                if said.quantity.is_none() && options.quantity.is_none() {
                    channel::refuse_percent(head).map_err(at)?;
                    channel::refuse_log(head).map_err(at)?;
                }
                let unit = head.unit.or(said.unit);
                find::divisor(&Head { unit, ..head.clone() }, column, options)?
            },
            weight: None,
            angle: None,
            scan: values.len(),
        });
    }
    for column in uncertainty::assign(heads, &taken, &mut values, options)? {
        taken[column] = true;
    }
    match taken.iter().position(|taken| !taken) {
        Some(column) if !values.is_empty() => Err(Error::new(format!(
            "VARS has '{}', an uncertainty that does not say of which value",
            shown(&heads[column].text)
        ))
        .at_column(column as u64 + 1)
        .help("name the value in it, as in sigma_R")),
        _ => Ok(values),
    }
}

/// What a variable's values are.
fn quantity(head: &Head, said: Option<Quantity>) -> Result<Quantity, Error> {
    let name = shown(&head.text);
    if finder::goes_through(head) {
        return Err(through(&name));
    }
    let other = said.filter(|&said| said != Quantity::Brdf);
    match (role::role(head), other) {
        (Role::Value(own), Some(said)) if own != said => Err(Error::new(format!(
            "VARS says '{name}', and MEAS_NAME says that the values are {}",
            said.title()
        ))
        .help("write in both what the values are")),
        (Role::Value(own), _) => Ok(own),
        // Of a channel such as 525nm the length is its wavelength.
        (Role::Unknown(Look::Other), _) if channel::is(head) || !matches!(head.unit, Some(Unit::Length(_))) => {
            Ok(said.unwrap_or_else(|| channel::quantity(head)))
        }
        _ => Err(Error::new(format!(
            "VARS has '{name}', which is no value, and no angle that this format has"
        ))
        .help("leave it out, and give what it tells apart files of their own")),
    }
}

/// What is said of transmission.
fn through(name: &str) -> Error {
    Error::new(format!("this holds transmission ('{name}'), and no reflection")).help("measure the BRDF")
}

/// What `MEAS_NAME` says of the values.
///
/// # Errors
/// It is transmission.
pub fn said(text: &str) -> Result<Said, Error> {
    for (line, row) in (1..).zip(text.lines()) {
        if row.starts_with("VARS") {
            break;
        }
        let Some(name) = row.strip_prefix("MEAS_NAME").map(str::trim) else {
            continue;
        };
        let head = Head::new(name);
        if finder::goes_through(&head) {
            return Err(through(&shown(name)).at_line(line));
        }
        let quantity = role::quantity(&head.plain);
        let unit = head.unit.filter(|_| quantity.is_some());
        return Ok(Said { quantity, unit });
    }
    Ok(Said::default())
}
