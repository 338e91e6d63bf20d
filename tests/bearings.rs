//! Real wheels: the shipped scenarios do what their comments say, tachometers are read, and impossible settings are
//! refused.

use flexsc_core::metrics::{MetricValue, Metrics};
use flexsc_core::record::{Column, Detail, Trace};
use flexsc_core::scenario::Scenario;

use crate::study::pairs;
use crate::traces::{column, flown, traced, within};
use crate::util::SCENARIOS;

fn text(name: &str) -> String {
    std::fs::read_to_string(format!("{SCENARIOS}/{name}.toml")).expect("a file")
}

/// Returns a shipped scenario with some of its words changed.
fn changed(name: &str, change: &[(&str, &str)]) -> Scenario {
    let mut text = text(name);
    for (from, to) in change {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    Scenario::parse("wheels.toml", &text).expect("a scenario")
}

/// Returns a count of each of the wheels' events.
fn counts(trace: &Trace, name: &str) -> Vec<u64> {
    let rows = trace.topic("/wheel_events").expect("events");
    let Some(Column::Counts(counts)) = rows.get(name) else { panic!("{name}") };
    counts.clone()
}

/// Returns a number of each wheel in each row, wheel by wheel within a row.
fn of_wheels<'a>(trace: &'a Trace, topic: &str, name: &str) -> &'a [f64] {
    within(trace, topic, "wheels", name)
}

/// Returns the largest pointing error about any axis from a time on (rad).
fn worst(trace: &Trace, from: f64) -> f64 {
    let period = 0.25;
    let errors =
        ["roll", "pitch", "yaw"].map(|axis| column(trace, "/pointing", &format!("{axis}_error_rad")));
    let rows = (0..errors[0].len()).filter(|row| period * *row as f64 >= from);
    rows.flat_map(|row| errors.each_ref().map(|of| of[row].abs())).fold(0.0, f64::max)
}

const COMPENSATED: (&str, &str) =
    ("friction = {", "compensation = { coulomb = 3.6e-3, viscous = 4.5e-5 }\nfriction = {");
const SILENT: (&str, &str) =
    ("angle_random_walk = 3e-6, rate_random_walk = 1e-8", "angle_random_walk = 1e-9");

#[test]
fn wheels_pass_through_zero_and_compensation_helps() {
    let (metrics, trace) = flown(&changed("wheel-friction", &[]), 0, Detail::Full);
    let (wheels, times) = (counts(&trace, "wheel"), column(&trace, "/wheel_events", "time_s"));
    assert_eq!(metrics.number("wheel_zero_crossings"), Some(times.len() as f64));
    let first: Vec<f64> =
        times.iter().zip(wheels).filter(|(_, wheel)| *wheel == 0).map(|(t, _)| *t).collect();
    assert!(
        first.len() == 2 && (40.0..50.0).contains(&first[0]) && (170.0..190.0).contains(&first[1]),
        "{times:?}"
    );
    // The heat is the work of friction: t |Omega| and c Omega² over the run.
    let (speeds, heat) =
        (of_wheels(&trace, "/wheels", "speed_rad_s"), of_wheels(&trace, "/bearings", "heat_j"));
    let lost: f64 = speeds.iter().map(|speed| 0.25 * (4e-3 * speed.abs() + 5e-5 * speed * speed)).sum();
    let total: f64 = heat[heat.len() - 4..].iter().sum();
    assert!((lost / total - 1.0).abs() < 1e-2, "{lost} {total}");
    assert_eq!(metrics.number("friction_heat_j"), Some(total));
    let goal = |change: &[(&str, &str)]| flown(&changed("wheel-friction", change), 0, Detail::Events).0;
    let met = |metrics: &Metrics| metrics.get("goal") == Some(&MetricValue::Word("met"));
    assert!(!met(&metrics) && met(&goal(&[COMPENSATED])));
    let faster = ("speeds = [40, -40, 40, -40] ", "speeds = [200, -200, 200, -200] ");
    assert!(met(&goal(&[faster])));
    // Without noise of the gyro the error is that of friction.
    let error = |change: &[(&str, &str)]| worst(&traced(&changed("wheel-friction", change)), 30.0);
    let (plain, helped) = (error(&[SILENT]), error(&[SILENT, COMPENSATED]));
    // 1.5 mrad, as the comment says; nine tenths of the friction are compensated, and 0.16 of the error is
    // left.
    assert!((1.4e-3..1.6e-3).contains(&plain) && helped < 0.2 * plain, "{plain:e} {helped:e}");
}

#[test]
fn a_run_repeats_whatever_is_looked_at() {
    let scenario = changed("wheel-friction", &[("duration = 300.0", "duration = 60.0")]);
    let (full, trace) = flown(&scenario, 0, Detail::Full);
    let (quiet, events) = flown(&scenario, 0, Detail::Events);
    assert_eq!(full.to_json(), quiet.to_json());
    let times = |trace: &Trace| counts(trace, "time_fs");
    assert_eq!(times(&trace), times(&events));
    let mut often = scenario.clone();
    often.written.log.period = Some(flexsc_core::numerics::time::Span::from_seconds(0.013));
    assert_eq!(full.to_json(), flown(&often, 0, Detail::Full).0.to_json());
}

/// A tachometer of few pulses reads whole pulses; while it fails the drives keep the last reading.
#[test]
fn drives_know_what_tachometers_read() {
    let scenario = changed(
        "wheel-friction",
        &[
            ("duration = 300.0", "duration = 40.0"),
            ("pulses = 360 }", "pulses = 24, faults = [{ silent = { from = 10.01, to = 20.01 } }] }"),
            COMPENSATED,
        ],
    );
    let trace = traced(&scenario);
    let (known, speeds) =
        (of_wheels(&trace, "/bearings", "known_rad_s"), of_wheels(&trace, "/wheels", "speed_rad_s"));
    let quantum = std::f64::consts::TAU / 24.0 / 0.05;
    for (row, (known, speeds)) in pairs(known.chunks(4), speeds.chunks(4)).enumerate().skip(1) {
        let t = 0.25 * row as f64;
        for (known, speed) in pairs(known, speeds) {
            assert!((known / quantum - (known / quantum).round()).abs() < 1e-9);
            let late = if (10.0..20.0).contains(&t) { 4.0 } else { 0.1 };
            assert!((known - speed).abs() < quantum + late, "{t}: {known} {speed}");
        }
    }
    assert_eq!(known[4 * 44..4 * 45], known[4 * 79..4 * 80], "kept while it fails");
}

/// The elastic rates are largest where a line passes the mode at 92.9 rad/s: twice the speed at 46 rad/s, then the
/// speed itself.
#[test]
fn a_run_up_shakes_the_modes_that_it_passes() {
    let (metrics, trace) = flown(&changed("wheel-run-up", &[]), 0, Detail::Full);
    let speeds: Vec<f64> = of_wheels(&trace, "/wheels", "speed_rad_s").iter().step_by(4).copied().collect();
    let elastic = within(&trace, "/rates", "axes", "elastic_rad_s");
    let size: Vec<f64> = elastic.chunks(3).map(|of| of.iter().map(|x| x * x).sum::<f64>().sqrt()).collect();
    let most = |from: f64, to: f64| {
        let rows = speeds.iter().zip(&size).filter(|(speed, _)| (from..to).contains(*speed));
        rows.map(|(_, size)| *size).fold(0.0, f64::max)
    };
    // Near its line at 47 rad/s the mode swings 10 and 4 times as far as beside it, at half of it 13 and 5
    // times.
    assert!(most(45.0, 49.0) > 4.0 * most(35.0, 40.0) && most(45.0, 49.0) > 3.0 * most(50.0, 54.0));
    assert!(most(91.0, 95.0) > 8.0 * most(80.0, 84.0) && most(91.0, 95.0) > 5.0 * most(98.0, 110.0));
    // 115 - 85 exp(-2.4) rad/s.
    assert!((speeds.last().expect("rows") - 107.3).abs() < 0.2, "{:?}", speeds.last());
    assert_eq!(metrics.get("goal"), Some(&MetricValue::Word("met")));
    assert_eq!(metrics.number("wheel_zero_crossings"), None, "there is no friction");
}

#[test]
fn what_cannot_be_is_refused() {
    let refused = |name: &str, from: &str, to: &str, key: &str, why: &str| {
        let text = text(name);
        assert!(text.contains(from), "{from}");
        let error = Scenario::parse("w.toml", &text.replace(from, to)).expect_err(to).to_string();
        assert!(error.contains(key) && error.contains(why), "{error}");
    };
    let friction = "friction = { coulomb = 4e-3, viscous = 5e-5 }";
    let with = |keys: &str| format!("friction = {{ {keys} }}");
    let name = "wheel-friction";
    refused(name, friction, &with("coulomb = [1e-3, 2e-3]"), "friction.coulomb", "one for each of 4 wheels");
    refused(
        name,
        friction,
        &with("coulomb = 2e-3, breakaway = 1e-3"),
        "friction.breakaway",
        "at least `coulomb`",
    );
    let tachometer = "tachometer = { period = 0.05, pulses = 360 }";
    refused(name, tachometer, "tachometer = { period = 0.05, pulses = 0 }", "pulses", "from 1 to 4294967295");
    let two = format!("{tachometer}\n[[sensor]]\n{tachometer}");
    refused(name, tachometer, &two, "tachometer", "on each wheel already");
    let spatial = "[body.spatial]\ninertia = [[100, 0, 0], [0, 80, 0], [0, 0, 60]]\npoints = [{ name = \"hub\" }]\n\
                   [law.attitude]\nperiod = 0.25\nbandwidth = 0.1\n";
    let parse = |rest: &str| {
        Scenario::parse("w.toml", &format!("duration = 10.0\n{rest}")).expect_err("refused").to_string()
    };
    let wheels = "[actuator.wheels]\narrangement = \"orthogonal\"\ninertia = 0.01\n";
    let error = parse(&format!("{spatial}{wheels}friction = {{ coulomb = 1e-3 }}\n"));
    assert!(error.contains("actuator.wheels.friction") && error.contains("[spacecraft]"), "{error}");
    let both = "sensor = [\"continuous\", { tachometer = { period = 0.1 } }]\n";
    let error = parse(&format!("{both}{spatial}{wheels}"));
    assert!(error.contains("sensor[1].tachometer") && error.contains("[spacecraft]"), "{error}");
    let error = parse(&format!("{both}{spatial}"));
    assert!(error.contains("sensor[1].tachometer") && error.contains("there are none"), "{error}");
    let error = parse(&format!("sensor = {{ tachometer = {{ period = 0.1 }} }}\n{spatial}{wheels}"));
    assert!(error.contains("sensor.tachometer") && error.contains("measures only wheels"), "{error}");
}
