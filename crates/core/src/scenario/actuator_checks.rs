//! Checks of several actuators: their combination, and whether their shares sum to the whole demand.

use flexsc_control::actuator::{
    ActuatorKind, ActuatorTask, AssignedActuator, AssignedMember, WheelUnloading,
};
use flexsc_control::law::LawKind;
use flexsc_control::one_or_many::OneOrMany;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::AXES;
use flexsc_numerics::quantity::Time;

use super::ScenarioSpec;

/// Tolerance of the sum of rounded shares.
const ROUNDING: f64 = 1e-9;

impl ScenarioSpec {
    /// Checks the actuators: each alone, duplicates, phases, and shares.
    pub(super) fn validate_actuators(&self) -> Option<ConfigError> {
        let members = self.actuator.members();
        let each = self.actuator.iter().enumerate();
        each.map(|(index, of)| (self.actuator.key("actuator", index), of))
            .find_map(|(key, of)| self.validate_actuator(of).map(|fault| fault.within(&key)))
            .or_else(|| validate_unloading(&self.actuator, &members))
            .or_else(|| self.validate_duplicates(&members))
            .or_else(|| self.validate_phase(&members))
            .or_else(|| self.validate_shares(&members))
    }

    /// Checks the axes and share of an actuator; returns the error at its key.
    fn validate_actuator(&self, of: &AssignedActuator) -> Option<ConfigError> {
        let at = |key: &str, why: &str| Some(ConfigError::new(key, why));
        if of.unloads.is_some() {
            let why = "must be left out with `unloads`: an actuator that unloads wheels executes no demand";
            return match (&of.axes, of.share) {
                (Some(_), _) => at("axes", why),
                (None, Some(_)) => at("share", why),
                (None, None) => None,
            };
        }
        let axes = of.axes.as_ref()?;
        if self.axis_count() == 1 {
            return at("axes", "names axes of three, and the body has one angle: leave it out");
        }
        if axes.is_empty() {
            return at("axes", "must name an axis: `roll`, `pitch` or `yaw`, got none");
        }
        let twice = axes.iter().enumerate().find(|(index, axis)| axes[..*index].contains(axis));
        twice.and_then(|(_, axis)| at("axes", &format!("names `{}` twice", AXES[axis.index()])))
    }

    /// Checks that there is one actuator where only one is allowed.
    fn validate_duplicates(&self, members: &[AssignedMember<'_>]) -> Option<ConfigError> {
        for (index, member) in members.iter().enumerate() {
            let before = &members[..index];
            let is_alike = |other: &&AssignedMember<'_>| other.kind.kind() == member.kind.kind();
            let why = match &*member.kind {
                ActuatorKind::Wheels(_) => "write all wheels in one `wheels`, by their `axes`",
                ActuatorKind::ControlMomentGyros(_) => {
                    "write all of them in one `control_moment_gyros`, by their `gimbal_axes`"
                }
                ActuatorKind::Jets(_) => "write all thrusters in one `jets`",
                ActuatorKind::Magnetorquers(_) => "they act along all three axes: write one `magnetorquers`",
                ActuatorKind::Wheel(wheel) => {
                    if members.len() > 1 && wheel.rotor.is_some() {
                        let why = "gets its speed from the rate of the body, which other actuators change too: leave it out, or use \
                                   `[actuator.wheels]` on a body with three axes";
                        return Some(ConfigError::new(format!("{}.rotor", member.key), why));
                    }
                    let meets = |other: &AssignedMember<'_>| {
                        (0..self.axis_count()).find(|axis| other.share(*axis) * member.share(*axis) > 0.0)
                    };
                    if before.iter().filter(is_alike).find_map(meets).is_none() {
                        continue;
                    }
                    "an axis has one flywheel: give it the gain of both"
                }
                _ => continue,
            };
            if let Some(other) = before.iter().find(is_alike) {
                return Some(ConfigError::new(
                    &member.key,
                    format!("are there already, as `{}`: {why}", other.key),
                ));
            }
        }
        None
    }

    /// Checks that a phase does not miss a first period.
    fn validate_phase(&self, members: &[AssignedMember<'_>]) -> Option<ConfigError> {
        let planned =
            (0..self.axis_count()).any(|axis| matches!(self.law.about(axis), LawKind::PhasePlane(_)));
        members.iter().find_map(|member| {
            let at = |why: &str| Some(ConfigError::new(format!("{}.phase", member.key), why));
            let phase = member.kind.phase()?;
            if member.kind.period().is_none() {
                return at(
                    "applies only to jets with a `period` of their own: without one they act with the law",
                );
            }
            if phase == Time::ZERO {
                return None;
            }
            if self.manoeuvre.is_some() {
                return at("must be 0 with a `[manoeuvre]`, whose begin it would miss");
            }
            let acts = (0..3).any(|axis| member.share(axis) > 0.0);
            if planned && acts {
                return at("must be 0 with a law `phase_plane`, whose pulses begin with the law's periods");
            }
            None
        })
    }

    /// Checks that the shares about each axis sum to 1.
    fn validate_shares(&self, members: &[AssignedMember<'_>]) -> Option<ConfigError> {
        for (axis, name) in AXES.iter().enumerate().take(self.axis_count()) {
            let serving: Vec<&AssignedMember<'_>> =
                members.iter().filter(|member| member.share(axis) > 0.0).collect();
            let about = if self.axis_count() == 1 { String::new() } else { format!(" about {name}") };
            let Some(last) = serving.last() else {
                if matches!(self.law.about(axis), LawKind::Open(_)) {
                    continue;
                }
                let why = format!(
                    "has none that acts{about}, and the law acts there: name `{name}` in the `axes` of one"
                );
                return Some(ConfigError::new("actuator", why));
            };
            let sum: f64 = serving.iter().map(|member| member.share(axis)).sum();
            if (sum - 1.0).abs() > ROUNDING {
                let each: Vec<String> =
                    serving.iter().map(|of| format!("{} of `{}`", of.share(axis), of.key)).collect();
                let why = format!("must sum to 1 with the others{about}, got {sum} ({})", each.join(", "));
                let key = last.key.rsplit_once('.').map_or("actuator", |(entry, _)| entry);
                return Some(ConfigError::new(format!("{key}.share"), why));
            }
            if serving.len() > 1 && matches!(self.law.about(axis), LawKind::PhasePlane(_)) {
                let why = format!("needs one actuator{about}, and there are {}", serving.len());
                return Some(ConfigError::new(self.law_key(axis), why));
            }
        }
        None
    }
}

/// Checks the unloading of wheels or control moment gyros.
fn validate_unloading(
    actuators: &OneOrMany<AssignedActuator>,
    members: &[AssignedMember<'_>],
) -> Option<ConfigError> {
    if let Some((wheels, key)) = actuators.wheels()
        && let Some(fault) = wheels.unloading.as_deref().and_then(WheelUnloading::inconsistency)
    {
        return Some(fault.within(&format!("{key}.unloading")));
    }
    let mut unloaders = members.iter().filter_map(|member| match &member.task {
        ActuatorTask::Unloads(unloads) => Some((member, unloads)),
        ActuatorTask::Executes(_) => None,
    });
    let (member, unloads) = unloaders.next()?;
    let how = member.unloading_key();
    if let Some((fault, within)) = unloads.fault(&member.kind) {
        return Some(fault.within(if within { &member.key } else { &how }));
    }
    let why = match (actuators.wheels(), actuators.control_moment_gyros()) {
        (None, None) => {
            "needs `wheels` or `control_moment_gyros` in the list, whose momentum it takes, and there are none"
        }
        (Some(_), Some(_)) => {
            "must be left out with both `wheels` and `control_moment_gyros`, whose momenta it cannot tell apart"
        }
        _ => "",
    };
    if !why.is_empty() {
        return Some(ConfigError::new(how, why));
    }
    let (second, _) = unloaders.next()?;
    let why = format!("must be left out: `{}` unloads the wheels, and only one can", member.key);
    Some(ConfigError::new(&second.key, why))
}
