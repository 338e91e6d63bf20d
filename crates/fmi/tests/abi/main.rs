//! FMUs through their C functions: equal to the native run in every bit, with and without events.

#![cfg(unix)]
#![expect(clippy::macro_metavars_in_unsafe, reason = "the macro names the types of a C function")]
#![expect(unsafe_code, reason = "the tests call the C functions of the library")]

mod absent;
mod controller;
mod fmi2;
mod importer;
mod refusals;
mod sequences;
mod states;

use flexsc_core::control::law::Command;
use flexsc_core::control::quantity::total_width;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{Column, Columns, Detail, Trace};
use flexsc_core::{Scenario, Simulation, StopAt};
use flexsc_cosim::FmuPart;
use importer::{Fmu3, shipped};

/// Rows of a topic of a native run.
fn native(scenario: &Scenario, topic: &str) -> Columns {
    let mut trace = Trace::new(Detail::Full);
    Simulation::new(scenario, 0).run(&mut trace).expect("a run");
    trace.topic(topic).expect("a topic").clone()
}

/// Bits of the switchings of a native run: exact time, angle and rate.
fn switchings(scenario: &Scenario) -> Vec<[u64; 4]> {
    let rows = native(scenario, "/command");
    let column = |name: &str| rows.numbers(name).expect(name).to_vec();
    let (angle, rate) = (column("angle_rad"), column("rate_rad_s"));
    let count = |name: &str| match rows.get(name) {
        Some(Column::Counts(values)) => values.clone(),
        _ => panic!("{name}"),
    };
    let (whole, part) = (count("time_whole_s"), count("time_fs"));
    (0..angle.len()).map(|row| [whole[row], part[row], angle[row].to_bits(), rate[row].to_bits()]).collect()
}

/// Keys by which the law and the sensor of a wheel's loop act each 0.3 s.
const OFTEN: [(&str, &str); 2] = [("law.pd.period", "0.3"), ("sensor.sampled.period", "0.3")];

#[test]
fn events_of_a_relay_equal_those_of_the_native_run() {
    let scenario = shipped("relay-fixed", &[("duration", "1000.0")]);
    let expected = switchings(&scenario);
    assert!(expected.len() > 100, "{}", expected.len());
    for size in [0.1, 0.37, 1.0 / 3.0, 1000.0] {
        let fmu = Fmu3::new(&scenario, FmuPart::Loop, true);
        fmu.begin(None);
        let mut found = Vec::new();
        fmu.run(1000.0, size, true, |fmu, point| {
            if point.is_none() && fmu.ticks("switched") {
                let [whole, part] = fmu.integers(["event_whole_s", "event_fs"]).map(|value| value as u64);
                let [angle, rate] = fmu.reals(["state.angle", "state.rate"]).map(f64::to_bits);
                found.push([whole, part, angle, rate]);
            }
        });
        assert_eq!(found, expected, "{size}");
        assert_eq!(fmu.integers(["switchings"]), [expected.len() as i64]);
    }
}

#[test]
fn points_are_equal_with_and_without_events() {
    for (name, keys) in [
        ("relay-fixed", ["duration", "300.0"]),
        ("wheel-fixed-gain", ["duration", "60.0"]),
        ("earth-observer", ["duration", "20.0"]),
        ("station-keeping", ["duration", "60.0"]),
    ] {
        let scenario = shipped(name, &[(keys[0], keys[1])]);
        let end = scenario.duration.seconds();
        for size in [0.1, 0.37] {
            let mut all = [Vec::new(), Vec::new()];
            for (uses_events, points) in [true, false].into_iter().zip(&mut all) {
                let fmu = Fmu3::new(&scenario, FmuPart::Loop, uses_events);
                let names: Vec<String> = fmu.table.variables().iter().map(|of| of.name.clone()).collect();
                let names: Vec<&str> =
                    names.iter().map(String::as_str).filter(|of| of.starts_with("state.")).collect();
                fmu.begin(None);
                fmu.run(end, size, uses_events, |fmu, point| {
                    if point.is_some() {
                        points.extend(names.iter().map(|name| fmu.reals([name])[0].to_bits()));
                        points.push(fmu.integers(["events"])[0] as u64);
                    }
                });
            }
            assert!(all[0].len() > 50 && all[0] == all[1], "{name} {size}");
        }
    }
}

#[test]
fn the_end_of_an_fmu_is_that_of_the_native_run() {
    for name in ["wheel-ekf", "earth-observer"] {
        let scenario = shipped(name, &[("duration", "30.0")]);
        let mut run = Simulation::new(&scenario, 0);
        run.run(&mut ()).expect("a run");
        let width = total_width(&run.observation_fields(&scenario));
        let mut expected = vec![0.0; width];
        run.observe(&mut expected).expect("a state");
        let fmu = Fmu3::new(&scenario, FmuPart::Loop, false);
        fmu.begin(None);
        fmu.run(30.0, 0.5, false, |_, _| {});
        for (variable, expected) in fmu.table.variables()[1..].iter().zip(&expected) {
            let [value] = fmu.reals([&variable.name]);
            assert_eq!(value.to_bits(), expected.to_bits(), "{name} {}", variable.name);
        }
    }
}

#[test]
fn a_plant_is_commanded_at_its_samples() {
    let scenario = shipped("wheel-fixed-gain", &[("duration", "40.0"), OFTEN[0], OFTEN[1]]);
    let command = |angle: f64, rate: f64| -0.5 * angle - 2.0 * rate;
    let mut run = Simulation::new(&scenario, 0);
    let mut expected = Vec::new();
    run.set_external_command([Command::Torque(0.0); 3]);
    let width = total_width(&run.observation_fields(&scenario));
    let mut row = vec![0.0; width];
    while run.run_to_next(StopAt::Sample, Instant::END, &mut ()).expect("a run") && !run.is_finished() {
        run.observe(&mut row).expect("a state");
        let [angle, rate] = [row[width - 4], row[width - 3]];
        run.set_external_command([
            Command::Torque(command(angle, rate)),
            Command::Torque(0.0),
            Command::Torque(0.0),
        ]);
        expected.push((run.time().parts(), angle.to_bits(), row[0].to_bits()));
    }
    let fmu = Fmu3::new(&scenario, FmuPart::Plant, true);
    fmu.begin(None);
    let mut found = Vec::new();
    fmu.run(39.95, 7.99, true, |fmu, point| {
        if point.is_none() && fmu.ticks("sampled") {
            let [angle, rate, truth] = fmu.reals(["measured.angle", "measured.rate", "state.angle"]);
            assert_eq!(fmu.set("command", command(angle, rate)), 0);
            let [whole, part] = fmu.integers(["time_whole_s", "time_fs"]);
            found.push(((whole as u64, part as u64), angle.to_bits(), truth.to_bits()));
        }
    });
    assert!(found.len() > 30, "{}", found.len());
    assert_eq!(found, expected[..found.len()]);
}

#[test]
fn an_external_torque_acts_from_its_communication_point() {
    let text = "duration = 10.0\n[law.open]\n[body.planar]\ninertia = 2.0";
    let scenario = Scenario::parse("pushed.toml", text).expect("a scenario");
    for uses_events in [false, true] {
        let fmu = Fmu3::new(&scenario, FmuPart::Loop, uses_events);
        fmu.begin(Some(20.0));
        fmu.run(4.0, 4.0, uses_events, |fmu, _| {
            assert_eq!(fmu.set("disturbance_torque", 0.5), 0);
        });
        // The stop time extends the run.
        assert_eq!(fmu.step(4.0, 12.0).status, 0);
        let [rate] = fmu.reals(["state.rigid_rate"]);
        assert!((rate - 3.0).abs() < 1e-14, "{rate}");
    }
}

#[test]
fn a_grid_gives_points_the_samples_of_their_instants() {
    let scenario = shipped("wheel-fixed-gain", &[("duration", "400.0"), OFTEN[0], OFTEN[1]]);
    let period = scenario.study.sample_period.expect("sampled").seconds();
    let (mut run, mut row) = (Simulation::new(&scenario, 0), Vec::new());
    let width = total_width(&run.observation_fields(&scenario));
    row.resize(width, 0.0);
    let mut expected = Vec::new();
    for point in 1..=(400.0 / period) as i64 {
        let at = Instant::START + Span::from_femtoseconds(point * (period * 1e15).round() as i64);
        run.run_until(at, &mut ()).expect("a run");
        run.observe(&mut row).expect("a state");
        expected.push(row[width - 4].to_bits());
    }
    let missed = |grid: u64| {
        let fmu = Fmu3::new(&scenario, FmuPart::Loop, false);
        if grid > 0 {
            fmu.set_grid(grid);
        }
        fmu.begin(None);
        let mut missed = 0;
        fmu.run(399.9, period, false, |fmu, point| {
            let [angle] = fmu.reals(["measured.angle"]);
            missed += usize::from(point.is_some_and(|point| expected[point] != angle.to_bits()));
        });
        missed
    };
    assert_eq!(missed(1), 0);
    assert!(missed(0) > 0);
}

#[test]
fn clocks_have_exact_intervals() {
    let scenario = shipped("earth-observer", &[]);
    let fmu = Fmu3::new(&scenario, FmuPart::Loop, true);
    let exact =
        |span: Option<Span>| (span.expect("a period").leading_femtoseconds() as u64, 1_000_000_000_000_000);
    assert_eq!(fmu.interval("sampling"), exact(scenario.study.sample_period));
    assert_eq!(fmu.interval("deciding"), exact(scenario.study.law_period));
}
