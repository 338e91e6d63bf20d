//! Actuators of a scenario as a set: each with its key and its task.

use std::borrow::Cow;

use flexsc_formats::document::ConfigError;

use super::{
    ActuatorKind, AssignedActuator, ControlMomentGyros, Failure, Jets, Magnetorquers, Share, Thrusters,
    UnloadingTask, Wheel, Wheels,
};
use crate::one_or_many::OneOrMany;

/// Actuator among those of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct AssignedMember<'a> {
    /// Key of the actuator in the scenario.
    pub key: String,
    /// Kind and settings of the actuator.
    pub kind: Cow<'a, ActuatorKind>,
    /// Task of the actuator.
    pub task: ActuatorTask,
}

/// Task of an actuator.
#[derive(Clone, Debug, PartialEq)]
pub enum ActuatorTask {
    /// Execution of this share of the laws' demand about each axis.
    Executes([f64; 3]),
    /// Unloading of the wheels or gyros of the list.
    Unloads(UnloadingTask),
}

impl AssignedMember<'_> {
    /// Returns the actuator's share of the laws' demand about an axis.
    pub fn share(&self, axis: usize) -> f64 {
        match &self.task {
            ActuatorTask::Executes(shares) => shares[axis],
            ActuatorTask::Unloads(_) => 0.0,
        }
    }

    /// Returns true if the actuator executes commands of the laws, and does not unload wheels.
    pub fn executes(&self) -> bool {
        matches!(self.task, ActuatorTask::Executes(_))
    }

    /// Returns true if the actuator is given within another, whose momentum it unloads.
    pub fn is_nested(&self) -> bool {
        matches!(self.kind, Cow::Owned(_))
    }

    /// Returns the key of the unloading settings: `actuator[1].unloads`, or the table within wheels that contains it.
    pub fn unloading_key(&self) -> String {
        let prefix = self.key.rsplit_once('.').map_or("", |(prefix, _)| prefix);
        if prefix.ends_with(".unloading") { prefix.to_owned() } else { format!("{prefix}.unloads") }
    }

    /// Checks the failures of an actuator on a body with `axes` axes; returns the first inconsistent key and the
    /// reason.
    pub fn failure_fault(&self, axes: usize) -> Option<ConfigError> {
        Some(self.kind.validate_failures(self.kind.failures(), axes)?.within(&self.key))
    }
}

impl ActuatorKind {
    /// Checks failures of the actuator on a body with `axes` axes; returns the first inconsistent key and the reason.
    pub fn validate_failures(&self, failures: &[Failure], axes: usize) -> Option<ConfigError> {
        let (components, sines) = (self.failing_components(axes), !self.offers().turns_with_field);
        let mut failures = failures.iter().enumerate();
        failures.find_map(|(index, failure)| {
            Some(failure.validate(&components, sines)?.within(&format!("faults[{index}]")))
        })
    }
}

impl OneOrMany<AssignedActuator> {
    /// Returns all actuators, including those given within others.
    pub fn members(&self) -> Vec<AssignedMember<'_>> {
        let mut members = Vec::with_capacity(self.len());
        for (index, assigned) in self.iter().enumerate() {
            let key = self.kind_key(index);
            let share = assigned.share.map_or(1.0, Share::get);
            let serves = |axis: usize| {
                assigned.axes.as_ref().is_none_or(|axes| axes.iter().any(|own| own.index() == axis))
            };
            let shares = [0, 1, 2].map(|axis| if serves(axis) { share } else { 0.0 });
            let task = assigned.unloads.as_deref();
            let task =
                task.map_or(ActuatorTask::Executes(shares), |unloads| ActuatorTask::Unloads(unloads.clone()));
            let within = assigned.unloading().map(|unloading| {
                let kind = unloading.device();
                let key = format!("{key}.unloading.{}", kind.kind());
                AssignedMember {
                    key,
                    kind: Cow::Owned(kind),
                    task: ActuatorTask::Unloads(unloading.method()),
                }
            });
            members.push(AssignedMember { key, kind: Cow::Borrowed(&assigned.kind), task });
            members.extend(within);
        }
        members
    }

    /// Returns the key of an actuator, with its kind.
    fn kind_key(&self, index: usize) -> String {
        format!("{}.{}", self.key("actuator", index), self[index].kind.kind())
    }

    /// Returns the only actuator, if there are no others and it executes the whole demand.
    pub fn only_actuator(&self) -> Option<&ActuatorKind> {
        match &**self {
            [only] if !only.has_task() && only.unloading().is_none() => Some(&only.kind),
            _ => None,
        }
    }

    /// Returns true if laws are executed exactly, without failures.
    pub fn is_ideal(&self) -> bool {
        self.only_actuator().is_some_and(ActuatorKind::is_ideal)
    }

    /// Returns true if any actuator satisfies `is`.
    pub fn has_kind(&self, is: impl Fn(&ActuatorKind) -> bool) -> bool {
        self.iter().any(|assigned| is(&assigned.kind))
    }

    /// Returns the first actuator of a kind, with its key.
    fn first<'a, T>(&'a self, role_of: impl Fn(&'a ActuatorKind) -> Option<T>) -> Option<(T, String)> {
        self.iter()
            .enumerate()
            .find_map(|(index, assigned)| Some((role_of(&assigned.kind)?, self.kind_key(index))))
    }

    /// Returns the flywheel about the first axis, with its key.
    pub fn flywheel(&self) -> Option<(&Wheel, String)> {
        self.first(|kind| if let ActuatorKind::Wheel(wheel) = kind { Some(wheel) } else { None })
    }

    /// Returns the thrusters with pulse-width modulation, with their key.
    pub fn thrusters(&self) -> Option<(&Thrusters, String)> {
        self.first(|kind| if let ActuatorKind::Thrusters(thrusters) = kind { Some(thrusters) } else { None })
    }

    /// Removes the imbalance of all reaction wheels.
    pub fn balance_wheels(&mut self) {
        for assigned in self.iter_mut() {
            if let ActuatorKind::Wheels(wheels) = &mut assigned.kind {
                wheels.imbalance = None;
            }
        }
    }

    /// Returns the reaction wheels, with their key.
    pub fn wheels(&self) -> Option<(&Wheels, String)> {
        self.first(|kind| if let ActuatorKind::Wheels(wheels) = kind { Some(wheels) } else { None })
    }

    /// Returns the control moment gyros, with their key.
    pub fn control_moment_gyros(&self) -> Option<(&ControlMomentGyros, String)> {
        self.first(|kind| if let ActuatorKind::ControlMomentGyros(gyros) = kind { Some(gyros) } else { None })
    }

    /// Returns the jets, for control or for unloading, with their key.
    pub fn jets(&self) -> Option<(&Jets, String)> {
        self.first(ActuatorKind::jets).or_else(|| {
            let (wheels, key) = self.wheels()?;
            Some((wheels.unloading.as_ref()?.jets.as_ref()?, format!("{key}.unloading.jets")))
        })
    }

    /// Returns the magnetorquers, for control or for unloading, with their key.
    pub fn magnetorquers(&self) -> Option<(&Magnetorquers, String)> {
        self.first(
            |kind| if let ActuatorKind::Magnetorquers(torquers) = kind { Some(torquers) } else { None },
        )
        .or_else(|| {
            let (wheels, key) = self.wheels()?;
            let torquers = wheels.unloading.as_ref()?.magnetorquers.as_ref()?;
            Some((torquers, format!("{key}.unloading.magnetorquers")))
        })
    }
}
