//! One model for every way of writing a body, which scenarios with the same body have in common.

use std::path::Path;
use std::sync::Arc;

use flexsc_core::spacecraft::body::{BodyAxes, BodyModel};
use flexsc_core::{Document, Scenario};

const SCENARIOS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios");
const MATRICES: &str = "duration = 1.0\n[law.open]\n[body.matrices]\nmass = [[3.0, 1.0], [1.0, 1.0]]\n\
                        stiffness = [[0.0, 0.0], [0.0, 2.0]]";

fn shipped(name: &str) -> Scenario {
    Scenario::load(Path::new(&format!("{SCENARIOS}/{name}.toml"))).expect("a scenario")
}

fn kind(model: &BodyModel) -> &'static str {
    match model {
        BodyModel::OneAxis(_) => "planar",
        BodyModel::Chain(..) => "chain",
        BodyModel::ThreeAxis(_) => "spatial",
        BodyModel::Spacecraft(_) => "craft",
    }
}

/// Returns true if two models are one in memory.
fn are_one(a: &BodyModel, b: &BodyModel) -> bool {
    match (a, b) {
        (BodyModel::OneAxis(a), BodyModel::OneAxis(b)) => Arc::ptr_eq(a, b),
        (BodyModel::Chain(a, chain), BodyModel::Chain(b, other)) => {
            Arc::ptr_eq(a, b) && Arc::ptr_eq(chain, other)
        }
        (BodyModel::ThreeAxis(a), BodyModel::ThreeAxis(b)) => Arc::ptr_eq(a, b),
        _ => false,
    }
}

#[test]
fn every_way_of_writing_a_body_comes_to_a_model() {
    let matrices = || Scenario::parse("matrices.toml", MATRICES).expect("valid");
    for (name, expected, axes, modes) in [
        ("relay-fixed", "planar", 1, 2),
        ("matrices", "planar", 1, 1),
        ("rotation-sine", "planar", 1, 4),
        ("rotation-nonlinear", "chain", 1, 4),
        ("iss-ringdown", "spatial", 3, 12),
        ("earth-observer", "craft", 3, 8),
    ] {
        let scenario = if name == "matrices" { matrices() } else { shipped(name) };
        let model = &scenario.model;
        assert_eq!(kind(model), expected, "{name}");
        let found = match model.axes() {
            BodyAxes::One(body) => (1, body.modes.len()),
            BodyAxes::Three(body) => (3, body.modes.len()),
        };
        assert_eq!(found, (axes, modes), "{name}");
        assert_eq!((scenario.axis_count(), scenario.mode_count()), found, "{name}");
        assert_eq!(
            (model.one_axis().is_some(), model.three_axis().is_some()),
            (axes == 1, axes == 3),
            "{name}"
        );
        assert_eq!(
            (model.chain().is_some(), model.spacecraft().is_some()),
            (expected == "chain", expected == "craft")
        );
        let frequencies: Vec<f64> = model.frequencies().collect();
        assert_eq!(frequencies.len(), modes, "{name}");
        assert!(frequencies.is_sorted() && frequencies.iter().all(|w| *w > 0.0), "{name}: {frequencies:?}");
    }
}

/// A body is solved once for all scenarios that differ in other keys, and anew for one that differs in it.
#[test]
fn a_scenario_takes_the_model_of_the_same_body_over() {
    for (name, key, value) in [
        ("relay-fixed", "body.planar.angle", "1e-7"),
        ("rotation-nonlinear", "body.panels.angle", "1e-7"),
        ("iss-ringdown", "body.spatial.rate", "[1e-7, 0.0, 0.0]"),
    ] {
        let parent = shipped(name);
        let like = |key: &str, value: &str| {
            let mut document = Document::from_table(name, parent.to_table());
            document.set_text(key, value).expect("a key");
            Scenario::from_document_reusing(&document, &parent).expect("valid")
        };
        assert!(are_one(&like("seed", "7").model, &parent.model), "{name}");
        let other = like(key, value);
        assert!(other.model != parent.model, "{name}");
        assert_eq!(kind(&other.model), kind(&parent.model));
    }
}
