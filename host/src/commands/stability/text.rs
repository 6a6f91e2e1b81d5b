//! The report as text: one line a case, the meaning of the columns below.

use std::fmt::Write;

use crate::analysis::stability::accuracy::Errors;
use crate::analysis::stability::assess::{Assessment, CURVE_PART, DIFFERENT, EXCESS, Ended, Precisions, RESOLUTION};

/// rms residuals below this are those of data without noise, where a relative excess says nothing.
const NOISELESS: f64 = 1e-7;

/// The table with its notes.
pub fn write(cases: &[Assessment]) -> String {
    let width = cases.iter().map(|case| case.name.chars().count()).max().unwrap_or(0);
    let width = width.clamp(4, 40);
    let mut out = String::new();
    let mut line = |text: &str| {
        out += text.trim_end();
        out.push('\n');
    };
    line(&format!(
        "{:width$} {:>9} | {:^11} | {:^11} | {:^19} | {:^51}",
        "", "condition", "ln f, ulp", "grad., ulp", "ended by, passes", "f32 against f64"
    ));
    line(&format!(
        "{:width$} {:>9} | {:>5} {:>5} | {:>5} {:>5} | {:>9} {:>9} | {:>8} {:>8} {:>8} {:>8} {:>5}  {}",
        "case", "of J'J", "f64", "f32", "f64", "f32", "f64", "f32", "excess", "curve", "rho_d", "m", "good", "differ"
    ));
    for case in cases {
        line(&row(case, width));
    }
    out + &notes()
}

fn row(case: &Assessment, width: usize) -> String {
    let (fit, loss) = (&case.fit, &case.loss);
    let error = |of: fn(&Precisions<Errors>) -> f64| case.error_ulp.as_ref().map_or("-".into(), |ulp| units(of(ulp)));
    let excess = if fit.f64.rms_ln < NOISELESS {
        "-".into()
    } else {
        format!("{:.0e}", loss.excess_mse2)
    };
    let name: String = case.name.chars().take(width).collect();
    let mut row = format!(
        "{name:width$} {:>9.1e} | {:>5} {:>5} | {:>5} {:>5} | {:>9} {:>9}",
        case.condition,
        error(|ulp| ulp.f64.ln_f),
        error(|ulp| ulp.f32.ln_f),
        error(|ulp| ulp.f64.gradient),
        error(|ulp| ulp.f32.gradient),
        end(&fit.f64),
        end(&fit.f32)
    );
    let good = if case.f32_is_good_enough { "yes" } else { "NO" };
    let names: Vec<&str> = case.different().map(|parameter| parameter.name).collect();
    let differ = if names.is_empty() {
        "none".into()
    } else {
        names.join(" ")
    };
    // A String takes all that is written to it.
    let _ = write!(
        row,
        " | {excess:>8} {:>8.0e} {:>8.0e} {:>8.0e} {good:>5}  {differ}",
        loss.curve_rms_ln, loss.parameters[0].change, loss.parameters[3].change
    );
    row
}

/// In five columns.
fn units(ulp: f64) -> String {
    if ulp < 999.0 {
        format!("{ulp:.1}")
    } else {
        format!("{ulp:.0e}")
    }
}

fn end(fit: &Ended) -> String {
    format!("{} {}", fit.stop, fit.passes)
}

fn notes() -> String {
    format!(
        "
All quantities are dimensionless; the parameters are within the bounds of Table 1.
condition  ratio of the largest to the least eigenvalue of J'J at the f64 optimum, each column of J scaled
           to length 1, over the parameters that are inside their bounds and that the scan sees.
ulp        largest error against 256-bit arithmetic, of ln f and of its six derivatives, in units in the
           last place of the natural scale: the value, and what rounding angles and parameters changes in it.
ended by   cost: no step promises less; step: no step that rounding can show lowers the cost;
           passes: NOT converged. Then the passes over the scan that the whole search made.
excess     MSE^2 (Eq. 17) of the f32 fit over that of the f64 fit, less 1, both evaluated in f64;
           - where the data have no noise.
curve      rms difference of ln f between the two fitted curves; 0.01 is 1 % of the BRDF.
rho_d, m   f32 over f64, less 1; the difference where f64 has 0.
good       f32 is good enough: it converged, excess <= {EXCESS:.0e} and curve <= {CURVE_PART} of the rms residual,
           or curve <= {RESOLUTION:.0e}, which is below what a scatterometer resolves.
           A scan may need more than f32 holds: there a lobe with rho below 1e-16 counts as absent.
differ     parameters that differ by more than {} %; where the condition is high they are not
           determined by the scan, and differ though the curves do not.
",
        100.0 * DIFFERENT
    )
}

/// What a user's scan should know, in words.
pub fn verdict(case: &Assessment) -> String {
    let (fit, loss) = (&case.fit, &case.loss);
    let mut out = String::from("\nparameter            f64            f32     change\n");
    for parameter in &loss.parameters {
        let (name, change) = (parameter.name, parameter.change);
        // A String takes all that is written to it.
        let _ = writeln!(
            out,
            "{name:9} {:>14.6e} {:>14.6e} {change:>10.1e}",
            parameter.f64, parameter.f32
        );
    }
    let part = loss.curve_rms_ln / fit.f64.rms_ln.max(f64::MIN_POSITIVE);
    out += "\nVerdict: ";
    out += if case.f32_is_good_enough {
        "f32 firmware is good enough for this scan.\n"
    } else {
        "f32 firmware is NOT good enough for this scan; compute in f64.\n"
    };
    let residual = if fit.f64.rms_ln < NOISELESS {
        "the scan has no noise".into()
    } else {
        format!(
            "that is {part:.1e} of the rms residual of {:.3e}, and MSE^2 changes by {:+.1e} of itself",
            fit.f64.rms_ln, loss.excess_mse2
        )
    };
    let _ = writeln!(
        out,
        "The fitted curve changes by {:.1e} rms in ln f; {residual}.",
        loss.curve_rms_ln
    );
    let names: Vec<&str> = case.different().map(|parameter| parameter.name).collect();
    let percent = 100.0 * DIFFERENT;
    let _ = if names.is_empty() {
        writeln!(out, "No parameter differs by more than {percent} %.")
    } else {
        writeln!(
            out,
            "These parameters differ by more than {percent} %: {}.",
            names.join(", ")
        )
    };
    if case.condition > 1e6 {
        let _ = writeln!(
            out,
            "The scan hardly determines some combination of its parameters (condition {:.0e}), in any precision.",
            case.condition
        );
    }
    out
}
