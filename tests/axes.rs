//! Three axes that small rates do not couple: each moves as a one-axis body.
//!
//! Golden numbers: tests/golden/axes_oracle.py, NumPy and SciPy.

use std::fmt::Write as _;

use flexsc_core::dynamics::flow::RigidBody;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::{Scenario, Simulation};

use crate::plants::golden;
use crate::study::pairs;

const INERTIAS: [f64; 3] = [80.0, 120.0, 200.0];
const AXES: [&str; 3] = ["roll", "pitch", "yaw"];
/// Angle (rad), rate (rad/s), and a torque from one time to another (N m, s), to be scaled.
const STARTS: [[f64; 2]; 3] = [[1.0, 0.05], [-0.7, 0.02], [0.5, -0.04]];
const TORQUES: [Option<(f64, &str)>; 3] =
    [Some((1.0, "from = 10.0\nto = 30.0\n")), None, Some((-1.5, "from = 5.0\nto = 60.0\n"))];
/// Frequency (rad/s), damping, displacement, rate, rotation at the hub, and the axis that it turns.
const MODES: [(f64, f64, [f64; 2], f64, usize); 4] = [
    (0.9, 0.005, [2.0, 1.0], 0.06, 0),
    (1.3, 0.0, [-1.0, 2.0], 0.05, 1),
    (0.7, 0.01, [3.0, -1.0], 0.04, 2),
    (2.3, 0.0, [1.0, -2.0], 0.03, 0),
];
const LAWS: [&str; 3] = [
    "pd = { k_p = 3.2, k_d = 22.0, period = 0.5 }",
    "pd = { k_p = 4.8, k_d = 34.0, period = 1.0 }",
    "pd = { k_p = 8.0, k_d = 56.0, period = 0.5 }",
];
/// A wheel behind a filter, as the oracle has it.
pub const FILTERED: &str = "[sensor.sampled]\nperiod = 0.5\n[estimator.kalman]\nangle_noise = 1e-4\nmoment_noise = 1e-8\n\
    initial = { angle = 1e-3, rate = 1e-3, displacement = 2e-3, mode_rate = 6e-4 }\nprior = \"true\"\n\
    [actuator.wheel]\ngain = 1.0\ndelay = 0.1\n";
/// Other loops.
const LOOPS: [&str; 3] = [
    "",
    "[actuator.hold]\nperiod = 0.5\n",
    "[sensor.sampled]\nperiod = 0.5\n[actuator.wheel]\ngain = 1.0\nlimit = 1e-7\n",
];

/// Returns one body with all three axes, at scaled rates.
pub fn together(rest: &str, scale: f64) -> Scenario {
    let half: Vec<f64> = STARTS.iter().map(|[angle, _]| 0.5 * scale * angle).collect();
    let rates: Vec<f64> = STARTS.iter().map(|[_, rate]| scale * rate).collect();
    let [a, b, c] = INERTIAS;
    let mut text = format!(
        "duration = 60.0\n[law.per_axis]\nroll = {{ {} }}\npitch = {{ {} }}\nyaw = {{ {} }}\n{rest}[body.spatial]\n\
         inertia = [[{a:?}, 0.0, 0.0], [0.0, {b:?}, 0.0], [0.0, 0.0, {c:?}]]\n\
         attitude = [1.0, {:e}, {:e}, {:e}]\nrate = {rates:?}\npoints = [{{ name = \"hub\" }}]\n",
        LAWS[0], LAWS[1], LAWS[2], half[0], half[1], half[2],
    );
    for (frequency, damping, [q, rate], rotation, about) in MODES {
        let mut turns = [0.0; 3];
        turns[about] = rotation;
        let _ = writeln!(
            text,
            "[[body.spatial.modes]]\nfrequency = {frequency:?}\ndamping = {damping:?}\ndisplacement = {:e}\n\
             rate = {:e}\nshapes.hub = {{ rotation = {turns:?} }}",
            scale * q,
            scale * rate,
        );
    }
    for (axis, torque) in TORQUES.iter().enumerate() {
        let Some((torque, times)) = torque else { continue };
        let torque = scale * torque;
        let _ = write!(text, "[[disturbance]]\nabout = \"{}\"\ntorque = {torque:e}\n{times}", AXES[axis]);
    }
    Scenario::parse("axes.toml", &text).expect("valid")
}

/// Returns one of the axes as a one-axis body, in which the modes of the others have no rotation.
fn alone(axis: usize, rest: &str, scale: f64) -> Scenario {
    let [angle, rate] = STARTS[axis].map(|start| scale * start);
    let mut text = format!(
        "duration = 60.0\n[law.{}\n{rest}[body.planar]\ninertia = {:?}\nangle = {angle:e}\nrate = {rate:e}\n",
        LAWS[axis].replace(" = {", "]\n").replace(", ", "\n").replace(" }", ""),
        INERTIAS[axis],
    );
    for (frequency, damping, start, rotation, about) in MODES {
        let rotation = if about == axis { rotation } else { 0.0 };
        let [x, rate] = start.map(|start| scale * rotation * start);
        let gain = INERTIAS[axis] * rotation * rotation;
        let _ = writeln!(
            text,
            "[[body.planar.modes]]\nfrequency = {frequency:?}\ndamping = {damping:?}\ngain = {gain:e}\n\
             displacement = {x:e}\nrate = {rate:e}"
        );
    }
    if let Some((torque, times)) = TORQUES[axis] {
        let _ = write!(text, "[[disturbance]]\ntorque = {:e}\n{times}", scale * torque);
    }
    Scenario::parse("axis.toml", &text).expect("valid")
}

fn after(time: f64) -> Instant {
    Instant::START + Span::from_seconds(time)
}

/// Returns the angles of the three axes, elastic parts included, and their rigid rates, at some times.
fn of_three(scenario: &Scenario, times: &[f64]) -> Vec<([f64; 3], [f64; 3])> {
    let mut simulation = Simulation::new(scenario, 0);
    let at = |time: &f64| {
        simulation.run_until(after(*time), &mut ()).expect("a run");
        let state = simulation.three_axis_state().expect("three axes");
        let mut angles = [0, 1, 2].map(|axis| 2.0 * state.turn.attitude.vector()[axis]);
        for ((.., rotation, about), mode) in MODES.iter().zip(&state.modes) {
            angles[*about] += rotation * mode.displacement;
        }
        let momentum = RigidBody::momentum(&state.turn);
        (angles, [0, 1, 2].map(|axis| momentum[axis] / INERTIAS[axis]))
    };
    times.iter().map(at).collect()
}

/// Returns the angle, elastic part included, and the rigid rate of a one-axis body, at some times.
fn of_one(scenario: &Scenario, times: &[f64]) -> Vec<(f64, f64)> {
    let mut simulation = Simulation::new(scenario, 0);
    let at = |time: &f64| {
        simulation.run_until(after(*time), &mut ()).expect("a run");
        let state = simulation.state().expect("one angle");
        (state.angle(), state.rigid_rate)
    };
    times.iter().map(at).collect()
}

const TIMES: [f64; 6] = [0.0, 7.3, 10.0, 25.0, 40.2, 60.0];

/// Returns the largest difference of angles (rad) and of rates (rad/s) between three axes and one by one.
fn difference(rest: &str, scale: f64) -> [f64; 2] {
    let three = of_three(&together(rest, scale), &TIMES);
    let mut worst = [0.0_f64; 2];
    for axis in 0..3 {
        for ((angles, rates), (angle, rate)) in pairs(&three, of_one(&alone(axis, rest, scale), &TIMES)) {
            worst[0] = worst[0].max((angles[axis] - angle).abs());
            worst[1] = worst[1].max((rates[axis] - rate).abs());
        }
    }
    worst
}

#[test]
fn each_axis_moves_as_a_body_with_one_angle() {
    for rest in LOOPS.iter().chain(&[FILTERED]) {
        let [angle, rate] = difference(rest, 1e-7);
        assert!(angle < 2e-14 && rate < 2e-14, "{rest}: {angle:e} rad, {rate:e} rad/s");
    }
    // The remaining difference is the coupling of rotations, of second order.
    for rest in ["", LOOPS[1], FILTERED] {
        let [small, large] = [1e-5, 1e-4].map(|scale| difference(rest, scale)[0]);
        assert!((large / small - 100.0).abs() < 5.0, "{rest}: {small:e} {large:e}");
    }
}

#[test]
fn each_axis_moves_as_in_scipy() {
    let table: Vec<[f64; 3]> =
        golden("../axes").iter().map(|row| [0, 1, 2].map(|at| row[at].parse().expect("a number"))).collect();
    let times: Vec<f64> = table[..4].iter().map(|row| row[1]).collect();
    let three = of_three(&together(FILTERED, 1e-7), &times);
    // A command that waits gives the same torque whether a wheel is named by its axis or belongs to an array.
    let array = "[actuator.wheels]\narrangement = \"orthogonal\"\ninertia = 1e-3\ndelay = 0.1\n";
    let array = FILTERED.replace("[actuator.wheel]\ngain = 1.0\ndelay = 0.1\n", array);
    let arrayed = of_three(&together(&array, 1e-7), &times);
    for (axis, rows) in table.chunks(4).enumerate() {
        let one = of_one(&alone(axis, FILTERED, 1.0), &times);
        for (at, [_, time, exact]) in rows.iter().enumerate() {
            let error = one[at].0 - exact;
            assert!(error.abs() < 1e-11, "{axis} at {time} s: {error:e}");
            let error = three[at].0[axis] - 1e-7 * exact;
            assert!(error.abs() < 2e-14, "{axis} of three at {time} s: {error:e}");
            let error = arrayed[at].0[axis] - 1e-7 * exact;
            assert!(error.abs() < 2e-14, "{axis} of wheels at {time} s: {error:e}");
        }
    }
}
