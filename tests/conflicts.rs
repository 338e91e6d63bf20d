//! Conflicts between the parts of a scenario: all are reported at once, in the order of the document, and none that only follows
//! from another.

use flexsc_core::{Document, Scenario, ScenarioError};

use crate::kinds::SPACECRAFT;
use crate::util::Dir;

/// A spacecraft whose parts contradict each other in seven ways; the order of the tables is that of no check.
const CONTRADICTORY: &str = r#"duration = 10.0

[[requirement]]
name = "pointing"
quantity = "pointing_eror"
limit = 0.1

[adaptation.random_search]
tunes = "gain"
step = 10.0
bounds = [1e3, 1e5]

[law.b_dot]
period = 0.1
gain = 1e4

[actuator.magnetorquers]
moment = 1.0

[sensor.gyro]
point = "boom"
period = 0.1

[[disturbance]]
about = "yaw"
torque = 0.1
from = 5.0
to = 2.0

[spacecraft]
mass = 100.0
inertia = [[10.0, 0, 0], [0, 12.0, 0], [0, 0, 8.0]]

[drift.common.ramp]
time = 5.0
to = 1.1
"#;

/// The keys of its errors, with their lines.
const CONFLICTS: [(&str, u64); 7] = [
    ("requirement[0].quantity", 5),
    ("adaptation.random_search", 8),
    ("law.b_dot", 13),
    ("actuator.magnetorquers", 17),
    ("sensor.gyro.point", 21),
    ("disturbance[0].to", 28),
    ("drift", 34),
];

/// Returns the keys of the errors of a scenario.
fn keys(scenario: Result<Scenario, ScenarioError>) -> Vec<String> {
    let mistakes = scenario.expect_err("a conflict").mistakes();
    mistakes.into_iter().map(|mistake| mistake.key.unwrap_or_default()).collect()
}

#[test]
fn all_conflicts_are_reported_in_the_order_of_the_document() {
    let dir = Dir::holding("bad.toml", CONTRADICTORY);
    let printed = dir.run("check bad.toml").exits(2).err;
    let places: Vec<String> =
        CONFLICTS.iter().map(|(key, line)| format!("bad.toml:{line}:: `{key}`")).collect();
    let shown = printed.lines().filter_map(|line| {
        let (place, message) = line.strip_prefix("error: ").unwrap_or(line).split_once(": ")?;
        let place = place.trim_end_matches(|c: char| c.is_ascii_digit());
        Some(format!("{place}: `{}`", message.split('`').nth(1)?))
    });
    assert_eq!(shown.collect::<Vec<_>>(), places, "{printed}");
    let carets = printed.lines().filter(|line| line.ends_with('^'));
    assert_eq!(carets.count(), CONFLICTS.len(), "{printed}");
}

#[test]
fn programs_get_all_conflicts() {
    let dir = Dir::holding("bad.toml", CONTRADICTORY);
    let printed = dir.run("check bad.toml --json").json();
    let each = printed["mistakes"].as_array().expect("a list").iter();
    let each = each.map(|mistake| (mistake["key"].as_str(), mistake["line"].as_u64()));
    assert!(each.eq(CONFLICTS.map(|(key, line)| (Some(key), Some(line)))), "{printed}");
    let names = CONFLICTS.map(|(key, _)| key);
    // Of a table without a text, such as a Python dictionary, the order is that of the keys.
    let table = CONTRADICTORY.parse().expect("TOML");
    assert_eq!(keys(Scenario::from_document(&Document::from_table("bad", table))), names);
    // A key that is set stands in no line: it comes last.
    let mut document = Document::parse("bad", CONTRADICTORY.to_owned()).expect("TOML");
    document.set_text("sensor.gyro.point", "mast").expect("a key");
    let set = keys(Scenario::from_document(&document));
    assert_eq!(set.last().map(String::as_str), Some("sensor.gyro.point"));
    assert_eq!(set.len(), names.len());
}

#[test]
fn a_changed_scenario_has_all_conflicts() {
    let good = "duration = 1.0\n[body.planar]\n[law.relay]\ndead_zone = 5e-4\nhysteresis = 1e-4\nstrong = 4e-5\nweak = 1e-6\n\
                k_t = 0.3\n";
    let changed = Scenario::parse("good", good).expect("a scenario").with(|written| {
        written.name = "a/b".to_owned();
        written.log.scene.turning = flexsc_core::numerics::quantity::Positive::new(1e300);
    });
    let error = changed.expect_err("two conflicts");
    assert_eq!(error.to_string().lines().count(), 2, "{error}");
    assert_eq!(keys(Err(error)), ["name", "log.scene.turning"]);
}

/// A body with one angle and one with three axes, without modes.
const PLANAR: &str = "[body.planar]\ninertia = 10.0\n";
const SPATIAL: &str = "[spacecraft]\nmass = 100.0\ninertia = [[10.0, 0, 0], [0, 12.0, 0], [0, 0, 8.0]]\n";
/// Laws, and a filter that is given modes.
const PD: &str = "[law.pd]\nk_p = 1.0\nk_d = 1.0\nperiod = 0.1\n";
const OPEN: &str = "[law.open]\n";
const B_DOT: &str = "[law.b_dot]\nperiod = 0.1\ngain = 1e4\n";
const FILTER: &str = "[estimator.kalman]\nmodes = [{ frequency = 1.0, gain = 0.1 }]\n";
const ENVIRONMENT: &str = "[environment]\nmagnetic_field = {}\n";
const WHEELS: &str = "[[actuator]]\nwheel = { gain = 1.0 }\n[[actuator]]\nwheel = { gain = 1.0 }\n";
const TURNED: &str = "[[target]]\nfrom = 5.0\nframe = \"nadir\"\n";
const SAMPLED: &str = "[[sensor]]\nsampled = { period = 0.1, noise = 1e-6 }\n";

#[rustfmt::skip] // One case a line.
const CASCADES: &[(&str, &[&str], &[&str])] = &[
    // What parts for other axes require of each other: a magnetometer, magnetorquers and an orbit.
    ("axes", &[PLANAR, B_DOT, ENVIRONMENT], &["law.b_dot", "environment"]),
    // Which sensors measure the same, beside one that has to go.
    ("sensors", &[PLANAR, PD, "[[sensor]]\ncontinuous = {}\n", SAMPLED], &["sensor[0].continuous"]),
    // Shares that sum to 2, with two wheels of which one has to go.
    ("actuators", &[PLANAR, PD, WHEELS], &["actuator[1].wheel"]),
    // A target in the axes of an orbit that there is not.
    ("environment", &[SPATIAL, PD, ENVIRONMENT, TURNED], &["environment.magnetic_field"]),
    // The number of modes of a filter of a body without any.
    ("modes", &[PLANAR, PD, FILTER], &["estimator.kalman"]),
    // Modes and several sensors of a filter that is not read.
    ("estimator", &[PLANAR, OPEN, FILTER, SAMPLED, SAMPLED], &["estimator.kalman"]),
    // A magnetometer and magnetorquers, which a law about three axes requires about each.
    ("law", &[SPATIAL, B_DOT], &["law.b_dot", "law.b_dot"]),
];

#[test]
fn conflicts_that_follow_from_others_are_silent() {
    let mut wrong = Vec::new();
    for (name, parts, wanted) in CASCADES {
        let found = keys(Scenario::parse("bad", &format!("duration = 10.0\n{}", parts.concat())));
        if found != *wanted {
            wrong.push(format!("{name}: {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    // The motion of a point that there is not, on a body with appendages that turn.
    let turning = SPACECRAFT.replace("plate =", "drive = { about = [0, 1, 0], rate = 0.02 }\nplate =");
    let text = format!("{PD}[sensor.sampled]\nperiod = 0.1\npoint = \"boom\"\n{turning}");
    let error = Scenario::parse("bad", &format!("duration = 10.0\n{text}")).expect_err("no such point");
    assert!(error.to_string().contains("`sensor.sampled.point` must be one of the body's points"), "{error}");
    assert_eq!(keys(Err(error)).len(), 1);
}
