//! The means of s and p polarisation of a table's scans.

use std::collections::HashMap;

use super::sorter::Scan;
use crate::error::Error;
use crate::input::head::Head;
use crate::input::{channel, polarisation};

/// The mean of s and p of each scan.
///
/// # Errors
/// One of the two is missing, or they do not have the same directions.
pub fn means(scans: Vec<Scan>) -> Result<Vec<Scan>, Error> {
    let other_names = |scan: &Scan| {
        let mut names = scan.splits.clone();
        let own = |name: &&String| {
            let is_polarisation = scan
                .polarisation
                .as_ref()
                .is_some_and(|polarisation| polarisation == *name);
            !is_polarisation && channel::polarisation(&Head::new(name)).is_none()
        };
        names.extend(scan.raw.names.iter().filter(own).cloned());
        names
    };
    let fail = || {
        Error::new("there is not one scan of s and one of p polarisation for each mean")
            .help("choose two with --column, or fit all apart (--polarisation apart)")
    };
    let mut found: Vec<(Vec<String>, Option<Scan>, Option<Scan>)> = Vec::new();
    let mut places = HashMap::new();
    for scan in scans {
        let names = other_names(&scan);
        let place = *places.entry(names.clone()).or_insert(found.len());
        if place == found.len() {
            found.push((names, None, None));
        }
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
