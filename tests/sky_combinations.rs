//! Targets by two directions, and star trackers that bright bodies blind, with every law and estimator: each is accepted
//! where it is without them, or refused with the reason, and keeps the invariants of a run.

use flexsc_core::Scenario;

use crate::combinations::{self, Body, Parts};
use crate::kinds::{ACTUATORS, ESTIMATORS, Kind, LAWS, SENSORS};
use crate::study::pairs;

/// A target whose axes point to the planet and along the orbit's normal.
const TARGET: &str = "target = [{ from = 0.0, primary = { body = [0, 0, 1], along = \"nadir\" }, \
                      secondary = { body = [0, 1, 0], along = \"orbit_normal\" } }]";

/// Returns laws, estimators and sensors with one actuator each of wheels and of thrusters.
fn parts(wanted: fn(&Kind) -> bool) -> impl Iterator<Item = Parts> {
    let actuators = || ACTUATORS.into_iter().filter(|actuator| ["wheels", "thrusters"].contains(&actuator.0));
    let sensors = move || SENSORS.into_iter().filter(wanted);
    LAWS.into_iter().flat_map(move |law| {
        ESTIMATORS.into_iter().flat_map(move |estimator| {
            sensors().flat_map(move |sensor| {
                actuators().map(move |actuator| Parts { law, sensor, estimator, actuator })
            })
        })
    })
}

/// Compares combinations with and without something; returns how many are run and how many are refused because of it.
fn compared(
    body: &'static Body,
    wanted: fn(&Kind) -> bool,
    changed: impl Fn(Parts) -> Result<Scenario, flexsc_core::ScenarioError>,
    reason: &str,
) -> [usize; 2] {
    let (mut run, mut refused, mut wrong) = (0, 0, Vec::new());
    for parts in parts(wanted) {
        match (combinations::is_accepted(body, parts), changed(parts)) {
            (true, Ok(scenario)) => {
                run += 1;
                if let Err(why) = combinations::run(&scenario, body, &[parts.law.0], parts.actuator.0) {
                    wrong.push(format!("{parts:?}: {why}"));
                }
            }
            (false, Err(_)) => {}
            (true, Err(why)) if why.to_string().contains(reason) => refused += 1,
            (true, Err(why)) => wrong.push(format!("{parts:?}: only without: {why}")),
            (false, Ok(_)) => wrong.push(format!("{parts:?}: only with")),
        }
    }
    assert!(wrong.is_empty(), "{}: {} {:#?}", body.name, wrong.len(), &wrong[..wrong.len().min(8)]);
    [run, refused]
}

#[test]
fn targets_by_directions_combine_with_every_law_and_estimator() {
    let found = combinations::on_all(|body| {
        if body.name == "One angle" {
            return [0, 0];
        }
        let changed =
            |parts| combinations::scenario(body.text, parts, |law| format!("law = {{ {law} }}\n{TARGET}"));
        compared(body, |_| true, changed, "must stay fixed from the start for small rotations")
    });
    for (body, ([run, refused], [least, all])) in pairs(combinations::bodies(), pairs(&found, TARGETS)) {
        assert!(*run >= least && *refused == all, "{}: {found:?}", body.name);
    }
}

/// Combinations with a target by directions that are run at least, and those that are refused because of it.
const TARGETS: [[usize; 2]; 5] = [[0, 0], [760, 0], [760, 0], [700, 0], [0, 770]];

#[test]
fn trackers_that_are_blinded_combine_with_every_law_and_estimator() {
    let found = combinations::on_all(|body| {
        let changed = |parts: Parts| {
            let text = parts
                .sensor
                .2
                .replace("star_tracker = { period", "star_tracker = { exclusion = { sun = 0.3 }, period");
            let sensor: Kind = (parts.sensor.0, parts.sensor.1, Box::leak(text.into_boxed_str()));
            combinations::combined(body.text, Parts { sensor, ..parts })
        };
        compared(body, |sensor| sensor.0.contains("star_tracker"), changed, "no reason")
    });
    for (body, ([run, refused], least)) in pairs(combinations::bodies(), pairs(&found, BLINDED)) {
        assert!(*run >= least && *refused == 0, "{}: {found:?}", body.name);
    }
}

/// Combinations with a star tracker that is blinded that are run, at least.
const BLINDED: [usize; 5] = [0, 210, 210, 200, 210];
