//! Sorts the rows of a table into scans.

use std::sync::Arc;

use super::about;
use super::texts::Texts;
use super::unused::Seen;
use crate::error::{Error, shown};
use crate::input::about::{About, Missing};
use crate::input::columns::{Azimuth, Columns, Polar, Value, WeightKind};
use crate::input::facts::Facts;
use crate::input::head::Head;
use crate::input::options::ReadOptions;
use crate::input::raw::{Places, RawScan, Row, Weight};
use crate::input::role::Role;
use crate::input::rows::{self, Decimal};
use crate::input::unit::Unit;
use crate::input::units::{Angles, WavelengthUnit};
use crate::input::weight::Deviation;
use crate::input::{channel, part, polarisation, wavelength};

/// A scan with what tells it from others.
pub struct Scan {
    /// Its rows.
    pub raw: RawScan,
    /// What stands in the columns that make scans.
    pub splits: Vec<String>,
    /// Its polarisation, if it is known.
    pub polarisation: Option<String>,
}

/// What stands between the parts of a key, and in no cell.
const BETWEEN: char = '\u{1}';

/// Sorts rows into scans.
pub struct Sorter<'a> {
    columns: &'a Columns,
    options: &'a ReadOptions,
    facts: &'a Facts,
    decimal: Decimal,
    /// Each group of rows has so many scans: one a column of values, or of several at one angle each.
    width: usize,
    /// What the scans of a group are before their first row.
    empty: Vec<Empty>,
    /// The scans, group by group, without their rows.
    scans: Vec<Scan>,
    /// The rows of all scans, and the scan of each if there are several: one buffer costs less than thousands.
    rows: Vec<Row>,
    of_scan: Vec<u32>,
    /// What stands in the rows, the group of each such text, and which the row before has.
    texts: Texts,
    of_text: Vec<usize>,
    last: usize,
    /// The names of the groups, which is what those texts mean.
    names: Texts,
    key: String,
    /// The columns that are not used.
    pub unused: Vec<Seen>,
    /// The column of the unit and what stands in it, if there is one.
    pub unit: Option<(usize, String)>,
}

impl<'a> Sorter<'a> {
    /// Has no row yet; `theta_i` is what a remark says, degrees.
    pub fn new(columns: &'a Columns, facts: &'a Facts, theta_i: Option<f64>, options: &'a ReadOptions) -> Self {
        let is_left_out = |column: usize| {
            let mut places = options
                .ignore
                .iter()
                .map(|name| part::place(name, &columns.heads, "--ignore"));
            places.any(|place| place.is_ok_and(|place| place == column))
        };
        let seen =
            |&(column, role): &(usize, Role)| Seen::new(column, &columns.heads[column].text, role, is_left_out(column));
        let width = columns.values.iter().map(|value| value.scan + 1).max().unwrap_or(0);
        let mut together = vec![Vec::new(); width];
        for (place, value) in columns.values.iter().enumerate() {
            together[value.scan].push(place);
        }
        let names: Arc<[String]> = columns.heads.iter().map(|head| head.text.clone()).collect();
        let unused = about::unused(columns);
        let empty = together.iter().filter_map(|together| {
            let value = &columns.values[*together.first()?];
            let about = about::of(columns, value, together, &names, &unused, theta_i, facts.own);
            Some(Empty::new(columns, value, about))
        });
        Sorter {
            columns,
            options,
            facts,
            decimal: Decimal::Unknown,
            width,
            empty: empty.collect(),
            scans: Vec::new(),
            rows: Vec::new(),
            of_scan: Vec::new(),
            texts: Texts::default(),
            of_text: Vec::new(),
            last: 0,
            names: Texts::default(),
            key: String::new(),
            unused: columns.unused.iter().map(seen).collect(),
            unit: None,
        }
    }

    /// Takes one row.
    ///
    /// # Errors
    /// A cell is no number, or the unit is another than before.
    pub fn row(&mut self, line: u64, cells: &[&str]) -> Result<(), Error> {
        for seen in &mut self.unused {
            seen.see(cells[seen.column]);
        }
        if let Some(column) = self.columns.unit {
            self.see_unit(column, cells[column])?;
        }
        let group = self.group(cells)?;
        let columns = self.columns;
        let sigma_ln = columns.sigma_ln.map(|column| self.number(cells, column)).transpose()?;
        let angles = Directions {
            theta_i: match columns.theta_i {
                Some(column) => self.angle(cells, column)?,
                None => f64::NAN,
            },
            theta_s: match columns.theta_s {
                Some(column) => self.angle(cells, column)?,
                None => f64::NAN,
            },
            delta_phi: match columns.azimuth {
                None => None,
                Some(Azimuth::Difference(column)) => Some(self.angle(cells, column)?),
                Some(Azimuth::Of(phi_s, None)) => Some(self.angle(cells, phi_s)?),
                Some(Azimuth::Of(phi_s, Some(phi_i))) => Some(self.angle(cells, phi_s)? - self.angle(cells, phi_i)?),
            },
        };
        for value in &columns.values {
            let of_head = |polar: Polar| value.angle.filter(|(of, _)| *of == polar).map(|(_, angle)| angle);
            let row = Row {
                theta_i: of_head(Polar::Incidence).unwrap_or(angles.theta_i),
                theta_s: of_head(Polar::Scattering).unwrap_or(angles.theta_s),
                delta_phi: angles.delta_phi,
                value: self.number(cells, value.column)?,
                weight: self.weight(cells, value)?,
                line,
            };
            let scan = group * self.width + value.scan;
            if row.value.is_nan() || matches!(row.weight, Weight::Sigma(x) | Weight::RelativeSigma(x) if x.is_nan()) {
                let weight = value.weight.filter(|_| !row.value.is_nan()).map(|(column, _)| column);
                let column = weight.unwrap_or(value.column);
                self.scans[scan].raw.about.missing.get_or_insert_with(|| Missing {
                    line,
                    column: column as u64 + 1,
                    text: cells[column].to_string(),
                });
            }
            if sigma_ln.is_some() {
                self.scans[scan].raw.about.sigma_ln = sigma_ln;
            }
            if self.scans.len() > 1 {
                // Until now all were of the first.
                self.of_scan.resize(self.rows.len(), 0);
                self.of_scan.push(scan as u32);
            }
            self.rows.push(row);
        }
        Ok(())
    }

    /// The scans with their rows, in order.
    pub fn finish(self) -> Vec<Scan> {
        let mut scans = self.scans;
        if let [only] = &mut scans[..] {
            only.raw.rows = self.rows;
            return scans;
        }
        // Where the rows of each scan begin among those in order of scans.
        let mut next = vec![0; scans.len()];
        self.of_scan.iter().for_each(|&scan| next[scan as usize] += 1);
        let mut begin = 0;
        for count in &mut next {
            begin += std::mem::replace(count, begin);
        }
        let mut order = vec![0; self.rows.len()];
        for (place, &scan) in self.of_scan.iter().enumerate() {
            let next = &mut next[scan as usize];
            order[*next] = place;
            *next += 1;
        }
        let mut begin = 0;
        for (scan, end) in scans.iter_mut().zip(next) {
            scan.raw.rows = order[begin..end].iter().map(|&place| self.rows[place]).collect();
            begin = end;
        }
        scans
    }

    fn number(&mut self, cells: &[&str], column: usize) -> Result<f64, Error> {
        rows::number_in(cells, column, &mut self.decimal)
    }

    /// The angle in a cell, which may have its unit behind it if that is the unit of the column: `20°`.
    fn angle(&mut self, cells: &[&str], column: usize) -> Result<f64, Error> {
        self.number(cells, column).or_else(|error| {
            let (number, unit) = Unit::at_end(cells[column]);
            let here = self.options.angles.unwrap_or(self.columns.angles);
            let same = matches!(
                (unit, here),
                (Some(Unit::Deg), Angles::Deg) | (Some(Unit::Rad), Angles::Rad)
            );
            let number = Some(number.trim()).filter(|_| same);
            number.and_then(|number| rows::parse(number, self.decimal)).ok_or(error)
        })
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
        if telling.peek().is_none() && self.texts.count() > 0 {
            return Ok(0);
        }
        self.key.clear();
        for &column in telling {
            self.key.push_str(cells[column]);
            self.key.push(BETWEEN);
        }
        // Most rows are of the group of the one before, or of the one that came after it the last time.
        let near = [self.last, self.last + 1];
        let near = near.into_iter().find(|&text| self.texts.is(text, &self.key));
        self.last = near.unwrap_or_else(|| self.texts.number(&self.key));
        if self.last == self.of_text.len() {
            let group = self.new_group(cells)?;
            self.of_text.push(group);
        }
        Ok(self.of_text[self.last])
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
        self.key.clear();
        for part in splits.iter().chain(&wavelength).chain(&polarisation) {
            self.key.push_str(part);
            self.key.push(BETWEEN);
        }
        let groups = self.names.count();
        let group = self.names.number(&self.key);
        if group == groups {
            let scans = self.empty.iter();
            self.scans
                .extend(scans.map(|empty| empty.scan(&splits, &wavelength, &polarisation)));
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

/// A scan before its first row, of which each group has its own.
struct Empty {
    raw: RawScan,
    /// What the head of the values says.
    polarisation: Option<String>,
    /// What tells its values from others of a group.
    name: Option<String>,
}

impl Empty {
    /// Of one column of values, or of several at one angle each of which this is the first.
    fn new(columns: &Columns, value: &Value, about: About) -> Empty {
        let place = |column: usize| column as u64 + 1;
        let head = &columns.heads[value.column];
        let of_name = value.name.as_deref().map(Head::new);
        let polarisation = of_name.as_ref().and_then(channel::polarisation);
        let polarisation = polarisation.or_else(|| channel::polarisation(head));
        // Of an angle each there are several columns.
        let is_only = value.angle.is_none();
        Empty {
            raw: RawScan {
                quantity: value.quantity,
                places: Places {
                    theta_i: columns.theta_i.map(place),
                    theta_s: columns.theta_s.map(place),
                    phi: columns.azimuth.map(|azimuth| match azimuth {
                        Azimuth::Difference(column) | Azimuth::Of(column, _) => place(column),
                    }),
                    value: is_only.then(|| place(value.column)),
                    weight: value.weight.filter(|_| is_only).map(|(column, _)| place(column)),
                },
                about,
                ..RawScan::new(Vec::new(), columns.angles)
            },
            polarisation: polarisation.map(str::to_string),
            name: value.name.clone(),
        }
    }

    /// That of one group.
    fn scan(&self, splits: &[String], wavelength: &Option<String>, polarisation: &Option<String>) -> Scan {
        let names = self.name.iter().chain(wavelength).chain(polarisation);
        Scan {
            raw: RawScan {
                names: names.cloned().collect(),
                ..self.raw.clone()
            },
            splits: splits.to_vec(),
            polarisation: polarisation.clone().or_else(|| self.polarisation.clone()),
        }
    }
}

/// The angles of a row, as they stand there.
struct Directions {
    theta_i: f64,
    theta_s: f64,
    delta_phi: Option<f64>,
}
