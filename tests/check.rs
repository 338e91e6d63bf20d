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
    let remark = "actuator.wheels.imbalance` takes most of the time of a run";
    let said = dir.run("check balanced.toml unbalanced.toml").exits(0);
    let all = format!("{}{}", said.out, said.err);
    assert_eq!(all.matches(remark).count(), 1, "{all}");
    assert!(all.find("unbalanced.toml") < all.find(remark), "{all}");
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
