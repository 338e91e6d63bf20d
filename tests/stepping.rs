//! Runs in pieces: they have the results of whole runs, copies are independent, and commands come from outside.

use std::collections::BTreeMap;

use flexsc_core::control::law::Command;
use flexsc_core::control::quantity::total_width;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{Detail, Trace};
use flexsc_core::{Scenario, Simulation, StopAt};

use crate::study::pairs;
use crate::util::SCENARIOS;

/// Shipped scenarios of every kind of motion, law, sensor and actuator, and their simulated times (s).
const FLOWN: [(&str, f64); 16] = [
    ("attitude-hold", 60.0),
    ("canted-jets", 60.0),
    ("detumble-and-point", 300.0),
    ("earth-observer", 60.0),
    ("four-clamped-modes", 60.0),
    ("four-clamped-modes-faults", 60.0),
    ("momentum-unloading", 120.0),
    ("relay-adaptive", 2500.0),
    ("relay-sampled", 400.0),
    ("relay-wheel", 400.0),
    ("relays-three-axes", 300.0),
    ("rotation-nonlinear", 20.0),
    ("rotation-thrusters", 20.0),
    ("safe-mode", 1500.0),
    ("wheel-ekf", 30.0),
    ("wheel-friction", 60.0),
];

fn at(seconds: f64) -> Instant {
    Instant::START + Span::from_seconds(seconds)
}

fn flown(name: &str, seconds: f64) -> Scenario {
    let text = std::fs::read_to_string(format!("{SCENARIOS}/{name}.toml")).expect("a file");
    let scenario = Scenario::parse(&format!("{SCENARIOS}/{name}.toml"), &text).expect("a scenario");
    let duration = Span::from_seconds(seconds.min(scenario.duration.seconds()));
    scenario.with(|scenario| scenario.duration = duration).expect("a shorter one")
}

/// Returns the row of a simulation, to the bit.
fn row(simulation: &mut Simulation, scenario: &Scenario) -> Vec<u64> {
    let mut row = vec![0.0; total_width(&simulation.observation_fields(scenario))];
    simulation.observe(&mut row).expect("finite numbers");
    row.into_iter().map(f64::to_bits).collect()
}

#[test]
fn a_run_in_pieces_comes_to_the_same_as_a_whole_one() {
    for (name, seconds) in FLOWN {
        let scenario = flown(name, seconds);
        let mut trace = Trace::new(Detail::Events);
        let mut whole = Simulation::new(&scenario, 3);
        whole.run(&mut trace).expect("a run");
        let rows = |trace: Trace| -> BTreeMap<String, usize> {
            trace.into_columns().map(|(name, rows)| (name, rows.len())).collect()
        };
        let reported = rows(trace);
        for piece in [0.37, 1.0, 9.9] {
            let mut pieces = Trace::new(Detail::Events);
            let mut cut = Simulation::new(&scenario, 3);
            let mut until = 0.0;
            while !cut.is_finished() {
                until += piece;
                cut.run_up_to(at(until), &mut pieces).expect("a piece");
                // Copies do not disturb.
                let mut copy = cut.clone();
                copy.set_external_command([Command::Torque(1e-4); 3]);
                copy.run_up_to(at(until + 0.5), &mut ()).expect("a copy");
                row(&mut cut, &scenario);
            }
            assert_eq!(row(&mut cut, &scenario), row(&mut whole, &scenario), "{name} {piece}");
            assert_eq!(rows(pieces), reported, "{name} {piece}");
        }
    }
}

#[test]
fn telemetry_has_the_values_of_its_layout_and_changes_no_controlled_run() {
    for (name, seconds) in FLOWN {
        let scenario = flown(name, seconds.min(20.0));
        let [mut seen, mut unseen] = [0, 1].map(|_| Simulation::new(&scenario, 3));
        let layout = seen.telemetry_layout(&scenario);
        seen.open(&mut ()).expect("a start");
        while !seen.is_finished() {
            let telemetry = seen.telemetry(&layout).expect("numbers");
            assert_eq!(telemetry.law_inputs.len(), total_width(&layout.law_inputs), "{name}");
            let mut inputs = telemetry.law_inputs.iter();
            for field in &layout.law_inputs {
                // A condition that is not tested now compares nothing.
                let may_be_none = field.name == "readings";
                let mut own = inputs.by_ref().take(total_width(std::slice::from_ref(field)));
                assert!(own.all(|value| may_be_none || value.is_finite()), "{name} {}", field.name);
            }
            for (sensor, read) in pairs(layout.sensors.iter(), &telemetry.sensors) {
                assert_eq!(read.values.len(), total_width(&sensor.fields), "{name} {}", sensor.group);
                assert!(read.at.is_none_or(|at| at <= seen.time()), "{name} {}", sensor.group);
            }
            let until = seen.time() + Span::from_seconds(0.3);
            for simulation in [&mut seen, &mut unseen] {
                simulation.open(&mut ()).expect("a start");
                simulation.set_external_command([Command::Torque(1e-4); 3]);
                simulation.run_up_to(until, &mut ()).expect("a piece");
            }
        }
        assert_eq!(row(&mut seen, &scenario), row(&mut unseen, &scenario), "{name}");
    }
}

#[test]
fn what_a_law_would_command_may_come_from_outside() {
    // The law of the four clamped modes: -30 p - 60 w, at most 1 N m, held for a second.
    let scenario = flown("four-clamped-modes", 60.0);
    let fields = Simulation::new(&scenario, 0).observation_fields(&scenario);
    let place = |name: &str| -> usize {
        let found = fields.iter().position(|field| field.name == name).expect("a field");
        total_width(&fields[..found])
    };
    let (attitude, rate) = (place("attitude"), place("rate"));
    let mut whole = Simulation::new(&scenario, 0);
    let mut steered = Simulation::new(&scenario, 0);
    let mut row = vec![0.0; total_width(&fields)];
    for second in 1..=60 {
        steered.open(&mut ()).expect("a start");
        steered.observe(&mut row).expect("numbers");
        let torque = |axis: usize| {
            let p = row[attitude + 1 + axis] / (1.0 + row[attitude]);
            (-30.0 * p - 60.0 * row[rate + axis]).clamp(-1.0, 1.0)
        };
        steered.set_external_command([0, 1, 2].map(|axis| Command::Torque(torque(axis))));
        steered.run_up_to(at(f64::from(second)), &mut ()).expect("a step");
    }
    whole.run(&mut ()).expect("a run");
    let (one, other) = (whole.three_axis_state().expect("axes"), steered.three_axis_state().expect("axes"));
    let off = (one.turn.attitude - other.turn.attitude).norm();
    assert!(off < 1e-10, "{off:e}");
    for (one, other) in pairs(one.modes.iter(), &other.modes) {
        assert!((one.displacement - other.displacement).abs() < 1e-9, "{one:?} {other:?}");
    }
}

#[test]
fn a_command_acts_from_the_instant_at_which_the_run_stands() {
    // The hold takes what is commanded at the start of each of its periods of 0.5 s.
    let text = "duration = 4.0\n[law.open]\n[body.planar]\ninertia = 2.0\n[actuator.hold]\nperiod = 0.5";
    let scenario = Scenario::parse("hold.toml", text).expect("a scenario");
    let mut simulation = Simulation::new(&scenario, 0);
    let rate = |simulation: &Simulation| simulation.state().expect("one angle").rigid_rate;
    for (until, torque, expected) in [(0.5, 2.0, 0.5), (1.0, -4.0, -0.5), (1.25, 0.0, -0.5), (2.0, 8.0, 1.5)]
    {
        simulation.set_external_command([Command::Torque(torque); 3]);
        simulation.run_up_to(at(until), &mut ()).expect("a step");
        assert!((rate(&simulation) - expected).abs() < 1e-15, "{until}: {}", rate(&simulation));
    }
    // Commands stay; the whole of the rest is one period after the other.
    simulation.run(&mut ()).expect("the rest");
    assert!(simulation.is_finished());
    assert!((rate(&simulation) - 9.5).abs() < 1e-14, "{}", rate(&simulation));
}

#[test]
fn runs_stop_at_what_comes_next() {
    let scenario = flown("relay-adaptive", 2500.0);
    let mut trace = Trace::new(Detail::Events);
    Simulation::new(&scenario, 0).run(&mut trace).expect("a run");
    let times = |topic: &str, name: &str| {
        trace.topic(topic).and_then(|rows| rows.numbers(name)).expect("a column").to_vec()
    };
    let stops = |occasion: StopAt| {
        let mut simulation = Simulation::new(&scenario, 0);
        let mut stops = Vec::new();
        while simulation.run_to_next(occasion, Instant::END, &mut ()).expect("a run") {
            stops.push(simulation.time().seconds());
        }
        assert!(simulation.is_finished());
        stops
    };
    assert_eq!(stops(StopAt::Switching), times("/command", "time_s"));
    assert!(stops(StopAt::Decision).len() >= stops(StopAt::Switching).len());
    assert_eq!(stops(StopAt::Window), [500.0, 1000.0, 1500.0, 2000.0, 2500.0]);
    assert_eq!(stops(StopAt::Sample), [0.0; 0], "its sensor measures at every instant");
    let scenario = flown("relay-sampled", 10.0);
    let mut simulation = Simulation::new(&scenario, 0);
    assert!(simulation.run_to_next(StopAt::Sample, Instant::END, &mut ()).expect("a run"));
    let first = simulation.time().seconds();
    assert!(first > 0.0 && !simulation.run_to_next(StopAt::Sample, at(1.5 * first), &mut ()).expect("a run"));
    assert_eq!(simulation.time(), at(1.5 * first));
}
