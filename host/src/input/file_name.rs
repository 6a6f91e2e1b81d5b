//! The angle of incidence in a file's name: `scan_20.txt`, `aoi45.csv`, `paint_30deg.csv`.

use std::path::Path;

use super::head::Head;
use super::role::{self, Role};
use crate::error::Error;
use crate::number::shortest;

/// What may stand between a number and the words around it.
const MARKS: [char; 8] = ['_', '-', ' ', '=', '(', ')', '+', '.'];
/// Words in front of a number that is no angle of incidence, beside the names of other columns: what counts, in several languages, and other quantities.
const OTHERS: &str = "sample specimen wafer slot lot batch panel tile plate coupon piece part box tray file test \
    trial try meas pos position place spot site step frame image img channel ch version ver v rev \
    revision copy serial sn exp experiment series day week cycle temp temperature gain thickness \
    roughness load dose nummer id job order set line row col n no nr avg average mean \
    nd od filter size coat coats coating layer layers x y z rot rotation tilt stage det detector \
    receiver scatter scattered scattering out view exposure integration power current voltage speed humidity rh \
    age year month hour minute jan feb mar apr may jun jul aug sep oct nov dec grit rms ra rq rz sa sq \
    vol mix pct ratio conc probe versuch lauf messung muestra essai echantillon prova campione monster";
/// Units and the like that may stand apart behind a number that is no angle.
const UNITS: &str = "nm um µm mm cm hz khz mhz ghz thz kv mv ma mw rpm ms sec secs min mins minutes h hr hrs hours \
    days degc degf °c °f celsius percent %";

/// A number in a name.
struct Number<'a> {
    text: &'a str,
    value: f64,
    /// All before it.
    before: &'a str,
    /// All behind it.
    after: &'a str,
}

/// The angle of incidence in a file's name, degrees: after `aoi`, `theta_i`, `inc` and the like, before `deg`, or the only number that stands apart.
///
/// A number behind letters, one with a zero in front and one below 5 are more often counted: `paint7`, `scan_01`, `run 2`.
/// So is one behind a word such as `sample`, and one before letters has another unit: `60s`.
///
/// # Errors
/// There are several such numbers, or one may go on: `aoi30p5`, `aoi_44_5`, `aoi45to60`; or the one that is left stands beside one that counts: `run_7_45`.
pub fn theta_i(file: &str) -> Result<Option<f64>, Error> {
    let path = Path::new(file);
    let text = |part: Option<&std::ffi::OsStr>| part.map(|part| part.to_string_lossy().to_string()).unwrap_or_default();
    let (mut name, extension) = (text(path.file_stem()), text(path.extension()));
    // `aoi22.5` may have no extension.
    if extension.len() < 3 && extension.parse::<u8>().is_ok() {
        name += &format!(",{extension}");
    }
    let (mut tagged, mut all) = (Vec::new(), Vec::new());
    let mut end = 0;
    // The number that counts right before this one, which may be the angle as well.
    let mut rival: Option<String> = None;
    while let Some(number) = next(&name, &mut end) {
        let is_tagged = number.is_keyed() || number.is_degrees();
        let before = rival.take();
        if is_tagged || !(number.is_counted() || number.is_other()) {
            let list = if is_tagged { &mut tagged } else { &mut all };
            list.extend(before.filter(|_| !is_tagged));
            list.push(shortest(number.value));
            // A comma or a `p` is a point, and a second number another half of this one, or its rival.
            list.extend(number.goes_on(is_tagged));
        } else if number.may_be_angle() && name[end..].starts_with(MARKS) {
            let behind = name[end..].trim_start_matches(MARKS);
            rival = Some(shortest(number.value)).filter(|_| behind.starts_with(|c: char| c.is_ascii_digit()));
        }
    }
    let several = |numbers: &[String]| {
        Err(Error::new(format!(
            "the name of the file may give theta_i as {} or {}",
            numbers[0], numbers[1]
        ))
        .help("say which with --theta-i, in degrees"))
    };
    match (&tagged[..], &all[..]) {
        ([one], _) => Ok(one.parse().ok()),
        ([], [one]) => Ok(one.parse().ok().filter(|one| (0.0..90.0).contains(one))),
        ([], []) => Ok(None),
        ([], numbers) | (numbers, _) => several(numbers),
    }
}

/// The number that begins at `end` or behind it, whose own end that becomes.
fn next<'a>(name: &'a str, end: &mut usize) -> Option<Number<'a>> {
    let begin = *end + name[*end..].find(|c: char| c.is_ascii_digit())?;
    let digits = name[begin..].find(|c: char| !c.is_ascii_digit() && c != '.');
    let text = name[begin..digits.map_or(name.len(), |length| begin + length)].trim_end_matches('.');
    *end = begin + text.len();
    Some(Number {
        text,
        // `2024.01.15` is none.
        value: text.parse().unwrap_or(f64::NAN),
        before: &name[..begin],
        after: &name[*end..],
    })
}

impl Number<'_> {
    /// The word before it, and the last two.
    fn keys(&self) -> [String; 2] {
        let before = self.before.trim_end_matches(MARKS);
        let words: Vec<&str> = before.rsplitn(3, MARKS).take(2).collect();
        let two = words.iter().rev().copied().collect::<Vec<_>>().join("_");
        [words.first().copied().unwrap_or_default().to_string(), two]
    }

    /// Is the word before it a name of the angle of incidence?
    fn is_keyed(&self) -> bool {
        let is = |key: &String| {
            role::role(&Head::new(key)) == Role::ThetaI
                || ["inc", "incidence", "incident", "ti"].contains(&key.to_lowercase().as_str())
        };
        self.keys().iter().any(is)
    }

    /// The word behind it, apart or not.
    fn word_behind(&self) -> String {
        let after = self.after.trim_start_matches(MARKS);
        after
            .chars()
            .take_while(|c| c.is_alphabetic() || "°%".contains(*c))
            .collect()
    }

    fn is_degrees(&self) -> bool {
        let word = self.word_behind().to_lowercase();
        let rest = ["degrees", "degree", "deg", "grad", "°"]
            .iter()
            .find_map(|unit| word.strip_prefix(unit));
        rest.is_some_and(|rest| !["c", "f", "k", "celsius"].contains(&rest))
    }

    /// True of a number that counts files or samples.
    fn is_counted(&self) -> bool {
        let glued = self.before.ends_with(char::is_alphabetic) || self.before.ends_with(['(', '#']);
        let padded = self.text.starts_with('0') && self.text.len() > 1 && !self.text.starts_with("0.");
        glued || padded || self.value > 0.0 && self.value < 5.0
    }

    /// True of a number of something else, by the word before it or the unit behind.
    fn is_other(&self) -> bool {
        let is = |key: &String| {
            let named = match role::role(&Head::new(key)) {
                // A file may be called after its scan.
                Role::Sample => !key.to_lowercase().ends_with("scan"),
                Role::ThetaS | Role::PhiI | Role::PhiS | Role::DeltaPhi | Role::Phi => true,
                Role::Wavelength | Role::Repeat => true,
                _ => false,
            };
            named || is_among(OTHERS, key)
        };
        let behind = self.word_behind();
        let is_unit = is_among(UNITS, &behind) || ["C", "F", "K"].contains(&behind.as_str());
        let is_glued = self.after.starts_with(|c: char| c.is_alphabetic());
        self.value.is_nan() || self.keys().iter().any(is) || is_glued || is_unit
    }

    /// True of a number that may be an angle of incidence, whatever word stands before it.
    fn may_be_angle(&self) -> bool {
        let padded = self.text.starts_with('0') && self.text.len() > 1;
        !padded && (self.value == 0.0 || (5.0..90.0).contains(&self.value))
    }

    /// What else it may be, for people, if digits go on behind it: `30p5`, `30,5`, `44_5`, `45to60`.
    fn goes_on(&self, tagged: bool) -> Option<String> {
        let digits = |rest: &str| -> String { rest.chars().take_while(char::is_ascii_digit).collect() };
        let behind = |mark: &str| {
            self.after
                .strip_prefix(mark)
                .map(digits)
                .filter(|more| !more.is_empty())
        };
        if let Some(more) = behind(",").or_else(|| behind("p").filter(|_| tagged)) {
            return Some(format!("{}.{more}", self.text));
        }
        let more = behind("to").or_else(|| ["_", "-", " "].iter().find_map(|mark| behind(mark)));
        let more = more.filter(|more| tagged && more.len() < 3 && (more.len() == 1 || !more.starts_with('0')))?;
        // A number with a unit of its own is another thing: `aoi45_10um`.
        let rest = &self.after[self.after.find(|c: char| c.is_ascii_digit())? + more.len()..];
        (!rest.starts_with(|c: char| c.is_alphabetic() || c == '.') && !rest.starts_with("°")).then_some(more)
    }
}

/// Is a word one of those between spaces, in any case?
fn is_among(words: &str, word: &str) -> bool {
    words.split(' ').any(|one| one == word.to_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_in_names() {
        for (name, angle) in [
            ("dir3/scan_20.txt", Some(20.0)),
            ("aoi45.csv", Some(45.0)),
            ("AOI30.csv", Some(30.0)),
            ("theta_i=45.csv", Some(45.0)),
            ("45deg.csv", Some(45.0)),
            ("45°.csv", Some(45.0)),
            ("paint_theta_i_22.5_run3.csv", Some(22.5)),
            ("paint7_30deg.csv", Some(30.0)),
            ("AOI_30deg_run2.csv", Some(30.0)),
            ("run_7_aoi_60_rep3.csv", Some(60.0)),
            ("paint_550nm_inc60.csv", Some(60.0)),
            ("aoi_45_10um.csv", Some(45.0)),
            ("aoi45_01.csv", Some(45.0)),
            ("aoi45_633.csv", Some(45.0)),
            ("ti=10.txt", Some(10.0)),
            ("paint_633nm_20.dat", Some(20.0)),
            ("sample_12_scan_20.dat", Some(20.0)),
            ("25degC_60.dat", Some(60.0)),
            ("20_s.dat", Some(20.0)),
            ("s-pol_45.csv", Some(45.0)),
            ("run_07_45.csv", Some(45.0)),
            ("paint2_20.csv", Some(20.0)),
            ("exp10_aoi20.csv", Some(20.0)),
            ("exp10_b_20.csv", Some(20.0)),
            ("aoi3.csv", Some(3.0)),
            ("scan_0.csv", Some(0.0)),
        ] {
            assert_eq!(theta_i(name).unwrap(), angle, "{name}");
        }
    }

    #[test]
    fn numbers_that_are_no_angles() {
        let names = "paint.csv; paint_550nm.csv; run2026.csv; paint7.csv; scan_026.csv; sample 3.csv; \
            run_7.csv; sample_12.csv; 25degC.csv; 25 °C.csv; 25_C.csv; paint_60min.csv; \
            paint 60 min.csv; wafer 25 slot 3.csv; 45C.csv; 60s.csv; 10x.csv; 12h30.csv; \
            filter_10.csv; OD_10.csv; det_20.csv; nov_20.csv; Ra_10.csv; paint #20.csv; versuch 20.csv; \
            batch_5.csv; Nr. 9.csv; no_9.csv; 5 um.csv; 0.5V.csv; theta_s_30.csv; phi_45.csv; \
            lambda_10.csv; paint (12).csv; 25_C_a.csv; v1.20.csv; 50%.csv";
        for name in names.split("; ") {
            assert_eq!(theta_i(name).unwrap(), None, "{name}");
        }
    }

    #[test]
    fn names_that_may_give_two_angles() {
        let names = "paint_7_20.csv; aoi30p5.csv; aoi30,5.csv; paint_30,5.csv; aoi_44_5.csv; aoi_4p5.csv; \
            run_7_45.csv; exp10_20.csv; paint7_20.csv; sample 12 - 30.csv; \
            aoi45to60.csv; aoi 45-60.csv; 45deg_0deg.csv; aoi_22_5; aoi22.5; 2024-01-15.csv";
        for name in names.split("; ") {
            let error = theta_i(name).map(|angle| panic!("{name}: {angle:?}")).unwrap_err();
            assert!(error.to_string().contains("--theta-i"), "{name}: {error}");
        }
    }
}
