//! Two-line element sets: each field at and beyond its limits, and lines that are none.

use super::structures;
use crate::chance::Chance;
use crate::mutate;

/// Sets of a geosynchronous, a low and a half-day orbit.
const SETS: [[&str; 2]; 3] = [
    [
        "1 08195U 75081A   06176.33215444  .00000099  00000-0  11873-3 0   813",
        "2 08195  64.1586 279.0717 6877146 264.7651  20.2257  2.00491383225656",
    ],
    [
        "1 28057U 03049A   06177.78615833  .00000060  00000-0  35940-4 0  1836",
        "2 28057  98.4283 247.6961 0000884  88.1964 271.9322 14.35478080140550",
    ],
    [
        "1 25544U 98067A   24001.50000000  .00016717  00000-0  30000-3 0  9990",
        "2 25544  51.6400 208.9163 0006703 130.5360 325.0288 15.49815348000018",
    ],
];
/// Fields: the line, the first column from 0, and values.
const FIELDS: &[(usize, usize, &[&str])] = &[
    (
        0,
        18,
        &[
            "57001.00000000",
            "56366.99999999",
            "00366.99999999",
            "24000.00000000",
            "-1001.00000000",
            "24001.5       ",
        ],
    ),
    (0, 33, &["-.99999999", " .99999999"]),
    (0, 44, &[" 99999+9", " 99999-0", "-99999+9"]),
    (0, 53, &[" 99999-0", " 99999+9", "-99999+9", " 00000-0", " 99999-9", " 12345+1"]),
    (1, 8, &["180.0000", "000.0000", "063.4349", "-90.0000", "999.9999", "  0.0001"]),
    (1, 17, &["360.0000", "000.0000", "-10.0000", "999.9999"]),
    (1, 26, &["0000000", "9999999", "9990000", "0000001", "7000000", "       ", "-000001"]),
    (1, 34, &["360.0000", "000.0000", "270.0000", "-10.0000"]),
    (1, 43, &["360.0000", "180.0000", "-10.0000"]),
    (
        1,
        52,
        &[
            " 0.00000000",
            " 0.05000000",
            " 1.00273791",
            " 2.00000000",
            " 6.39999999",
            " 6.40000001",
            "16.40000000",
            "17.99999999",
            "18.00000000",
            "99.99999999",
            "-1.00000000",
            "        nan",
        ],
    ),
];
const MESSAGE: &str = "CCSDS_OMM_VERS = 2.0\nOBJECT_NAME = A\nCENTER_NAME = EARTH\nREF_FRAME = TEME\nTIME_SYSTEM = UTC\n\
    MEAN_ELEMENT_THEORY = SGP4\nEPOCH = 2026-11-24T06:00:00\nMEAN_MOTION = 15.5\nECCENTRICITY = .0005\nINCLINATION = 51.6\n\
    RA_OF_ASC_NODE = 10\nARG_OF_PERICENTER = 20\nMEAN_ANOMALY = 30\nBSTAR = .1E-3\n";
const JSON: &str = "{\"EPOCH\": \"2026-11-24T06:00:00\", \"MEAN_MOTION\": 15.5, \"ECCENTRICITY\": 5e-4, \"INCLINATION\": 51.6, \
    \"RA_OF_ASC_NODE\": 10.0, \"ARG_OF_PERICENTER\": 20.0, \"MEAN_ANOMALY\": 30.0, \"BSTAR\": 1e-4}";
/// Column of the checksum.
const CHECKSUM: usize = 68;

/// Returns the lines of a set.
fn lines(chance: &mut Chance) -> Vec<String> {
    let mut lines: Vec<Vec<u8>> = SETS[chance.below(SETS.len())].map(|line| line.as_bytes().to_vec()).into();
    for _ in 0..chance.below(4) {
        let (line, column, values) = FIELDS[chance.below(FIELDS.len())];
        let value = chance.one(values);
        lines[line][column..column + value.len()].copy_from_slice(value.as_bytes());
    }
    if chance.percent(15) {
        let (line, column) = (chance.below(2), chance.below(CHECKSUM));
        lines[line][column] = b"0123456789 -+.A"[chance.below(15)];
    }
    if chance.percent(85) {
        for line in &mut lines {
            seal(line);
        }
    }
    match chance.below(25) {
        0 => lines.swap(0, 1),
        1 => lines.truncate(1),
        2 => lines.extend(lines.clone()),
        3 => lines.insert(0, b"ISS (ZARYA)".to_vec()),
        4 => lines.clear(),
        5 => mutate::bytes(&mut lines[0], chance),
        6 => lines[1].truncate(chance.below(CHECKSUM)),
        _ => {}
    }
    lines.iter().map(|line| String::from_utf8_lossy(line).into_owned()).collect()
}

/// Returns a set as a scenario gives it: its value, and a file if it is in one.
pub fn given(chance: &mut Chance) -> (String, Option<(String, Vec<u8>)>) {
    let quoted = |text: &str| serde_json::to_string(text).unwrap_or_default();
    if chance.percent(20) {
        let text = if chance.percent(50) { MESSAGE.to_owned() } else { JSON.to_owned() };
        return (quoted("a.omm"), Some(("a.omm".to_owned(), structures::spoilt(&text, chance))));
    }
    let lines = lines(chance);
    let mut text = lines.join("\n") + "\n";
    match chance.below(6) {
        0 => (quoted(&text), None),
        1 => {
            structures::rewrite(&mut text, chance);
            (quoted("a.tle"), Some(("a.tle".to_owned(), text.into_bytes())))
        }
        2 => (JSON.replace("\":", "\" ="), None),
        _ => (serde_json::to_string(&lines).unwrap_or_default(), None),
    }
}

/// Gives a line the checksum of its digits, where a minus counts 1.
fn seal(line: &mut [u8]) {
    let digit = |byte: &u8| if *byte == b'-' { 1 } else { char::from(*byte).to_digit(10).unwrap_or(0) };
    let sum: u32 = line[..CHECKSUM].iter().map(digit).sum();
    line[CHECKSUM] = b'0' + (sum % 10) as u8;
}
