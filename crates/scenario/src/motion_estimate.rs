//! Motion that a run of a three-axis body is expected to have, from which the length of its steps is estimated.

use flexsc_control::actuator::{Failure, Wheels};
use flexsc_control::law::AttitudeTarget;
use flexsc_dynamics::periodic_torque::PeriodicTorque;
use flexsc_dynamics::three_axis::{Bearing, IMBALANCE_PHASE, Surroundings};
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_numerics::attitude::vector;

use super::Scenario;
use super::pace::QUIET_RATE;

/// Mean speed of the fastest wheel, as a part of the speed that the wheels can reach.
const MEAN_SPEED: f64 = 0.5;

impl Scenario {
    /// Returns true if a three-axis body of this rate (rad/s) holds its attitude in surroundings, and its steps need not resolve
    /// its modes.
    pub(super) fn is_quiet(&self, rate: f64) -> bool {
        let study = &self.study;
        rate < QUIET_RATE
            && study.surroundings.as_ref().is_some_and(|around| around.thermal_forces().is_empty())
            && study.drives.is_none()
            && study.hinges() == 0
            && study.bearings.is_empty()
            && self.actuator.control_moment_gyros().is_none()
    }

    /// Returns the time in which forces act at points of the body (s).
    pub(super) fn forced_time(&self) -> f64 {
        let duration = self.duration.seconds();
        let forces = self.disturbance.iter().filter(|disturbance| disturbance.is_force());
        let times = forces.map(|disturbance| {
            let until = disturbance.to.map_or(duration, |to| to.get().min(duration));
            let part = disturbance.pulse.map_or(1.0, |pulse| pulse.on.seconds() / pulse.period.seconds());
            part * (until - disturbance.from.get()).max(0.0)
        });
        times.sum::<f64>().min(duration)
    }

    /// Returns the largest frequency of the sinusoidal torques of disturbances and failures (rad/s); 0 without.
    pub(super) fn largest_sine_frequency(&self) -> f64 {
        let members = self.actuator.members();
        let failures = members.iter().flat_map(|member| member.kind.failures()).flat_map(Failure::sines);
        let disturbances = self.disturbance.iter().flat_map(|disturbance| &disturbance.sines);
        failures.chain(disturbances).map(|sine| sine.frequency.get()).fold(0.0, f64::max)
    }

    /// Returns the expected largest frequency (rad/s) of the rotation and loads of a three-axis body.
    pub(super) fn largest_expected_rate(&self, body: &ThreeAxisModel) -> f64 {
        let around = self.study.surroundings.as_ref().map_or(0.0, Surroundings::frequency);
        let own = body.disturbance.as_ref().map_or(0.0, PeriodicTorque::frequency);
        let gimbals =
            self.actuator.control_moment_gyros().map_or(0.0, |(gyros, _)| gyros.largest_gimbal_rate());
        self.largest_turn_rate(body) + around + own + gimbals + self.largest_sine_frequency()
    }

    /// Returns the largest rate (rad/s) of the body at the start and of its targets.
    fn largest_turn_rate(&self, body: &ThreeAxisModel) -> f64 {
        let limits = self.targets().iter().filter_map(AttitudeTarget::fastest).map(|(_, rate)| rate);
        limits.fold(vector(&body.rate).norm(), f64::max)
    }

    /// Returns the largest angular acceleration (rad/s²) that the environment can give the body.
    pub(super) fn largest_acceleration(&self, body: &ThreeAxisModel) -> f64 {
        let torque = self.study.surroundings.as_ref().map_or(0.0, Surroundings::bound);
        body.inertia.try_inverse().map_or(0.0, |inverse| inverse.norm() * torque)
    }

    /// Returns the length of steps that resolve viscous friction, whirl and the imbalance of wheels at the speeds that they can reach
    /// (s); infinite without wheels.
    pub(super) fn rotor_step(&self, body: &ThreeAxisModel) -> f64 {
        let Some((wheels, _)) = self.actuator.wheels() else { return f64::INFINITY };
        let highest = self.study.bearings.iter().map(Bearing::highest_order).fold(0.0, f64::max);
        let slowing = self.study.bearings.iter().map(Bearing::viscous_rate).fold(0.0, f64::max);
        let speed = self.mean_wheel_speed(wheels, body);
        let whirl = self.study.bearings.iter().map(|own| own.whirl_rate(own.inertia * speed));
        IMBALANCE_PHASE / (highest * speed).max(slowing).max(whirl.fold(0.0, f64::max))
    }

    /// Returns the expected mean speed (rad/s) of the fastest wheel: the initial or bias speed, or a part of the largest speed, if
    /// that is more; without a limit, the speed that takes up the momentum of the body's turns.
    fn mean_wheel_speed(&self, wheels: &Wheels, body: &ThreeAxisModel) -> f64 {
        let first = wheels.largest_initial_speed();
        let reached = match wheels.speed_bound() {
            Some(bound) => MEAN_SPEED * bound,
            None => body.inertia.norm() * self.largest_turn_rate(body) / wheels.inertia.get(),
        };
        first.max(reached)
    }
}
