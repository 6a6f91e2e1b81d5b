//! What is not determined, and through what it still is.

use brdfit_core::model::Parameter;
use brdfit_core::uncertainty::Place;

use super::derived::{Derived, Value};
use crate::engine::Material;
use crate::engine::uncertainty::Uncertainty;

/// A parameter whose standard error is a larger part of it than this is not determined.
pub const LOOSE: f64 = 0.2;
/// A product whose standard error is a smaller part of it than this is determined.
pub const TIGHT: f64 = 0.2;

/// Parameters of which the scan does not tell the value.
#[derive(Clone, Debug, PartialEq)]
pub struct Undetermined {
    /// Their names.
    pub parameters: Vec<&'static str>,
    /// Through what they change the curve all the same, with its relative standard error.
    pub through: Vec<(&'static str, f64)>,
}

/// The parameters that are open: the standard error, with no other parameter held by a bound, is above [`LOOSE`] of the parameter itself; for kappa, which may be 0, of 1 at least.
pub fn open(material: &Material, known: &Uncertainty) -> impl Iterator<Item = &'static str> {
    let values = &material.values;
    let parameters = material.model.parameters;
    let open = move |&index: &usize| match known.places[index] {
        None | Some(Place::Fixed) => false,
        // A weight that no sample sees is said to be that, and stays out of all else.
        Some(Place::Unseen) => !parameters[index].is_weight(),
        Some(_) => is_open(&parameters[index], values[index], known.stderr_lifted[index]),
    };
    (0..values.len()).filter(open).map(move |index| parameters[index].name)
}

/// Is a parameter of this value open, with this standard error where no other parameter is held by a bound?
pub fn is_open(parameter: &Parameter, value: f64, stderr_lifted: f64) -> bool {
    let size = if parameter.name == "kappa" {
        value.max(1.0)
    } else {
        value
    };
    size > 0.0 && stderr_lifted > LOOSE * size
}

/// What `known` leaves open.
///
/// rho_s or rho_v with n or kappa counts as determined through its product with F, if that is known to [`TIGHT`] at some angle of incidence.
pub fn undetermined(material: &Material, known: &Uncertainty, derived: &[Derived]) -> Vec<Undetermined> {
    let mut open: Vec<&'static str> = open(material, known).collect();
    let mut found = Vec::new();
    let index_is_open = open.contains(&"n") || open.contains(&"kappa");
    let tightest = |of: fn(&Derived) -> Option<Value>| {
        let errors = derived
            .iter()
            .filter_map(of)
            .map(|product| product.stderr / product.value);
        errors.fold(f64::INFINITY, f64::min)
    };
    let products = [
        ("rho_s", "rho_s F(theta_d)", tightest(|at| at.rho_s_f)),
        ("rho_v", "rho_v F(theta_de)", tightest(|at| at.rho_v_f)),
    ];
    let through = products
        .iter()
        .filter(|(rho, _, error)| index_is_open && open.contains(rho) && *error < TIGHT);
    let through: Vec<(&'static str, &'static str, f64)> = through.copied().collect();
    if !through.is_empty() {
        let of_products =
            |name: &&'static str| matches!(*name, "n" | "kappa") || through.iter().any(|(rho, ..)| rho == name);
        found.push(Undetermined {
            parameters: open.iter().copied().filter(of_products).collect(),
            through: through.iter().map(|&(_, product, error)| (product, error)).collect(),
        });
        open.retain(|name| !of_products(name));
    }
    if !open.is_empty() {
        found.push(Undetermined {
            parameters: open,
            through: Vec::new(),
        });
    }
    found
}
