//! Takes columns by their roles, each once.

use super::channel;
use super::columns::Azimuth;
use super::head::{Head, plain};
use super::options::ReadOptions;
use super::role::Role;
use super::unit::Unit;
use super::units::Quantity;
use crate::error::{Error, shown};
use crate::plain::some_of;

/// Takes columns by their roles.
pub struct Finder<'a> {
    /// The heads of all columns.
    pub heads: &'a [Head],
    /// The role of each; none if it has none, or an option took it.
    pub roles: &'a [Option<Role>],
    /// Which are taken.
    pub taken: Vec<bool>,
}

impl Finder<'_> {
    /// The one column of a role, if there is any.
    ///
    /// # Errors
    /// There are several.
    pub fn one(&mut self, quantity: &str, role: Role) -> Result<Option<usize>, Error> {
        let mut places = (0..self.heads.len()).filter(|&place| self.roles[place] == Some(role));
        let (first, second) = (places.next(), places.next());
        if let (Some(first), Some(second)) = (first, second) {
            let names = [first, second].map(|place| shown(&self.heads[place].text));
            return Err(Error::new(format!(
                "there is more than one column for {quantity}: {}",
                names.join(" and ")
            ))
            .at_column(second as u64 + 1)
            .help(match role {
                Role::ThetaS => format!(
                    "say what each is, such as --columns theta_i={},theta_s={}, or leave one out with --ignore",
                    first + 1,
                    second + 1
                ),
                Role::PhiS => format!(
                    "say what each is, such as --columns phi_i={},phi_s={}, or leave one out with --ignore",
                    first + 1,
                    second + 1
                ),
                _ => format!("leave one out with --ignore, such as --ignore {}", second + 1),
            }));
        }
        if let Some(first) = first {
            self.taken[first] = true;
        }
        Ok(first)
    }

    /// Azimuth of scattering with that of incidence, or their difference.
    ///
    /// # Errors
    /// There are several.
    pub fn azimuth(&mut self) -> Result<Option<Azimuth>, Error> {
        let difference = self.one("the azimuth", Role::DeltaPhi)?;
        let phi_s = self.one("the azimuth of scattering", Role::PhiS)?;
        let phi = self.one("the azimuth", Role::Phi)?;
        let mut all = [difference, phi_s, phi].into_iter().flatten();
        let first = all.next();
        if let Some(second) = all.next() {
            return Err(Error::new("there is more than one column for the azimuth")
                .at_column(second as u64 + 1)
                .help("leave one out with --ignore, which takes its name or number"));
        }
        if difference.is_some() || first.is_none() {
            // An azimuth of incidence alone says nothing; whether it matters is seen by its numbers.
            return Ok(difference.map(Azimuth::Difference));
        }
        let phi_i = self.one("the azimuth of incidence", Role::PhiI)?;
        Ok(first.map(|phi_s| Azimuth::Of(phi_s, phi_i)))
    }

    /// The columns of values.
    ///
    /// # Errors
    /// There is none, or two hold one quantity.
    pub fn values(&mut self, options: &ReadOptions) -> Result<Vec<(usize, Quantity)>, Error> {
        let wanted = |head: &Head| options.column.iter().any(|wanted| plain(wanted) == head.plain);
        let free = |place: &usize| !self.taken[*place];
        let quantity = |place: usize| match self.roles[place] {
            Some(Role::Value(quantity)) => quantity,
            _ => Quantity::Brdf,
        };
        if !options.column.is_empty() {
            let named = (0..self.heads.len())
                .filter(free)
                .filter(|&place| wanted(&self.heads[place]));
            let named: Vec<_> = named.map(|place| (place, quantity(place))).collect();
            if !named.is_empty() {
                return Ok(named);
            }
        }
        let mut known = Vec::new();
        for quantity in Quantity::ALL {
            known.extend(
                self.one(quantity.title(), Role::Value(quantity))?
                    .map(|column| (column, quantity)),
            );
        }
        let asked = known.iter().find(|(_, quantity)| options.quantity == Some(*quantity));
        let chosen = asked.or(known.first()).copied();
        for (column, _) in known {
            self.taken[column] = false;
        }
        if let Some(chosen) = chosen {
            return Ok(vec![chosen]);
        }
        let channels: Vec<_> = (0..self.heads.len())
            .filter(|place| !self.taken[*place] && self.roles[*place].is_some())
            .filter(|&place| channel::is(&self.heads[place]))
            .map(|place| (place, channel::quantity(&self.heads[place])))
            .collect();
        if channels.is_empty() {
            return Err(self.missing("brdf_per_sr"));
        }
        let places: Vec<usize> = channels.iter().map(|(place, _)| *place).collect();
        channel::refuse_count(self.heads, &places, options)?;
        Ok(channels)
    }

    /// There is no column of this quantity.
    pub fn missing(&self, quantity: &str) -> Error {
        let found: Vec<String> = self.heads.iter().map(|head| shown(&head.text)).collect();
        let name = quantity.trim_end_matches("_deg").trim_end_matches("_per_sr");
        let foreign = self.heads.iter().find(|head| head.unit == Some(Unit::Foreign));
        let foreign = foreign.filter(|_| name == "brdf");
        let foreign = foreign.map_or(String::new(), |head| {
            format!(
                "; '{}' is not in sr^-1, so it is no BRDF before it is calibrated",
                shown(&head.text)
            )
        });
        let through = |head: &&Head| goes_through(head);
        let through = self.heads.iter().find(through).filter(|_| name == "brdf");
        let through = through.map_or(String::new(), |head| {
            format!(
                "; '{}' is of light that goes through, and no reflectance",
                shown(&head.text)
            )
        });
        // The one free column whose name goes on.
        let word = quantity.split('_').next().unwrap_or(quantity);
        let mut alike =
            (0..self.heads.len()).filter(|&place| !self.taken[place] && self.heads[place].plain.contains(word));
        let number = match (alike.next(), alike.next()) {
            (Some(only), None) => (only + 1).to_string(),
            _ => "N".to_string(),
        };
        Error::new(format!("no column {quantity} among the columns {}{foreign}{through}", some_of(&found))).help(format!(
            "the first line must name the columns theta_i_deg,theta_s_deg,brdf_per_sr, or --columns {name}={number} says where it is"
        ))
    }
}

/// True of the name of what goes through a sample.
pub fn goes_through(head: &Head) -> bool {
    ["btdf", "transmi"].iter().any(|name| head.plain.contains(name))
}
