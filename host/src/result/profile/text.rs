//! Profiles as a page for people.

use std::fmt::Write;

use crate::analysis::bootstrap::quantile;
use crate::analysis::profile::calibrate::LEVELS;
use crate::analysis::profile::findings::Findings;
use crate::analysis::profile::{self, End, Interval};
use crate::analysis::unseen;
use crate::number::{percent, significant, two};
use crate::result::beside;
use crate::result::text::choice;
use crate::result::words::correlated;

/// The table of the intervals.
pub fn text(findings: &Findings) -> String {
    let known = &findings.outcome.uncertainty;
    let mut page = format!(
        "{}\n  {} samples, residual {}, {} degrees of freedom\n\n",
        findings.name,
        findings.outcome.samples,
        percent(known.scale),
        known.degrees_of_freedom
    );
    for (about, what) in beside::of_fit(&findings.options, &findings.outcome, &findings.about) {
        page.truncate(page.trim_end().len());
        let _ = write!(page, "\n  {about:<9}  {what}\n\n");
    }
    if let Some(misfit) = &known.misfit {
        let copies = if findings.copies.is_empty() {
            ""
        } else {
            "; copies of the bootstrap have independent ones"
        };
        page.truncate(page.trim_end().len());
        let _ = write!(page, "\n  {}{copies}\n\n", correlated(misfit));
    }
    let row = |page: &mut String, cells: [&str; 5]| {
        let [name, best, error, one, two] = cells;
        let line = format!("  {name:<9} {best:>11}  {error:>9}  {one:<26} {two}");
        let _ = writeln!(page, "{}", line.trim_end());
    };
    if let Some(choice) = &findings.choice {
        page += &choice::lines(choice).join("\n");
        page += "\n\n";
    }
    row(&mut page, ["", "best", "+-", "68 % interval", "95 % interval"]);
    let exact = unseen::without_errors(known);
    let name = |index: usize| findings.outcome.model.parameters[index].name;
    for profile in &findings.profiles {
        let index = profile.index;
        let [narrow, wide] = profile.intervals.map(|interval| match exact {
            true => "-".into(),
            false => shown(&interval),
        });
        let error = match profile::stderr(index, known) {
            Some(error) => two(error),
            None => "-".into(),
        };
        row(
            &mut page,
            [name(index), &five(profile.best.value), &error, &narrow, &wide],
        );
    }
    if exact {
        page += "\n  The fit is exact: no residual tells of errors, and so nothing tells which other values the scan allows.\n";
        return page;
    }
    if !findings.copies.is_empty() {
        let _ = writeln!(
            page,
            "\n  bootstrap: {} copies, seed {}",
            findings.copies.len(),
            findings.options.seed
        );
        for profile in &findings.profiles {
            let index = profile.index;
            let values: Vec<f64> = findings.copies.iter().map(|params| params[index]).collect();
            let [one, two] = LEVELS.map(|level| {
                let (low, high) = (
                    quantile(&values, 0.5 - 0.5 * level),
                    quantile(&values, 0.5 + 0.5 * level),
                );
                format!("{} to {}", five(low), five(high))
            });
            row(&mut page, [name(index), &five(quantile(&values, 0.5)), "", &one, &two]);
        }
    }
    page.push('\n');
    if let Some(before) = findings.improved_from {
        let _ = writeln!(
            page,
            "  A profile met a better fit than the search, with MSE^2 lower by {}; all of this is of the better one.",
            percent(1.0 - findings.outcome.cost / before)
        );
    }
    page += "  The 95 % interval holds the values at which the best fit of the others is not refuted by ";
    page += &match findings.calibrated {
        0 => "an F test.\n".to_string(),
        copies => format!("{copies} copies, seed {}.\n", findings.options.seed),
    };
    page += "  (bound) marks an end that the bound of the parameter sets, not the data.\n";
    page
}

fn shown(interval: &Interval) -> String {
    let end = |end: End| five(end.value) + if end.at_bound { " (bound)" } else { "" };
    format!("{} to {}", end(interval.low), end(interval.high))
}

/// Five digits fit the columns.
fn five(x: f64) -> String {
    significant(x, 5)
}
