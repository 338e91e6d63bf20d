//! Files that a scenario names, and the formats by which a refusal names one that its reader does not take.

use std::io::Read;
use std::path::Path;

use crate::text_file::open_text_up_to;

/// Number of bytes from which a format is recognised.
const START: u64 = 4096;

/// Messages of the CCSDS: abbreviation, and the key of a scenario that takes one, if any.
const MESSAGES: [(&str, Option<&str>); 9] = [
    ("OEM", Some("`orbit.ephemeris`, in keyword-value notation")),
    ("OMM", Some("`orbit.tle`")),
    ("OPM", None),
    ("OCM", None),
    ("AEM", None),
    ("APM", None),
    ("ACM", None),
    ("TDM", None),
    ("CDM", None),
];

/// Beginnings of files that are no text, and their formats.
const BINARY: [(&[u8], &str); 6] = [
    (b"PK\x03\x04", "a zip archive"),
    (b"\x1f\x8b", "a gzip archive: unpack it"),
    (b"\x89HDF", "an HDF5 file"),
    (b"MATLAB 5.0", "a file of MATLAB"),
    (b"%PDF", "a PDF"),
    (b"CDF\x01", "a NetCDF file"),
];

/// Reads a file by `read`, which takes the formats that `reads` describes; `own` are those of them that have names here, such as
/// `an OEM`.
///
/// # Errors
/// The path, with the error in the file, or with the format of a file that is none of those.
pub fn read_file<T>(
    path: &Path,
    own: &[&str],
    reads: &str,
    read: impl FnOnce(&Path) -> Result<T, String>,
) -> Result<T, String> {
    read(path).map_err(|why| {
        let why = foreign_format(&beginning(path), own).map_or(why, |(name, taken)| {
            let taken = taken.map(|key| format!("; it is given as {key}")).unwrap_or_default();
            format!("this is {name}, and flexsc reads {reads} here{taken}")
        });
        format!("cannot be used: {}: {why}", path.display())
    })
}

/// Returns what to do with a file of modes of another program, by its extension.
pub fn instead(path: &Path) -> Option<&'static str> {
    Some(match path.extension()?.to_ascii_lowercase().to_str()? {
        "op2" | "pch" | "bdf" | "nas" => {
            "`flexsc.appendage_from_nastran` in Python reads .op2 and .pch files with their bulk data"
        }
        "op4" | "mat" | "mtx" | "npz" => {
            "`flexsc.appendage_from_matrices` in Python takes mass and stiffness matrices, `flexsc.appendage_from_craig_bampton` \
             reduced ones"
        }
        "inp" => "CalculiX writes its results to the .frd and the .dat beside the deck",
        "odb" | "fil" | "rst" | "unv" | "h5" | "xdb" => {
            "export the mass and stiffness matrices for `flexsc.appendage_from_matrices`, or the modes as a .csv"
        }
        _ => return None,
    })
}

/// Returns the first bytes of a file; none of a file that cannot be read.
fn beginning(path: &Path) -> Vec<u8> {
    let mut start = Vec::new();
    if let Ok(text) = open_text_up_to(path, u64::MAX) {
        // What was read before an error has the format as well.
        drop(text.take(START).read_to_end(&mut start));
    }
    start
}

/// Returns the format of a file by its first bytes, and the key that takes it, if any, unless it is one of a reader's `own`.
fn foreign_format(start: &[u8], own: &[&str]) -> Option<(String, Option<&'static str>)> {
    format(start).filter(|(name, _)| !own.contains(&name.as_str()))
}

/// Returns the format of a file by its first bytes, and the key that takes it, if any.
fn format(start: &[u8]) -> Option<(String, Option<&'static str>)> {
    let plain = |name: &str| Some((name.to_owned(), None));
    if let Some((_, name)) = BINARY.iter().find(|(beginning, _)| start.starts_with(beginning)) {
        return plain(name);
    }
    if start.contains(&0) {
        return plain("a binary file");
    }
    let text = String::from_utf8_lossy(start);
    let text = text.trim_start();
    let message = |is: &dyn Fn(&str) -> bool, notation: &str| {
        let (name, key) = MESSAGES.iter().find(|(name, _)| is(name))?;
        Some((format!("an {name}{notation}").replace("an T", "a T").replace("an C", "a C"), *key))
    };
    let lower = text.to_ascii_lowercase();
    if text.starts_with('<') {
        if lower.starts_with("<!doctype html") || lower.starts_with("<html") {
            return plain("a web page: did the download fail?");
        }
        let is = |name: &str| {
            lower.contains(&format!("<{}", name.to_ascii_lowercase()))
                || lower.contains(&format!(":{}", name.to_ascii_lowercase()))
        };
        return message(&is, " in XML").or_else(|| plain("a file in XML"));
    }
    if text.starts_with(['{', '[']) && text.contains('"') {
        return message(&|name| name == "OMM" && text.contains("\"MEAN_MOTION\""), " in JSON")
            .or_else(|| plain("a file in JSON"));
    }
    let begins = |line: &str, number: &str| line.len() >= 60 && line.starts_with(number);
    if text.starts_with("CCSDS_") {
        return message(&|name| text[6..].starts_with(name), "");
    }
    let mut lines = text.lines();
    let second = text.lines().nth(1).unwrap_or_default();
    if lines.clone().take(2).any(|line| begins(line, "1 "))
        && lines.clone().take(3).any(|line| begins(line, "2 "))
    {
        return Some(("a two-line element set".to_owned(), Some("`orbit.tle`")));
    }
    let first = lines.next().unwrap_or_default();
    let is_sp3 = first.starts_with('#')
        && first[1..].starts_with(['a', 'b', 'c', 'd'])
        && first.get(2..3).is_some_and(|kind| kind == "P" || kind == "V")
        && second.starts_with("##");
    if is_sp3 {
        return plain("an SP3 ephemeris: convert it to an OEM");
    }
    if lower.starts_with("stk.v") {
        return plain("a file of STK: export an OEM from there");
    }
    if lower.starts_with("%%matrixmarket") {
        return Some(("a matrix of MatrixMarket".to_owned(), Some("a matrix of mass, stiffness or damping")));
    }
    None
}

#[cfg(test)]
mod tests {
    use super::foreign_format;

    #[test]
    fn files_are_named_by_their_format() {
        let named = |text: &str| foreign_format(text.as_bytes(), &["an OEM"]).map(|(name, _)| name);
        for (text, expected) in [
            ("<?xml version=\"1.0\"?>\n<oem id=\"CCSDS_OEM_VERS\"/>", "an OEM in XML"),
            ("<?xml version=\"1.0\"?>\n<ndm:omm>", "an OMM in XML"),
            ("<!DOCTYPE html>\n<html>", "a web page: did the download fail?"),
            ("<kml>", "a file in XML"),
            ("CCSDS_TDM_VERS = 1.0", "a TDM"),
            ("CCSDS_OCM_VERS = 3.0", "an OCM"),
            ("[{\"OBJECT_NAME\":\"A\",\"MEAN_MOTION\":15.5}]", "an OMM in JSON"),
            (
                "#cP2020  6 24  0  0  0.00000000      96 ORBIT\n## 2111",
                "an SP3 ephemeris: convert it to an OEM",
            ),
            ("stk.v.11.0\nBEGIN Ephemeris", "a file of STK: export an OEM from there"),
            ("PK\u{3}\u{4}", "a zip archive"),
            ("a\0b", "a binary file"),
        ] {
            assert_eq!(named(text).as_deref(), Some(expected), "{text}");
        }
        let set = "A\n1 25544U 98067A   26332.50000000  .00016717  00000-0  10270-3 0  9008\n\
                   2 25544  51.6400 208.9163 0006317  69.9862  25.2906 15.54225995    16";
        assert_eq!(named(set).as_deref(), Some("a two-line element set"));
        for own in ["", "t,x,y,z\n1,2,3,4", "CCSDS_OEM_VERS = 2.0", "# comment\n1,2"] {
            assert_eq!(named(own), None, "{own}");
        }
    }
}
