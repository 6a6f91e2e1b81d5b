//! Rows that are no sample, summed up in one line.

use crate::error::Error;

/// The rows that are no sample, summed up.
#[derive(Default)]
pub(super) struct Faults {
    pub(super) count: usize,
    /// How many are close to the direction of incidence, where a detector blocks the beam.
    pub(super) near_retro: usize,
    pub(super) negative: usize,
    /// How many have no angle of incidence.
    pub(super) no_angle: usize,
    first: Option<(u64, Option<u64>, String)>,
    lines: Vec<String>,
}

impl Faults {
    pub(super) fn add(&mut self, line: u64, column: Option<u64>, what: String) {
        const LISTED: usize = 8;
        self.first.get_or_insert((line, column, what));
        if self.lines.len() < LISTED {
            self.lines.push(line.to_string());
        }
        self.count += 1;
    }

    /// One line for all of them, of so many rows, at the place of the first.
    pub(super) fn error(self, rows: usize) -> Error {
        let Some((line, column, mut what)) = self.first else {
            return Error::new("no row is at fault");
        };
        if self.count > 1 {
            let more = if self.count > self.lines.len() { ", ..." } else { "" };
            let lines = self.lines.join(", ");
            what += &format!(" ({} rows are not valid, on lines {lines}{more})", self.count);
        }
        let help = if self.no_angle == self.count && self.count < rows {
            "write the angle in every row (of merged cells only the first has it), or use --drop-invalid to leave such rows out"
        } else if 2 * self.negative > rows {
            "most values are negative: are they logarithms? say so with --quantity ln-brdf or log10-brdf"
        } else if 2 * self.near_retro > self.count {
            "most are where a detector blocks the incident beam: use --mask-retro 6, or --drop-invalid to leave such rows out"
        } else {
            "use --drop-invalid to leave such rows out"
        };
        Error::new(what).help(help).at(line, column)
    }
}

#[cfg(test)]
mod tests {
    use crate::error::Error;
    use crate::input::{Measurement, ReadOptions, parse};

    fn read(text: &str, options: &ReadOptions) -> Result<Measurement, Error> {
        parse("scan.csv", text.as_bytes(), options).map(|mut scans| scans.remove(0))
    }

    #[test]
    fn quotes_the_cell_that_is_no_number() {
        for (cells, words) in [
            ("n/a,0.1", "the BRDF is 'n/a', which"),
            (",0.1", "the BRDF is an empty cell, which"),
            ("#DIV/0!,0.1", "the BRDF is '#DIV/0!', which"),
            ("0.5,", "the standard deviation is an empty cell, which"),
            ("0.5,-0.1", "the standard deviation is -0.1, which"),
        ] {
            let text = format!("theta_i,theta_s,brdf,sigma\n45,0,1,0.1\n45,1,{cells}\n");
            let error = read(&text, &ReadOptions::default()).unwrap_err();
            assert!(error.line == Some(3) && error.what.contains(words), "{error}");
        }
    }

    #[test]
    fn drops_only_what_is_asked_for() {
        let text = "theta_i,theta_s,brdf\n45,1,-0.1\n45,2,1\n45,90,1\n45,4,nan\n30,5,0\n";
        let error = read(text, &ReadOptions::default()).unwrap_err();
        assert_eq!((error.line, error.column), (Some(2), Some(3)));
        assert!(
            error.what.contains("4 rows are not valid, on lines 2, 4, 5, 6"),
            "{error}"
        );
        let options = ReadOptions {
            drop_invalid: true,
            ..ReadOptions::default()
        };
        let scan = read(text, &options).unwrap();
        assert_eq!(scan.lines, [3]);
        let counts: Vec<_> = scan.left_out.iter().map(|one| (one.theta_i_deg, one.samples)).collect();
        assert_eq!(counts, [(30.0, 1), (45.0, 3)]);
    }
}
