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
    ("| a law |", "law", "LawKind::Attitude", 0),
    ("| a sensor |", "sensor", "SensorKind::StarTracker", 0),
    ("| a sensor |", "sensor", "SensorKind::Gyro", 0),
    ("| a law |", "law", "LawKind::BDot", 0),
    ("| a sensor |", "sensor", "SensorKind::Magnetometer", 0),
    ("| a sensor |", "sensor", "SensorKind::SunSensor", 0),
    ("| an estimator |", "estimator", "EstimatorKind::RigidRate", 0),
    ("| an estimator |", "estimator", "EstimatorKind::Attitude", 0),
    ("| an actuator about each axis |", "actuator", "ActuatorKind::Hold", 0),
    ("| a law |", "law", "LawKind::PhasePlane", 0),
    ("| a law |", "law", "LawKind::Relay", 0),
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

/// Toys with a state of their own that is logged: file in `tests/own_parts`, and name of its topic.
const TOYS: [(&str, &str); 4] =
    [("law", "/pid"), ("sensor", "/encoder"), ("estimator", "/alpha_beta"), ("actuator", "/servo")];

/// Largest number of files outside the declaration of a topic that name its row: the part, its metric, its journal line,
/// its figure.
const ROW_FILES: usize = 4;

/// Rows that parts with a state report.
const ROWS: [&str; 3] = ["BearingMotion", "ElasticEstimates", "SteeringRecord"];

#[test]
fn a_part_of_ones_own_logs_its_state_from_one_file() {
    let mut engine = Vec::new();
    for part in ENGINE.into_iter().chain(["cli", "figure", "papers", "py"]) {
        sources(Path::new(&format!("{ROOT}/crates/{part}/src")), &mut engine);
    }
    for (file, topic) in TOYS {
        let path = format!("{ROOT}/tests/own_parts/{file}.rs");
        let text = fs::read_to_string(&path).expect("a toy");
        assert!(text.contains(&format!("\"{topic}\"")) && text.contains("fn report("), "{path}");
        let named: Vec<_> =
            engine.iter().filter(|(_, text)| text.contains(&format!("\"{topic}\""))).collect();
        assert!(named.is_empty(), "{topic} is in {}", named[0].0);
    }
}

#[test]
fn a_row_is_named_by_its_part_and_its_readers() {
    let mut all = Vec::new();
    for part in ["control", "scenario", "sim", "analysis", "core", "cli", "py"] {
        sources(Path::new(&format!("{ROOT}/crates/{part}/src")), &mut all);
    }
    for row in ROWS {
        let is_word = |text: &str, at: usize| {
            let is_letter = |c: char| c.is_alphanumeric() || c == '_';
            !text[..at].ends_with(is_letter) && !text[at + row.len()..].starts_with(is_letter)
        };
        let names = |text: &str| text.match_indices(row).any(|(at, _)| is_word(text, at));
        let named: Vec<&str> =
            all.iter().filter(|(_, text)| names(text)).map(|(name, _)| name.as_str()).collect();
        assert!(!named.is_empty() && named.len() <= ROW_FILES, "{row} is named in {named:?}");
        let built = named.iter().filter(|name| name.contains("/control/")).count();
        assert_eq!(built, 1, "{row} is built in {named:?}");
    }
}

/// Quantities of runs with names that mean nothing else.
const QUANTITIES: [&str; 5] =
    ["gimbal_angles", "gimbal_rates", "hinge_angles", "hinge_rates", "wheel_speeds"];

/// File that declares them.
const TABLE: &str = "crates/sim/src/quantities.rs";

#[test]
fn a_quantity_is_declared_in_one_file() {
    let mut all = Vec::new();
    for part in ENGINE.into_iter().chain(["cli", "export-c", "figure", "fmi", "papers", "py"]) {
        sources(Path::new(&format!("{ROOT}/crates/{part}/src")), &mut all);
    }
    for quantity in QUANTITIES {
        let names = |(_, text): &&(String, String)| text.contains(&format!("\"{quantity}\""));
        let named: Vec<&str> = all.iter().filter(names).map(|(name, _)| name.as_str()).collect();
        assert!(named.len() == 1 && TABLE.ends_with(named[0]), "{quantity} is in {named:?}");
    }
}

#[test]
#[cfg(feature = "full")]
fn quantities_of_a_run_are_in_its_packets_and_fmus() {
    use flexsc_core::{Scenario, Simulation};
    use flexsc_cosim::{FmuPart, VariableTable};

    let names = [
        "agile-observer",
        "attitude-hold",
        "earth-observer",
        "panel-deployment",
        "relay-adaptive",
        "wheel-ekf",
    ];
    let dir = crate::util::Dir::with(&names);
    let mut seen = BTreeSet::new();
    for name in names {
        let scenario = Scenario::load(&dir.path(&format!("{name}.toml"))).expect("a scenario");
        let simulation = Simulation::new(&scenario, 0);
        let (observed, layout) =
            (simulation.observation_fields(&scenario), simulation.telemetry_layout(&scenario));
        let table = VariableTable::new(&scenario, &simulation, FmuPart::Plant);
        let packets = dir.run(&format!("serve {name}.toml --describe --period 1")).exits(0).printed();
        for field in observed.iter().chain(&layout.law_inputs) {
            let path = field.path();
            for component in 1..=field.width() {
                let element = field.shape.count().map_or(path.clone(), |_| format!("{path}[{component}]"));
                let variable = table.find(&element).unwrap_or_else(|| panic!("{name}: {element}"));
                assert_eq!(variable.unit, field.unit, "{name}: {element}");
            }
            seen.insert(field.name);
        }
        for field in &layout.law_inputs {
            let parameter = field.path().replace('.', "_");
            let component =
                field.shape.components().first().map_or(String::new(), |first| format!("_{first}"));
            assert!(packets.contains(&format!("\"{parameter}{component}\"")), "{name}: {parameter}");
        }
    }
    assert!(QUANTITIES.iter().all(|quantity| seen.contains(quantity)), "{seen:?}");
}
