//! Messages of `flexsc check` and of linear tools that say why, and what to do.

use flexsc_core::Scenario;

use crate::kinds::{AROUND, THREE_AXES};
use crate::util::Dir;

#[test]
fn check_takes_keys() {
    let dir = Dir::with(&["relay-fixed"]);
    let said = dir.run("check relay-fixed.toml --set duration=7").exits(0);
    assert!(
        said.out.contains("accepted: 7 s") || said.err.contains("accepted: 7 s"),
        "{} {}",
        said.out,
        said.err
    );
    dir.run("check relay-fixed.toml --set law.relay.k_t=-1").exits(2).says(&["law.relay.k_t", "-1"]);
    dir.run("check relay-fixed.toml --set law").exits(2).says(&["not a KEY=VALUE"]);
}

/// Wheels that run fast have many turns, whose imbalance takes the time of a run.
#[test]
fn check_names_the_cost_of_an_imbalance() {
    let dir = Dir::new();
    let wheels = "[actuator.wheels]\narrangement = \"orthogonal\"\ninertia = 0.01\ntorque = 0.05\nspeeds = [600.0, 600.0, 600.0]\n";
    let craft = "duration = 1000.0\nlaw.attitude = { period = 0.5, bandwidth = 0.05 }\n[spacecraft]\nmass = 200.0\n\
                 inertia = [[80.0, 0.0, 0.0], [0.0, 70.0, 0.0], [0.0, 0.0, 60.0]]\npoints = [{ name = \"hub\" }]\n[sensor.sampled]\nperiod = 0.5\n";
    dir.write("balanced.toml", format!("{craft}{wheels}"));
    dir.write("unbalanced.toml", format!("{craft}{wheels}imbalance = {{ static = 1e-6 }}\n"));
    let remark = "actuator.wheels.imbalance` multiplies the time of a run by";
    let said = dir.run("check balanced.toml unbalanced.toml").exits(0);
    let all = format!("{}{}", said.out, said.err);
    assert_eq!(all.matches(remark).count(), 1, "{all}");
    assert!(all.find("unbalanced.toml") < all.find(remark), "{all}");
}

/// A CubeSat with four modes of operation, whose wheels start at rest and reach their limit of 6000 rpm.
const CUBESAT: &str = include_str!("golden/cube6u.toml");

/// Wheels that start at rest turn later: the estimate counts them at the speeds that they reach. Measured on an idle core, 600 s
/// from a slow start take 7.6 s, and 0.18 s without the imbalance.
#[test]
fn unbalanced_wheels_that_start_at_rest_are_counted() {
    let dir = Dir::holding("a.toml", CUBESAT);
    let slow = "--set duration=600 --set spacecraft.rate=[0.001,0,0]";
    let printed = dir.run(&format!("check a.toml {slow} --json")).exits(0).json();
    let estimate = printed["estimate_s"].as_f64().expect("a time");
    assert!((3.8..15.2).contains(&estimate), "{estimate}");
    let remarks = printed["remarks"].to_string();
    assert!(
        remarks.contains("multiplies the time of a run by") && remarks.contains("vibration"),
        "{remarks}"
    );
    dir.run("simulate a.toml --runs 1000").exits(2).says(&["in each of 1000 runs", "must be confirmed"]);
    let balanced: Vec<&str> = CUBESAT.lines().filter(|line| !line.starts_with("imbalance")).collect();
    dir.write("b.toml", balanced.join("\n"));
    let estimate = dir.run(&format!("check b.toml {slow} --json")).exits(0).json()["estimate_s"].clone();
    assert!((0.09..0.36).contains(&estimate.as_f64().expect("a time")), "{estimate}");
}

/// A factor of the density far beyond its models, and torques of the environment that no step could follow.
#[test]
fn an_environment_that_no_step_follows_is_refused() {
    let dir = Dir::holding("a.toml", CUBESAT);
    let scale = dir.run("check a.toml --set environment.drag.scale=1e300").exits(2);
    scale.says(&["environment.drag.scale", "must be a factor of 0.001 to 1000, got 1e300"]);
    dir.run("check a.toml --set environment.drag.scale=10").exits(0);
    for set in ["environment.drag.coefficient=1e300", "environment.torque=[0,1e30,0]"] {
        let refused = dir.run_bounded(&format!("check a.toml --set {set}")).exits(2);
        refused.says(&["`environment` makes", "at most 1.0e12 are allowed"]);
    }
    let leap = CUBESAT.replace("2027-03-21T10:00:00Z", "2027-03-21T10:00:60Z");
    dir.write("b.toml", leap);
    dir.run("check b.toml").exits(2).says(&["b.toml:3", "`epoch`", "a second 60 is a leap second"]);
}

fn filtered(sensors: &str) -> String {
    let gyro = "{ gyro = { period = 0.2, angle_random_walk = 1e-6 } }";
    format!(
        "duration = 4.0\nlaw.attitude = {{ period = 0.2, bandwidth = 0.06 }}\nsensor = [{gyro}, {sensors}]\n\
         estimator.attitude = {{}}\n{THREE_AXES}{AROUND}"
    )
}

#[test]
fn margins_say_why_a_filter_has_no_linear_loop() {
    let dir = Dir::new();
    let tracker = "{ star_tracker = { period = 1.0, noise = [1e-6, 1e-6, 1e-6] } }";
    let field = "{ magnetometer = { period = 1.0, noise = 1e-8 } }";
    let sun = "{ sun_sensor = { period = 1.0, noise = 1e-3 } }";
    dir.write("vectors.toml", filtered(&format!("{field}, {sun}")));
    dir.write("two.toml", filtered(&format!("{tracker}, {tracker}")));
    dir.write("one.toml", filtered(tracker));
    let vectors = ["reads the directions of `sensor[1].magnetometer`", "do not settle"];
    dir.run("margins vectors.toml").exits(2).says(&vectors);
    dir.run("margins two.toml").exits(2).says(&["reads `sensor[2].star_tracker` beside another sensor"]);
    dir.run("margins one.toml").exits(0);
}

#[test]
fn a_continuous_sensor_beside_a_magnetometer_is_refused_with_the_reason() {
    let text = |other: &str| {
        format!(
            "duration = 4.0\nlaw.attitude = {{ period = 0.2, bandwidth = 0.06 }}\nsensor = [\"continuous\", {other}]\n\
             {THREE_AXES}{AROUND}"
        )
    };
    let refused =
        |other: &str| Scenario::parse("sensors.toml", &text(other)).expect_err("refused").to_string();
    let why = refused("{ magnetometer = { period = 1.0 } }");
    assert!(why.contains("has no samples") && why.contains("use a `sampled` sensor beside them"), "{why}");
    let why = refused("{ gyro = { period = 1.0 } }");
    assert!(why.contains("so other sensors add nothing"), "{why}");
    let sampled = text("{ magnetometer = { period = 1.0 } }")
        .replace("\"continuous\"", "{ sampled = { period = 0.2 } }");
    Scenario::parse("sensors.toml", &sampled).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn margins_of_stages_say_which_loops_there_are() {
    let dir = Dir::new();
    let law = |bandwidth: f64| format!("law.attitude = {{ period = 0.5, bandwidth = {bandwidth} }}");
    let craft = "duration = 100.0\n[spacecraft]\nmass = 200.0\ninertia = [[80, 0, 0], [0, 70, 0], [0, 0, 60]]\n\
                 points = [{ name = \"hub\" }]\n[sensor.sampled]\nperiod = 0.5\n[actuator.ideal]\n";
    let stages = format!("[[law.stages]]\n{}\n[[law.stages]]\nfrom = 50.0\n{}\n", law(0.1), law(0.05));
    dir.write("stages.toml", format!("{craft}{stages}"));
    let told = [
        "law.stages",
        "one in each stage",
        "in Python `in_mode`: `0`, attitude from 0 s; `1`, attitude from 50 s",
    ];
    dir.run("margins stages.toml").exits(2).says(&told);
    dir.run("spectrum stages.toml").exits(2).says(&["law.stages"]);
    dir.run("margins stages.toml --mode 2")
        .exits(2)
        .says(&["index of a stage of the law, from 0 to 1, got `2`"]);
    for (stage, bandwidth) in [0.1, 0.05].into_iter().enumerate() {
        dir.write("one.toml", format!("{}\n{craft}", law(bandwidth)));
        let alone = dir.run("margins one.toml --json").exits(0).json();
        let chosen = dir.run(&format!("margins stages.toml --mode {stage} --json")).exits(0).json();
        assert_eq!(alone["loops"], chosen["loops"]);
        assert!(alone["loops"].is_array(), "{alone}");
    }
}

/// Samples each second show 3.5 rad/s as 2 pi - 3.5 rad/s.
#[test]
fn check_names_modes_that_samples_alias() {
    let dir = Dir::new();
    let text = |period: f64| {
        format!(
            "duration = 10.0\nsensor.sampled.period = {period}\nlaw.pd = {{ period = {period}, k_p = 1.0, k_d = 1.0 }}\n\
             actuator = \"ideal\"\n[body.planar]\ninertia = 100.0\nmodes = [{{ frequency = 3.5, gain = 0.01 }}, {{ frequency = 3.0, gain = 0.01 }}]\n"
        )
    };
    dir.write("slow.toml", text(1.0));
    let told =
        ["remark: `law.pd.period`", "1/(2 period) = 0.500 Hz: 1 mode is above it", "0.557 Hz", "0.443 Hz"];
    dir.run("check slow.toml").exits(0).says(&told);
    dir.write("quick.toml", text(0.5));
    assert!(!dir.run("check quick.toml").exits(0).err.contains("remark"));
    let law = Dir::with(&["earth-observer"]);
    let told = ["remark: `law.attitude.bandwidth` is above pi/period = 12.566 rad/s", "another unit"];
    law.run("check earth-observer.toml --set law.attitude.bandwidth=30").exits(0).says(&told);
}

/// Units that do not fit and keys that are misspelt are reported together, in the order of the file.
#[test]
fn errors_of_units_and_of_names_come_at_once() {
    let text = Dir::with(&["relay-fixed"]).text("relay-fixed.toml");
    let wrong =
        text.replace("dead_zone =", "dead_zon =").replace("duration = 20000.0", "duration = \"20 km\"");
    assert!(wrong.contains("dead_zon =") && wrong.contains("20 km"), "{wrong}");
    let dir = Dir::holding("a.toml", wrong);
    let said =
        dir.run("check a.toml").exits(2).says(&["`duration` has the unit `km`", "unknown key `dead_zon`"]);
    assert!(said.err.find("20 km") < said.err.find("dead_zon"), "{}", said.err);
}

/// A key of a law is refused in a scenario with modes of operation by the keys that there are.
#[test]
fn a_law_beside_modes_is_refused_with_the_laws_of_the_modes() {
    let dir = Dir::with(&["cubesat-day"]);
    let line = "check cubesat-day.toml --set law.attitude.bandwidth=0.1";
    dir.run(line).exits(2).says(&["each mode has a law of its own", "`mode[2].law.attitude` (point)"]);
}

/// The refusal of a mode without a linear loop has the command that analyses it, which works.
#[test]
fn a_refused_mode_comes_with_the_command_that_analyses_it() {
    let dir = Dir::with(&["cubesat-day"]);
    let said = dir.run("margins cubesat-day.toml --mode point").exits(2).err;
    let hint = said.lines().find_map(|line| line.split_once("flexsc margins ")).expect("a command").1;
    assert!(hint.contains("--mode point --set 'mode[2].sensors=["), "{said}");
    let set = hint.split("--set ").skip(1).map(|pair| pair.trim().trim_matches('\'').replace(' ', ""));
    let set: Vec<String> = set.map(|pair| format!("--set {pair}")).collect();
    dir.run(&format!("margins cubesat-day.toml --mode point {}", set.join(" "))).exits(0).says(&["stable"]);
}
