//! Laws alone as an FMU: joined with a plant, the closed loop in every bit.

use flexsc_core::Scenario;
use flexsc_cosim::{Causality, FmuPart};

use crate::importer::{Fmu3, memory_kb, shipped};

/// Plant and laws of a scenario, with the variables that join them.
struct Pair {
    plant: Fmu3,
    laws: Fmu3,
    /// Inputs of the laws that are outputs of the plant.
    measured: Vec<String>,
    /// Inputs of the plant that are outputs of the laws.
    commanded: Vec<String>,
}

/// Returns the names of the variables with a causality.
fn names(fmu: &Fmu3, causality: Causality) -> Vec<String> {
    let own = fmu.table.variables().iter().filter(|of| of.causality == causality && !of.is_clock());
    own.map(|of| of.name.clone()).collect()
}

impl Pair {
    fn new(scenario: &Scenario, uses_events: bool) -> Self {
        let [plant, laws] =
            [FmuPart::Plant, FmuPart::Controller].map(|part| Fmu3::new(scenario, part, uses_events));
        let joined = |inputs: Vec<String>, outputs: Vec<String>| -> Vec<String> {
            inputs.into_iter().filter(|name| outputs.contains(name)).collect()
        };
        let measured = joined(names(&laws, Causality::Input), names(&plant, Causality::Output));
        let commanded = joined(names(&plant, Causality::Input), names(&laws, Causality::Output));
        assert_eq!(measured.len(), names(&laws, Causality::Input).len(), "{measured:?}");
        for fmu in [&plant, &laws] {
            fmu.set_grid(1);
            fmu.begin(None);
        }
        Self { plant, laws, measured, commanded }
    }

    fn measure(&self) {
        for name in &self.measured {
            let [value] = self.plant.reals([name]);
            assert_eq!(self.laws.set(name, value), 0, "{name}");
        }
    }

    fn command(&self) {
        for name in &self.commanded {
            let [value] = self.laws.reals([name]);
            assert_eq!(self.plant.set(name, value), 0, "{name}");
        }
    }
}

/// Returns the bits of the motion in the state of a run. Torques at a point are those before the response in a plant, and those after
/// it in a loop.
fn state(fmu: &Fmu3) -> Vec<u64> {
    let is_motion = |name: &String| name.starts_with("state.") && !name.contains("torque");
    let own = names(fmu, Causality::Output).into_iter().filter(is_motion);
    own.map(|name| fmu.reals([&name])[0].to_bits()).collect()
}

const SCENARIOS: [(&str, f64, usize); 5] = [
    ("wheel-fixed-gain", 4.5, 40),
    ("wheel-scheduled-gain", 4.5, 40),
    ("earth-observer", 0.25, 120),
    ("earth-observer-lqg", 0.25, 120),
    ("station-keeping", 0.5, 200),
];

#[test]
fn plant_and_laws_equal_the_closed_loop() {
    for (name, period, count) in SCENARIOS {
        let scenario = shipped(name, &[("duration", "200.0")]);
        let native = Fmu3::new(&scenario, FmuPart::Loop, false);
        native.set_grid(1);
        native.begin(None);
        let pair = Pair::new(&scenario, false);
        for index in 0..count {
            let from = index as f64 * period;
            let size = (index + 1) as f64 * period - from;
            pair.measure();
            assert_eq!(pair.laws.step(from, size).status, 0);
            pair.command();
            assert_eq!(pair.plant.step(from, size).status, 0);
            native.step(from, size);
            assert_eq!(state(&pair.plant), state(&native), "{name} at {} s", from + size);
        }
        assert_eq!(pair.laws.integers(["events"]), [count as i64]);
    }
}

#[test]
fn laws_return_early_at_their_decisions() {
    for (name, _, _) in SCENARIOS {
        let scenario = shipped(name, &[("duration", "40.0")]);
        let native = Fmu3::new(&scenario, FmuPart::Loop, false);
        native.begin(None);
        let pair = Pair::new(&scenario, true);
        pair.measure();
        pair.laws.update();
        pair.command();
        pair.plant.update();
        for fmu in [&pair.plant, &pair.laws] {
            assert_eq!(fmu.mode("fmi3EnterStepMode"), 0);
        }
        let (mut at, mut decisions) = (0.0, 0);
        while at < 30.0 {
            // The laws say when they decide; the plant goes there through its own events.
            let decided = pair.laws.step(at, 40.0 - at);
            assert!(decided.is_event && decided.is_early, "{name} {decided:?}");
            let mut reached = at;
            while reached < decided.reached {
                let stepped = pair.plant.step(reached, decided.reached - reached);
                assert_eq!(stepped.status, 0, "{name}");
                reached = stepped.reached;
                if stepped.is_early {
                    assert_eq!(pair.plant.mode("fmi3EnterEventMode"), 0);
                    pair.plant.update();
                    assert_eq!(pair.plant.mode("fmi3EnterStepMode"), 0);
                }
            }
            for fmu in [&pair.plant, &pair.laws] {
                assert_eq!(fmu.mode("fmi3EnterEventMode"), 0);
            }
            pair.measure();
            pair.laws.update();
            pair.command();
            pair.plant.update();
            for fmu in [&pair.plant, &pair.laws] {
                assert_eq!(fmu.mode("fmi3EnterStepMode"), 0);
            }
            native.step(at, decided.reached - at);
            at = decided.reached;
            decisions += 1;
            assert_eq!(state(&pair.plant), state(&native), "{name} at {at} s");
        }
        assert_eq!(pair.laws.integers(["events"]), [decisions], "{name}");
    }
}

#[test]
fn states_of_laws_are_restored() {
    let scenario = shipped("wheel-fixed-gain", &[("duration", "60.0")]);
    let pair = Pair::new(&scenario, false);
    let steps = |from: usize, to: usize| -> Vec<u64> {
        let mut found = Vec::new();
        for index in from..to {
            for (place, name) in pair.measured.iter().enumerate() {
                assert_eq!(pair.laws.set(name, 1e-3 * (index * 7 + place) as f64), 0);
            }
            let at = index as f64 * 0.3;
            assert_eq!(pair.laws.step(at, (index + 1) as f64 * 0.3 - at).status, 0);
            found.extend(pair.commanded.iter().map(|name| pair.laws.reals([name])[0].to_bits()));
        }
        found
    };
    steps(0, 20);
    let bytes = pair.laws.bytes(pair.laws.state());
    let kept = pair.laws.state();
    let expected = steps(20, 40);
    pair.laws.restore(kept);
    assert_eq!(steps(20, 40), expected);
    let restored = pair.laws.deserialized(&bytes).expect("a state");
    pair.laws.restore(restored);
    assert_eq!(steps(20, 40), expected);
    assert!(pair.laws.deserialized(b"damaged").is_none());
}

#[test]
fn a_million_decisions_keep_the_memory_and_the_state() {
    let scenario = shipped("earth-observer", &[("duration", "20.0")]);
    let laws = Fmu3::new(&scenario, FmuPart::Controller, false);
    laws.set_grid(1);
    laws.begin(Some(3e5));
    let input = names(&laws, Causality::Input).swap_remove(0);
    let decide = |from: usize, to: usize| {
        for index in from..to {
            // An input changes now and then.
            if index.is_multiple_of(100_000) {
                assert_eq!(laws.set(&input, 1e-3 * (1 + index) as f64), 0);
            }
            let at = index as f64 * 0.25;
            assert_eq!(laws.step(at, (index + 1) as f64 * 0.25 - at).status, 0);
        }
    };
    decide(0, 100);
    let (before, bytes) = (memory_kb(), laws.bytes(laws.state()).len());
    decide(100, 1_000_000);
    let (after, later) = (memory_kb(), laws.bytes(laws.state()).len());
    // Other tests run in this process.
    assert!(after < before + 60_000, "{before} kB, then {after} kB");
    assert!(later < bytes + 2000, "{bytes} bytes, then {later}");
    assert_eq!(laws.integers(["events"]), [1_000_000]);
}

#[test]
fn laws_have_an_end() {
    let scenario = shipped("wheel-fixed-gain", &[("duration", "60.0")]);
    let laws = Fmu3::new(&scenario, FmuPart::Controller, false);
    laws.begin(None);
    for size in [1e300, 61.0] {
        assert_eq!(laws.step(0.0, size).status, 3);
        let why = laws.messages.0.last().expect("a message");
        assert!(why.contains("s is after the end of the run, 60"), "{why}");
    }
    assert_eq!(laws.step(0.0, 60.0).status, 0);
    let later = Fmu3::new(&scenario, FmuPart::Controller, false);
    later.begin(Some(70.0));
    assert_eq!((later.step(0.0, 70.0).status, later.step(70.0, 1.0).status), (0, 3));
    let endless = Fmu3::new(&scenario, FmuPart::Controller, false);
    assert_eq!(endless.try_begin(Some(1e300)), [0, 3]);
}

#[test]
fn laws_that_cannot_run_alone_are_refused() {
    for (name, words) in [
        ("relay-fixed", ["law.relay", "crosses a limit"]),
        ("rotation-cosine", ["law.open", "controller"]),
        ("relay-adaptive", ["adaptation", "controller"]),
    ] {
        let refused = flexsc_cosim::FmuContent::new(&shipped(name, &[]), FmuPart::Controller);
        let why = refused.expect_err("a refusal").to_string();
        assert!(words.iter().all(|word| why.contains(word)), "{name}: {why}");
    }
}

#[test]
fn a_plant_has_the_readings_of_its_sensors() {
    let plant = Fmu3::new(&shipped("earth-observer", &[("duration", "40.0")]), FmuPart::Plant, false);
    plant.begin(None);
    assert_eq!(plant.integers(["gyro.time_whole_s", "gyro.time_fs"]), [0, 0]);
    plant.step(0.0, 20.45);
    // The gyro comes each 0.1 s, the star tracker each 0.5 s with a latency of 0.2 s.
    assert_eq!(plant.integers(["gyro.time_whole_s", "gyro.time_fs"]), [20, 400_000_000_000_000]);
    assert_eq!(
        plant.integers(["star_tracker.time_whole_s", "star_tracker.time_fs"]),
        [20, 200_000_000_000_000]
    );
    let near = |one: &str, other: &str, count: usize, within: f64| {
        for index in 1..=count {
            let [reading, truth] = plant.reals([&format!("{one}[{index}]"), &format!("{other}[{index}]")]);
            assert!((reading - truth).abs() < within, "{one}[{index}]: {reading:e} for {truth:e}");
        }
    };
    near("gyro.rate", "state.rate", 3, 1e-4);
    near("star_tracker.attitude", "state.attitude", 4, 1e-3);
    let [norm] = plant.reals(["star_tracker.attitude[1]"]);
    assert!(norm != 0.0);
}
