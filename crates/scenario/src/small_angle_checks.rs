//! Checks of small rotations: only what keeps the motion about a fixed target linear, under constant torques, goes with
//! them.

use flexsc_control::actuator::ActuatorTask;
use flexsc_control::sensor::SensorKind;
use flexsc_dynamics::three_axis_model::{SmallAngleBounds, ThreeAxisModel};
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{AXES, Vector, rotation_vector, vector};
use flexsc_numerics::time::Instant;
use flexsc_spacecraft::body::BodyModel;
use flexsc_spacecraft::body::craft::Appendage;

use super::{ResolvedScenario, ScenarioSpec};

impl ScenarioSpec {
    /// Checks that the parts of a body with small rotations leave its motion linear.
    pub(super) fn validate_small_angles(&self, model: &BodyModel) -> Option<ConfigError> {
        model.three_axis()?.small_angles?;
        let checks: [&dyn Fn() -> Option<(String, &'static str)>; 5] = [
            &|| self.body_beyond_small_angles(model),
            &|| self.torque_beyond_small_angles(model),
            &|| self.actuator_beyond_small_angles(),
            &|| self.sensor_beyond_small_angles(),
            &|| self.sines_beyond_small_angles(),
        ];
        let (key, why) = checks.iter().find_map(|check| check())?;
        Some(ConfigError::new(key, format!("{why}: leave out `{}.small_angles`", self.body_key())))
    }

    /// Returns the key of modes that have no closed form, with the reason.
    fn body_beyond_small_angles(&self, model: &BodyModel) -> Option<(String, &'static str)> {
        if self.drift.is_some() {
            return Some(("drift".to_owned(), "leaves no closed form for the modes of small rotations"));
        }
        let turns = |appendage: &Appendage| {
            let keys = [
                ("drive", appendage.drive.is_some()),
                ("hinge", appendage.hinge.is_some()),
                ("thermal", appendage.thermal.is_some()),
            ];
            keys.into_iter().find(|(_, is_given)| *is_given)
        };
        let turned = self.appendage.iter().enumerate().find_map(|(index, of)| Some((index, turns(of)?.0)));
        if let Some((index, key)) = turned {
            let why =
                "changes the modes or pushes them during the run, and those of small rotations are constant";
            return Some((format!("appendage[{index}].{key}"), why));
        }
        let coupling = model.three_axis().and_then(|body| body.coupling.as_ref());
        let is_coupled = coupling.is_some_and(|coupling| coupling.couples_by_damping);
        let is_asked = self.spacecraft.as_ref().is_some_and(|craft| craft.whole_damping == Some(true));
        let key = if is_asked { "spacecraft.whole_damping" } else { "spacecraft.small_angles" };
        is_coupled
            .then(|| (key.to_owned(), "needs uncoupled free modes, and the damping matrix couples them"))
    }

    /// Returns the key of a torque that depends on attitude or time, with the reason.
    fn torque_beyond_small_angles(&self, model: &BodyModel) -> Option<(String, &'static str)> {
        let own = model.three_axis().and_then(|body| body.disturbance.as_ref());
        if own.is_some_and(|own| own.amplitude != Vector::zeros()) {
            let why = "is periodic, and torques on small rotations are constant for a while";
            return Some(("body.spatial.disturbance.amplitude".to_owned(), why));
        }
        let around = self.environment.as_ref()?;
        let torques = [
            ("gravity_gradient", around.gravity_gradient.is_some()),
            ("solar_pressure", around.solar_pressure.is_some()),
            ("dipole", around.dipole.is_some()),
            ("drag", around.drag.is_some()),
            ("torque", around.torque.iter().any(|torque| torque.get() != 0.0)),
        ];
        let (key, _) = torques.into_iter().find(|(_, is_given)| *is_given)?;
        let why = "is a torque that changes with the attitude, and those on small rotations are constant for a while";
        Some((format!("environment.{key}"), why))
    }

    /// Returns the key of an actuator whose torque depends on the motion, with the reason.
    fn actuator_beyond_small_angles(&self) -> Option<(String, &'static str)> {
        if let Some((_, key)) = self.actuator.control_moment_gyros() {
            let why = "store momentum, whose gyroscopic torque small rotations leave out";
            return Some((key, why));
        }
        if let Some((_, key)) = self.actuator.magnetorquers() {
            let why = "push with a torque that changes with the attitude, and those on small rotations are constant for a while";
            return Some((key, why));
        }
        let (wheels, key) = self.actuator.wheels()?;
        if let Some(bearing) = wheels.bearing_key() {
            let why = "acts between commands, and torques on small rotations are constant for a while";
            return Some((format!("{key}.{bearing}"), why));
        }
        let stored = "stores momentum from the start, whose gyroscopic torque small rotations leave out";
        if wheels.largest_initial_speed() > 0.0 {
            let start = if wheels.speed_bias.is_some() { "speed_bias" } else { "speeds" };
            return Some((format!("{key}.{start}"), stored));
        }
        let unloads = |task: &ActuatorTask| matches!(task, ActuatorTask::Unloads(_));
        let is_unloaded =
            wheels.unloading.is_some() || self.actuator.members().iter().any(|member| unloads(&member.task));
        is_unloaded.then(|| {
            let why = "are unloaded of momentum, whose gyroscopic torque small rotations leave out";
            (key, why)
        })
    }

    /// Returns the key of a sensor of the coupled motion, with the reason.
    fn sensor_beyond_small_angles(&self) -> Option<(String, &'static str)> {
        if let Some((index, _)) = self.sensor.tachometer() {
            let why = "measures wheels in bearings, which move with the coupled rotation alone";
            return Some((self.sensor_key(index), why));
        }
        let index = self.sensor.iter().position(|sensor| matches!(sensor, SensorKind::Accelerometer(_)))?;
        let why = "measures the force on the coupled motion, which small rotations do not compute";
        Some((self.sensor_key(index), why))
    }

    /// Returns the key of sines, with the reason.
    fn sines_beyond_small_angles(&self) -> Option<(String, &'static str)> {
        let why = "change with time, and torques on small rotations are constant for a while";
        if let Some(index) = self.disturbance.iter().position(|of| !of.sines.is_empty()) {
            return Some((format!("disturbance[{index}].sines"), why));
        }
        self.actuator.members().into_iter().find_map(|member| {
            let index = member.kind.failures().iter().position(|failure| !failure.sines().is_empty())?;
            Some((format!("{}.faults[{index}].added.sines", member.key), why))
        })
    }

    /// Checks that a body with small rotations starts near a target that stays fixed.
    pub(super) fn validate_small_start(
        &self,
        body: &ThreeAxisModel,
        study: &ResolvedScenario,
    ) -> Option<ConfigError> {
        let SmallAngleBounds { angle: largest, rate: fastest } = body.small_angles?;
        let profile = &study.profile;
        if profile.is_moving(Instant::START) || profile.next(Instant::START).is_some() {
            let own = !self.law.own_targets().is_empty();
            let key = if own { format!("law.{}.targets", self.law.kind()) } else { "target".to_owned() };
            let why = format!(
                "must stay fixed from the start for small rotations: give at most one, inertial and without a slew, or leave out \
                 `{}.small_angles`",
                self.body_key()
            );
            return Some(ConfigError::new(key, why));
        }
        let angles = rotation_vector(&profile.target(Instant::START), &body.attitude.get());
        let checks = [
            ("attitude", angles, largest, "angle", "rad from the target"),
            ("rate", vector(&body.rate), fastest, "rate", "rad/s"),
        ];
        checks.into_iter().find_map(|(key, values, limit, of, unit)| {
            let axis = (0..3).find(|axis| values[*axis].abs() > limit)?;
            let why = format!(
                "must be within `small_angles.{of} = {limit}` about each axis, got {} {unit} about {}",
                values[axis], AXES[axis]
            );
            Some(ConfigError::new(format!("{}.{key}", self.body_key()), why))
        })
    }
}
