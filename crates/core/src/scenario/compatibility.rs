//! Compatibility of the parts of a scenario; errors give the reason and an alternative.

use flexsc_control::actuator::{ActuatorKind, ActuatorTask};
use flexsc_control::law::{AttitudeErrorMeasure, AttitudeProfile, AttitudeTarget, LawKind};
use flexsc_control::sensor::SensorKind;
use flexsc_formats::document::ConfigError;
use flexsc_spacecraft::body::BodyModel;
use flexsc_spacecraft::disturbance::Disturbance;

use super::ScenarioSpec;

impl ScenarioSpec {
    /// Checks that the parts of the scenario are compatible.
    ///
    /// # Errors
    /// Fails with the first key that is incompatible with the others, and the reason.
    pub(super) fn validate_compatibility(&self, model: &BodyModel) -> Result<(), ConfigError> {
        let faults = [
            self.validate_axes(),
            self.validate_actuators(),
            self.validate_environment(),
            self.validate_targets(model),
            self.validate_law(),
            self.validate_sensors(),
            self.validate_actuator_requirements(),
            self.validate_estimator_inputs(),
        ];
        faults.into_iter().flatten().next().map_or(Ok(()), Err)
    }

    /// Returns the error of a part for one-axis bodies with a three-axis body, or the reverse.
    fn validate_axes(&self) -> Option<ConfigError> {
        let refused = |key: &str, why: &str| Some(ConfigError::new(key, why));
        if self.axis_count() == 1 {
            let kind = self.body_kind();
            let members = self.actuator.members();
            let of = |is: fn(&ActuatorKind) -> bool| members.iter().find(|member| is(&member.kind));
            let jets = of(|kind| matches!(kind, ActuatorKind::Jets(_)));
            let torquers = of(|kind| matches!(kind, ActuatorKind::Magnetorquers(_)));
            let wheels = self.actuator.wheels();
            let alone = if wheels.is_none() { (jets, torquers) } else { (None, None) };
            let found = match (&self.law, alone) {
                (LawKind::PerAxis(_), _) => Some(("law.per_axis", "")),
                (_, (Some(jets), _)) => {
                    Some((&*jets.key, ": `[actuator.thrusters]` push a body with one angle"))
                }
                (_, (_, Some(torquers))) => Some((&*torquers.key, "")),
                (LawKind::BDot(_), _) => Some(("law.b_dot", "")),
                _ if !self.target.is_empty() => {
                    Some(("target", ": a `[manoeuvre]` turns a body with one angle"))
                }
                _ if self.environment.is_some() => {
                    Some(("environment", ": a `[[disturbance]]` acts on a body with one angle"))
                }
                _ => None,
            };
            if let Some((key, instead)) = found {
                return Some(ConfigError::new(
                    key,
                    format!("is for a body with three axes, and the body is `{kind}`{instead}"),
                ));
            }
            if let Some(index) = self.sensor.iter().position(|sensor| sensor.point().is_some()) {
                let why = format!("is for a body with three axes, and the body is `{kind}`");
                return Some(ConfigError::new(format!("{}.point", self.sensor_key(index)), why));
            }
            let measured = self.sensor.iter().enumerate().find_map(|(index, sensor)| {
                let SensorKind::Gyro(gyro) = sensor else { return None };
                gyro.three_axis_key().map(|key| format!("{}.{key}", self.sensor_key(index)))
            });
            if self.estimator.as_ref().is_some_and(|estimator| estimator.attitude().is_some()) {
                let why = "is for three axes: use `[estimator.kalman]` for a body with one angle";
                return refused("estimator.attitude", why);
            }
            if let Some((_, key)) = wheels {
                let why = "are for three axes: use `[actuator.wheel]` for a body with one angle";
                return refused(&key, why);
            }
            if let Some((_, key)) = self.actuator.control_moment_gyros() {
                let why = "turn a body about three axes, and the body has one angle: use `[actuator.wheel]`";
                return refused(&key, why);
            }
            let trackers = |sensor: &SensorKind| {
                matches!(sensor, SensorKind::StarTracker(_)) || sensor.measures_vector()
            };
            if let Some(index) = self.sensor.iter().position(trackers) {
                let why = "measures three axes: use a `sampled` sensor for a body with one angle";
                return refused(&self.sensor_key(index), why);
            }
            let pushed = members.iter().find_map(|member| match &*member.kind {
                ActuatorKind::Thrusters(thrusters) if thrusters.torque.is_three() => {
                    Some(format!("{}.torque", member.key))
                }
                _ => None,
            });
            if let Some(key) = measured.or(pushed) {
                return refused(
                    &key,
                    "must be one number for a body with one angle, got one for each of three axes",
                );
            }
            let forced =
                |disturbance: &Disturbance| disturbance.force.is_some() || disturbance.point.is_some();
            if let Some(index) = self.disturbance.iter().position(forced) {
                let why = "acts on a body with three axes: use a `torque` for a body with one angle";
                return refused(&format!("disturbance[{index}].force"), why);
            }
            let about = self.disturbance.iter().position(|disturbance| disturbance.about.is_some())?;
            return refused(
                &format!("disturbance[{about}].about"),
                "names one of three axes, and the body has one angle",
            );
        }
        if self.manoeuvre.is_some() {
            return refused("manoeuvre", "is for bodies with one angle: use `[[target]]` for three axes");
        }
        if self.drift.is_some() && self.spacecraft.is_some() {
            let why = "is for modes that are given: those of a `[spacecraft]` follow from its appendages, which a `drive` can turn";
            return refused("drift", why);
        }
        for (index, disturbance) in self.disturbance.iter().enumerate() {
            if let Some(fault) = disturbance.validate_three_axis() {
                return Some(fault.within(&format!("disturbance[{index}]")));
            }
        }
        self.actuator.members().into_iter().find_map(|member| {
            let ActuatorKind::Wheel(wheel) = &*member.kind else { return None };
            let why = "couples the modes of one angle: leave it out for a body with three axes";
            (wheel.back_emf.get() > 0.0).then(|| ConfigError::new(format!("{}.back_emf", member.key), why))
        })
    }

    fn validate_targets(&self, model: &BodyModel) -> Option<ConfigError> {
        if let LawKind::PhasePlane(law) = &self.law
            && !law.targets.is_empty()
        {
            if !self.target.is_empty() {
                let why = "are those of the scenario: leave out `law.phase_plane.targets`";
                return Some(ConfigError::new("target", why));
            }
            // The order of the targets is checked with the law.
            if AttitudeTarget::validate_order(&law.targets).is_some() {
                return None;
            }
            let fault =
                AttitudeProfile::validate(&law.targets, &self.orbit_environment(), &model.free_modes())?;
            return Some(fault.within("law.phase_plane.targets"));
        }
        if let Some((late, why)) = AttitudeTarget::validate_order(&self.target) {
            return Some(ConfigError::new(format!("target[{late}].from"), why));
        }
        AttitudeProfile::validate(&self.target, &self.orbit_environment(), &model.free_modes())
            .map(|fault| fault.within("target"))
    }

    fn validate_law(&self) -> Option<ConfigError> {
        for axis in 0..self.axis_count() {
            let (law, key) = (self.law.about(axis), self.law_key(axis));
            let at = |inner: &str, why: String| Some(ConfigError::new(inner, why).within(&key));
            if let Some(fault) = law.inconsistency() {
                return Some(fault.within(&key));
            }
            match law {
                LawKind::PerAxis(_) => return at("", "must be a law of one axis".to_owned()),
                LawKind::Relay(relay) => {
                    let (width, gamma) = (2.0 * relay.dead_zone.get(), relay.hysteresis.get());
                    if gamma >= width {
                        let why = format!("must be less than the dead zone's width of {width}, got {gamma}");
                        return at("hysteresis", why);
                    }
                    if self.axis_count() == 3 && self.sensor.iter().any(SensorKind::is_continuous) {
                        let why = "finds its crossings in closed form, which three axes do not have: give it a `[sensor.sampled]`";
                        return at("", why.to_owned());
                    }
                }
                LawKind::PhasePlane(law) => {
                    if self.axis_count() == 1 && !law.targets.is_empty() {
                        let why =
                            "are for a body with three axes: a `[manoeuvre]` turns a body with one angle";
                        return at("targets", why.to_owned());
                    }
                    if matches!(self.law, LawKind::PerAxis(_)) && !law.targets.is_empty() {
                        return at("targets", "are those of all axes: write them as `[[target]]`".to_owned());
                    }
                    let period = law.period;
                    let members = self.actuator.members();
                    let serving = members.iter().find(|member| member.share(axis) > 0.0);
                    let Some(member) = serving else { continue };
                    let why = match &*member.kind {
                        ActuatorKind::Jets(jets) if jets.period.is_none_or(|own| own == period) => None,
                        ActuatorKind::Thrusters(thrusters) if thrusters.period == period => None,
                        ActuatorKind::Jets(_) | ActuatorKind::Thrusters(_) => {
                            Some("needs thrusters with the law's own period")
                        }
                        ActuatorKind::Wheel(wheel) if wheel.delay.get() > 0.0 => {
                            Some("needs a wheel without delay, whose commands it does not see")
                        }
                        ActuatorKind::Wheel(wheel) if wheel.limit.is_some() => None,
                        ActuatorKind::Wheels(wheels) if wheels.torque.is_some() => None,
                        ActuatorKind::Own(own) if own.limit(axis).is_some() => None,
                        ActuatorKind::ControlMomentGyros(_) => Some(
                            "needs a largest torque that is constant, and that of control moment gyros changes with their gimbal angles",
                        ),
                        ActuatorKind::Ideal(_)
                        | ActuatorKind::Hold(_)
                        | ActuatorKind::Wheel(_)
                        | ActuatorKind::Wheels(_)
                        | ActuatorKind::Magnetorquers(_)
                        | ActuatorKind::Own(_) => Some(
                            "needs the largest torque, on which its switching lines depend: thrusters, jets, a wheel with a \
                             `limit`, or wheels with a `torque`",
                        ),
                    };
                    if let Some(why) = why {
                        return at("", why.to_owned());
                    }
                }
                LawKind::BDot(_) => {
                    if let Some(fault) = self.validate_b_dot() {
                        return Some(fault.within(&key));
                    }
                }
                LawKind::Stages(laws) => {
                    let commands = laws.laws().position(|law| matches!(law, LawKind::BDot(_)));
                    let magnetic = commands.and_then(|index| {
                        Some(self.validate_b_dot()?.within(&format!("[{index}].law.b_dot")))
                    });
                    if let Some(fault) = magnetic {
                        return Some(fault.within(&key));
                    }
                }
                LawKind::Pd(_)
                | LawKind::Attitude(_)
                | LawKind::StateSpace(_)
                | LawKind::Open(_)
                | LawKind::Own(_) => {}
            }
            if let LawKind::Attitude(law) = law
                && law.inertia.is_some()
                && (self.axis_count() == 1 || matches!(self.law, LawKind::PerAxis(_)))
            {
                let why =
                    "is the tensor for one law about three axes: it needs a `[law.attitude]` for all of them";
                return at("inertia", why.to_owned());
            }
            let measure = match law {
                LawKind::Pd(law) => law.error,
                LawKind::Attitude(law) => law.error,
                _ => AttitudeErrorMeasure::default(),
            };
            if self.axis_count() == 1 && measure != AttitudeErrorMeasure::default() {
                let why = "applies only to rotations about three axes";
                return at("error", why.to_owned());
            }
        }
        None
    }

    fn validate_actuator_requirements(&self) -> Option<ConfigError> {
        if let Some((_, key)) = self.actuator.magnetorquers()
            && self.environment.as_ref().is_none_or(|around| around.magnetic_field.is_none())
        {
            let why = "need the field of `[environment.magnetic_field]`, and there is none";
            return Some(ConfigError::new(key, why));
        }
        let gyros = self.actuator.control_moment_gyros().filter(|(gyros, _)| gyros.period.is_none());
        let holds = |axis: usize| matches!(self.law.about(axis), LawKind::Relay(_));
        if let Some((_, of)) = gyros.filter(|_| (0..self.axis_count()).any(holds)) {
            let why = "must be given with a law `relay`, which holds its torque: gimbals at constant rates turn theirs";
            return Some(ConfigError::new(format!("{of}.period"), why));
        }
        let acting = self.actuator.members().into_iter().find(|member| {
            matches!(&*member.kind, ActuatorKind::Jets(_)) && matches!(member.task, ActuatorTask::Executes(_))
        })?;
        let ActuatorKind::Jets(jets) = &*acting.kind else { return None };
        let at = |key: &str, why: String| Some(ConfigError::new(format!("{}.{key}", acting.key), why));
        let laws = (0..3).map(|axis| self.law.about(axis).period());
        let own: Vec<_> = laws.collect();
        let Some(period) = jets.period.or(own[0]) else {
            return at("period", "must be given with a law that has none of its own".to_owned());
        };
        if jets.period.is_none() && own.iter().any(|other| *other != own[0]) {
            return at(
                "period",
                "must be given where the laws of the axes have periods that differ".to_owned(),
            );
        }
        let period = period.seconds();
        for (key, value) in [("minimum_on", jets.minimum_on.get()), ("quantum", jets.quantum.get())] {
            if value > period {
                let whose = if jets.period.is_some() { "" } else { "law's " };
                return at(key, format!("must be at most the {whose}period of {period} s, got {value}"));
            }
        }
        if jets.delay > 1 {
            return at("delay", format!("must be 0 or 1 cycles, got {}", jets.delay));
        }
        None
    }
}
