//! Flight code of whole CubeSats: B-dot and attitude laws under one supervisor, wheels, and the magnetorquers that unload them.

use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{Magnetorquers, Pointing, Record, RecordError, Sample, Wheels};
use flexsc_core::{Scenario, Simulation};
use flexsc_export_c::control_system::ControlSystem;
use flexsc_export_c::vectors;

use crate::day_balance::SHORT;
use crate::flight_exports::{hashes, is_installed, make, text};
use crate::util::Dir;

/// Scenarios with detumbling, all of whose loop is exported, and what shortens them.
const WHOLE: [(&str, &[(&str, &str)]); 3] = [
    ("cubesat-day", &SHORT),
    (
        "detumble-and-point",
        &[
            ("duration = 12000.0", "duration = 7000.0"),
            ("assess = [600.0, 12000.0]", "assess = [600.0, 7000.0]"),
        ],
    ),
    ("safe-mode", &[("period = 5.0\n\n[reference]", "period = 0.5\n\n[reference]")]),
];

/// Returns a directory with a shortened scenario.
fn shortened(name: &str, changes: &[(&str, &str)]) -> Dir {
    let dir = Dir::with(&[name]);
    let file = format!("{name}.toml");
    let mut text = dir.text(&file);
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    dir.write(&file, text);
    dir
}

/// Rows of a log: time, torques of the wheels (N m) and moments of the magnetorquers (A m²).
#[derive(Default)]
struct Rows(Vec<(Instant, [f64; 3], [f64; 3])>);

impl Record for Rows {
    fn wants_motion(&self) -> bool {
        true
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        let Sample::Report(report) = sample else { return Ok(()) };
        if report.get::<Pointing>().is_none() {
            return Ok(());
        }
        let wheels = report.get::<Wheels>().expect("wheels");
        let torquers = report.get::<Magnetorquers>().expect("magnetorquers");
        let torques = [0, 1, 2].map(|wheel: usize| wheels.wheels[wheel].torque_nm);
        let moments = [0, 1, 2].map(|axis: usize| torquers.axes[axis].moment_am2);
        self.0.push((now, torques, moments));
        Ok(())
    }
}

#[test]
fn the_rows_of_wheels_and_magnetorquers_are_those_of_the_flight_code() {
    for (name, changes) in WHOLE {
        let dir = shortened(name, changes);
        let scenario = Scenario::load(&dir.path(&format!("{name}.toml"))).expect("a scenario");
        let mut rows = Rows::default();
        Simulation::new(&scenario, 0).run(&mut rows).expect("a run");
        let system = ControlSystem::new(&scenario).expect("an exportable scenario");
        let calls = vectors::record(&scenario, 1_000_000).expect("equal commands");
        let layouts = system.calls();
        let (mut torque, mut moment) = ([0.0; 3], [0.0; 3]);
        let (mut place, mut compared, mut moments) = (0, 0, 0);
        for (now, torques, torquers) in &rows.0 {
            let until = now.ticks();
            while place < calls.len() && !until.is_before(calls[place].now) {
                let mut words = calls[place].outputs.iter();
                for channel in &layouts[calls[place].call].outputs {
                    let values: Vec<f64> =
                        words.by_ref().take(channel.count).map(|word| f64::from_bits(*word)).collect();
                    match channel.name.as_str() {
                        "wheel_torque" => torque.copy_from_slice(&values),
                        "moment" => moment.copy_from_slice(&values),
                        _ => {}
                    }
                }
                place += 1;
            }
            assert_eq!((*torques, *torquers), (torque, moment), "{name} at {} s", now.seconds());
            compared += usize::from(torque != [0.0; 3]);
            moments += usize::from(moment != [0.0; 3]);
        }
        assert!(compared > 100 && moments > 100, "{name}: {compared} and {moments} of {} rows", rows.0.len());
    }
}

#[test]
fn exports_of_whole_cubesats_are_complete_and_replay_their_run() {
    if !is_installed("make") || !is_installed("gcc") || !is_installed("g++") {
        return;
    }
    for (name, changes) in &WHOLE[..2] {
        let dir = shortened(name, changes);
        dir.run(&format!(
            "export-c {name}.toml -o out --name sat --calls 100000 --complete --guest cfs --guest fprime"
        ))
        .exits(0)
        .says(&["sat_field", "sat_unload", "input of it: target"]);
        let hash = format!("HASH={}", hashes(&dir, "out")[&20_000]);
        let said = text(&make(&dir, "out", &["check-gcc", "LEVELS=-O3", "CYCLES=20000", &hash]));
        assert!(said.contains(" calls equal") && said.contains("20000 cycles"), "{name}: {said}");
        for (guest, words) in
            [("cfs", "calls equal through messages"), ("fprime", "calls equal through ports")]
        {
            let said = text(&make(&dir, &format!("out/{guest}"), &["check"]));
            assert!(said.contains(words), "{name}: {said}");
        }
    }
}

#[test]
fn what_is_left_out_of_an_unloaded_wheel_is_said() {
    let dir = Dir::with(&["orbit-correction"]);
    dir.run("export-c orbit-correction.toml -o out --calls 10 --complete").exits(2).says(&[
        "actuator",
        "jets",
        "is not part of the exported code",
    ]);
    assert!(!dir.has("out"));
}
