//! The numbers in the words of the command line.

fn number(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| format!("'{text}' is not a number"))
}

pub fn positive(text: &str) -> Result<f64, String> {
    match number(text)? {
        x if x > 0.0 && x.is_finite() => Ok(x),
        _ => Err("it must be above 0".to_string()),
    }
}

pub fn theta_i(text: &str) -> Result<f64, String> {
    match number(text)? {
        x if x.abs() < 90.0 => Ok(x),
        _ => Err("it must be an angle between -90 and 90 degrees".to_string()),
    }
}

pub fn not_negative(text: &str) -> Result<f64, String> {
    match number(text)? {
        x if x >= 0.0 && x.is_finite() => Ok(x),
        _ => Err("it must not be negative".to_string()),
    }
}

pub fn angle(text: &str) -> Result<f64, String> {
    match number(text)? {
        x if (0.0..=180.0).contains(&x) => Ok(x),
        _ => Err("it must be an angle in degrees".to_string()),
    }
}

pub fn weight_angle(text: &str) -> Result<(f64, f64), String> {
    let (theta_i, factor) = text.split_once('=').ok_or("write DEG=FACTOR, such as 60=0.5")?;
    Ok((angle(theta_i)?, not_negative(factor)?))
}
