//! Checks of the tasks of actuators: axes, unloading, and shares that sum to the whole demand.

use flexsc_control::actuator::{ActuatorTask, AssignedActuator, WheelUnloading};
use flexsc_control::law::Stage;
use flexsc_control::offers::{ActuatorMember, AxisLaw, Offers};
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::AXES;

use super::ScenarioSpec;

/// Tolerance of the sum of rounded shares.
const ROUNDING: f64 = 1e-9;

impl ScenarioSpec {
    /// Checks the axes and the share of each actuator.
    pub(super) fn validate_assignments(&self, errors: &mut Vec<ConfigError>) {
        for (index, of) in self.actuator.iter().enumerate() {
            let error = validate_assignment(of);
            errors.extend(error.map(|error| error.within(&self.actuator.key("actuator", index))));
        }
    }

    /// Adds the requirement that the shares about each axis sum to 1, in each stage of the law if stages select actuators.
    pub(super) fn require_shares(&self, offers: &Offers, errors: &mut Vec<ConfigError>) {
        let known = errors.len();
        if self.law.selects_actuators() {
            errors.extend(self.selection_error(offers));
            for (index, stage) in self.law.stages().iter().enumerate() {
                self.require_stage_shares(index, stage, offers, errors);
            }
        } else {
            for error in (0..self.axis_count()).filter_map(|axis| self.share_error(axis, offers)) {
                // What is wrong about several axes at one key is one error.
                if errors[known..].iter().all(|other| other.key != error.key) {
                    errors.push(error);
                }
            }
        }
        // Actuators that execute other shares hold the torques of other laws.
        if errors.len() == known {
            self.require_pulse_periods(offers, errors);
        }
    }

    /// Adds the requirement that an actuator without pulses has one period in which it executes changes of the rate about an
    /// axis.
    fn require_pulse_periods(&self, offers: &Offers, errors: &mut Vec<ConfigError>) {
        let held = offers.actuators.iter().filter(|member| member.executes && !member.offers.pulses);
        let axes = 0..self.axis_count();
        for (member, axis) in held.flat_map(|member| axes.clone().map(move |axis| (member, axis))) {
            let plans =
                |law: &&AxisLaw| law.axis == axis && law.offers.plans_pulses && law.drives(member.kind);
            let mut laws = offers.laws.iter().filter(plans);
            let Some(first) = laws.next().filter(|_| member.shares[axis] > 0.0) else { continue };
            let Some(period) = first.offers.period else { continue };
            let why = format!(
                "must be that of `{}`, {} s: `{}` holds the torque of a change of the rate for one period",
                first.key,
                period.seconds(),
                member.key
            );
            let others = laws.filter(|law| law.offers.period != first.offers.period);
            errors.extend(others.map(|other| ConfigError::new(format!("{}.period", other.key), &why)));
        }
    }

    /// Returns the error of stages that select actuators beside parts that need all of them.
    fn selection_error(&self, offers: &Offers) -> Option<ConfigError> {
        let selects = |stage: &Stage| stage.actuators.is_some();
        let index = self.law.stages().iter().position(selects)?;
        let why = if offers.body.has_manoeuvre {
            "must be left out with a `[manoeuvre]`, whose torque all actuators execute from its begin to its end"
        } else if self.has_adaptive_observers() {
            "must be left out with `[estimator.adaptive]`, which predicts what the same actuators do throughout"
        } else {
            return None;
        };
        Some(ConfigError::new(format!("{}[{index}].actuators", self.law.key()), why))
    }

    /// Adds the requirements on the actuators that a stage of the law selects.
    fn require_stage_shares(
        &self,
        index: usize,
        stage: &Stage,
        offers: &Offers,
        errors: &mut Vec<ConfigError>,
    ) {
        let key = format!("{}[{index}].actuators", self.law.key());
        let known = errors.len();
        for (entry, name) in stage.actuators.iter().flatten().enumerate() {
            let mut listed = offers.actuators.iter().filter(|member| member.is_listed);
            let why = match listed.find(|member| member.kind == name.as_str()) {
                None => {
                    let listed = offers.actuators.iter().filter(|member| member.is_listed);
                    let kinds: Vec<String> = listed.map(|member| format!("`{}`", member.kind)).collect();
                    format!("must be one of the actuators, {}, got `{}`", kinds.join(", "), name.as_str())
                }
                Some(member) if !member.executes => {
                    format!("must execute commands, and `{}` unloads wheels", member.key)
                }
                Some(_) => continue,
            };
            errors.push(ConfigError::new(format!("{key}[{entry}]"), why));
        }
        // Another name in the list changes the shares.
        if errors.len() == known {
            let why = self.stage_share_error(stage, offers);
            errors.extend(why.map(|why| ConfigError::new(key, why)));
        }
    }

    /// Returns the reason why the actuators that a stage selects do not execute the commands of its law.
    fn stage_share_error(&self, stage: &Stage, offers: &Offers) -> Option<String> {
        let selected: Vec<&ActuatorMember> =
            offers.actuators.iter().filter(|member| member.executes && stage.selects(member.kind)).collect();
        let about = |axis: usize| stage.law.about(axis).offers();
        let axes = 0..self.axis_count();
        if axes.clone().any(|axis| about(axis).commands_moments) {
            let has_torquers = selected.iter().any(|member| member.kind == "magnetorquers");
            let unloads = |member: &ActuatorMember| !member.executes && member.kind == "magnetorquers";
            if !has_torquers && !offers.actuators.iter().any(unloads) {
                return Some("must include `magnetorquers`, which execute the law's moments".to_owned());
            }
        }
        axes.zip(AXES).find_map(|(axis, name)| {
            let law = about(axis);
            if law.is_open || law.commands_moments {
                return None;
            }
            let about = if self.axis_count() == 1 { String::new() } else { format!(" about {name}") };
            let serving: Vec<_> = selected.iter().filter(|member| member.shares[axis] > 0.0).collect();
            let each: Vec<String> =
                serving.iter().map(|member| format!("{} of `{}`", member.shares[axis], member.key)).collect();
            let sum = serving.iter().fold(0.0, |sum, member| sum + member.shares[axis]);
            if (sum - 1.0).abs() <= ROUNDING {
                let why =
                    || format!("must name one actuator{about} for a law `phase_plane`, got {}", each.len());
                return (each.len() > 1 && law.plans_pulses).then(why);
            }
            let found = if each.is_empty() { "no actuator".to_owned() } else { each.join(", ") };
            Some(format!("must have shares that sum to 1{about}, got {sum} ({found})"))
        })
    }

    /// Returns the error of shares about an axis that do not sum to 1, or are several where a law plans pulses.
    fn share_error(&self, axis: usize, offers: &Offers) -> Option<ConfigError> {
        let name = AXES[axis];
        let serves = |member: &&ActuatorMember| member.shares[axis] > 0.0;
        let serving: Vec<&ActuatorMember> = offers.actuators.iter().filter(serves).collect();
        let mut laws = offers.laws.iter().filter(|law| law.axis == axis);
        let about = if self.axis_count() == 1 { String::new() } else { format!(" about {name}") };
        let Some(last) = serving.last() else {
            let why = || {
                format!(
                    "has none that acts{about}, and the law acts there: name `{name}` in the `axes` of one"
                )
            };
            return laws.any(|law| !law.offers.is_open).then(|| ConfigError::new("actuator", why()));
        };
        let sum: f64 = serving.iter().map(|member| member.shares[axis]).sum();
        if (sum - 1.0).abs() > ROUNDING {
            let each: Vec<String> =
                serving.iter().map(|of| format!("{} of `{}`", of.shares[axis], of.key)).collect();
            let why = format!("must sum to 1 with the others{about}, got {sum} ({})", each.join(", "));
            let key = last.key.rsplit_once('.').map_or("actuator", |(entry, _)| entry);
            return Some(ConfigError::new(format!("{key}.share"), why));
        }
        let law = laws.find(|law| serving.len() > 1 && law.offers.plans_pulses)?;
        let why = format!("needs one actuator{about}, and there are {}", serving.len());
        Some(ConfigError::new(&law.key, why))
    }

    /// Checks the unloading of wheels or control moment gyros.
    pub(super) fn validate_unloading(&self, errors: &mut Vec<ConfigError>) {
        let (actuators, members) = (&self.actuator, self.actuator.members());
        if let Some((wheels, key)) = actuators.wheels()
            && let Some(error) = wheels.unloading.as_deref().and_then(WheelUnloading::validate)
        {
            errors.push(error.within(&format!("{key}.unloading")));
            return;
        }
        let mut unloaders = members.iter().filter_map(|member| match &member.task {
            ActuatorTask::Unloads(unloads) => Some((member, unloads)),
            ActuatorTask::Executes(_) => None,
        });
        let Some((first, unloads)) = unloaders.next() else { return };
        let how = first.unloading_key();
        if let Some((error, within)) = unloads.fault(&first.kind) {
            errors.push(error.within(if within { &first.key } else { &how }));
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
            errors.push(ConfigError::new(how, why));
        }
        errors.extend(unloaders.map(|(other, _)| {
            let why = format!("must be left out: `{}` unloads the wheels, and only one can", first.key);
            ConfigError::new(&other.key, why)
        }));
    }
}

/// Checks the axes and the share of an actuator; returns the inconsistent key and the reason.
fn validate_assignment(of: &AssignedActuator) -> Option<ConfigError> {
    if of.unloads.is_some() {
        let key = of.axes.as_ref().map(|_| "axes").or(of.share.map(|_| "share"))?;
        let why = "must be left out with `unloads`: an actuator that unloads wheels executes no demand";
        return Some(ConfigError::new(key, why));
    }
    let axes = of.axes.as_ref()?;
    if axes.is_empty() {
        return Some(ConfigError::new("axes", "must name an axis: `roll`, `pitch` or `yaw`, got none"));
    }
    let (_, axis) = axes.iter().enumerate().find(|(index, axis)| axes[..*index].contains(axis))?;
    Some(ConfigError::new("axes", format!("names `{}` twice", AXES[axis.index()])))
}
