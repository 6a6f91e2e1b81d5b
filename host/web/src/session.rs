//! The files at hand, and what was made of them last.

use brdfit::analysis::choose::Wanted;
use brdfit::analysis::deviations::settled;
use brdfit::analysis::fit::{FittedScan, fit};
use brdfit::error::Error;
use brdfit::input::{self, Measurement};

use crate::request::Subject;

/// What the page works on.
#[derive(Default)]
pub struct Session {
    files: Vec<(String, Vec<u8>)>,
    last: Option<Last>,
}

/// The subject of the last request, as far as something is made of it.
struct Last {
    /// The request's own text.
    asked: String,
    subject: Subject,
    scans: Vec<Measurement>,
    /// The scan as it was fitted, and its fit.
    fitted: Option<(Measurement, FittedScan)>,
}

/// A scan with its fit.
pub struct Fitted<'a> {
    /// The scan.
    pub scan: &'a Measurement,
    /// How it was asked for.
    pub wanted: Wanted,
    /// Its fit.
    pub fit: &'a FittedScan,
}

impl Session {
    /// Takes a file, in place of one of the same name.
    pub fn take_file(&mut self, name: String, bytes: Vec<u8>) {
        self.last = None;
        self.files.retain(|(known, _)| *known != name);
        self.files.push((name, bytes));
    }

    /// The scans of a subject, read anew unless it is the one before.
    ///
    /// # Errors
    /// A request that cannot be understood, a file that is not there, and all of [`input::read`].
    pub fn read(&mut self, asked: &str) -> Result<(&Subject, &[Measurement]), Error> {
        let last = self.look(asked)?;
        Ok((&last.subject, &last.scans))
    }

    /// The one scan of a subject.
    ///
    /// # Errors
    /// As [`Session::read`], and if there are several.
    pub fn one(&mut self, asked: &str) -> Result<(&Subject, &Measurement), Error> {
        let last = self.look(asked)?;
        Ok((&last.subject, only(&last.scans)?))
    }

    /// The fit of a subject, made anew unless it is the one before.
    ///
    /// # Errors
    /// As [`Session::one`], and if the scan cannot be fitted.
    pub fn fit(&mut self, asked: &str) -> Result<Fitted<'_>, Error> {
        let last = self.look(asked)?;
        let wanted = last.subject.search.wanted()?;
        let (scan, fit) = match &mut last.fitted {
            Some(fitted) => fitted,
            none => {
                let scan = settled(only(&last.scans)?.clone(), &wanted);
                let fit = fit(&scan, &wanted)?;
                none.insert((scan, fit))
            }
        };
        Ok(Fitted { scan, wanted, fit })
    }

    fn look(&mut self, asked: &str) -> Result<&mut Last, Error> {
        if self.last.as_ref().is_none_or(|last| last.asked != asked) {
            let subject: Subject =
                serde_json::from_str(asked).map_err(|error| Error::new(error.to_string()).help("check the options"))?;
            subject.read.check()?;
            let one = |name: &String| {
                let known = self.files.iter().find(|(known, _)| known == name);
                known.ok_or_else(|| Error::new("no such file").in_file(name))
            };
            let files = subject.files.iter().map(one).collect::<Result<Vec<_>, _>>()?;
            let scans = input::read_named(&files, &subject.read)?;
            self.last = None;
            self.last = Some(Last {
                asked: asked.to_string(),
                subject,
                scans,
                fitted: None,
            });
        }
        self.last.as_mut().ok_or_else(|| Error::new("nothing was read"))
    }
}

fn only(scans: &[Measurement]) -> Result<&Measurement, Error> {
    match scans {
        [one] => Ok(one),
        several => Err(Error::new(format!("there are {} scans", several.len())).help("choose one")),
    }
}
