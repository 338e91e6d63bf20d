//! Attitude and rates at the start: those of the target, errors beside them, draws of the errors, and what is refused.

use flexsc_core::Scenario;
use flexsc_core::numerics::attitude::{Vector, rotation_vector, vector};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion};

use crate::util::Dir;

/// Semi-major axis (m), inclination and node (rad) of the orbit, and its rate (rad/s) with the Earth's mu.
const ORBIT: [f64; 3] = [7.0e6, 1.2, 0.3];

/// Scenario in the orbit with these lines of the body, of which `kind` is the table.
fn text(kind: &str, body: &str) -> String {
    let mass = if kind == "spacecraft" { "mass = 100.0\n" } else { "" };
    let [axis, inclination, node] = ORBIT;
    format!(
        "duration = 50.0\n[{kind}]\n{mass}inertia = [[10, 0.4, 0], [0.4, 12, 0.3], [0, 0.3, 9]]\n{body}\n\
         [environment]\norbit = {{ semi_major_axis = {axis}, inclination = {inclination}, node = {node} }}\n\
         [[target]]\nfrom = 0.0\nframe = \"nadir\"\n\
         [law.attitude]\nperiod = 0.5\nbandwidth = 0.1\n"
    )
}

/// Returns the attitude and the rates at the start.
fn start(scenario: &Scenario) -> (Quaternion<f64>, Vector) {
    let body = scenario.model.three_axis().expect("three axes");
    (body.attitude.get(), vector(&body.rate))
}

fn parsed(kind: &str, body: &str) -> Scenario {
    Scenario::parse("start.toml", &text(kind, body)).expect("valid")
}

/// Returns the axes of the local frame at the ascending node, x forward and z down, by their definition, and its rate
/// (rad/s).
fn local_axes() -> (Matrix3<f64>, Vector) {
    let [axis, inclination, node] = ORBIT;
    let up = Vector::new(node.cos(), node.sin(), 0.0);
    let forward =
        Vector::new(-node.sin() * inclination.cos(), node.cos() * inclination.cos(), inclination.sin());
    let axes = Matrix3::from_columns(&[forward, -up.cross(&forward), -up]);
    let rate = (3.986_004_418e14_f64 / axis.powi(3)).sqrt();
    (axes, Vector::new(0.0, -rate, 0.0))
}

fn matrix(attitude: Quaternion<f64>) -> Matrix3<f64> {
    UnitQuaternion::from_quaternion(attitude).to_rotation_matrix().into_inner()
}

#[test]
fn a_body_starts_in_the_attitude_and_with_the_rate_of_its_target() {
    let (axes, rate) = local_axes();
    for kind in ["spacecraft", "body.spatial"] {
        let (attitude, rates) = start(&parsed(kind, "attitude = \"target\"\nrate = \"target\""));
        assert!((matrix(attitude) - axes).norm() < 2e-15, "{kind}: {attitude}");
        assert!((rates - rate).norm() < 1e-18, "{kind}: {rates}");
    }
}

#[test]
fn errors_are_rotations_from_the_target_in_body_axes_and_rates_in_addition() {
    let (axes, rate) = local_axes();
    let keys = "attitude = \"target\"\nattitude_error = [\"3 deg\", -0.02, 0.01]\nrate = \"target\"\n\
                rate_error = [1e-3, \"0.1 deg/s\", -2e-3]";
    for kind in ["spacecraft", "body.spatial"] {
        let (attitude, rates) = start(&parsed(kind, keys));
        let error = Vector::new(3.0_f64.to_radians(), -0.02, 0.01);
        // Rodrigues' formula.
        let (angle, unit) = (error.norm(), error.normalize().cross_matrix());
        let turn = Matrix3::identity() + unit * angle.sin() + unit * unit * (1.0 - angle.cos());
        assert!((matrix(attitude) - axes * turn).norm() < 2e-15, "{kind}: {attitude}");
        let expected = turn.transpose() * rate + Vector::new(1e-3, 0.1_f64.to_radians(), -2e-3);
        assert!((rates - expected).norm() < 1e-17, "{kind}: {rates}");
    }
}

#[test]
fn an_error_is_added_to_a_written_attitude_too() {
    let (attitude, rates) = start(&parsed(
        "spacecraft",
        "attitude = [0.6, 0.8, 0, 0]\nattitude_error = [0, 0, 0.3]\nrate = [0.1, 0, 0]\nrate_error = [0.02, 0, 0]",
    ));
    let error = rotation_vector(&Quaternion::new(0.6, 0.8, 0.0, 0.0), &attitude);
    assert!((error - Vector::new(0.0, 0.0, 0.3)).norm() < 1e-15);
    assert!((rates - Vector::new(0.12, 0.0, 0.0)).norm() < 1e-16);
}

#[test]
fn a_scenario_that_starts_at_its_target_has_no_error_at_the_start() {
    let dir = Dir::new();
    dir.write("start.toml", text("spacecraft", "attitude = \"target\"\nrate = \"target\""));
    dir.run("simulate start.toml --log full -o start.mcap").exits(0);
    let written =
        dir.run("log scenario start.mcap").exits(0).prints(&["attitude = \"target\"", "rate = \"target\""]);
    dir.write("again.toml", written);
    dir.run("export start.mcap --topic /pointing -o start.csv").exits(0);
    dir.run("simulate again.toml --log full -o again.mcap").exits(0);
    dir.run("export again.mcap --topic /pointing -o again.csv").exits(0);
    assert_eq!(dir.read("start.csv"), dir.read("again.csv"));
    let rows = crate::util::table(&dir, "start.csv");
    for key in ["roll_error_rad", "pitch_error_rad", "yaw_error_rad"] {
        let error: f64 = rows[0][key].parse().expect("a number");
        assert!(error.abs() < 1e-15, "{key} = {error}");
    }
}

#[test]
fn errors_are_drawn_in_campaigns() {
    let dir = Dir::new();
    let drawn = "\n[uncertain]\n\"spacecraft.attitude_error[0]\" = { normal = { mean = 0.0, sd = 0.02 } }\n\
                 \"spacecraft.rate_error[2]\" = { uniform = [-1e-3, 1e-3] }\n";
    let keys = "attitude = \"target\"\nattitude_error = [0, 0, 0]\nrate = \"target\"\nrate_error = [0, 0, 0]";
    dir.write("start.toml", text("spacecraft", keys) + drawn);
    dir.run("simulate start.toml --runs 3 -o runs.csv").exits(0);
    let rows = crate::util::table(&dir, "runs.csv");
    assert_eq!(rows.len(), 3);
    let values: Vec<&String> = rows.iter().map(|row| &row["spacecraft.attitude_error[0]"]).collect();
    assert!(values[0] != values[1] && values[1] != values[2]);
    assert!(rows.iter().all(|row| row["error"].is_empty()), "{rows:?}");
}

#[test]
fn other_words_and_shapes_are_refused() {
    for (keys, words) in [
        ("attitude = \"traget\"", &["attitude", "traget", "target"][..]),
        ("attitude = [1, 0, 0]", &["attitude"]),
        ("attitude = 3", &["attitude", "\"target\""]),
        ("rate = \"nadir\"", &["rate", "target"]),
        ("attitude_error = \"target\"", &["attitude_error"]),
        ("attitude_error = [0, nan, 0]", &["attitude_error"]),
        ("rate_error = [0, 0]", &["rate_error"]),
        (
            "attitude_error = [1e300, 1e300, 1e300]",
            &["spacecraft.attitude_error", "from -6.2832 to 6.2832 rad"],
        ),
        ("rate_error = [0, 1e300, 0]", &["spacecraft.rate_error", "rad/s about each axis, got 1"]),
    ] {
        let error = Scenario::parse("start.toml", &text("spacecraft", keys)).expect_err(keys).to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{keys}: {error}");
    }
}
