//! Files in which a new kind of a part appears, as docs/extending.md says, counted in the code for existing kinds.

#[cfg(feature = "full")]
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::rooms::{ENGINE, sources};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// Kind of a part: the enum of its role, its variant, the type of its settings, its key, and the files that name it beside its
/// own file and the list of kinds.
type Kind = (&'static str, &'static str, &'static str, &'static str, &'static [&'static str]);

/// Kinds whose names mean nothing else. The number in a comment is that of files, beside their own, that named the kind before
/// roles had a list of kinds and a trait of settings; in 408934b1 two sensors and the blinding of one touched 36 Rust files of
/// the crates.
const KINDS: [Kind; 14] = [
    // 6
    ("SensorKind", "Magnetometer", "Magnetometer", "magnetometer", &[]),
    // 6
    ("SensorKind", "SunCells", "SunCells", "sun_cells", &[]),
    // 6
    ("SensorKind", "EarthSensor", "EarthSensor", "earth_sensor", &[]),
    // 9; its exposures and its exclusion angles, and abbreviations of keys.
    (
        "SensorKind",
        "StarTracker",
        "StarTracker",
        "star_tracker",
        &["sensor/exclusion.rs", "sensor/exposure.rs", "formats/src/document/suggestions.rs"],
    ),
    // 10; the wheels whose drives read it.
    (
        "SensorKind",
        "Tachometer",
        "Tachometer",
        "tachometer",
        &["sensor/sensor_list.rs", "actuator/placement.rs", "actuator/wheels_state.rs", "requirement.rs"],
    ),
    // 9
    (
        "SensorKind",
        "Accelerometer",
        "Accelerometer",
        "accelerometer",
        &["sensor/sensor_list.rs", "requirement.rs", "scenario/src/small_angle_checks.rs"],
    ),
    // 6
    (
        "EstimatorKind",
        "UnscentedKalman",
        "UnscentedKalman",
        "unscented_kalman",
        &["formats/src/document/suggestions.rs"],
    ),
    // 2, and its settings were in the file of the list.
    ("EstimatorKind", "Truth", "IdealObserver", "truth", &["estimator/requirements.rs"]),
    // 6
    (
        "EstimatorKind",
        "Adaptive",
        "Adaptive",
        "adaptive",
        &["estimator/adaptive/mod.rs", "estimator/adaptive/design.rs", "estimator/requirements.rs"],
    ),
    // 4
    ("ActuatorKind", "Hold", "ZeroOrderHold", "hold", &[]),
    // 11; what can unload wheels, has a limit of its own, flies and has a figure.
    (
        "ActuatorKind",
        "Magnetorquers",
        "Magnetorquers",
        "magnetorquers",
        &[
            "actuator/allocation_role.rs",
            "actuator/limits.rs",
            "actuator/unloading.rs",
            "cli/src/plot/magnetorquers.rs",
            "export-c/src/control_system/actuation.rs",
            "export-c/src/control_system/excluded_parts.rs",
            "export-c/src/flight_sources.rs",
            "formats/src/document/suggestions.rs",
            "scenario/src/actuator_checks.rs",
        ],
    ),
    // 10
    (
        "ActuatorKind",
        "ControlMomentGyros",
        "ControlMomentGyros",
        "control_moment_gyros",
        &[
            "actuator/actuator_set.rs",
            "actuator/allocation_role.rs",
            "actuator/capabilities.rs",
            "actuator/control_moment_gyros_state.rs",
            "export-c/src/control_system/excluded_parts.rs",
            "formats/src/document/suggestions.rs",
            "scenario/src/mode_checks.rs",
        ],
    ),
    // 7; flight code and its export.
    (
        "LawKind",
        "BDot",
        "BDot",
        "b_dot",
        &[
            "law/stages.rs",
            "export-c/src/control_system/actuation.rs",
            "export-c/src/control_system/b_dot.rs",
            "export-c/src/control_system/excluded_parts.rs",
            "export-c/src/control_system/mod.rs",
            "export-c/src/control_system/mode_laws.rs",
            "export-c/src/flight_sources.rs",
            "scenario/src/remarks.rs",
        ],
    ),
    ("AdaptationKind", "RandomSearch", "RandomSearch", "random_search", &[]),
];

/// Returns the code of a file without comments and unit tests.
fn code(text: &str) -> String {
    let code = text.rsplit_once("#[cfg(test)]\nmod tests {").map_or(text, |(code, _)| code);
    code.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

/// Returns true if a text contains a name that is not part of a longer one.
fn contains_name(text: &str, name: &str) -> bool {
    let is_letter = |c: char| c.is_alphanumeric() || c == '_';
    let is_whole =
        |at: usize| !text[..at].ends_with(is_letter) && !text[at + name.len()..].starts_with(is_letter);
    text.match_indices(name).any(|(at, _)| is_whole(at))
}

#[test]
fn a_kind_is_named_in_its_file_and_in_the_list_of_kinds() {
    let mut all = Vec::new();
    for part in fs::read_dir(format!("{ROOT}/crates")).expect("the crates").flatten() {
        let folder = part.path().join("src");
        if folder.is_dir() {
            sources(&folder, &mut all);
        }
    }
    assert!(all.len() > 1000, "{}", all.len());
    all.retain(|(name, _)| !name.ends_with("tests.rs"));
    for (_, text) in &mut all {
        *text = code(text);
    }
    for (role, variant, settings, key, others) in KINDS {
        let folder = format!("crates/control/src/{}/", role.trim_end_matches("Kind").to_lowercase());
        let names = |(name, text): &&(String, String)| {
            let has = |own: &str| contains_name(text, own);
            name.starts_with(&folder) && has(&format!("Self::{variant}"))
                || name.starts_with("crates/control/") && has(settings)
                || has(&format!("{role}::{variant}"))
                || text.contains(&format!("\"{key}\""))
        };
        let declares = |text: &str| {
            ["struct", "type"].iter().any(|of| contains_name(text, &format!("pub {of} {settings}")))
        };
        let list = format!("{folder}mod.rs");
        let (listed, elsewhere): (Vec<&str>, Vec<&str>) = all
            .iter()
            .filter(|(_, text)| !declares(text))
            .filter(names)
            .map(|(name, _)| name.as_str())
            .partition(|name| *name == list);
        assert_eq!(listed.len(), 1, "{settings} is not in {list}: a wrong name?");
        let new =
            elsewhere.iter().find(|name| !others.iter().any(|other| name.ends_with(&format!("/{other}"))));
        assert!(new.is_none(), "{settings} is named in {elsewhere:?}");
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
