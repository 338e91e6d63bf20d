//! Limits of wheels and jets in the metrics, and warnings of runs that end in saturation or in an oscillation.

use flexsc_core::metrics::{MetricValue, Metrics, MetricsCollector};
use flexsc_core::record::Detail;
use flexsc_core::{Scenario, Simulation};

use crate::traces::{flown, within};
use crate::util::Dir;

/// A rigid body that its wheels hold at rest; tests append to it.
fn body(bandwidth: f64, more: &str) -> String {
    format!(
        "duration = 400.0\n[spacecraft]\nmass = 100.0\ninertia = [[100, 0, 0], [0, 80, 0], [0, 0, 60]]\nrate = [0, 0, 1e-4]\n\
         [[sensor]]\ngyro = {{ period = 0.5 }}\n[law.attitude]\nperiod = 0.5\nbandwidth = {bandwidth}\n\
         [actuator.wheels]\narrangement = \"orthogonal\"\ninertia = 0.02\ntorque = 0.05\nmomentum = 10.0\n{more}"
    )
}

fn metrics(text: &str) -> Metrics {
    let scenario = Scenario::parse("a", text).expect("valid");
    let mut gather = MetricsCollector::new(&scenario);
    Simulation::new(&scenario, 0).run(&mut gather).expect("a run");
    gather.finish(&scenario)
}

fn word(metrics: &Metrics, name: &str) -> &'static str {
    match metrics.get(name) {
        Some(MetricValue::Word(word)) => word,
        other => panic!("{name}: {other:?}"),
    }
}

/// The sampled double integrator with gains w² and 2 zeta w is unstable where 2 zeta w T > 2: the wheels then alternate between
/// their torque limits.
#[test]
fn an_unstable_loop_is_reported() {
    let dir = Dir::holding("a.toml", body(4.0, ""));
    let reported = dir.run("simulate a.toml --log events").exits(0);
    reported.says(&["  ! the run ends in an oscillation that does not decay: ", "the last 40 s"]);
    let object = dir.run("simulate a.toml --log none --json").exits(0).json();
    assert_eq!(object["metrics"]["actuator_end"], "cycling");
    assert!(object["metrics"]["actuator_limit_late_share"].as_f64().expect("a share") > 0.5);
    assert!(object["warnings"][0].as_str().expect("a warning").contains("oscillation"));
    dir.run("export a.mcap --topic /log").exits(0).prints(&["warning", "does not decay", "actuators"]);

    let stable = Dir::holding("a.toml", body(0.1, ""));
    let object = stable.run("simulate a.toml --log none --json").exits(0).json();
    assert_eq!(object["metrics"]["actuator_end"], "free");
    assert!(object["warnings"].is_null());
}

/// The last tenth of 0.75 s has no cycle of 0.5 s.
#[test]
fn without_a_late_cycle_there_is_no_late_share() {
    let text = body(0.1, "").replace("duration = 400.0", "duration = 0.75");
    let (meaning, _) = metrics(&text)
        .0
        .into_iter()
        .find(|(meaning, _)| meaning.name == "actuator_limit_late_share")
        .expect("the metric");
    assert!(meaning.doc.contains("null if no cycle"), "{}", meaning.doc);
    let dir = Dir::holding("a.toml", text);
    let object = dir.run("simulate a.toml --log none --json").exits(0).json();
    assert!(object["metrics"]["actuator_limit_late_share"].is_null() && object["warnings"].is_null());
    assert_eq!(object["metrics"]["actuator_end"], "free");
}

#[test]
fn steady_saturation_is_reported() {
    let more = "[[disturbance]]\nabout = \"yaw\"\ntorque = 0.08\n";
    let of = metrics(&body(0.1, more));
    assert_eq!(word(&of, "actuator_end"), "saturated");
    assert!(of.number("wheel_torque_limit_share").expect("a share") > 0.3);
    let dir = Dir::holding("a.toml", body(0.1, more));
    dir.run("simulate a.toml --log none").exits(0).says(&[
        "  ! the run ends in saturation: an actuator is at its limit",
        "torque for 61 % of the time",
    ]);
}

/// Wheels that hold a body against a torque take its impulse: 0.01 N m for 300 s, in 0.02 kg m².
#[test]
fn peaks_of_wheels_are_those_of_the_impulse() {
    let of = metrics(&body(0.2, "[[disturbance]]\nabout = \"yaw\"\ntorque = 0.01\nto = 300.0\n"));
    let number = |name: &str| of.number(name).expect("a metric");
    for (name, exact) in [
        ("one_wheel_momentum_peak_nm_s", 3.0),
        ("wheel_momentum_peak_nm_s", 3.0),
        ("wheel_speed_peak_rad_s", 150.0),
    ] {
        // The law overshoots by 1.0 % when the torque ends.
        assert!((0.0..0.011).contains(&(number(name) / exact - 1.0)), "{name}: {}", number(name));
    }
    assert_eq!(number("wheel_torque_limit_share"), 0.0);
}

#[test]
fn propellant_is_reported_by_axis_or_by_thruster() {
    for (name, list, count) in [("iss-ringdown", "fuel_axes_kg", 3), ("canted-jets", "fuel_thrusters_kg", 4)]
    {
        let dir = Dir::with(&[name]);
        let object = dir.run(&format!("simulate {name}.toml --log none --json")).exits(0).json();
        let parts = object["metrics"][list].as_array().expect("a list");
        let sum: f64 = parts.iter().filter_map(serde_json::Value::as_f64).sum();
        let whole = object["metrics"]["fuel_kg"].as_f64().expect("a number");
        assert!(parts.len() >= count && (sum / whole - 1.0).abs() < 1e-12, "{name}: {parts:?} {whole}");
    }
}

#[test]
fn slews_have_errors_of_their_own() {
    let target = "[[target]]\nfrom = 10.0\nyaw = 0.2\nacceleration = 2e-4\n";
    let of = metrics(&body(0.2, target));
    let [peak, rms] =
        ["slew_error_peak_rad", "slew_error_rms_rad"].map(|name| of.number(name).expect("a metric"));
    assert!(peak > rms && rms > 0.0 && peak < 1e-3, "{peak} {rms}");
    assert!(metrics(&body(0.2, "")).get("slew_error_peak_rad").is_none());
}

/// The share of cycles at the largest moment is that of the logged moments.
#[test]
fn magnetorquers_at_their_limit_are_counted() {
    let text = "duration = 3000.0\nsensor = { magnetometer = { period = 1.0 } }\n\
        law = { b_dot = { period = 1.0, gain = 4e5 } }\nactuator = { magnetorquers = { moment = 0.3 } }\n\
        log = { period = 1.0 }\n[spacecraft]\nmass = 20.0\n\
        inertia = [[0.4, 0.01, 0], [0.01, 0.45, 0], [0, 0, 0.3]]\nrate = [0.02, -0.03, 0.025]\n\
        [environment]\norbit = { semi_major_axis = 6.928e6, inclination = 1.7 }\nmagnetic_field = {}\n";
    let (metrics, trace) = flown(&Scenario::parse("tumble.toml", text).expect("valid"), 0, Detail::Full);
    let moments = within(&trace, "/magnetorquers", "axes", "moment_am2");
    let at_limit = |axes: &[f64]| axes.iter().any(|moment| moment.abs() >= 0.3 * 0.999);
    let limited = moments.chunks(3).filter(|axes| at_limit(axes)).count();
    let share = metrics.number("moment_limit_share").expect("a share");
    let logged = limited as f64 / (moments.len() / 3) as f64;
    assert!(limited > 300 && (share - logged).abs() < 1e-9, "{share} {limited}");
}

/// A wheel that nothing unloads is full; the summary says so.
#[test]
fn wheels_that_are_full_are_counted() {
    let dir = Dir::with(&["momentum-unloading"]);
    let text = dir.text("momentum-unloading.toml");
    let (before, rest) = text.split_once("[actuator.wheels.unloading]").expect("the table");
    let (_, after) = rest.split_once("[reference]").expect("the band");
    dir.write("full.toml", format!("{before}[reference]{after}"));
    let reported = dir.run("simulate full.toml --log none").exits(0).err;
    assert!(
        reported.contains("! wheels: at the limit of momentum or speed for 29 % of the run"),
        "{reported}"
    );
}

/// A communications satellite as a user wrote it, with wings from a finite-element solver, whose loop is too fast for
/// its modes: the summary says so.
#[test]
fn the_loop_of_a_communications_satellite_is_reported() {
    let dir = Dir::holding("comsat.toml", include_str!("golden/comsat/comsat.toml"));
    dir.write("wing.inp", include_str!("golden/comsat/wing.inp"));
    dir.write("wing.frd", include_str!("golden/comsat/wing.frd"));
    dir.write("panel.inp", include_str!("golden/fe/panel.inp"));
    dir.write("panel.frd", include_str!("golden/fe/panel.frd"));
    let says = ["does not decay", "41 % of the last 300 s", "may be unstable"];
    dir.run("simulate comsat.toml --log none").exits(0).says(&says);
}
