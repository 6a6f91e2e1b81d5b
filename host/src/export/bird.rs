//! EURAMET BiRD universal BRDF JSON: the model in `software.simulation_model`, and its BRDF in plane.

use brdfit_core::real::Real;
use serde_json::{Value, json};

use super::model::{Model, word};
use crate::document;
use crate::engine::clock::since_1970;

const SCHEMA: &str =
    "https://raw.githubusercontent.com/BiRD-project/BiRD_view/master/BRDF_JSON_schema/brdf_json_schema_v1.0.json";
const PAPER: &str = "https://doi.org/10.1117/1.OE.60.9.094103";

/// The file.
pub fn write(model: &Model) -> String {
    let parameter = |place: usize| {
        let mut object = {
            let parameter = &model.material.model.parameters[place];
            json!({ "name": parameter.name, "description": parameter.what, "value": model.material.values[place], "unit": parameter.unit })
        };
        if let Some(stderr) = model.stderr[place] {
            object["uncertainty"] = stderr.into();
            object["uncertainty_unit"] = "".into();
            object["comments"] = "The uncertainty is the standard error (k = 1) of the fit.".into();
        }
        object
    };
    let parameters: Vec<Value> = (0..model.material.values.len()).map(parameter).collect();
    let mut rows = Vec::new();
    for theta_i in (0..=80).step_by(10) {
        for theta_s in -85..=85 {
            let (incident, scattered) = (f64::from(theta_i), f64::from(theta_s));
            let f = model.f(incident.to_radians(), scattered.to_radians(), f64::PI);
            rows.push([incident, scattered.abs(), if theta_s > 0 { 180.0 } else { 0.0 }, f]);
        }
    }
    let column = |unit: &str, place: usize| json!({ "unit": unit, "values": rows.iter().map(|row| row[place]).collect::<Vec<f64>>() });
    let file = json!({
        "metadata": {
            "schema": SCHEMA,
            "id": format!("urn:brdfit:{}", word(&model.name)),
            "type": "BRDF",
            "timestamp": now(),
            "provenance": { "organization": "NA" },
            "method": "simulation",
            "instrumentation": "NA",
            "software": {
                "name": "brdfit",
                "version": env!("CARGO_PKG_VERSION"),
                "simulation_model": {
                    "name": "modified Cook-Torrance model",
                    "description": "Eq. 14 of Bishop, Butler and Marciniak (2021): Lambertian term, surface lobe with Beckmann facets, Fresnel and Blinn's masking, volume lobe around the direction of incidence.",
                    "equation": "rho_s*F(theta_d)*D(theta_h)*G/(4*cos(theta_i)*cos(theta_r)) + rho_d/pi + rho_v*F(theta_de)*D(theta_he)",
                    "parameters": parameters,
                    "data_links": [PAPER],
                },
            },
            "sample": { "name": model.name },
            "environment": "NA",
            "comments": format!("{}. phi_r = 180 deg is forward.", model.origin),
        },
        "data": {
            "theta_i": column("°", 0),
            "phi_i": json!({ "unit": "°", "values": vec![0.0; rows.len()] }),
            "theta_r": column("°", 1),
            "phi_r": column("°", 2),
            "BRDF": column("sr^-1", 3),
        },
    });
    document::json(&file)
}

/// Now, in UTC as ISO 8601.
fn now() -> String {
    let seconds = since_1970().as_secs();
    let (days, rest) = (seconds / 86_400, seconds % 86_400);
    let (year, month, day) = date(days);
    format!(
        "{year:04}-{month:02}-{day:02}T{:02}:{:02}:{:02}+00:00",
        rest / 3600,
        rest / 60 % 60,
        rest % 60
    )
}

/// The date `days` after 1970-01-01: years that begin in March have their leap day last, and every 5 of their months 153 days.
fn date(days: u64) -> (u64, u64, u64) {
    let since_0000_03_01 = days + 719_468;
    let (era, day_of_era) = (since_0000_03_01 / 146_097, since_0000_03_01 % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 {
        month_from_march + 3
    } else {
        month_from_march - 9
    };
    (era * 400 + year_of_era + u64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use super::date;

    #[test]
    fn dates_are_those_of_the_calendar() {
        let days = [
            (0, (1970, 1, 1)),
            (58, (1970, 2, 28)),
            (59, (1970, 3, 1)),
            (11_016, (2000, 2, 29)),
            (11_017, (2000, 3, 1)),
            (20_453, (2025, 12, 31)),
        ];
        for (day, expected) in days {
            assert_eq!(date(day), expected);
        }
    }
}
