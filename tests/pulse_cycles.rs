//! Limit cycles of pulses that their describing function predicts, against runs.

use crate::util::Dir;

/// A rigid body with an integral law and thrusters, which is unstable with less than 0.222 times the gain: torques at their limit
/// make it oscillate with growing amplitude if it begins far enough from its goal.
fn scenario(angle: f64) -> String {
    format!(
        r#"
name = "pulses"
duration = 400.0
sensor.sampled.period = 0.5

[body.planar]
inertia = 100.0
angle = {angle}

[law.state_space]
period = 0.5
a = [[1.0]]
b = [[0.5, 0.0]]
c = [[0.4]]
d = [[6.0, 30.0]]

[actuator.thrusters]
torque = 1.0
period = 0.5
"#
    )
}

#[test]
fn the_predicted_cycle_is_the_edge_of_attraction() {
    let dir = Dir::with(&[]);
    std::fs::write(dir.path("pulses.toml"), scenario(0.1)).expect("a file");
    let found = dir.run("cycle pulses.toml --json").exits(0).json();
    let crossing = &found["crossings"][0];
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    // kd kp f² = ki J f of the continuous loop, which sampling changes little.
    assert!((number(&crossing["factor"]) - 0.222).abs() < 0.02, "{crossing}");
    assert!((number(&crossing["frequency_rad_s"]) - 0.115).abs() < 0.005, "{crossing}");
    let cycles = found["described"].as_array().expect("cycles");
    assert_eq!(cycles.len(), 1, "{found}");
    assert_eq!(cycles[0]["stable"], false);
    // 4/(pi f) times the torque of a pulse, where the demand is far above it.
    let demand = number(&cycles[0]["torque_amplitude_nm"]);
    assert!(
        (demand / (4.0 / (std::f64::consts::PI * number(&crossing["factor"]))) - 1.0).abs() < 0.02,
        "{demand}"
    );
    // The torque 4/pi swings the body by 4/(pi J w²): runs from rest at a part of that end at rest, or grow.
    let swing = 4.0 / (std::f64::consts::PI * 100.0 * number(&crossing["frequency_rad_s"]).powi(2));
    for (part, is_caught) in [(0.5, true), (1.6, false)] {
        std::fs::write(dir.path("run.toml"), scenario(part * swing)).expect("a file");
        // One that grows diverges.
        let code = i32::from(!is_caught);
        let metrics = dir.run("simulate run.toml --force --json").exits(code).json();
        let late = number(&metrics["metrics"]["angle_error_late_rad"]);
        assert_eq!(late < 0.05 * swing, is_caught, "{part}: {late}");
    }
    dir.run("cycle pulses.toml").exits(0).says(&["predicts a cycle, unstable", "demand"]);
    let remark = format!("predicts swings of {:.2} s that grow", number(&cycles[0]["period_s"]));
    dir.run("check pulses.toml").exits(0).says(&["remark: `actuator.thrusters` has pulses", &remark]);
    // Without the integral no lower gain is unstable.
    std::fs::write(dir.path("pd.toml"), scenario(0.1).replace("c = [[0.4]]", "c = [[0.0]]")).expect("a file");
    assert!(!dir.run("check pd.toml").exits(0).err.contains("remark"));
    let other = scenario(0.1).replace("torque = 1.0\nperiod = 0.5", "torque = 1.0\nperiod = 1.0");
    std::fs::write(dir.path("other.toml"), other).expect("a file");
    dir.run("cycle other.toml").exits(2).says(&["actuator.thrusters.period", "the period of the law"]);
}
