//! Several files as one scan, and what options say of each of them.

use super::format::Format;
use super::options::ReadOptions;
use super::raw::RawScan;
use crate::error::Error;

/// The options of each of some files: each has its own angle of incidence if several are given.
///
/// # Errors
/// There are several angles, and not as many as files.
pub fn options_of_each(options: &ReadOptions, files: usize) -> Result<Vec<ReadOptions>, Error> {
    let angles = &options.theta_i;
    if angles.len() > 1 && angles.len() != files {
        return Err(
            Error::new(format!("--theta-i gives {} angles for {files} files", angles.len()))
                .help("give one angle for each file, in their order, or one for all"),
        );
    }
    let own = |place: usize| ReadOptions {
        theta_i: angles
            .get(if angles.len() > 1 { place } else { 0 })
            .copied()
            .into_iter()
            .collect(),
        ..options.clone()
    };
    Ok((0..files).map(own).collect())
}

/// The scans of several files as those of one: rows of scans of one name follow each other.
///
/// # Errors
/// The files have not the same scans, or their numbers mean different things.
pub fn one(files: Vec<(String, (Format, Vec<RawScan>))>) -> Result<(String, (Format, Vec<RawScan>)), Error> {
    let mut files = files.into_iter();
    let Some((mut label, (format, mut scans))) = files.next() else {
        return Err(Error::new("there are no files"));
    };
    for (file, (other, others)) in files {
        let fail = |what: &str| {
            Err(
                Error::new(format!("{what} than in {label}, so they are not parts of one scan"))
                    .in_file(&file)
                    .help("leave out --one-scan, or give files of one kind"),
            )
        };
        if other != format || others.len() != scans.len() {
            return fail("there are other scans");
        }
        for (scan, more) in scans.iter_mut().zip(others) {
            if scan.names != more.names {
                return fail("there are other scans");
            }
            let same = |a: &RawScan, b: &RawScan| {
                (a.angles, a.quantity, a.about.divisor) == (b.angles, b.quantity, b.about.divisor)
            };
            if !same(scan, &more) {
                return fail("the numbers are in other units");
            }
            scan.rows.extend(more.rows);
            scan.left_out.merge(more.left_out);
            scan.about.doubts.extend(more.about.doubts);
            scan.about.sources = [&scan.about.sources[..], &more.about.sources].concat().into();
            for note in more.about.notes {
                if !scan.about.notes.contains(&note) {
                    scan.about.notes.push(note);
                }
            }
        }
        label = format!("{label} + {file}");
    }
    Ok((label, (format, scans)))
}
