//! Files in which a new kind of a role appears, as docs/extending.md lists them, counted in the code for existing
//! kinds.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::rooms::{ENGINE, sources};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// Row of the document, folder of the role, name of a kind in code, and the largest number of files elsewhere that name
/// it.
const KINDS: [(&str, &str, &str, usize); 14] = [
    ("| a law |", "law", "LawKind::Attitude", 1),
    ("| a sensor |", "sensor", "SensorKind::StarTracker", 1),
    ("| a sensor |", "sensor", "SensorKind::Gyro", 1),
    ("| a law |", "law", "LawKind::BDot", 1),
    ("| a sensor |", "sensor", "SensorKind::Magnetometer", 1),
    ("| a sensor |", "sensor", "SensorKind::SunSensor", 1),
    ("| an estimator |", "estimator", "EstimatorKind::RigidRate", 0),
    ("| an estimator |", "estimator", "EstimatorKind::Attitude", 0),
    ("| an actuator about each axis |", "actuator", "ActuatorKind::Hold", 0),
    ("| a law |", "law", "LawKind::PhasePlane", 1),
    ("| a law |", "law", "LawKind::Relay", 1),
    ("| an actuator about all axes together |", "actuator", "ActuatorKind::Jets", 0),
    ("| an actuator about all axes together |", "actuator", "ActuatorKind::Wheels", 0),
    ("| an actuator about all axes together |", "actuator", "ActuatorKind::ControlMomentGyros", 0),
];

/// Returns the path from `src` on for a crate of the engine, and other paths whole.
fn within_the_engine(name: &str) -> &str {
    let part = name.split('/').nth(1).unwrap_or_default();
    if ENGINE.contains(&part) { name.split_once("/src/").map_or(name, |(_, short)| short) } else { name }
}

#[test]
fn a_new_kind_is_named_where_the_document_says_and_nowhere_else() {
    let document = fs::read_to_string(format!("{ROOT}/docs/extending.md")).expect("the document");
    let mut all = Vec::new();
    for part in ENGINE.into_iter().chain(["cli", "figure", "papers", "py"]) {
        sources(Path::new(&format!("{ROOT}/crates/{part}/src")), &mut all);
    }
    assert!(all.len() > 300, "{}", all.len());
    for (row, folder, kind, most) in KINDS {
        let row =
            document.lines().find(|line| line.starts_with(row)).unwrap_or_else(|| panic!("no row {row}"));
        let names = |(_, text): &&(String, String)| {
            // `LawKind::Attitude` is not `LawKind::AttitudeX`.
            text.match_indices(kind).any(|(at, _)| {
                !text[at + kind.len()..].starts_with(|next: char| next.is_alphanumeric() || next == '_')
            })
        };
        let own = format!("{folder}/");
        let elsewhere: BTreeSet<&str> = all
            .iter()
            .filter(names)
            .map(|(name, _)| within_the_engine(name))
            .filter(|name| !name.starts_with(&own))
            .collect();
        for name in &elsewhere {
            assert!(row.contains(&format!("`{name}`")), "{kind} is in {name}, of which its row says nothing");
        }
        assert!(elsewhere.len() <= most, "{kind} is named in {} files: {elsewhere:?}", elsewhere.len());
        let variant = kind.split("::").nth(1).unwrap_or_default();
        let is_own = |(name, text): &(String, String)| {
            within_the_engine(name).starts_with(&own) && text.contains(&format!("Self::{variant}("))
        };
        assert!(all.iter().any(is_own), "{kind} is named nowhere in {own}: a wrong name?");
    }
}
