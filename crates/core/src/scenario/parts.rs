//! Compatibility of the parts of a scenario; errors give the reason and an alternative.

use super::Written;
use crate::actuator::{Actuator, ActuatorTask};
use crate::body::Model;
use crate::disturbance::Disturbance;
use crate::document::Fault;
use crate::law::{Itinerary, Law, Measure, Target};
use crate::sensor::Sensor;

impl Written {
    /// Checks that the parts of the scenario are compatible.
    ///
    /// # Errors
    /// Fails with the first key that is incompatible with the others, and the reason.
    pub(super) fn fit(&self, model: &Model) -> Result<(), Fault> {
        let faults = [
            self.axes_fault(),
            self.assignment_fault(),
            self.environment_fault(),
            self.target_fault(model),
            self.law_fault(),
            self.sensor_fault(),
            self.actuator_fault(),
            self.reading_fault(),
        ];
        faults.into_iter().flatten().next().map_or(Ok(()), Err)
    }

    /// Returns the error of a part for one-axis bodies with a three-axis body, or the reverse.
    fn axes_fault(&self) -> Option<Fault> {
        let refused = |key: &str, why: &str| Some(Fault::new(key, why));
        if self.axis_count() == 1 {
            let kind = self.body_kind();
            let members = self.actuator.members();
            let of = |is: fn(&Actuator) -> bool| members.iter().find(|member| is(&member.kind));
            let jets = of(|kind| matches!(kind, Actuator::Jets(_)));
            let torquers = of(|kind| matches!(kind, Actuator::Magnetorquers(_)));
            let wheels = self.actuator.wheels();
            let alone = if wheels.is_none() { (jets, torquers) } else { (None, None) };
            let found = match (&self.law, alone) {
                (Law::PerAxis(_), _) => Some(("law.per_axis", "")),
                (_, (Some(jets), _)) => {
                    Some((&*jets.key, ": `[actuator.thrusters]` push a body with one angle"))
                }
                (_, (_, Some(torquers))) => Some((&*torquers.key, "")),
                (Law::BDot(_), _) => Some(("law.b_dot", "")),
                _ if !self.target.is_empty() => {
                    Some(("target", ": a `[manoeuvre]` turns a body with one angle"))
                }
                _ if self.environment.is_some() => {
                    Some(("environment", ": a `[[disturbance]]` acts on a body with one angle"))
                }
                _ => None,
            };
            if let Some((key, instead)) = found {
                return Some(Fault::new(
                    key,
                    format!("is for a body with three axes, and the body is `{kind}`{instead}"),
                ));
            }
            if let Some(index) = self.sensor.iter().position(|sensor| sensor.point().is_some()) {
                let why = format!("is for a body with three axes, and the body is `{kind}`");
                return Some(Fault::new(format!("{}.point", self.sensor_key(index)), why));
            }
            let measured = self.sensor.iter().enumerate().find_map(|(index, sensor)| {
                let Sensor::Gyro(gyro) = sensor else { return None };
                gyro.three().map(|key| format!("{}.{key}", self.sensor_key(index)))
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
            let trackers =
                |sensor: &Sensor| matches!(sensor, Sensor::StarTracker(_)) || sensor.is_of_a_vector();
            if let Some(index) = self.sensor.iter().position(trackers) {
                let why = "measures three axes: use a `sampled` sensor for a body with one angle";
                return refused(&self.sensor_key(index), why);
            }
            let pushed = members.iter().find_map(|member| match &*member.kind {
                Actuator::Thrusters(thrusters) if thrusters.torque.is_three() => {
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
            if let Some(fault) = disturbance.three_axes_fault() {
                return Some(fault.within(&format!("disturbance[{index}]")));
            }
        }
        self.actuator.members().into_iter().find_map(|member| {
            let Actuator::Wheel(wheel) = &*member.kind else { return None };
            let why = "couples the modes of one angle: leave it out for a body with three axes";
            (wheel.back_emf.get() > 0.0).then(|| Fault::new(format!("{}.back_emf", member.key), why))
        })
    }

    fn target_fault(&self, model: &Model) -> Option<Fault> {
        if let Law::PhasePlane(law) = &self.law
            && !law.targets.is_empty()
        {
            if !self.target.is_empty() {
                let why = "are those of the scenario: leave out `law.phase_plane.targets`";
                return Some(Fault::new("target", why));
            }
            // The order of the targets is checked with the law.
            if Target::disorder(&law.targets).is_some() {
                return None;
            }
            let fault = Itinerary::fault(&law.targets, &self.sky(), &model.free_modes())?;
            return Some(fault.within("law.phase_plane.targets"));
        }
        if let Some((late, why)) = Target::disorder(&self.target) {
            return Some(Fault::new(format!("target[{late}].from"), why));
        }
        Itinerary::fault(&self.target, &self.sky(), &model.free_modes()).map(|fault| fault.within("target"))
    }

    fn law_fault(&self) -> Option<Fault> {
        for axis in 0..self.axis_count() {
            let (law, key) = (self.law.about(axis), self.law_key(axis));
            let at = |inner: &str, why: String| Some(Fault::new(inner, why).within(&key));
            if let Some(fault) = law.inconsistency() {
                return Some(fault.within(&key));
            }
            match law {
                Law::PerAxis(_) => return at("", "must be a law of one axis".to_owned()),
                Law::Relay(relay) => {
                    let (eps, gamma) = (relay.dead_zone.get(), relay.hysteresis.get());
                    if gamma >= 2.0 * eps {
                        let width = 2.0 * eps;
                        return at(
                            "hysteresis",
                            format!("must be less than the dead zone's width of {width}, got {gamma}"),
                        );
                    }
                    if self.axis_count() == 3 && self.sensor.iter().any(Sensor::is_continuous) {
                        let why = "finds its crossings in closed form, which three axes do not have: give it a `[sensor.sampled]`";
                        return at("", why.to_owned());
                    }
                }
                Law::PhasePlane(law) => {
                    if self.axis_count() == 1 && !law.targets.is_empty() {
                        let why =
                            "are for a body with three axes: a `[manoeuvre]` turns a body with one angle";
                        return at("targets", why.to_owned());
                    }
                    if matches!(self.law, Law::PerAxis(_)) && !law.targets.is_empty() {
                        return at("targets", "are those of all axes: write them as `[[target]]`".to_owned());
                    }
                    let period = law.period;
                    let members = self.actuator.members();
                    let serving = members.iter().find(|member| member.share(axis) > 0.0);
                    let Some(member) = serving else { continue };
                    let why = match &*member.kind {
                        Actuator::Jets(jets) if jets.period.is_none_or(|own| own == period) => None,
                        Actuator::Thrusters(thrusters) if thrusters.period == period => None,
                        Actuator::Jets(_) | Actuator::Thrusters(_) => {
                            Some("needs thrusters with the law's own period")
                        }
                        Actuator::Wheel(wheel) if wheel.delay.get() > 0.0 => {
                            Some("needs a wheel without delay, whose commands it does not see")
                        }
                        Actuator::Wheel(wheel) if wheel.limit.is_some() => None,
                        Actuator::Wheels(wheels) if wheels.torque.is_some() => None,
                        Actuator::Own(own) if own.limit(axis).is_some() => None,
                        Actuator::ControlMomentGyros(_) => Some(
                            "needs a largest torque that is constant, and that of control moment gyros changes with their gimbal angles",
                        ),
                        Actuator::Ideal(_)
                        | Actuator::Hold(_)
                        | Actuator::Wheel(_)
                        | Actuator::Wheels(_)
                        | Actuator::Magnetorquers(_)
                        | Actuator::Own(_) => Some(
                            "needs the largest torque, on which its switching lines depend: thrusters, jets, a wheel with a \
                             `limit`, or wheels with a `torque`",
                        ),
                    };
                    if let Some(why) = why {
                        return at("", why.to_owned());
                    }
                }
                Law::BDot(_) => {
                    if let Some(fault) = self.b_dot_fault() {
                        return Some(fault.within(&key));
                    }
                }
                Law::Stages(laws) => {
                    let commands = laws.laws().position(|law| matches!(law, Law::BDot(_)));
                    let magnetic = commands
                        .and_then(|index| Some(self.b_dot_fault()?.within(&format!("[{index}].law.b_dot"))));
                    if let Some(fault) = magnetic {
                        return Some(fault.within(&key));
                    }
                }
                Law::Pd(_) | Law::Attitude(_) | Law::StateSpace(_) | Law::Open(_) | Law::Own(_) => {}
            }
            if let Law::Attitude(law) = law
                && law.inertia.is_some()
                && (self.axis_count() == 1 || matches!(self.law, Law::PerAxis(_)))
            {
                let why =
                    "is the tensor for one law about three axes: it needs a `[law.attitude]` for all of them";
                return at("inertia", why.to_owned());
            }
            let measure = match law {
                Law::Pd(law) => law.error,
                Law::Attitude(law) => law.error,
                _ => Measure::default(),
            };
            if self.axis_count() == 1 && measure != Measure::default() {
                let why = "applies only to rotations about three axes";
                return at("error", why.to_owned());
            }
        }
        None
    }

    fn actuator_fault(&self) -> Option<Fault> {
        if let Some((_, key)) = self.actuator.magnetorquers()
            && self.environment.as_ref().is_none_or(|around| around.magnetic_field.is_none())
        {
            let why = "need the field of `[environment.magnetic_field]`, and there is none";
            return Some(Fault::new(key, why));
        }
        let gyros = self.actuator.control_moment_gyros().filter(|(gyros, _)| gyros.period.is_none());
        let holds = |axis: usize| matches!(self.law.about(axis), Law::Relay(_));
        if let Some((_, of)) = gyros.filter(|_| (0..self.axis_count()).any(holds)) {
            let why = "must be given with a law `relay`, which holds its torque: gimbals at constant rates turn theirs";
            return Some(Fault::new(format!("{of}.period"), why));
        }
        let acting = self.actuator.members().into_iter().find(|member| {
            matches!(&*member.kind, Actuator::Jets(_)) && matches!(member.task, ActuatorTask::Executes(_))
        })?;
        let Actuator::Jets(jets) = &*acting.kind else { return None };
        let at = |key: &str, why: String| Some(Fault::new(format!("{}.{key}", acting.key), why));
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
