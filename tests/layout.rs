//! Viewer layouts: every path of every panel is a topic and a field of a log.

use std::collections::BTreeSet;

use flexsc_core::record::{Column, Columns, Log};
use serde_json::Value;

use crate::util::Dir;

/// The paths that a layout's panels show.
fn paths(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(object) => {
            for (key, value) in object {
                match value {
                    Value::String(text) if key == "value" || key == "topicPath" => {
                        found.insert(text.clone());
                    }
                    _ => paths(value, found),
                }
            }
        }
        Value::Array(array) => array.iter().for_each(|value| paths(value, found)),
        _ => {}
    }
}

/// Whether columns have a field such as `modes[0].displacement_rad`.
fn has(columns: &Columns, field: &str) -> bool {
    match field.split_once('[') {
        None => columns.get(field).is_some(),
        Some((rows, rest)) => {
            let Some((_, inner)) = rest.split_once("].") else { return false };
            matches!(columns.get(rows), Some(Column::Rows(_, columns)) if has(columns, inner))
        }
    }
}

/// Every path of a layout must be a field of the log of a run.
fn check(scenario: &str, options: &str, layout: &str) {
    let dir = Dir::with(&[scenario]);
    dir.run(&format!("simulate {scenario}.toml --log full {options}")).exits(0);
    let log = Log::open(&dir.path(&format!("{scenario}.mcap"))).expect("a log");

    let mut found = BTreeSet::new();
    paths(&serde_json::from_str(layout).expect("JSON"), &mut found);
    assert!(found.len() > 10, "{found:?}");
    for path in found {
        let (topic, field) = path.split_once('.').unwrap_or((&path, ""));
        let columns = log.columns(topic).unwrap_or_else(|error| panic!("{path}: {error}"));
        assert!(field.is_empty() || has(&columns, field), "{path}: no such field");
    }
}

#[test]
fn every_path_is_a_field_of_a_log() {
    check("relay-adaptive", "--set duration=1200", include_str!("../scenarios/layouts/relay.json"));
    check("iss-manoeuvre", "--set duration=20", include_str!("../scenarios/layouts/spatial.json"));
    check("rotation-robust", "--set duration=20", include_str!("../scenarios/layouts/rotation.json"));
    let rotor = "--set actuator.wheel.rotor={inertia=1e-4}";
    check(
        "wheel-ekf",
        &format!("--set duration=20 {rotor}"),
        include_str!("../scenarios/layouts/wheel.json"),
    );
    check("rotation-nonlinear", "--set duration=13", include_str!("../scenarios/layouts/rotation.json"));
}

#[test]
fn a_log_holds_the_layout_of_its_kind() {
    let dir = Dir::with(&["wheel-ekf", "wheel-fast-mode", "rotation-sine", "relay-fixed"]);
    let layouts = [
        ("wheel-ekf", include_str!("../scenarios/layouts/wheel.json")),
        ("wheel-fast-mode", include_str!("../scenarios/layouts/wheel.json")),
        ("rotation-sine", include_str!("../scenarios/layouts/rotation.json")),
        ("relay-fixed", include_str!("../scenarios/layouts/relay.json")),
    ];
    for (name, layout) in layouts {
        dir.run(&format!("simulate {name}.toml --set duration=1")).exits(0);
        let bytes = dir.read(&format!("{name}.mcap"));
        let summary = mcap::Summary::read(&bytes).expect("whole").expect("a summary");
        let held = summary.attachment_indexes.iter().any(|index| {
            mcap::read::attachment(&bytes, index).expect("whole").data.as_ref() == layout.as_bytes()
        });
        assert!(held, "{name}");
    }
}
