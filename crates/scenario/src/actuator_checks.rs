//! Checks of the tasks of actuators: axes, unloading, and shares that sum to the whole demand.

use flexsc_control::actuator::{ActuatorTask, AssignedActuator, AssignedMember, WheelUnloading};
use flexsc_control::law::Stage;
use flexsc_control::offers::{ActuatorMember, AxisLaw, Offers};
use flexsc_control::one_or_many::OneOrMany;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::AXES;

use super::ScenarioSpec;

/// Tolerance of the sum of rounded shares.
const ROUNDING: f64 = 1e-9;

impl ScenarioSpec {
    /// Checks the tasks of the actuators, each alone, and the unloading.
    pub(super) fn validate_assignments(&self) -> Option<ConfigError> {
        let members = self.actuator.members();
        let each = self.actuator.iter().enumerate();
        each.map(|(index, of)| (self.actuator.key("actuator", index), of))
            .find_map(|(key, of)| self.validate_actuator(of).map(|fault| fault.within(&key)))
            .or_else(|| validate_unloading(&self.actuator, &members))
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

    /// Checks that the shares about each axis sum to 1, in each stage of the law if stages select actuators.
    pub(super) fn validate_shares(&self, offers: &Offers) -> Option<ConfigError> {
        if !self.law.selects_actuators() {
            return self.validate_sums(offers).or_else(|| self.validate_pulse_periods(offers));
        }
        let misplaced = self.validate_selection(offers);
        misplaced.or_else(|| {
            let mut stages = self.law.stages().iter().enumerate();
            let fault = stages.find_map(|(index, stage)| self.validate_stage(index, stage, offers));
            fault.or_else(|| self.validate_pulse_periods(offers))
        })
    }

    /// Checks that an actuator without pulses has one period in which it executes changes of the rate about an axis.
    fn validate_pulse_periods(&self, offers: &Offers) -> Option<ConfigError> {
        let held = offers.actuators.iter().filter(|member| member.executes && !member.offers.pulses);
        held.flat_map(|member| (0..self.axis_count()).map(move |axis| (member, axis))).find_map(
            |(member, axis)| {
                let plans = |law: &&AxisLaw| {
                    law.axis == axis && law.offers.plans_pulses && law.drives(member.kind)
                };
                let mut laws = offers.laws.iter().filter(plans);
                let first = laws.next().filter(|_| member.shares[axis] > 0.0)?;
                let other = laws.find(|law| law.offers.period != first.offers.period)?;
                let period = first.offers.period?.seconds();
                let why = format!(
                    "must be that of `{}`, {period} s: `{}` holds the torque of a change of the rate for one period",
                    first.key, member.key
                );
                Some(ConfigError::new(format!("{}.period", other.key), why))
            },
        )
    }

    /// Checks that stages that select actuators fit the other parts.
    fn validate_selection(&self, offers: &Offers) -> Option<ConfigError> {
        let selects = |stage: &Stage| stage.actuators.is_some();
        let index = self.law.stages().iter().position(selects)?;
        let at = |why: &str| Some(ConfigError::new(format!("{}[{index}].actuators", self.law.key()), why));
        if offers.body.has_manoeuvre {
            return at(
                "must be left out with a `[manoeuvre]`, whose torque all actuators execute from its begin to its end",
            );
        }
        if self.has_adaptive_observers() {
            return at(
                "must be left out with `[estimator.adaptive]`, which predicts what the same actuators do throughout",
            );
        }
        None
    }

    /// Checks the actuators that a stage of the law selects.
    fn validate_stage(&self, index: usize, stage: &Stage, offers: &Offers) -> Option<ConfigError> {
        let key = format!("{}[{index}].actuators", self.law.key());
        let at = |key: String, why: String| Some(ConfigError::new(key, why));
        for (entry, name) in stage.actuators.iter().flatten().enumerate() {
            let (key, name) = (format!("{key}[{entry}]"), name.as_str());
            let mut named = offers.actuators.iter().filter(|member| member.is_listed && member.kind == name);
            match named.next() {
                None => {
                    let kinds = offers.actuators.iter().filter(|member| member.is_listed);
                    let kinds: Vec<String> = kinds.map(|member| format!("`{}`", member.kind)).collect();
                    return at(
                        key,
                        format!("must be one of the actuators, {}, got `{name}`", kinds.join(", ")),
                    );
                }
                Some(member) if !member.executes => {
                    let why = format!("must execute commands, and `{}` unloads wheels", member.key);
                    return at(key, why);
                }
                Some(_) => {}
            }
        }
        let selected: Vec<&ActuatorMember> =
            offers.actuators.iter().filter(|member| member.executes && stage.selects(member.kind)).collect();
        let about = |axis: usize| stage.law.about(axis).offers();
        let axes = 0..self.axis_count();
        if axes.clone().any(|axis| about(axis).commands_moments) {
            let has_torquers = selected.iter().any(|member| member.kind == "magnetorquers");
            let unloads = |member: &ActuatorMember| !member.executes && member.kind == "magnetorquers";
            if !has_torquers && !offers.actuators.iter().any(unloads) {
                return at(key, "must include `magnetorquers`, which execute the law's moments".to_owned());
            }
        }
        axes.zip(AXES).find_map(|(axis, name)| {
            let law = about(axis);
            if law.is_open || law.commands_moments {
                return None;
            }
            let about = if self.axis_count() == 1 { String::new() } else { format!(" about {name}") };
            let serving = selected.iter().filter(|member| member.shares[axis] > 0.0);
            let each: Vec<String> = serving
                .clone()
                .map(|member| format!("{} of `{}`", member.shares[axis], member.key))
                .collect();
            let sum = serving.map(|member| member.shares[axis]).fold(0.0, |sum, share| sum + share);
            if (sum - 1.0).abs() <= ROUNDING {
                let why =
                    || format!("must name one actuator{about} for a law `phase_plane`, got {}", each.len());
                return (each.len() > 1 && law.plans_pulses).then(|| ConfigError::new(&key, why()));
            }
            let found = if each.is_empty() { "no actuator".to_owned() } else { each.join(", ") };
            at(key.clone(), format!("must have shares that sum to 1{about}, got {sum} ({found})"))
        })
    }

    /// Checks that the shares of all actuators about each axis sum to 1.
    fn validate_sums(&self, offers: &Offers) -> Option<ConfigError> {
        for (axis, name) in AXES.iter().enumerate().take(self.axis_count()) {
            let serves = |member: &&ActuatorMember| member.shares[axis] > 0.0;
            let serving: Vec<&ActuatorMember> = offers.actuators.iter().filter(serves).collect();
            let mut laws = offers.laws.iter().filter(|law| law.axis == axis);
            let about = if self.axis_count() == 1 { String::new() } else { format!(" about {name}") };
            let Some(last) = serving.last() else {
                if laws.all(|law| law.offers.is_open) {
                    continue;
                }
                let why = format!(
                    "has none that acts{about}, and the law acts there: name `{name}` in the `axes` of one"
                );
                return Some(ConfigError::new("actuator", why));
            };
            let sum: f64 = serving.iter().map(|member| member.shares[axis]).sum();
            if (sum - 1.0).abs() > ROUNDING {
                let each: Vec<String> =
                    serving.iter().map(|of| format!("{} of `{}`", of.shares[axis], of.key)).collect();
                let why = format!("must sum to 1 with the others{about}, got {sum} ({})", each.join(", "));
                let key = last.key.rsplit_once('.').map_or("actuator", |(entry, _)| entry);
                return Some(ConfigError::new(format!("{key}.share"), why));
            }
            if let Some(law) = laws.find(|law| serving.len() > 1 && law.offers.plans_pulses) {
                let why = format!("needs one actuator{about}, and there are {}", serving.len());
                return Some(ConfigError::new(&law.key, why));
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
        && let Some(fault) = wheels.unloading.as_deref().and_then(WheelUnloading::validate)
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
