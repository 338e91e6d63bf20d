//! Rules of time: crossings are found where they are, and recording does not change a run.

use std::convert::Infallible;

use flexsc_core::control::law::{Command, DecisionCause, Setpoint};
use flexsc_core::control::state_estimate::StateEstimate;
use flexsc_core::dynamics::crossing::first_crossing;
use flexsc_core::dynamics::flow::{SegmentInput, UncoupledSegment};
use flexsc_core::dynamics::guard::Guard;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{Column, Columns, Detail, Trace};
use flexsc_core::{Scenario, Simulation, SimulationError};

use crate::util::SCENARIOS;

const RELAY: &str =
    "[law.relay]\ndead_zone = 5e-4\nhysteresis = 1e-4\nstrong = 4e-5\nweak = 1e-6\nk_t = 0.31\n";

fn scenario(text: &str) -> Scenario {
    Scenario::parse("test.toml", text).expect("a valid scenario")
}

#[test]
fn a_tangent_touch_is_found() {
    // The body turns round a ten-thousandth of the last bit of its angle beyond the level: 1e-4 + v²/2m.
    let text = format!("duration = 1.0\n[body.planar]\nangle = 1e-4\nrate = 1e-5\n{RELAY}");
    let scenario = scenario(&text);
    let body = scenario.one_angle().expect("one angle");
    let mut segment = UncoupledSegment::new(body);
    let state = body.initial_state();
    segment.depart(&state, &SegmentInput::constant(-1e-6));
    let peak = 1e-4 + 1e-5 * 1e-5 / (2.0 * 1e-6);
    let mut there = state.clone();
    let horizon = Span::from_seconds(100.0);
    let below = first_crossing(&segment, &[Guard::at_least(peak - 1e-18)], horizon, &mut there, || {
        Ok::<_, Infallible>(())
    });
    let below = below.expect("not stopped").expect("a touch");
    assert!((below.after.seconds() - 10.0).abs() < 2e-6, "{}", below.after.seconds());
    let above = first_crossing(&segment, &[Guard::at_least(peak + 1e-18)], horizon, &mut there, || {
        Ok::<_, Infallible>(())
    });
    assert_eq!(above.expect("not stopped"), None);
}

#[test]
fn a_guard_that_holds_trips_at_once() {
    let scenario = scenario(&format!("duration = 1.0\n[body.planar]\nangle = 1e-4\n{RELAY}"));
    let body = scenario.one_angle().expect("one angle");
    let mut segment = UncoupledSegment::new(body);
    let state = body.initial_state();
    segment.depart(&state, &SegmentInput::constant(0.0));
    let mut there = state.clone();
    let guards = [Guard::at_most(0.0), Guard::at_least(1e-4)];
    let trip =
        first_crossing(&segment, &guards, Span::from_seconds(1.0), &mut there, || Ok::<_, Infallible>(()));
    let trip = trip.expect("not stopped").expect("a trip");
    assert_eq!((trip.after, trip.guard), (Span::ZERO, 1));
}

#[test]
fn a_crossing_beyond_64_bits_of_femtoseconds_is_found() {
    let text = format!("duration = 1.0\n[body.planar]\nrate = 1e-9\n{RELAY}");
    let scenario = scenario(&text);
    let body = scenario.one_angle().expect("one angle");
    let mut segment = UncoupledSegment::new(body);
    let state = body.initial_state();
    segment.depart(&state, &SegmentInput::constant(0.0));
    let mut there = state.clone();
    let guards = [Guard::at_least(5e-4)];
    let trip =
        first_crossing(&segment, &guards, Span::from_seconds(1e6), &mut there, || Ok::<_, Infallible>(()));
    let trip = trip.expect("not stopped").expect("a trip");
    assert!((trip.after.seconds() - 5e5).abs() < 1e-9);
    let none =
        first_crossing(&segment, &guards, Span::from_seconds(4.9e5), &mut there, || Ok::<_, Infallible>(()));
    assert_eq!(none.expect("not stopped"), None);
}

const FLEXIBLE: &str = "
[body.planar]
angle = 4.5e-4
rate = 2.2e-5
modes = [
    { frequency = 0.44, gain = 0.0213, displacement = 2.75e-6 },
    { frequency = 0.755, gain = 0.0216, damping = 0.002 },
]
";

fn commands(trace: &Trace) -> Columns {
    trace.topic("/command").expect("a topic").clone()
}

#[test]
fn watching_a_run_does_not_change_it() {
    let plain = scenario(&format!("duration = 3000\n{FLEXIBLE}{RELAY}"));
    let mut events = Trace::new(Detail::Events);
    Simulation::new(&plain, 0).run(&mut events).expect("a run");

    // A dense record, an observer with its windows, and stops on the way.
    let watched = scenario(&format!(
        "duration = 3000\n{FLEXIBLE}{RELAY}[log]\nperiod = 0.37\n[estimator.envelope]\nwindow = 61.7\n"
    ));
    let mut full = Trace::new(Detail::Full);
    let mut simulation = Simulation::new(&watched, 0);
    for stop in 1..=30 {
        let until = Instant::START + Span::from_seconds(100.0 * f64::from(stop));
        simulation.run_until(until, &mut full).expect("a run");
    }
    assert_eq!(commands(&events), commands(&full));
    assert!(full.topic("/attitude").expect("a topic").len() > 8000);
}

#[test]
fn a_run_ends_at_its_end() {
    let scenario = scenario(&format!("duration = 100\n{FLEXIBLE}{RELAY}"));
    let (mut whole, mut beyond) = (Trace::new(Detail::Full), Trace::new(Detail::Full));
    Simulation::new(&scenario, 0).run(&mut whole).expect("a run");
    let until = Instant::START + Span::from_seconds(150.0);
    Simulation::new(&scenario, 0).run_until(until, &mut beyond).expect("a run");
    assert_eq!(commands(&whole), commands(&beyond));
    assert_eq!(whole.topic("/rate"), beyond.topic("/rate"));
}

#[test]
fn a_sampled_sensor_trips_guards_at_samples() {
    let text = format!("duration = 500\n{FLEXIBLE}{RELAY}[sensor.sampled]\nperiod = 0.25\n");
    let mut trace = Trace::new(Detail::Events);
    Simulation::new(&scenario(&text), 0).run(&mut trace).expect("a run");
    let commands = commands(&trace);
    let (Some(Column::Labels(causes, labels)), Some(Column::Counts(parts))) =
        (commands.get("cause"), commands.get("time_fs"))
    else {
        panic!("no columns")
    };
    let (mut guards, mut timeouts) = (0, 0);
    for (cause, part) in causes.iter().zip(parts) {
        if labels[usize::from(*cause)] == "guard" {
            guards += 1;
            assert_eq!(part % 250_000_000_000_000, 0, "a guard tripped between samples");
        } else {
            timeouts += 1;
        }
    }
    assert!(guards > 30 && timeouts > 15, "{guards} {timeouts}");
}

#[test]
fn chatter_is_an_error() {
    // A weak torque of nothing and a brake shorter than a tick: the law switches for ever at one instant.
    let text = "duration = 10\n[body.planar]\nangle = 5e-4\nrate = 0.0\n[law.relay]\ndead_zone = 5e-4\n\
                hysteresis = 1e-300\nstrong = 4e-5\nweak = 1e-6\nk_t = 1e-3\n";
    let error = Simulation::new(&scenario(text), 0).run(&mut ()).expect_err("chatter");
    assert!(matches!(error, SimulationError::Chatter { .. }), "{error}");
    assert!(error.to_string().contains("t = 0.000000000000000 s"), "{error}");
}

#[test]
fn switching_much_faster_than_any_mode_is_an_error() {
    // The quick push of a huge torque; the modes have periods of 14.3 and 8.3 s.
    let shipped = std::fs::read_to_string(format!("{SCENARIOS}/relay-fixed.toml")).expect("shipped");
    let run = |text: &str| Simulation::new(&scenario(text), 0).run(&mut ());
    let quick = shipped.replace("strong = 4e-5", "strong = 1e12");
    let error = run(&quick).expect_err("chatter");
    assert!(matches!(error, SimulationError::LawChatter { .. }), "{error}");
    // It is the same error from the loop, which a log of rows at fixed times has from the start on.
    let mut rows = Trace::new(Detail::Full);
    let reported = Simulation::new(&scenario(&quick), 0).run(&mut rows).expect_err("chatter");
    assert_eq!(reported.to_string(), error.to_string());
    // A relay that is a million times as strong switches often, and is none.
    run(&shipped.replace("strong = 4e-5", "strong = 40.0").replace("duration = 20000.0", "duration = 20.0"))
        .expect("a run");
}

#[test]
fn a_state_that_overflows_is_an_error() {
    let text = format!("duration = 1e10\n[body.planar]\nangle = 1e-4\nrate = 1e300\n{RELAY}")
        .replace("strong = 4e-5", "strong = 1e-300");
    let error = Simulation::new(&scenario(&text), 0).run(&mut ()).expect_err("an overflow");
    assert!(matches!(error, SimulationError::NonFinite { .. }), "{error}");
}

#[test]
fn the_brake_keeps_the_gain_that_it_began_with() {
    let study = scenario(&format!("duration = 1\n{FLEXIBLE}{RELAY}"));
    let mut law = study.law.start(&study.study.authorities[0]);
    let at = |seconds| Instant::START + Span::from_seconds(seconds);
    let estimate = StateEstimate { angle: 6e-4, ..StateEstimate::default() };
    let push = law.decide(at(0.0), DecisionCause::Start, &Setpoint::default(), &estimate);
    assert_eq!(push.command, Command::Torque(-4e-5));
    law.tune("k_t", 0.25);
    let brake = law.decide(at(4.0), DecisionCause::Guard(0), &Setpoint::default(), &estimate);
    assert_eq!((brake.command, brake.until), (Command::Torque(4e-5), Some(at(5.0))));
    law.tune("k_t", 0.9);
    let coast = law.decide(at(5.0), DecisionCause::Timeout, &Setpoint::default(), &estimate);
    assert_eq!((coast.command, coast.until, coast.guards.len()), (Command::Torque(1e-6), None, 2));
}
