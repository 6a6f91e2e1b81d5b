//! Which sides of a matrix a text names.

use crate::input::head::Head;
use crate::input::role::{self, Role};
use crate::input::unit::Unit;

/// Arrows that say that a name is of the first row.
pub const ALONG: [&str; 3] = ["→", "->", "=>"];

/// What a side of a matrix holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Angles of incidence.
    Incidence,
    /// Scattering angles.
    Scattering,
    /// Azimuths of scattering less that of incidence.
    Azimuth,
}

/// The sides that the corner names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Names {
    /// None.
    Neither,
    /// One of them; which, the numbers tell.
    One(Axis),
    /// Both.
    Both {
        /// That of the first column.
        side: Axis,
        /// That of the first row.
        top: Axis,
    },
}

/// The two sides in a text such as `theta_s\theta_i`, `theta/phi [deg]`, `theta_i → / theta_s ↓`.
pub fn pair(text: &str) -> Option<(Names, [Head; 2])> {
    let marks = text.char_indices().filter(|&(_, c)| r"\/|,;".contains(c));
    marks.into_iter().find_map(|(at, mark)| {
        let (first, second) = (&text[..at], &text[at + mark.len_utf8()..]);
        let heads = [Head::new(first), Head::new(second)];
        let roles = [role::role(&heads[0]), role::role(&heads[1])];
        let axes = match roles.map(axis) {
            [Some(first), Some(second)] if first != second => [first, second],
            // The other direction of two is that of scattering.
            [None, Some(second)] if roles[0] == Role::Theta && second != Axis::Scattering => [Axis::Scattering, second],
            [Some(first), None] if roles[1] == Role::Theta && first != Axis::Scattering => [first, Axis::Scattering],
            _ => return None,
        };
        if !axes.contains(&Axis::Scattering) {
            return None;
        }
        // The first is of the column below, if no arrow says otherwise.
        let turned = ALONG.iter().any(|arrow| first.contains(arrow)) || second.contains('↓');
        let (side, top) = if turned { (axes[1], axes[0]) } else { (axes[0], axes[1]) };
        Some((Names::Both { side, top }, heads))
    })
}

/// What the values are, and then both sides, or both sides first: `BRDF theta_i\theta_s`, `theta_i\theta_s: BRF (%)`.
pub fn value_and_sides(text: &str) -> Option<(Head, (Names, [Head; 2]))> {
    let is_mark = |c: char| c.is_whitespace() || ":;,|([".contains(c);
    let marks: Vec<usize> = text.match_indices(is_mark).map(|(at, _)| at).collect();
    let value = |part: &str| {
        let head = Head::new(part.trim());
        matches!(role::role(&head), Role::Value(_)).then_some(head)
    };
    let sides = |part: &str| pair(part.trim_matches(|c: char| c.is_whitespace() || ":;,|".contains(c)));
    // The longest part that says what the values are has their unit in it.
    let first = marks
        .iter()
        .rev()
        .find_map(|&at| Some((value(&text[..at])?, sides(&text[at..])?)));
    first.or_else(|| {
        marks
            .iter()
            .find_map(|&at| Some((value(&text[at..])?, sides(&text[..at])?)))
    })
}

/// The side of a role, if it is an angle that says of which direction.
pub fn axis(role: Role) -> Option<Axis> {
    match role {
        Role::ThetaI => Some(Axis::Incidence),
        Role::ThetaS => Some(Axis::Scattering),
        Role::Phi | Role::PhiS | Role::DeltaPhi => Some(Axis::Azimuth),
        _ => None,
    }
}

/// The side that a single name names; an angle of no direction, and a unit alone, name neither.
pub fn one(head: &Head) -> Option<Names> {
    let role = role::role(head);
    let is_angle = role == Role::Theta || matches!(Unit::parse(&head.text), Some(Unit::Deg | Unit::Rad));
    axis(role).map(Names::One).or(is_angle.then_some(Names::Neither))
}
