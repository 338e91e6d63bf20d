//! Environment of a spacecraft: orbits by elements, ephemerides, fields and densities in files, and the targets that follow them.

use std::fmt::Write as _;

use super::{coefficients, element_sets, ephemerides, structures};
use crate::case::Case;
use crate::chance::Chance;
use crate::nasty;

const CRAFT: &str = "[spacecraft]\nmass = 600.0\ninertia = [[250, 0, 0], [0, 300, 0], [0, 0, 220]]\npoints = [{ name = \"bus\" }]\n";
const LAW: &str = "[law.pd]\nk_p = 1.0\nk_d = 20.0\nperiod = 0.5\n";
const DENSITIES: &str = "height,density\n1e5,5.6e-7\n2e5,2.5e-10\n3e5,1.9e-11\n4e5,2.8e-12\n5e5,5.2e-13\n6e5,1.1e-13\n\
    8e5,1.1e-14\n1e6,3.5e-15\n";
const PLATES: &str = "plates = [{ area = 4.0, normal = [1, 0, 0], at = [1.0, 0, 0] }]";
const COMMANDS: &[&str] =
    &["check s.toml", "check s.toml", "check s.toml", "simulate s.toml --log none", "simulate s.toml -o out"];
/// Dates at and beyond the limits of dates, fields and calendars.
const EPOCHS: &[&str] = &[
    "1970-01-01T00:00:00Z",
    "2499-12-31T23:59:59.999999999Z",
    "2500-01-01T00:00:00Z",
    "2016-12-31T23:59:60Z",
    "2024-02-29T12:00:00Z",
    "2023-02-29T12:00:00Z",
    "0001-01-01T00:00:00Z",
    "9999-12-31T23:59:59Z",
    "2029-12-31T23:59:59Z",
    "2025-01-01T00:00:00+23:59",
    "\"2026-11-24T00:00:00Z\"",
];
/// Directions of targets, right and odd.
const DIRECTIONS: &[&str] = &[
    "\"nadir\"",
    "\"velocity\"",
    "\"orbit_normal\"",
    "\"sun\"",
    "\"field\"",
    "{ orbit = [0, 0, 1] }",
    "{ inertial = [1, 0, 0] }",
    "{ inertial = [1e300, 1e300, 0] }",
    "{ inertial = [5e-324, 0, 0] }",
    "{ site = { latitude = 0.79, longitude = 0.3 } }",
    "{ site = { latitude = 1.5707963267948966, longitude = -7, height = -6.4e6 } }",
    "{ site = { latitude = -0.5, longitude = 1e300, height = 1e300 } }",
];
const AXES: &[&str] =
    &["[0, 0, 1]", "[0, 1, 0]", "[1, 0, 0]", "[0, 0, -1]", "[1e-200, 0, 0]", "[0, 1e-9, 1]"];

/// Part of an input that is changed.
#[derive(Copy, Clone, PartialEq)]
enum Focus {
    ElementSet,
    Ephemeris,
    Field,
    Density,
    Elements,
    Epoch,
    Target,
}

const FOCUSES: [Focus; 7] = [
    Focus::ElementSet,
    Focus::Ephemeris,
    Focus::Field,
    Focus::Density,
    Focus::Elements,
    Focus::Epoch,
    Focus::Target,
];

pub fn make(chance: &mut Chance) -> Case {
    let focus = FOCUSES[chance.below(FOCUSES.len())];
    let is_spoilt = |part: Focus| part == focus;
    let mut files = Vec::new();
    let mut environment = "sun = \"epoch\"\n".to_owned();
    let mut epoch = "2026-11-24T00:00:00Z";
    match focus {
        Focus::ElementSet => {
            let (text, file) = element_sets::given(chance);
            let _ = writeln!(environment, "orbit = {{ tle = {text} }}");
            files.extend(file);
            epoch = "";
        }
        Focus::Ephemeris => {
            let (name, bytes) = ephemerides::file(chance);
            let _ = writeln!(environment, "orbit = {{ ephemeris = \"{name}\" }}");
            files.push((name.to_owned(), bytes));
        }
        _ => {
            let _ = writeln!(environment, "orbit = {}", elements(is_spoilt(Focus::Elements), chance));
        }
    }
    if focus == Focus::Field {
        let (name, bytes) = coefficients::file(chance);
        let more =
            chance.one(&["", "", ", degree = 2", ", degree = 13", ", radius = 1e-3", ", model = \"table\""]);
        let _ = writeln!(environment, "magnetic_field = {{ table = \"{name}\"{more} }}");
        environment += "dipole = { moment = [1, 1, 1] }\n";
        files.push((name.to_owned(), bytes));
    } else if chance.percent(40) {
        environment += "magnetic_field = {}\n";
    }
    drag(is_spoilt(Focus::Density), &mut environment, &mut files, chance);
    if chance.percent(40) {
        environment += "gravity_gradient = {}\n";
    }
    if is_spoilt(Focus::Epoch) {
        epoch = chance.one(EPOCHS);
    }
    let duration = chance.one(&["2.0", "20.0", "20.0", "300.0"]);
    let epoch = if epoch.is_empty() { String::new() } else { format!("epoch = {epoch}") };
    let target = target(is_spoilt(Focus::Target), chance);
    let text = format!("duration = {duration}\n{epoch}\n{CRAFT}[environment]\n{environment}{LAW}{target}");
    files.push(("s.toml".to_owned(), text.into_bytes()));
    Case::new(chance.one(COMMANDS), files)
}

/// Kepler elements; one or two of them are odd.
fn elements(is_spoilt: bool, chance: &mut Chance) -> String {
    let mut keys = [
        ("semi_major_axis", "6.878e6"),
        ("eccentricity", "0.001"),
        ("inclination", "1.7"),
        ("node", "0.4"),
        ("perigee", "1"),
        ("anomaly", "3.141592653589793"),
        ("planet_radius", "6.378137e6"),
        ("gravity", "3.986004418e14"),
    ];
    if is_spoilt {
        for _ in 0..=chance.below(2) {
            keys[chance.below(keys.len())].1 = nasty::number(chance);
        }
    }
    let written = keys.map(|(key, value)| format!("{key} = {value}")).join(", ");
    let drifts = if chance.percent(30) { ", j2 = true" } else { "" };
    format!("{{ {written}{drifts} }}")
}

/// Drag by one of the models; that of a table has a file.
fn drag(is_spoilt: bool, environment: &mut String, files: &mut Vec<(String, Vec<u8>)>, chance: &mut Chance) {
    let scale = if is_spoilt && chance.percent(20) { nasty::number(chance) } else { "1" };
    let model = match chance.below(4) {
        _ if is_spoilt => {
            files.push(("d.csv".to_owned(), structures::spoilt(DENSITIES, chance)));
            "model = \"table\", table = \"d.csv\""
        }
        0 => "model = \"harris_priester\"",
        1 => "density = 1e-12, altitude = 5e5, scale_height = 6e4",
        _ => return,
    };
    let _ = writeln!(environment, "drag = {{ {model}, scale = {scale}, {PLATES} }}");
}

fn target(is_spoilt: bool, chance: &mut Chance) -> String {
    if !is_spoilt && chance.percent(50) {
        return String::new();
    }
    let mut text = "[[target]]\nfrom = 0\n".to_owned();
    for (role, axis, along) in
        [("primary", "[0, 0, 1]", "\"nadir\""), ("secondary", "[1, 0, 0]", "\"velocity\"")]
    {
        let spoils = is_spoilt && chance.percent(50);
        let axis = if spoils { chance.one(AXES) } else { axis };
        let along = if spoils { chance.one(DIRECTIONS) } else { along };
        let _ = writeln!(text, "{role} = {{ body = {axis}, along = {along} }}");
    }
    if is_spoilt && chance.percent(30) {
        let _ = writeln!(text, "acceleration = {}", nasty::number(chance));
    }
    text
}
