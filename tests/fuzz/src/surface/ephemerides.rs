//! Ephemerides: tables of positions and messages of the CCSDS, with other lines, numbers or bytes.

use std::fmt::Write as _;

use super::structures;
use crate::chance::Chance;

/// Mean motion of the orbit (rad/s), and its radius (m).
const RATE: f64 = 0.0011;
const RADIUS: f64 = 6.878e6;
/// Numbers of rows, eight of which are needed.
const ROWS: [usize; 5] = [7, 8, 9, 12, 40];

/// Returns the name and the bytes of a file.
pub fn file(chance: &mut Chance) -> (&'static str, Vec<u8>) {
    let (name, text) = if chance.percent(50) { ("o.csv", table(chance)) } else { ("o.oem", message(chance)) };
    (name, if chance.percent(20) { text.into_bytes() } else { structures::spoilt(&text, chance) })
}

/// Returns the angle (rad) and the size (m) of a row, most often those of a circular orbit.
fn radius(chance: &mut Chance) -> f64 {
    if chance.percent(85) {
        RADIUS
    } else {
        [1.0, 6e6, 6.3782e6, 4.2e7, 1e15, 1e-300, 1e300][chance.below(7)]
    }
}

fn table(chance: &mut Chance) -> String {
    let radius = radius(chance);
    let (step, start) = if chance.percent(85) {
        (60.0, -60.0)
    } else {
        ([1e-9, 1e-3, 1e6, 1e14, 5e-324][chance.below(5)], [0.0, -1e5, 1e15][chance.below(3)])
    };
    let mut text = chance.one(&["", "t,x,y,z\n", "# a comment\nt,x,y,z,vx\n"]).to_owned();
    for row in 0..ROWS[chance.below(ROWS.len())] {
        let angle = RATE * 60.0 * row as f64;
        let (x, y, z) = (radius * angle.cos(), radius * angle.sin(), 0.1 * radius);
        let _ = writeln!(text, "{:e},{x:e},{y:e},{z:e}", start + step * row as f64);
    }
    text
}

fn message(chance: &mut Chance) -> String {
    let frame = chance.one(&["TOD", "EME2000", "TEME", "ICRF", "GCRF", "ITRF"]);
    let mut text = format!(
        "CCSDS_OEM_VERS = 2.0\nCREATION_DATE = 2026-11-24T00:00:00\nORIGINATOR = TEST\n\nMETA_START\nOBJECT_NAME = A\n\
         OBJECT_ID = 2026-001A\nCENTER_NAME = EARTH\nREF_FRAME = {frame}\nTIME_SYSTEM = UTC\n\
         START_TIME = 2026-11-24T00:00:00\nSTOP_TIME = 2026-11-24T00:39:00\nMETA_STOP\n"
    );
    let radius = radius(chance) / 1e3;
    let spacing = [1, 1, 1, 10, 40][chance.below(5)];
    for row in 0..ROWS[chance.below(ROWS.len())] {
        let angle = RATE * 60.0 * (row * spacing) as f64;
        let (x, y) = (radius * angle.cos(), radius * angle.sin());
        let speed = if chance.percent(95) { 1.0 } else { [0.0, 1e3, -1.0][chance.below(3)] } * RATE * radius;
        let (vx, vy) = (-speed * angle.sin(), speed * angle.cos());
        let state = format!(" {x:.6} {y:.6} {:.6} {vx:.6} {vy:.6} 0\n", 0.1 * radius);
        let minute = row * spacing;
        let date = format!("2026-11-24T{:02}:{:02}:00.5", minute / 60 % 24, minute % 60);
        let row = format!("{date}{state}");
        text += &row;
        if chance.percent(3) {
            text += &row;
        }
        if chance.percent(3) {
            let place = |word: &str| text.find(word).unwrap_or(0);
            let metadata = text[place("META_START")..place("META_STOP")].to_owned();
            text += &[&metadata, "META_STOP\n", &row].concat();
        }
    }
    if chance.percent(15) {
        text += "COVARIANCE_START\nEPOCH = 2026-11-24T00:00:00\n1 2 3\nCOVARIANCE_STOP\n";
    }
    text
}
