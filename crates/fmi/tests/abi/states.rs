//! States of an instance, in memory and as bytes.

use flexsc_cosim::FmuPart;

use crate::importer::{Fmu3, memory_kb, shipped};

/// Steps from 4 s to 8 s with inputs, and returns the bits of the motion on the way.
fn onwards(fmu: &Fmu3, part: FmuPart, state: &str) -> Vec<u64> {
    let mut seen = Vec::new();
    for point in 0..40 {
        let from = 4.0 + f64::from(point) * 0.1;
        let next = 4.0 + f64::from(point + 1) * 0.1;
        if point % 10 == 3 {
            let name = if fmu.table.find("command[1]").is_some() { "[1]" } else { "" };
            fmu.set(&format!("disturbance_torque{name}"), f64::from(point) * 1e-3);
            if part == FmuPart::Plant {
                assert_eq!(fmu.set(&format!("command{name}"), f64::from(point) * 1e-3), 0);
            }
        }
        assert_eq!(fmu.step(from, next - from).status, 0);
        seen.push(fmu.reals([state])[0].to_bits());
    }
    seen
}

#[test]
fn a_state_continues_with_equal_bits() {
    for (name, part, state) in [
        ("relay-fixed", FmuPart::Loop, "state.angle"),
        ("wheel-fixed-gain", FmuPart::Plant, "state.rate"),
        ("wheel-ekf", FmuPart::Loop, "state.modes[1]"),
        ("earth-observer", FmuPart::Loop, "state.rate[2]"),
        ("earth-observer", FmuPart::Plant, "state.rate[1]"),
    ] {
        let scenario = shipped(name, &[("duration", "20.0")]);
        let fmu = Fmu3::new(&scenario, part, false);
        fmu.begin(None);
        fmu.run(3.9, 0.1, false, |fmu, point| {
            if point == Some(10) && part == FmuPart::Plant {
                let name = if fmu.table.find("command[1]").is_some() { "command[3]" } else { "command" };
                assert_eq!(fmu.set(name, 2e-3), 0);
            }
        });
        assert_eq!(fmu.step(3.9, 0.1).status, 0);
        let (state_before, kept) = (fmu.state(), fmu.state());
        let expected = onwards(&fmu, part, state);
        fmu.restore(state_before);
        assert_eq!(onwards(&fmu, part, state), expected, "{name} in memory");
        // Another instance repeats the run from the bytes.
        let bytes = fmu.bytes(kept);
        let other = Fmu3::new(&scenario, part, false);
        other.restore(other.deserialized(&bytes).expect("a state"));
        assert_eq!(other.integers(["events"]), {
            let again = fmu.deserialized(&bytes).expect("a state");
            fmu.restore(again);
            fmu.integers(["events"])
        });
        assert_eq!(onwards(&other, part, state), expected, "{name} as bytes");
    }
}

#[test]
fn a_state_within_an_event_continues_there() {
    let scenario = shipped("relay-fixed", &[("duration", "600.0")]);
    let fmu = Fmu3::new(&scenario, FmuPart::Loop, true);
    fmu.begin(None);
    fmu.update();
    assert_eq!(fmu.mode("fmi3EnterStepMode"), 0);
    let stepped = fmu.step(0.0, 500.0);
    assert!(stepped.is_event && stepped.is_early);
    let bytes = fmu.bytes(fmu.state());
    let onwards = |fmu: &Fmu3| {
        assert_eq!((fmu.mode("fmi3EnterEventMode"), fmu.ticks("switched")), (0, true));
        fmu.update();
        assert_eq!(fmu.mode("fmi3EnterStepMode"), 0);
        let next = fmu.step(stepped.reached, 500.0 - stepped.reached);
        (next, fmu.integers(["event_whole_s", "event_fs", "events", "switchings"]))
    };
    let other = Fmu3::new(&scenario, FmuPart::Loop, true);
    other.restore(other.deserialized(&bytes).expect("a state"));
    assert_eq!(onwards(&other), onwards(&fmu));
}

#[test]
fn a_state_in_the_place_of_another_frees_it() {
    let scenario = shipped("relay-fixed", &[("duration", "100.0")]);
    let fmu = Fmu3::new(&scenario, FmuPart::Loop, false);
    fmu.begin(None);
    let bytes = fmu.bytes(fmu.state());
    let mut state = fmu.state();
    let mut replace = |count: u32| {
        (0..count).for_each(|_| state = fmu.deserialized_over(&bytes, state).expect("a state"));
        memory_kb()
    };
    let (before, after) = (replace(50), replace(400));
    assert!(after < before + 8000, "{before} kB, then {after} kB");
    fmu.restore(state);
}

#[test]
fn a_state_whose_mode_and_start_do_not_fit_is_refused() {
    for part in [FmuPart::Plant, FmuPart::Controller] {
        let scenario = shipped("earth-observer", &[("duration", "20.0")]);
        let fmu = Fmu3::new(&scenario, part, false);
        let not_begun = fmu.bytes(fmu.state());
        fmu.begin(None);
        let begun = fmu.bytes(fmu.state());
        let modes = |bytes: &[u8]| -> Vec<u8> {
            (0..6).filter(|mode| fmu.deserialized(&[&[*mode], &bytes[1..]].concat()).is_some()).collect()
        };
        // Instantiated, configuration and initialization; then event, step and terminated.
        assert_eq!((modes(&not_begun), modes(&begun)), (vec![0, 1, 2], vec![3, 4, 5]));
    }
}

#[test]
fn damaged_states_are_refused() {
    let scenario = shipped("relay-fixed", &[("duration", "100.0")]);
    let fmu = Fmu3::new(&scenario, FmuPart::Loop, false);
    fmu.begin(None);
    assert_eq!(fmu.step(0.0, 50.0).status, 0);
    let bytes = fmu.bytes(fmu.state());
    let other = Fmu3::new(&shipped("relay-fixed", &[]), FmuPart::Loop, false);
    for (count, fmu) in [(1, &fmu), (1, &other)] {
        let wrong: Vec<Vec<u8>> = if std::ptr::eq(fmu, &raw const other) {
            vec![bytes.clone()]
        } else {
            let text = String::from_utf8_lossy(&bytes[1..]).replace("\"whole\":50", "\"whole\":500");
            let late = [&bytes[..1], text.as_bytes()].concat();
            vec![Vec::new(), vec![9], bytes[..bytes.len() - 1].to_vec(), vec![4, b'{', b'}'], late]
        };
        for wrong in wrong {
            let before = fmu.messages.0.len();
            assert!(fmu.deserialized(&wrong).is_none(), "{wrong:?}");
            assert_eq!(fmu.messages.0.len() - before, count);
        }
    }
}
