//! Tables of columns: their rows as scans, one for each column of values and for each wavelength, polarisation and sample.

use std::collections::HashMap;

use super::about::{About, Kind, ThetaI, Used};
use super::columns::{self, Azimuth, Columns, Value};
use super::facts::Facts;
use super::format::{self, Format};
use super::options::ReadOptions;
use super::raw::{Places, RawScan, Row, Weight};
use super::repeats;
use super::role::{Look, Role};
use super::rows::{self, Decimal};
use super::sheet::Sheet;
use super::uncertainty::WeightKind;
use super::unit::Unit;
use super::units::{Polarisation, WavelengthUnit};
use super::weight::Deviation;
use super::{channel, polarisation, wavelength};
use crate::error::{Error, shown};

/// This format, which is what no other is.
pub const FORMAT: Format = Format {
    name: "table",
    title: "table with named columns",
    about: "Columns: CSV, TSV, semicolons or spaces",
    reader: format::Reader::Text { is: |_| true, read },
};

/// The scans in a table.
///
/// # Errors
/// There is no header, no row, or a cell that is no number; a column that is not used could matter; a direction repeats at another value.
pub fn read(text: &str, options: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let sheet = Sheet::find(text, options)?;
    let columns = columns::find(sheet.heads.clone(), options).map_err(|error| error.at_line(sheet.line))?;
    let theta_i = match columns.theta_i {
        Some(_) => None,
        None => theta_i_of_remarks(text, sheet.first_line, options)?,
    };
    let mut reader = Reader::new(&columns, &sheet.facts, theta_i, options);
    sheet.for_each(|line, cells| reader.row(line, cells))?;
    if reader.scans.is_empty() {
        return Err(Error::new("there are no rows below the header").help("give one row a sample"));
    }
    let Reader {
        mut scans,
        unused,
        unit,
        splits,
        ..
    } = reader;
    for seen in &unused {
        seen.refuse().map_err(|error| error.at_line(sheet.line))?;
    }
    if options.value_unit.is_none()
        && let Some((column, unit)) = unit
    {
        let text = format!("{} {unit}", columns.heads[column].text);
        let divisor = columns::of_unit(Unit::parse(&unit), &text).map_err(|error| error.at_line(sheet.first_line))?;
        if divisor != 1.0 {
            scans.iter_mut().for_each(|scan| scan.raw.about.divisor = divisor);
        }
    }
    if !options.repeats && !sheet.facts.own {
        let tells_apart = unused
            .iter()
            .filter(|seen| seen.role == Role::Repeat)
            .map(|seen| seen.column);
        let tells_apart: Vec<usize> = tells_apart.collect();
        for scan in &scans {
            repeats::refuse(&scan.raw, &sheet, &columns, &tells_apart)?;
        }
    }
    if options.polarisation == Polarisation::Mean {
        scans = means(scans)?;
    }
    // The name of the only sample tells nothing apart.
    let single = |k: usize| scans.iter().all(|scan| scan.splits.get(k) == scans[0].splits.get(k));
    let telling: Vec<bool> = (0..splits).map(|k| !single(k)).collect();
    let finish = |scan: Scan| {
        let names = scan.splits.iter().zip(&telling).filter(|(_, telling)| **telling);
        let names = names.map(|(name, _)| name.clone());
        let mut raw = scan.raw;
        raw.names = names.chain(raw.names).collect();
        if raw.names.is_empty() {
            raw.names.extend(sheet.facts.scan.clone());
        }
        raw
    };
    Ok(scans.into_iter().map(finish).collect())
}

/// The angle of incidence in the remarks of the whole file, degrees: one between rows would be of those below.
fn theta_i_of_remarks(text: &str, first_line: u64, options: &ReadOptions) -> Result<Option<f64>, Error> {
    if !options.theta_i.is_empty() {
        return Ok(None);
    }
    let all = rows::lines(text).filter(|&(number, _, line)| number < first_line || line.trim_start().starts_with('#'));
    Facts::of(all.map(|(number, _, line)| (number, line))).one_theta_i()
}

/// A scan with what tells it from others.
struct Scan {
    raw: RawScan,
    splits: Vec<String>,
    polarisation: Option<String>,
}

/// Sorts rows into scans.
struct Reader<'a> {
    columns: &'a Columns,
    options: &'a ReadOptions,
    facts: &'a Facts,
    /// What a remark says, degrees.
    theta_i: Option<f64>,
    decimal: Decimal,
    /// Each group of rows has one scan a column of values.
    scans: Vec<Scan>,
    /// Groups by what stands in the rows, and by what that means.
    by_text: HashMap<String, usize>,
    by_name: HashMap<Vec<String>, usize>,
    last: Option<(String, usize)>,
    key: String,
    unused: Vec<Seen>,
    unit: Option<(usize, String)>,
    splits: usize,
}

impl<'a> Reader<'a> {
    fn new(columns: &'a Columns, facts: &'a Facts, theta_i: Option<f64>, options: &'a ReadOptions) -> Self {
        let seen = |&(column, role): &(usize, Role)| Seen {
            column,
            name: columns.heads[column].text.clone(),
            ignored: role == Role::Unknown(Look::Other),
            role,
            first: None,
            varies: false,
            is_zero: true,
        };
        Reader {
            columns,
            options,
            facts,
            theta_i,
            decimal: Decimal::Unknown,
            scans: Vec::new(),
            by_text: HashMap::new(),
            by_name: HashMap::new(),
            last: None,
            key: String::new(),
            unused: columns.unused.iter().map(seen).collect(),
            unit: None,
            splits: columns.splits.len(),
        }
    }

    fn row(&mut self, line: u64, cells: &[&str]) -> Result<(), Error> {
        for seen in &mut self.unused {
            seen.see(cells[seen.column]);
        }
        if let Some(column) = self.columns.unit {
            self.see_unit(column, cells[column])?;
        }
        let group = self.group(cells)?;
        let columns = self.columns;
        let sigma_ln = columns.sigma_ln.map(|column| self.number(cells, column)).transpose()?;
        let angles = Angles {
            theta_i: match columns.theta_i {
                Some(column) => self.number(cells, column)?,
                None => f64::NAN,
            },
            theta_s: self.number(cells, columns.theta_s)?,
            delta_phi: match columns.azimuth {
                None => None,
                Some(Azimuth::Difference(column)) => Some(self.number(cells, column)?),
                Some(Azimuth::Of(phi_s, None)) => Some(self.number(cells, phi_s)?),
                Some(Azimuth::Of(phi_s, Some(phi_i))) => Some(self.number(cells, phi_s)? - self.number(cells, phi_i)?),
            },
        };
        for (place, value) in columns.values.iter().enumerate() {
            let row = Row {
                theta_i: angles.theta_i,
                theta_s: angles.theta_s,
                delta_phi: angles.delta_phi,
                value: self.number(cells, value.column)?,
                weight: self.weight(cells, value)?,
                line,
            };
            let raw = &mut self.scans[group * columns.values.len() + place].raw;
            raw.about.sigma_ln = sigma_ln;
            raw.rows.push(row);
        }
        Ok(())
    }

    fn number(&mut self, cells: &[&str], column: usize) -> Result<f64, Error> {
        rows::number_in(cells, column, &mut self.decimal)
    }

    fn weight(&mut self, cells: &[&str], value: &Value) -> Result<Weight, Error> {
        let Some((column, kind)) = value.weight else {
            return Ok(Weight::Unknown);
        };
        let x = self.number(cells, column)?;
        Ok(match kind {
            WeightKind::Sigma(coverage) => Weight::Sigma(x / coverage),
            WeightKind::RelativeSigma(coverage) => Weight::RelativeSigma(x / coverage),
            WeightKind::PercentSigma(coverage) => Weight::RelativeSigma(x / coverage / 100.0),
            WeightKind::Factor => match self.columns.own_sigma {
                Some([absolute, relative]) if !cells[absolute].is_empty() => Weight::Own(
                    x,
                    Deviation {
                        absolute: self.number(cells, absolute)?,
                        relative: self.number(cells, relative)?,
                    },
                ),
                _ => Weight::Factor(x),
            },
        })
    }

    /// The group that a row belongs to, by its wavelength, polarisation and samples.
    fn group(&mut self, cells: &[&str]) -> Result<usize, Error> {
        let columns = self.columns;
        let mut telling = columns
            .splits
            .iter()
            .chain(&columns.polarisation)
            .chain(&columns.wavelength)
            .peekable();
        // Most tables have one group.
        if telling.peek().is_none() && !self.by_text.is_empty() {
            return Ok(0);
        }
        self.key.clear();
        for &column in telling {
            self.key.push_str(cells[column]);
            self.key.push('\u{1}');
        }
        if let Some((key, group)) = &self.last
            && *key == self.key
        {
            return Ok(*group);
        }
        let group = match self.by_text.get(&self.key) {
            Some(&group) => group,
            None => {
                let group = self.new_group(cells)?;
                self.by_text.insert(self.key.clone(), group);
                group
            }
        };
        self.last = Some((self.key.clone(), group));
        Ok(group)
    }

    /// A group whose text is new; 550 and 550.0 are the same one.
    fn new_group(&mut self, cells: &[&str]) -> Result<usize, Error> {
        let columns = self.columns;
        let wavelength = match columns.wavelength {
            Some(column) => Some(self.wavelength(cells, column)?),
            // A channel may say more of itself.
            None => self.facts.wavelength.map(wavelength::name),
        };
        let polarisation = match columns.polarisation {
            Some(column) => Some(polarisation::name(cells[column])),
            None => self.facts.polarisation.as_deref().map(polarisation::name),
        };
        let splits: Vec<String> = columns.splits.iter().map(|&column| cells[column].to_string()).collect();
        let mut name = splits.clone();
        name.extend([&wavelength, &polarisation].into_iter().flatten().cloned());
        let groups = self.by_name.len();
        let group = *self.by_name.entry(name).or_insert(groups);
        if group == groups {
            let of_value = |value: &Value| self.scan(value, &splits, &wavelength, &polarisation);
            let scans: Vec<Scan> = columns.values.iter().map(of_value).collect();
            self.scans.extend(scans);
        }
        Ok(group)
    }

    /// The wavelength of a row, for people.
    fn wavelength(&mut self, cells: &[&str], column: usize) -> Result<String, Error> {
        let Ok(number) = self.number(cells, column) else {
            // A word, such as the colour of a laser, tells rows apart as well.
            return Ok(cells[column].to_string());
        };
        let head = &self.columns.heads[column];
        let unit = match self.options.wavelength_unit {
            Some(WavelengthUnit::Nm) => Some(Unit::Length(1.0)),
            Some(WavelengthUnit::Um) => Some(Unit::Length(1e3)),
            Some(WavelengthUnit::M) => Some(Unit::Length(1e9)),
            Some(WavelengthUnit::Angstrom) => Some(Unit::Length(0.1)),
            Some(WavelengthUnit::PerCm) => Some(Unit::PerCm),
            None => match head.plain.as_str() {
                "wavelengthm" | "lambdam" => Some(Unit::Length(1e9)),
                "wavenumber" if head.unit.is_none() => Some(Unit::PerCm),
                _ => head.unit,
            },
        };
        let nanometres = wavelength::nanometres(number, unit).map_err(|error| error.at_column(column as u64 + 1))?;
        Ok(wavelength::name(nanometres))
    }

    /// An empty scan of one column of values in one group.
    fn scan(
        &self,
        value: &Value,
        splits: &[String],
        wavelength: &Option<String>,
        polarisation: &Option<String>,
    ) -> Scan {
        let columns = self.columns;
        let place = |column: usize| column as u64 + 1;
        let head = &columns.heads[value.column];
        let of_channel = channel::polarisation(head).map(str::to_string);
        let names = value.name.iter().chain(wavelength).chain(polarisation);
        Scan {
            raw: RawScan {
                quantity: value.quantity,
                places: Places {
                    theta_i: columns.theta_i.map(place),
                    theta_s: Some(place(columns.theta_s)),
                    phi: columns.azimuth.map(|azimuth| match azimuth {
                        Azimuth::Difference(column) | Azimuth::Of(column, _) => place(column),
                    }),
                    value: Some(place(value.column)),
                    weight: value.weight.map(|(column, _)| place(column)),
                },
                about: self.about(value),
                ..RawScan::new(names.cloned().collect(), columns.angles)
            },
            splits: splits.to_vec(),
            polarisation: polarisation.clone().or(of_channel),
        }
    }

    /// What is known of the columns before the rows.
    fn about(&self, value: &Value) -> About {
        let columns = self.columns;
        let mut used: Vec<(usize, String)> = Vec::new();
        let mut add =
            |column: Option<usize>, holds: &str| used.extend(column.map(|column| (column, holds.to_string())));
        add(columns.theta_i, "theta_i");
        add(Some(columns.theta_s), "theta_s");
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
        let value_is = if value.divisor == 100.0 { "in percent" } else { "" };
        add(
            Some(value.column),
            format!("{} {value_is}", value.quantity.title()).trim(),
        );
        if let Some((column, kind)) = value.weight {
            let times = |coverage: f64| {
                if coverage == 1.0 {
                    String::new()
                } else {
                    format!(" times {coverage}")
                }
            };
            let holds = match kind {
                WeightKind::Sigma(coverage) => format!("standard deviation{}", times(coverage)),
                WeightKind::RelativeSigma(coverage) => format!("relative standard deviation{}", times(coverage)),
                WeightKind::PercentSigma(coverage) => {
                    format!("standard deviation{} in percent of the value", times(coverage))
                }
                WeightKind::Factor => "weight".to_string(),
            };
            add(Some(column), &holds);
        }
        used.sort_by_key(|(column, _)| *column);
        let used = used.into_iter().map(|(column, holds)| Used {
            number: column + 1,
            name: columns.heads[column].text.clone(),
            holds,
        });
        let title = |column: usize| match columns.heads[column].text.as_str() {
            "" => format!("column {}", column + 1),
            name => name.to_string(),
        };
        About {
            kind: Kind::Table,
            columns: used.collect(),
            unused: columns.unused.iter().map(|&(column, _)| title(column)).collect(),
            theta_i: match columns.theta_i {
                Some(_) => ThetaI::Column,
                None => ThetaI::Missing {
                    remark: self.theta_i,
                    names: columns.heads.iter().map(|head| head.text.clone()).collect(),
                },
            },
            one_angle: false,
            settled: self.facts.own,
            angles_named: columns.angles_named,
            divisor: value.divisor,
            sigma_ln: None,
            ..About::default()
        }
    }

    fn see_unit(&mut self, column: usize, cell: &str) -> Result<(), Error> {
        match &self.unit {
            None => self.unit = Some((column, cell.to_string())),
            Some((_, known)) if known == cell => {}
            Some((_, known)) => {
                return Err(Error::new(format!(
                    "the unit is '{}', and was '{}' before",
                    shown(cell),
                    shown(known)
                ))
                .at_column(column as u64 + 1)
                .help(format!(
                    "give all values in one unit, or make scans of the units with --split {}",
                    column + 1
                )));
            }
        }
        Ok(())
    }
}

/// The angles of a row, as they stand there.
struct Angles {
    theta_i: f64,
    theta_s: f64,
    delta_phi: Option<f64>,
}

/// What was seen of a column that is not used.
struct Seen {
    column: usize,
    name: String,
    role: Role,
    ignored: bool,
    first: Option<String>,
    varies: bool,
    is_zero: bool,
}

impl Seen {
    fn see(&mut self, cell: &str) {
        if self.ignored || (self.varies && !self.is_zero) {
            return;
        }
        self.is_zero &= cell.is_empty() || rows::parse(cell, Decimal::Unknown) == Some(0.0);
        match &self.first {
            None => self.first = Some(cell.to_string()),
            Some(first) => self.varies |= first != cell,
        }
    }

    /// Refuses a column that could change what the scan is.
    fn refuse(&self) -> Result<(), Error> {
        let (matters, like) = match self.role {
            Role::ThetaI | Role::ThetaS | Role::Theta | Role::Unknown(Look::Angle) => (!self.is_zero, "an angle"),
            Role::PhiS | Role::DeltaPhi | Role::Phi => (!self.is_zero, "an azimuth"),
            // The plane of incidence may have any azimuth, if it is one plane.
            Role::PhiI => (self.varies, "an azimuth"),
            Role::Wavelength | Role::Unknown(Look::Wavelength) => (self.varies, "a wavelength"),
            Role::Polarisation | Role::Unknown(Look::Polarisation) => (self.varies, "a polarisation"),
            Role::Sample | Role::Unknown(Look::Sample) => (self.varies, "the name of a sample"),
            Role::Unit | Role::Unknown(Look::Unit) => (self.varies, "a unit"),
            Role::Repeat
            | Role::SigmaLn
            | Role::OwnAbsolute
            | Role::OwnRelative
            | Role::Value(_)
            | Role::Unknown(Look::Other) => (false, ""),
        };
        if !matters {
            return Ok(());
        }
        let (name, number) = (shown(&self.name), self.column + 1);
        Err(Error::new(format!("the column '{name}' looks like {like} and would not be used"))
            .at_column(number as u64)
            .help(format!(
                "say what it is with --columns NAME={number}, make scans of what stands in it with --split {number}, or leave it out with --ignore {number}"
            )))
    }
}

/// The mean of s and p of each scan.
fn means(scans: Vec<Scan>) -> Result<Vec<Scan>, Error> {
    let other_names = |scan: &Scan| {
        let mut names = scan.splits.clone();
        let own = |name: &&String| {
            let is_polarisation = scan
                .polarisation
                .as_ref()
                .is_some_and(|polarisation| polarisation == *name);
            !is_polarisation && channel::polarisation(&super::head::Head::new(name)).is_none()
        };
        names.extend(scan.raw.names.iter().filter(own).cloned());
        names
    };
    let fail = || {
        Error::new("there is not one scan of s and one of p polarisation for each mean")
            .help("choose two with --column, or fit all apart (--polarisation apart)")
    };
    let mut found: Vec<(Vec<String>, Option<Scan>, Option<Scan>)> = Vec::new();
    for scan in scans {
        let names = other_names(&scan);
        let place = match found.iter().position(|(known, ..)| *known == names) {
            Some(place) => place,
            None => {
                found.push((names, None, None));
                found.len() - 1
            }
        };
        let (_, s, p) = &mut found[place];
        let slot = match scan.polarisation.as_deref() {
            Some("s") => s,
            Some("p") => p,
            _ => return Err(fail()),
        };
        if slot.replace(scan).is_some() {
            return Err(fail());
        }
    }
    let mean = |(names, s, p): (Vec<String>, Option<Scan>, Option<Scan>)| {
        let (Some(s), Some(p)) = (s, p) else { return Err(fail()) };
        let names: Vec<String> = names.into_iter().skip(s.splits.len()).collect();
        let mut raw = polarisation::mean(s.raw, &p.raw, names)?;
        raw.about.notes.push("mean of s and p polarisation".to_string());
        Ok(Scan {
            raw,
            splits: s.splits,
            polarisation: None,
        })
    };
    found.into_iter().map(mean).collect()
}
#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use brdfit_core::geometry::Sample;

    use super::super::{Measurement, parse};
    use super::*;

    fn read(text: &str, options: &ReadOptions) -> Result<Vec<Measurement>, Error> {
        parse("scan.csv", text.as_bytes(), options)
    }

    fn one(text: &str) -> Measurement {
        let mut scans = read(text, &ReadOptions::default()).unwrap();
        assert_eq!(scans.len(), 1);
        scans.remove(0)
    }

    #[test]
    fn counts_lines_over_remarks_blanks_and_line_ends() {
        for end in ["\n", "\r\n"] {
            for mark in ["", "\u{feff}"] {
                let lines = [
                    "# remark",
                    "",
                    "theta_i,theta_s,brdf",
                    "",
                    "1,2,3",
                    "# x",
                    "  # y",
                    "",
                    "4,5,6",
                    ",,",
                    "7,8,9",
                ];
                let scan = one(&format!("{mark}{}{end}", lines.join(end)));
                assert_eq!(scan.lines, [5, 9, 11], "{end:?}");
                assert_eq!(scan.samples[2].brdf, 9.0);
                assert_eq!(scan.samples[0].theta_i, 1f64.to_radians());
            }
        }
    }

    #[test]
    fn takes_any_delimiter_and_quotes() {
        for text in [
            "theta_i;theta_s;brdf\n45;-85;0.5\n",
            "theta_i\ttheta_s\tbrdf\n45\t-85\t0.5",
            "\"theta_i\",\"theta_s\",\"brdf\"\n\"45\", -85 ,\"5e-1\"\n",
            "  theta_i theta_s  brdf\n# x\n\n 45   -85 0.5",
        ] {
            let sample = Sample::in_plane(45f64.to_radians(), (-85f64).to_radians(), 0.5);
            assert_eq!(one(text).samples, [sample], "{text}");
        }
    }

    #[test]
    fn takes_azimuths() {
        let scan = one("theta_i,theta_s,delta_phi,brdf\n45,40,180,1\n45,40,-180,1\n45,40,0,1\n45,40,270,1\n");
        let azimuths: Vec<f64> = scan.samples.iter().map(|sample| sample.delta_phi).collect();
        assert_eq!(azimuths, [PI, PI, 0.0, (-90f64).to_radians()]);
        let scan = one("theta_i,phi_i,theta_s,phi_s,brdf\n45,90,40,270,1\n");
        assert_eq!(scan.samples[0].delta_phi, PI);
        let scan = one("theta_i_rad,theta_s_rad,brdf\n0.5,0.25,1\n");
        assert_eq!(scan.samples, [Sample::in_plane(0.5, 0.25, 1.0)]);
    }

    #[test]
    fn columns_and_wavelengths_are_scans() {
        let text = "theta_i,theta_s,wavelength_nm,R,G\n45,1,550,1,2\n45,1,650,3,4\n45,2,550,5,6\n";
        let scans = read(text, &ReadOptions::default()).unwrap();
        let names: Vec<_> = scans.iter().map(|scan| scan.name.as_deref().unwrap()).collect();
        assert_eq!(names, ["R 550 nm", "G 550 nm", "R 650 nm", "G 650 nm"]);
        assert_eq!(
            (scans[1].samples[1].brdf, scans[1].lines.as_slice()),
            (6.0, [2, 4].as_slice())
        );
        let chosen = |column: &str| ReadOptions {
            column: column.split(',').map(String::from).collect(),
            ..ReadOptions::default()
        };
        let brdf = |column| -> Vec<f64> {
            let scans = read(text, &chosen(column)).unwrap();
            scans.iter().map(|scan| scan.samples[0].brdf).collect()
        };
        assert_eq!(brdf("r"), [1.0, 3.0]);
        assert_eq!(brdf("650nm"), [3.0, 4.0]);
        assert_eq!(brdf("R 650 nm"), [3.0]);
        let error = read(text, &chosen("X")).unwrap_err().to_string();
        assert!(error.contains("no scan 'X'") && error.contains("G 650 nm"), "{error}");
        let other = "theta_i,theta_s,brdf,mine\n45,1,1,7\n";
        assert_eq!(read(other, &chosen("mine")).unwrap()[0].samples[0].brdf, 7.0);
    }
}
