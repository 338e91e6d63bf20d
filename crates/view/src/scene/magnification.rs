//! Default factors by which bending and rotation are magnified in the scene, where the scenario leaves them out.
//!
//! The largest motion is not known before a run. The actuator's authority and the initial state give the order of
//! magnitude.

use flexsc_core::Scenario;
use flexsc_core::control::actuator::AssignedMember;
use flexsc_core::control::law::{TargetFrame, TorqueConditions};
use flexsc_core::dynamics::axis_model::{AxisMode, AxisModel};
use flexsc_core::dynamics::three_axis::HarmonicLine;
use flexsc_core::dynamics::three_axis_model::{ThreeAxisMode, ThreeAxisModel};
use flexsc_core::numerics::attitude::{Vector, from_yaw_pitch_roll};
use flexsc_core::numerics::quantity::{Finite, Positive};
use flexsc_core::numerics::time::Instant;
use flexsc_core::spacecraft::disturbance::Disturbance;

/// Bending and rotation (rad) that the estimated motion has as drawn.
const BENDING: f64 = 0.35;
const TURNING: f64 = 0.5;
/// Least damping ratio: a mode damped less is not in resonance long enough to reach its steady amplitude.
const LEAST_DAMPING: f64 = 1e-3;
/// Largest step of a disc per frame (rad).
const TURN: f64 = 1.0;

/// Returns 1, 2 or 5 times a power of ten, at least 1, and at most the factor by which `estimate` reaches `wanted`
/// (rad).
fn round_factor(wanted: f64, estimate: f64) -> f64 {
    let factor = wanted / estimate;
    if !factor.is_finite() || factor <= 1.0 {
        return 1.0;
    }
    let decade = libm::pow(10.0, libm::floor(libm::log10(factor)));
    [5.0, 2.0].into_iter().find(|step| step * decade <= factor).unwrap_or(1.0) * decade
}

/// Returns the magnification of the bending of panels with an estimated angle (rad).
pub fn bending(estimate: f64) -> f64 {
    round_factor(BENDING, estimate)
}

/// Returns the magnification of the rotation of a body with an estimated angle (rad).
pub fn turning(estimate: f64) -> f64 {
    round_factor(TURNING, estimate)
}

/// Returns the factor by which the drawn rotation of a disc with `step` (rad) per frame is slowed: 1, 2 or 5 times a
/// power of ten, at least 1, so that the drawn steps are at most `TURN`. Viewers would show a faster disc with another
/// speed or direction.
pub fn slow_down_factor(step: f64) -> f64 {
    let least = step / TURN;
    if !least.is_finite() || least <= 1.0 {
        return 1.0;
    }
    let decade = libm::pow(10.0, libm::floor(libm::log10(least)));
    [1.0, 2.0, 5.0].into_iter().find(|step| step * decade >= least).unwrap_or(10.0) * decade
}

/// Returns the estimated rotation of a one-axis body (rad).
pub fn expected_angle(scenario: &Scenario, body: &AxisModel) -> f64 {
    let start = body.angle.get();
    let zone = scenario.law.dead_zone();
    start.abs().max(scenario.goal().angle.abs()).max(zone)
}

/// Returns the estimated largest rate of a one-axis body (rad/s).
pub fn expected_rate(scenario: &Scenario, body: &AxisModel) -> f64 {
    let planned = scenario.plan.as_ref().map_or(0.0, |plan| 2.0 * scenario.goal().angle.abs() / plan.time);
    // Rate of the free oscillation in which the proportional gain is the spring.
    let by_law = scenario.actuator.flywheel().map_or(0.0, |(wheel, _)| {
        expected_angle(scenario, body)
            * f64::sqrt(scenario.law.stiffness() * wheel.gain.get() / body.commanded_inertia())
    });
    body.rate.get().abs().max(planned).max(by_law)
}

/// Returns the estimated rotation angle of a three-axis body (rad).
pub fn expected_attitude_angle(scenario: &Scenario, body: &ThreeAxisModel) -> f64 {
    let targets = scenario.targets().iter().map(|target| {
        let [roll, pitch, yaw] = [target.roll, target.pitch, target.yaw].map(Finite::get);
        from_yaw_pitch_roll(roll, pitch, yaw)
    });
    // A target in orbital or Sun-pointing axes: the body rotates from its initial attitude to these axes.
    let inertial = scenario.targets().iter().all(|target| target.target_frame() == TargetFrame::INERTIAL);
    let at_start = scenario.study.profile.target(Instant::START).conjugate() * body.attitude.get();
    let start = if inertial { body.attitude.get() } else { at_start };
    let angle = |q: nalgebra::Quaternion<f64>| 2.0 * libm::acos(q.w.abs().min(1.0));
    let zones = scenario.study.arrival_bands(scenario).into_iter().fold(0.0, f64::max);
    targets.chain([start]).map(angle).fold(zones, f64::max)
}

/// Returns the estimated displacement of each mode (rad): twice the equilibrium under the largest torque, or once if a
/// wheel under a PD law reduces its torque as the body rotates, but at most the displacement without a spring, or the
/// initial amplitude if it is larger.
pub fn expected_displacements(scenario: &Scenario, body: &AxisModel) -> Vec<f64> {
    let travel = expected_angle(scenario, body);
    let moment = largest_torque(scenario, body) / body.commanded_inertia();
    let lets_go = scenario.actuator.flywheel().is_some() && !scenario.law.is_switching();
    let times = if lets_go { 1.0 } else { 2.0 };
    let of = |mode: &AxisMode| {
        let start = mode.start();
        // A mode without an oscillation keeps its initial displacement.
        let swing = mode.amplitude(start);
        let held = if swing.is_nan() { libm::hypot(start.displacement, start.quadrature) } else { swing };
        held.max((times * mode.excitability().abs() * moment).min(mode.gain.get().abs() * travel))
    };
    body.modes.iter().map(of).collect()
}

/// Returns the estimated largest torque (N m; rad/s² if the motion is commanded).
pub fn largest_torque(scenario: &Scenario, body: &AxisModel) -> f64 {
    let planned = scenario.plan.as_ref().map_or(0.0, |plan| plan.peak().value.abs());
    // A law that does not switch follows the plan, and hardly adds to its torque.
    let by_law = if scenario.plan.is_none() || scenario.law.is_switching() {
        scenario.law.expected_torque(&TorqueConditions {
            angle: body.angle.get().abs(),
            inertia: body.commanded_inertia(),
            torque_per_command: 1.0,
            jets: 0.0,
            magnetorquers: 0.0,
            profile_acceleration: None,
            detailed: false,
        })
    } else {
        0.0
    };
    let of = |member: AssignedMember<'_>| member.kind.expected_torque(planned, by_law);
    scenario.actuator.members().into_iter().map(of).fold(0.0, f64::max)
}

/// Returns the estimated largest torque (N m) about an axis of a three-axis body, for actuators other than jets.
fn axis_torque(scenario: &Scenario, body: &ThreeAxisModel, axis: usize) -> f64 {
    let members = scenario.actuator.members();
    let serving = members.iter().find(|member| member.share(axis) > 0.0);
    let study = &scenario.study;
    let inertia = study.axes[axis].inertia.get();
    let most = study.authorities[axis].accelerations[0] * inertia;
    // A manoeuvre along a profile commands its acceleration, not the whole angle at once.
    let profile = scenario.targets().iter().map(|target| target.acceleration.map(Positive::get));
    let magnetorquers = scenario.actuator.magnetorquers().map_or(0.0, |(torquers, _)| {
        let field = study.surroundings.as_ref().map_or(0.0, |around| around.sky().field_bound());
        torquers.largest_moment() * field
    });
    let conditions = TorqueConditions {
        angle: expected_attitude_angle(scenario, body),
        inertia,
        torque_per_command: serving.map_or(1.0, |member| member.kind.torque_per_command()),
        jets: most,
        magnetorquers,
        profile_acceleration: profile.reduce(|most, next| Some(most?.max(next?))).flatten(),
        detailed: true,
    };
    scenario.law.about(axis).expected_torque(&conditions).min(most)
}

/// Returns the estimated displacements of the modes of a three-axis body (m sqrt(kg)), under the jets, the torque of
/// any axis, or a force.
pub fn expected_modal_displacements(scenario: &Scenario, body: &ThreeAxisModel) -> Vec<f64> {
    let torques = [0, 1, 2].map(|axis| axis_torque(scenario, body, axis));
    let hub = body.shapes(&scenario.study.torque_point);
    // Pulses may repeat with the period of a mode, and add up.
    let times = |of: &Disturbance| if of.pulse.is_some() { 2.0 } else { 1.0 };
    let pushes: Vec<_> =
        scenario.disturbance.iter().filter_map(|of| Some((of.force_effect(body)?, times(of)))).collect();
    let warmed = scenario.model.spacecraft().map_or(&[][..], |craft| &craft.bendings);
    let mode = |(index, mode): (usize, &ThreeAxisMode)| {
        let w = mode.frequency.get();
        let fired = scenario.study.groups.iter().flatten().flatten().map(|group| group.push.forces[index]);
        let others = (0..3).filter(|axis| !scenario.study.jet_only_axes[*axis]);
        let torques = others.map(|axis| torques[axis] * hub[index].1[axis]);
        let unloading =
            scenario.study.unloading_groups.iter().flatten().flatten().map(|group| group.push.forces[index]);
        let pushed = pushes.iter().map(|(push, times)| push.forces[index] * times);
        let force = fired.chain(torques).chain(unloading).chain(pushed).map(f64::abs).fold(0.0, f64::max);
        let held = libm::hypot(mode.displacement.get(), mode.rate.get() / w);
        let bent = warmed.iter().map(|of| of.forces[index].abs()).fold(0.0, f64::max);
        held.max(2.0 * force / (w * w)).max(bent / (w * w)).max(shaken(scenario, index, mode, &hub[index].1))
    };
    body.modes.iter().enumerate().map(mode).collect()
}

/// Returns the estimated displacement of a mode by wheel imbalance (m sqrt(kg)): in resonance if a wheel's speed range,
/// from the slowest initial or bias speed on, contains the mode's frequency, else at the highest speed.
fn shaken(scenario: &Scenario, index: usize, mode: &ThreeAxisMode, hub: &Vector) -> f64 {
    let Some((wheels, _)) = scenario.actuator.wheels() else { return 0.0 };
    let (w, damping) = (mode.frequency.get(), mode.damping.get().max(LEAST_DAMPING));
    let bias = wheels.speed_bias.map_or(f64::INFINITY, |bias| bias.speed.get().abs());
    let slowest = wheels.speeds.iter().map(|speed| speed.get().abs()).fold(bias, f64::min);
    let fastest = wheels.largest_initial_speed();
    let of = |line: &HarmonicLine| {
        let push = [0, 1].map(|part| line.forces[part][index] + hub.dot(&line.torque[part]));
        let size = libm::hypot(push[0], push[1]);
        let speed = w / line.order;
        if (slowest..=fastest).contains(&speed) {
            size * speed * speed / (2.0 * damping * w * w)
        } else {
            let turns = line.order * fastest;
            size * fastest * fastest / (w * w - turns * turns).abs()
        }
    };
    scenario.study.bearings.iter().flat_map(|bearing| &bearing.lines).map(of).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn discs_are_slowed_until_their_steps_show() {
        for (step, by) in [(0.0, 1.0), (1.0, 1.0), (1.2, 2.0), (24.0, 50.0), (50.0, 50.0), (700.0, 1000.0)] {
            assert_eq!(slow_down_factor(step), by, "{step}");
        }
    }

    #[test]
    fn factors_are_round_and_never_reduce() {
        for (estimate, factor) in
            [(0.0, 1.0), (2.0, 1.0), (0.4, 1.0), (0.01, 50.0), (2.4e-5, 20000.0), (0.07, 5.0)]
        {
            assert_eq!(turning(estimate), factor, "{estimate}");
        }
    }
}
