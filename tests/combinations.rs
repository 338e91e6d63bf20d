//! Combinations of parts: every combination of law, sensor, estimator and actuator is tried, on one axis and on three.
//!
//! What is accepted runs for 4 s, a second longer than a window of the envelope and the first of several
//! laws, in one and in pieces, and keeps the invariants of `tests/invariants.rs`; what is refused names a key
//! and a reason. The tables in `tests/frozen/combinations.md`, which the site shows, are made here.

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::sync::LazyLock;

use flexsc_core::numerics::attitude::{Vector, vector};
use flexsc_core::{Document, Scenario, ScenarioError};
use toml::Table;

use crate::combination_tables::{Accepted, section, total};
use crate::frozen::is_frozen_file;
use crate::invariants::{
    External, Flown, energy_does_not_grow, metrics_are_numbers, momentum_is_that_of_rates_and_rotors,
    pieces_give_the_whole, torque_changes_the_momentum, torque_changes_the_rate,
};
use crate::kinds::{
    ACTUATORS, AROUND, ESTIMATORS, HINGED, JETS, Kind, LAWS, ONE_ANGLE, SENSORS, SPACECRAFT, THREE_AXES,
    THRUST,
};
use crate::study::pairs;

/// Parts of a combination.
#[derive(Copy, Clone)]
pub struct Parts {
    pub law: Kind,
    pub sensor: Kind,
    pub estimator: Kind,
    pub actuator: Kind,
}

impl std::fmt::Debug for Parts {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { law, sensor, estimator, actuator } = self;
        out.write_str(&[law.0, sensor.0, estimator.0, actuator.0].join(", "))
    }
}

/// Returns a combination as a scenario.
pub fn combined(body: &str, parts: Parts) -> Result<Scenario, ScenarioError> {
    scenario(body, parts, |law| format!("law = {{ {law} }}"))
}

/// Returns a combination as a scenario, with its law written by `written`.
pub fn scenario(
    body: &str,
    parts: Parts,
    written: impl Fn(&str) -> String,
) -> Result<Scenario, ScenarioError> {
    let Parts { law, sensor, estimator, actuator } = parts;
    let estimator = match (estimator.0, law.0) {
        ("none", _) => String::new(),
        // A filter that an open loop does not read is there to be assessed.
        ("attitude", "open") => "estimator = { attitude = { watch_only = true } }\n".to_owned(),
        ("attitude with modes", "open") => {
            format!("estimator = {{ {} }}\n", estimator.2.replacen("{ ", "{ watch_only = true, ", 1))
        }
        (kind, "open") if kind.contains("kalman") => {
            format!("estimator = {{ {} }}\n", estimator.2.replace(" }", ", watch_only = true }"))
        }
        _ => format!("estimator = {{ {} }}\n", estimator.2),
    };
    let around = if body == ONE_ANGLE { "" } else { AROUND };
    let mut table = keys("duration = 4.0\nseed = 3\nlog.period = 0.1");
    let actuator = format!("actuator = {}", actuator.2);
    for text in [&written(law.2), sensor.2, &actuator, &estimator, &format!("{body}{around}")] {
        for (key, value) in keys(text) {
            assert!(table.insert(key, value).is_none(), "a key is given twice");
        }
    }
    Scenario::from_document(&Document::from_table("combination.toml", table))
}

/// Returns the keys of a part of a scenario's text. Each text is parsed once, since copying its keys takes less time.
fn keys(text: &str) -> Table {
    thread_local! {
        static KNOWN: RefCell<HashMap<String, Table>> = RefCell::default();
    }
    KNOWN.with_borrow_mut(|known| match known.get(text) {
        Some(table) => table.clone(),
        None => known.entry(text.to_owned()).or_insert(text.parse().expect("keys")).clone(),
    })
}

/// Body of combinations.
pub struct Body {
    pub name: &'static str,
    pub text: &'static str,
    /// How many combinations are accepted at least.
    least: usize,
    /// Centre of mass in the axes of the scenario (m), at which a body without masses has its origin.
    centre: [f64; 3],
    /// Angular momentum that drives give to appendages at the start (N m s).
    driven: [f64; 3],
    /// Tolerance of the balance of momentum, relative to the angular impulse: the hub vibrates between rows,
    /// panels that swing move the centre of mass, and with it the arms of jets, and a hinge's first angle
    /// changes the inertia.
    tolerance: f64,
}

/// Returns what is accepted on a body; what is refused has a reason.
fn accepted(body: &Body) -> Accepted {
    LAWS.map(|law| {
        ACTUATORS.map(|actuator| {
            ESTIMATORS.map(|estimator| {
                SENSORS.map(|sensor| match combined(body.text, Parts { law, sensor, estimator, actuator }) {
                    Ok(_) => true,
                    Err(error) => {
                        let text = error.to_string();
                        assert!(text.contains('`') && text.len() > 40, "no reason: {text}");
                        false
                    }
                })
            })
        })
    })
}

/// Returns what is accepted on each body. Every combination is parsed once, for all tests.
fn all_accepted() -> &'static [Accepted] {
    static ALL: LazyLock<Vec<Accepted>> = LazyLock::new(|| on_all(accepted));
    &ALL
}

/// Returns the position of a kind among those of a role.
fn position(kinds: &[Kind], kind: Kind) -> usize {
    kinds.iter().position(|known| known.0 == kind.0).expect("a known kind")
}

/// Returns true if a combination is accepted on a body.
pub fn is_accepted(body: &Body, parts: Parts) -> bool {
    let Parts { law, sensor, estimator, actuator } = parts;
    let body = bodies().iter().position(|known| known.name == body.name).expect("a known body");
    let on_actuator = &all_accepted()[body][position(&LAWS, law)][position(&ACTUATORS, actuator)];
    on_actuator[position(&ESTIMATORS, estimator)][position(&SENSORS, sensor)]
}

/// Runs each accepted combination of a body.
fn run_all(body: &Body) {
    // By what is wrong: how many, and the last of them.
    let mut wrong = BTreeMap::<String, (usize, String)>::new();
    for law in LAWS {
        for actuator in ACTUATORS {
            for (estimator, sensor) in readers() {
                let parts = Parts { law, sensor, estimator, actuator };
                if !is_accepted(body, parts) {
                    continue;
                }
                let scenario = combined(body.text, parts).expect("an accepted combination");
                if let Err(why) = run(&scenario, body, &[law.0], actuator.0) {
                    let (count, name) = wrong.entry(why).or_default();
                    *count += 1;
                    *name = format!("{parts:?}");
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}: {wrong:#?}", body.name);
}

/// Returns the estimators and sensors.
pub fn readers() -> impl Iterator<Item = (Kind, Kind)> {
    ESTIMATORS.into_iter().flat_map(|estimator| SENSORS.map(|sensor| (estimator, sensor)))
}

/// Returns the torques of the jets on a body with this centre of mass (N m).
fn jet_torques(centre: [f64; 3]) -> [Vector; 6] {
    JETS.map(|(offset, direction)| {
        (Vector::from(offset) - Vector::from(centre)).cross(&Vector::from(direction)) * THRUST
    })
}

/// Returns the external torque of an actuator on a three-axis body, where the rows have it exactly: a relay
/// switches an actuator without a period between rows.
fn external<'a>(actuator: &str, law: &str, jets: &'a [Vector; 6]) -> Option<External<'a>> {
    match actuator {
        "wheels" | "control_moment_gyros" => Some(External::None),
        "hold" | "thrusters" => Some(External::Applied),
        "ideal" | "wheel" | "ideal and wheel, by shares" | "wheel and thrusters, by shares" => {
            (law != "relay").then_some(External::Applied)
        }
        "magnetorquers" => (law != "relay").then_some(External::Magnetic),
        "wheels, magnetorquers unload" => Some(External::Magnetic),
        _ => Some(External::Pulses(jets)),
    }
}

/// Runs a combination to its end, with all that a full log holds, and checks its invariants.
pub fn run(scenario: &Scenario, body: &Body, laws: &[&str], actuator: &str) -> Result<(), String> {
    let whole = Flown::new(scenario, &[]);
    pieces_give_the_whole(scenario, &whole)?;
    metrics_are_numbers(&whole)?;
    if let Some(of) = scenario.model.three_axis() {
        let jets = jet_torques(body.centre);
        let start = of.inertia * vector(&of.rate) + Vector::from(body.driven);
        // Without samples and a period of the law, pulses of jets begin between the rows of cycles.
        let has_cycles = scenario.study.law_period.or(scenario.study.sample_period).is_some();
        let external =
            laws.iter().map(|law| external(actuator, law, &jets)).min_by_key(Option::is_some).flatten();
        if let Some(external) = external.filter(|of| has_cycles || !matches!(of, External::Pulses(_))) {
            torque_changes_the_momentum(&whole, start, external, body.tolerance)?;
        }
        if body.driven == [0.0; 3] {
            // On a spacecraft, modes change the inertia: by 4e-5 of the momentum at most.
            let tolerance = if scenario.model.is_two_way() { 1e-3 } else { 1e-11 };
            momentum_is_that_of_rates_and_rotors(&whole, &of.inertia, tolerance)?;
        }
    } else {
        torque_changes_the_rate(&whole, 100.0, body.tolerance)?;
    }
    // Wheels that are unloaded and drives act without a law.
    if laws.iter().all(|law| *law == "open") && !actuator.ends_with("unload") && body.driven == [0.0; 3] {
        energy_does_not_grow(&whole, &[1.0, 2.5])?;
    }
    Ok(())
}

/// Bodies of combinations.
pub fn bodies() -> &'static [Body; 5] {
    static BODIES: LazyLock<[Body; 5]> = LazyLock::new(|| {
        let turning =
            SPACECRAFT.replace("plate =", "drive = { about = [0, 1, 0], rate = 0.02 }\nplate =") + HINGED;
        let small = SPACECRAFT.replace("points =", "small_angles = {}\npoints =");
        let [lateral, whole] = [10.0 * 2.0, 200.0 + 10.0];
        [
            Body {
                name: "One angle",
                text: ONE_ANGLE,
                least: 912,
                centre: [0.0; 3],
                driven: [0.0; 3],
                tolerance: 1e-10,
            },
            Body {
                name: "Three axes",
                text: THREE_AXES,
                least: 3518,
                centre: [0.0; 3],
                driven: [0.0; 3],
                tolerance: 1e-5,
            },
            Body {
                name: "A spacecraft from parts",
                text: SPACECRAFT,
                least: 3747,
                centre: [0.0, lateral / whole, 0.0],
                driven: [0.0; 3],
                tolerance: 1e-4,
            },
            Body {
                name: "A spacecraft with panels that turn, on a drive and on a hinge",
                text: turning.leak(),
                least: 3416,
                centre: [5.0 * 1.5 / (whole + 5.0), lateral / (whole + 5.0), 0.0],
                driven: [0.0, 1.0 * 0.02, 0.0],
                tolerance: 1e-3,
            },
            Body {
                name: "A spacecraft from parts at small angles",
                text: small.leak(),
                least: 2734,
                centre: [0.0, lateral / whole, 0.0],
                driven: [0.0; 3],
                tolerance: 3e-3,
            },
        ]
    });
    &BODIES
}

/// Evaluates something on each body, all at once.
pub fn on_all<T: Send>(of: impl Fn(&'static Body) -> T + Sync) -> Vec<T> {
    let of = &of;
    std::thread::scope(|scope| {
        let threads: Vec<_> = bodies().iter().map(|body| scope.spawn(move || of(body))).collect();
        threads
            .into_iter()
            .map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    })
}

#[test]
fn parts_combine_as_the_documents_say() {
    on_all(run_all);
    let mut made = Vec::new();
    for (body, accepted) in pairs(bodies(), all_accepted()) {
        assert!(total(accepted) >= body.least, "{}: {}", body.name, total(accepted));
        made.push(section(body.name, accepted));
    }
    let made = format!("{}\n", made.concat().trim_end());
    is_frozen_file("tests/frozen/combinations.md", made.as_bytes());
}
