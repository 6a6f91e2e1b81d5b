//! Files that people try and that hold no scan: what they are, and what to do.

use crate::error::{Error, shown};
use crate::input::bytes;
use crate::input::rows::is_remark;

/// How many bytes tell what a file is.
const HEAD: usize = 4096;

/// First bytes of files that are not text, and what they are.
const BINARY: [(&[u8], &str); 17] = [
    (
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
        "an Excel workbook of the old kind (.xls)",
    ),
    (b"%PDF", "a PDF document"),
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"GIF8", "a GIF picture"),
    (b"II*\0", "a TIFF picture"),
    (b"MM\0*", "a TIFF picture"),
    (b"\x76\x2f\x31\x01", "an OpenEXR picture"),
    (b"\x89HDF\r\n\x1a\n", "an HDF5 file, such as MATLAB's .mat or NetCDF"),
    (b"CDF\x01", "a NetCDF file"),
    (b"MATLAB 5.0", "a MATLAB file (.mat)"),
    (b"\x93NUMPY", "a NumPy array (.npy)"),
    (b"\x1f\x8b", "compressed with gzip"),
    (b"BZh", "compressed with bzip2"),
    (b"\xfd7zXZ\0", "compressed with xz"),
    (b"PAR1", "a Parquet table"),
    (b"PK\x03\x04", "a ZIP archive"),
];

/// What a file is that no format knows by its bytes, if it is known to hold no scan.
pub fn named(file: &[u8]) -> Option<Error> {
    const SHEET: &[u8] = b"application/vnd.oasis.opendocument.spreadsheet";
    if file.starts_with(b"PK\x03\x04") && memchr::memmem::find(&file[..file.len().min(HEAD)], SHEET).is_some() {
        return Some(Error::new("this is an OpenDocument spreadsheet (.ods)").help("save the sheet as CSV"));
    }
    if let Some((_, what)) = BINARY.iter().find(|(begin, _)| file.starts_with(begin)) {
        let help = if what.starts_with("compressed") || what.contains("archive") {
            "unpack it, and give the file in it"
        } else {
            "export the measurement as CSV text"
        };
        return Some(Error::new(format!("this is {what}")).help(help));
    }
    let head = bytes::text(&file[..file.len().min(HEAD)]).ok()?;
    let head = head.trim_start();
    let first = head.lines().next().unwrap_or("").trim();
    let begins = |begin: &str| {
        head.get(..begin.len())
            .is_some_and(|head| head.eq_ignore_ascii_case(begin))
    };
    let (what, help) = if begins("OPTIS - ") {
        let words = "a model of Speos or another of its files, and no measured BRDF";
        (
            format!("'{}' is {words}", shown(first)),
            "export .brdf or .anisotropicbsdf",
        )
    } else if begins("<") {
        xml(head)
    } else if is_json(head) {
        json(head)
    } else if begins("file,scan,") && first.contains(",mse2,") {
        result()
    } else if begins("!!") {
        (
            "this looks like a BSDF of RPC Photonics, which is not read".to_string(),
            "export it as CSV with the columns theta_i, theta_s, delta_phi and brdf",
        )
    } else if head.contains("InitAbgScatter") {
        (
            "this is a script of FRED that makes an ABg scatter model, and no measurement".to_string(),
            "give the measurement that it was fitted to",
        )
    } else if head.contains("Name\tWave\tAngle\tA\tB\tg") {
        (
            "this is an ABg scatter profile of OpticStudio, and no measurement".to_string(),
            "give the measurement that it was fitted to",
        )
    } else if begins("analytic") && head.contains("::begin") {
        (
            "this is a model of BRDF Explorer, and no measurement".to_string(),
            "give the measurement that it was fitted to",
        )
    } else {
        return None;
    };
    Some(Error::new(what).help(help))
}

fn xml(head: &str) -> (String, &'static str) {
    if head.contains("WindowElement") || head.contains("Klems") {
        return (
            "this is a BSDF of WINDOW (Klems XML), whose values are means over patches and no samples".to_string(),
            "give the measurement that it was made of",
        );
    }
    let lower = head.to_ascii_lowercase();
    let what = if lower.contains("<!doctype html") || lower.contains("<html") {
        "this is a web page, and not the file that it may link to"
    } else {
        "this is XML of a kind that is not read"
    };
    (what.to_string(), "export the measurement as CSV text")
}

/// JSON and tables that brdfit has made.
fn result() -> (String, &'static str) {
    (
        "this is a result of brdfit, and no measurement".to_string(),
        "give the scan that was fitted, or a whole result of fit or batch to brdfit export, report or certify",
    )
}

/// True of what begins like JSON; `[Header]` and `[deg]` do not.
fn is_json(head: &str) -> bool {
    let inside = |mark: char| head.strip_prefix(mark).map(str::trim_start);
    let begins = |text: &str, marks: &[char]| text.is_empty() || text.starts_with(marks);
    inside('{').is_some_and(|text| begins(text, &['"', '}']))
        || inside('[').is_some_and(|text| {
            begins(text, &['"', '{', '[', ']', '-']) || text.starts_with(|c: char| c.is_ascii_digit())
        })
}

fn json(head: &str) -> (String, &'static str) {
    if head.contains("\"parameters\"") && (head.contains("\"rho_d\"") || head.contains("\"mse2\"")) {
        return result();
    }
    (
        "this is JSON, but neither a BiRD nor an OpenMATERIAL BRDF".to_string(),
        "it needs data with theta_i, phi_i, theta_r, phi_r and BRDF, or brdf with a lookupTable",
    )
}

/// What is wrong with a text that is no table either: no line has two numbers, and the first none but one or two words.
pub fn no_table(text: &str) -> Option<Error> {
    let cells = |line: &str| -> Vec<bool> {
        let cells = line
            .split([',', ';', '\t', '|', ' '])
            .filter(|cell| !cell.trim().is_empty());
        cells.map(|cell| cell.trim().parse::<f64>().is_ok()).collect()
    };
    let first = text.lines().find(|line| !is_remark(line))?;
    let numbers = |line: &str| cells(line).into_iter().filter(|&number| number).count();
    if cells(first).len() > 2 || text.lines().any(|line| numbers(line) > 1) {
        return None;
    }
    Some(
        Error::new(format!(
            "this is text without columns of numbers, and begins with '{}'",
            shown(first.trim())
        ))
        .help("give a table with named columns, or one of the formats of --input-format"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_file_is_called_by_its_name() {
        for (file, what) in [
            (&b"%PDF-1.4\n"[..], "a PDF document"),
            (b"\x89PNG\r\n\x1a\n\0", "a PNG picture"),
            (b"PK\x03\x04\0\0", "a ZIP archive"),
            (
                b"PK\x03\x04mimetypeapplication/vnd.oasis.opendocument.spreadsheetPK",
                "OpenDocument",
            ),
            (
                b"OPTIS - Scattering surface file v1.0\nx\n",
                "'OPTIS - Scattering surface file v1.0' is a model of Speos",
            ),
            (b"<?xml version=\"1.0\"?>\n<WindowElement>\n", "Klems XML"),
            (b"<!DOCTYPE html>\n", "web page"),
            (b"\n <a>\n", "XML of a kind"),
            (b"{\"a\": 1}", "neither a BiRD nor an OpenMATERIAL"),
            (b"[{\"parameters\": {\"rho_d\": 1}}]", "a result of brdfit"),
            (b"file,scan,model,samples,mse2,rho_d\n", "a result of brdfit"),
            (b"!! x\n!! y\n1 2 3\n", "RPC Photonics"),
            (
                b"' x\nSub Main\n    Dim lobe As T_ABGSCATTER\n    InitAbgScatter lobe\n",
                "a script of FRED",
            ),
            (
                b"! x\nName\tWave\tAngle\tA\tB\tg\nX\t0\t0\t1\t1\t0\n",
                "ABg scatter profile of OpticStudio",
            ),
            (b"analytic\n::begin parameters\n", "BRDF Explorer"),
        ] {
            let error = named(file).unwrap();
            assert!(error.what.contains(what) && error.help.is_some(), "{error}");
        }
        for file in [&b"theta_i,theta_s,brdf\n1,2,3\n"[..], b"# remark\n", b"", b"\0\0"] {
            assert!(named(file).is_none(), "{file:?}");
        }
    }

    #[test]
    fn text_without_numbers_is_no_table() {
        assert!(
            no_table("just text\nand more\n")
                .unwrap()
                .what
                .contains("begins with 'just text'")
        );
        assert!(no_table("theta_i,theta_s,brdf\n").is_none() && no_table("x\n1 2 3\n").is_none());
        assert!(no_table("# only a remark\n").is_none());
    }
}
