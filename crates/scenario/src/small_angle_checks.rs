//! Checks of small rotations: only what keeps the motion about a fixed target linear, under constant torques, goes with
//! them.

use flexsc_control::actuator::ActuatorTask;
use flexsc_control::sensor::SensorKind;
use flexsc_dynamics::three_axis_model::{SmallAngleBounds, ThreeAxisModel};
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{AXES, Vector, rotation_vector, vector};
use flexsc_numerics::time::Instant;
use flexsc_spacecraft::body::BodyModel;

use super::{ResolvedScenario, ScenarioSpec};

/// Keys that are in conflict with small rotations, each with the reason.
type Conflicts = Vec<(String, &'static str)>;

impl ScenarioSpec {
    /// Adds the requirement that the parts of a body with small rotations leave its motion linear.
    pub(super) fn require_small_angles(
        &self,
        model: &BodyModel,
        body: &ThreeAxisModel,
        errors: &mut Vec<ConfigError>,
    ) {
        let mut conflicts = Vec::new();
        self.body_beyond_small_angles(body, &mut conflicts);
        self.torque_beyond_small_angles(body, &mut conflicts);
        self.actuator_beyond_small_angles(&mut conflicts);
        self.sensor_beyond_small_angles(&mut conflicts);
        if model.spacecraft().is_some() {
            self.sines_beyond_small_angles(&mut conflicts);
        }
        errors.extend(conflicts.into_iter().map(|(key, why)| {
            ConfigError::new(key, format!("{why}: leave out `{}.small_angles`", self.body_key()))
        }));
    }

    /// Adds the keys of modes that have no closed form, with the reasons.
    fn body_beyond_small_angles(&self, body: &ThreeAxisModel, conflicts: &mut Conflicts) {
        if self.drift.is_some() && self.spacecraft.is_none() {
            conflicts.push(("drift".to_owned(), "leaves no closed form for the modes of small rotations"));
        }
        for (index, appendage) in self.appendage.iter().enumerate() {
            let keys = [
                ("drive", appendage.drive.is_some()),
                ("hinge", appendage.hinge.is_some()),
                ("thermal", appendage.thermal.is_some()),
            ];
            let why =
                "changes the modes or pushes them during the run, and those of small rotations are constant";
            let given = keys.into_iter().filter(|(_, is_given)| *is_given);
            conflicts.extend(given.map(|(key, _)| (format!("appendage[{index}].{key}"), why)));
        }
        if body.coupling.as_ref().is_some_and(|coupling| coupling.couples_by_damping) {
            let is_asked = self.spacecraft.as_ref().is_some_and(|craft| craft.whole_damping == Some(true));
            let key = if is_asked { "spacecraft.whole_damping" } else { "spacecraft.small_angles" };
            let why = "needs uncoupled free modes, and the damping matrix couples them";
            conflicts.push((key.to_owned(), why));
        }
    }

    /// Adds the keys of torques that depend on attitude or time, with the reasons.
    fn torque_beyond_small_angles(&self, body: &ThreeAxisModel, conflicts: &mut Conflicts) {
        if body.disturbance.as_ref().is_some_and(|own| own.amplitude != Vector::zeros()) {
            let why = "is periodic, and torques on small rotations are constant for a while";
            conflicts.push(("body.spatial.disturbance.amplitude".to_owned(), why));
        }
        let Some(around) = &self.environment else { return };
        let torques = [
            ("gravity_gradient", around.gravity_gradient.is_some()),
            ("solar_pressure", around.solar_pressure.is_some()),
            ("dipole", around.dipole.is_some()),
            ("drag", around.drag.is_some()),
            ("torque", around.torque.iter().any(|torque| torque.get() != 0.0)),
        ];
        let why = "is a torque that changes with the attitude, and those on small rotations are constant for a while";
        let given = torques.into_iter().filter(|(_, is_given)| *is_given);
        conflicts.extend(given.map(|(key, _)| (format!("environment.{key}"), why)));
    }

    /// Adds the keys of actuators whose torque depends on the motion, with the reasons.
    fn actuator_beyond_small_angles(&self, conflicts: &mut Conflicts) {
        if let Some((_, key)) = self.actuator.control_moment_gyros() {
            conflicts.push((key, "store momentum, whose gyroscopic torque small rotations leave out"));
        }
        let torquers = self.actuator.magnetorquers().map(|(_, key)| key);
        let turns_with_field = torquers.is_some();
        let why = "push with a torque that changes with the attitude, and those on small rotations are constant for a while";
        conflicts.extend(torquers.map(|key| (key, why)));
        let Some((wheels, key)) = self.actuator.wheels() else { return };
        if let Some(bearing) = wheels.bearing_key() {
            let why = "acts between commands, and torques on small rotations are constant for a while";
            conflicts.push((format!("{key}.{bearing}"), why));
        }
        if wheels.largest_initial_speed() > 0.0 {
            let start = if wheels.speed_bias.is_some() { "speed_bias" } else { "speeds" };
            let why = "stores momentum from the start, whose gyroscopic torque small rotations leave out";
            conflicts.push((format!("{key}.{start}"), why));
        }
        let unloads = |task: &ActuatorTask| matches!(task, ActuatorTask::Unloads(_));
        let is_unloaded = self.actuator.members().iter().any(|member| unloads(&member.task));
        // Magnetorquers that unload wheels were reported themselves.
        if (is_unloaded || wheels.unloading.is_some()) && !turns_with_field {
            conflicts
                .push((key, "are unloaded of momentum, whose gyroscopic torque small rotations leave out"));
        }
    }

    /// Adds the keys of sensors of the coupled motion, with the reasons.
    fn sensor_beyond_small_angles(&self, conflicts: &mut Conflicts) {
        if let Some((index, _)) = self.sensor.tachometer() {
            let why = "measures wheels in bearings, which move with the coupled rotation alone";
            conflicts.push((self.sensor_key(index), why));
        }
        let why = "measures the force on the coupled motion, which small rotations do not compute";
        let sensors = self.sensor.iter().enumerate();
        let accelerometers = sensors.filter(|(_, sensor)| matches!(sensor, SensorKind::Accelerometer(_)));
        conflicts.extend(accelerometers.map(|(index, _)| (self.sensor_key(index), why)));
    }

    /// Adds the keys of sines, with the reason.
    fn sines_beyond_small_angles(&self, conflicts: &mut Conflicts) {
        let why = "change with time, and torques on small rotations are constant for a while";
        let disturbances = self.disturbance.iter().enumerate().filter(|(_, of)| !of.sines.is_empty());
        conflicts.extend(disturbances.map(|(index, _)| (format!("disturbance[{index}].sines"), why)));
        for member in self.actuator.members() {
            let failures = member.kind.failures().iter().enumerate();
            let sines = failures.filter(|(_, failure)| !failure.sines().is_empty());
            conflicts
                .extend(sines.map(|(index, _)| (format!("{}.faults[{index}].added.sines", member.key), why)));
        }
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
            let why = format!(
                "must stay fixed from the start for small rotations: give at most one, inertial and without a slew, or leave out \
                 `{}.small_angles`",
                self.body_key()
            );
            return Some(ConfigError::new(self.targets_key(), why));
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
