//! Names that stand in two lines.

use super::lines::{Line, is_head, is_number, is_pair, is_remark, parts};
use crate::input::head::Head;
use crate::input::role::{self, Role};
use crate::input::unit::Unit;
use crate::input::{rows, wide};

/// Names broken over two lines; the upper of merged cells is that of all below it.
pub(super) fn joined(upper: &[&str], lower: &[&str]) -> Vec<String> {
    let mut last = "";
    let mut names = Vec::new();
    for (&upper, &lower) in upper.iter().zip(lower) {
        if !upper.is_empty() {
            // What has nothing below it, or its unit, is the name of its own column.
            let is_own = lower.is_empty() || Unit::parse(lower).is_some();
            last = if is_own { "" } else { upper };
        }
        let over = if upper.is_empty() && !lower.is_empty() {
            last
        } else {
            upper
        };
        names.push(format!("{over} {lower}").trim().to_string());
    }
    names
}

/// True if names go on in the line below them: it is no line of names by itself, has no numbers where the angles are, and the row below has.
pub(super) fn goes_on(heads: &[Head], below: &[&str], row: &[&str]) -> bool {
    let mut angles = (0..heads.len()).filter(|&k| is_angle(&heads[k])).peekable();
    below.len() == heads.len()
        && row.len() == heads.len()
        && below.iter().any(|cell| !cell.is_empty())
        && !is_head(below)
        && angles.peek().is_some()
        && angles.all(|k| !is_number(below[k]) && is_number(row[k]))
}

/// The names with the angles in the line right above them, if that has angles alone, and none over a column of angles.
pub(super) fn over_names(
    above: Option<&Line>,
    number: u64,
    names: &[&str],
    delimiter: Option<u8>,
) -> Option<Vec<String>> {
    let line = above.filter(|line| line.number + 1 == number && !is_remark(line.text))?;
    let angles = rows::split(line.text, delimiter);
    let both = joined(&angles, names);
    let fits = |((angle, name), both): ((&&str, &&str), &String)| {
        angle.is_empty() || !is_angle(&Head::new(name)) && wide::at(both).is_some()
    };
    let all = angles.len() == names.len() && angles.iter().any(|angle| !angle.is_empty());
    (all && angles.iter().zip(names).zip(&both).all(fits)).then_some(both)
}

fn is_angle(head: &Head) -> bool {
    matches!(role::role(head), Role::ThetaI | Role::ThetaS | Role::Theta)
}

/// The names in the last two lines above the rows: one below the other, or the second after the first.
pub(super) fn names_in_two(above: &[Line], width: usize, delimiter: Option<u8>) -> Option<Vec<String>> {
    let [.., upper, lower] = above else { return None };
    let uppers = parts(upper.text, delimiter);
    let pairs = uppers.iter().zip(parts(lower.text, delimiter));
    let either = pairs.flat_map(|(upper, lower)| {
        let words = !upper.iter().any(|cell| is_number(cell)) && lower.iter().any(|cell| !cell.is_empty());
        let after = words.then(|| [&upper[..], &lower[..]].concat());
        let below = (upper.len() == lower.len()).then(|| joined(upper, &lower));
        let after = after.map(|names| names.into_iter().map(String::from).collect());
        below.into_iter().chain(after)
    });
    let mut known = either.filter(|names: &Vec<String>| {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        names.len() == width && is_head(&names) && !is_pair(&names)
    });
    known.next()
}
