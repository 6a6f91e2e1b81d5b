//! What the columns of a table are taken for.

use std::sync::Arc;

use crate::input::about::{About, ThetaI, Used};
use crate::input::columns::{Azimuth, Columns, Value, WeightKind};
use crate::input::kind::Kind;
use crate::number::shortest;

/// What is known of the columns of these values before the rows; `together` are all columns of values of the same scan, `names` those of all columns, and `unused` those of the columns that are not used.
///
/// `theta_i` is what a remark says of the angle of incidence, degrees; `settled` if the program wrote the table itself.
pub fn of(
    columns: &Columns,
    value: &Value,
    together: &[usize],
    names: &Arc<[String]>,
    unused: &Arc<[String]>,
    theta_i: Option<f64>,
    settled: bool,
) -> About {
    let mut used: Vec<(usize, String)> = Vec::new();
    let mut add = |column: Option<usize>, holds: &str| used.extend(column.map(|column| (column, holds.to_string())));
    add(columns.theta_i, "theta_i");
    add(columns.theta_s, "theta_s");
    match columns.azimuth {
        None => {}
        Some(Azimuth::Difference(column)) => add(Some(column), "delta_phi"),
        Some(Azimuth::Of(phi_s, phi_i)) => {
            add(Some(phi_s), "phi_s");
            add(phi_i, "phi_i");
        }
    }
    add(columns.wavelength, "wavelength");
    add(columns.polarisation, "polarisation");
    add(columns.unit, "unit of the value");
    add(columns.sigma_ln, "standard deviation of ln f at a weight of 1");
    if let Some([absolute, relative]) = columns.own_sigma {
        add(Some(absolute), "absolute standard deviation");
        add(Some(relative), "relative standard deviation");
    }
    columns
        .splits
        .iter()
        .for_each(|&column| add(Some(column), "name of the scan"));
    for value in together.iter().map(|&place| &columns.values[place]) {
        used.push((value.column, held(value)));
        used.extend(value.weight.map(|(column, kind)| (column, held_beside(kind))));
    }
    used.sort_by_key(|(column, _)| *column);
    let used = used.into_iter().map(|(column, holds)| Used {
        number: column + 1,
        name: columns.heads[column].text.clone(),
        holds,
    });
    About {
        kind: Kind::Table,
        columns: used.collect(),
        unused: unused.clone(),
        theta_i: match columns.theta_i {
            Some(_) => ThetaI::Column,
            None if value.gives_theta_i() => ThetaI::Column,
            None => ThetaI::Missing {
                remark: theta_i,
                names: names.clone(),
            },
        },
        one_angle: false,
        angle_of_heads: value.angle.map(|(polar, _)| polar),
        settled,
        angles_named: columns.angles_named,
        divisor: value.divisor,
        sigma_ln: None,
        ..About::default()
    }
}

/// The names of the columns that are not used.
pub fn unused(columns: &Columns) -> Arc<[String]> {
    let title = |column: usize| match columns.heads[column].text.as_str() {
        "" => format!("column {}", column + 1),
        name => name.to_string(),
    };
    columns.unused.iter().map(|&(column, _)| title(column)).collect()
}

/// What a column of values holds, for people.
fn held(value: &Value) -> String {
    let title = value.quantity.title();
    let percent = if value.divisor == 100.0 { " in percent" } else { "" };
    let at = value.angle.map_or(String::new(), |(polar, angle)| {
        format!(" at {} = {}", polar.name(), shortest(angle))
    });
    format!("{title}{percent}{at}")
}

/// What a column of this kind holds, for people.
fn held_beside(kind: WeightKind) -> String {
    let times = |coverage: f64| {
        if coverage == 1.0 {
            String::new()
        } else {
            format!(" times {coverage}")
        }
    };
    match kind {
        WeightKind::Sigma(coverage) => format!("standard deviation{}", times(coverage)),
        WeightKind::RelativeSigma(coverage) => format!("relative standard deviation{}", times(coverage)),
        WeightKind::PercentSigma(coverage) => {
            format!("standard deviation{} in percent of the value", times(coverage))
        }
        WeightKind::Factor => "weight".to_string(),
    }
}
