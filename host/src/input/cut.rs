//! A file that ends in the midst of a line.

use super::format::{Format, Reader};
use super::raw::RawScan;

/// Notes in the scans that have the last line of the file that it has no end, if that is a number: of a file that was cut off, some digits may be missing.
pub fn suspect(format: Format, file: &[u8], scans: &mut [RawScan]) {
    // In a binary format the last byte may be any.
    if !matches!(format.reader, Reader::Text { .. }) {
        return;
    }
    // In UTF-16 each digit has a zero beside it.
    let last = file.iter().rev().find(|&&byte| byte != 0);
    if !last.is_some_and(|byte| byte.is_ascii_digit() || *byte == b'.') {
        return;
    }
    let of = |scan: &RawScan| scan.rows.iter().map(|row| row.line).max().unwrap_or(0);
    let last = scans.iter().map(of).max().unwrap_or(0);
    for scan in scans.iter_mut().filter(|scan| of(scan) == last) {
        let note = format!(
            "line {last} ends the file in a number and without a line feed: if the file was cut off there, that number is wrong"
        );
        scan.about.notes.push(note.clone());
        scan.about.doubts.push(note);
    }
}

#[cfg(test)]
mod tests {
    use crate::input::{ReadOptions, parse};

    #[test]
    fn a_number_at_the_end_is_suspected() {
        let doubts = |text: &str| {
            let options = ReadOptions {
                theta_i: vec![45.0],
                ..ReadOptions::default()
            };
            parse("scan", text.as_bytes(), &options).unwrap()[0]
                .about
                .doubts
                .clone()
        };
        let whole = "theta_s,brdf\n10,0.25\n20,0.125\n";
        assert!(doubts(whole).is_empty() && doubts("theta_s,brdf,remark\n10,0.25,x").is_empty());
        for cut in 1..4 {
            let doubts = doubts(&whole[..whole.len() - cut]);
            assert!(doubts[0].starts_with("line 3 ends the file"), "{cut}: {doubts:?}");
        }
    }
}
