//! The actuators of a scenario as they work together: each with its key, and what it is for.

use std::borrow::Cow;

use super::failure;
use super::{Actuator, Assigned, ControlMomentGyros, Jets, Magnetorquers, Share, Unloads, Wheel, Wheels};
use crate::document::Fault;
use crate::parts::Parts;

/// An actuator among those of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct ActuatorMember<'a> {
    /// Its key.
    pub key: String,
    /// The actuator.
    pub kind: Cow<'a, Actuator>,
    /// What it is for.
    pub task: ActuatorTask,
}

/// What an actuator is for.
#[derive(Clone, Debug, PartialEq)]
pub enum ActuatorTask {
    /// It executes this share of what laws demand about each axis.
    Executes([f64; 3]),
    /// It unloads the wheels beside it.
    Unloads(Unloads),
}

impl ActuatorMember<'_> {
    /// Its share of what laws demand about an axis.
    pub fn share(&self, axis: usize) -> f64 {
        match &self.task {
            ActuatorTask::Executes(shares) => shares[axis],
            ActuatorTask::Unloads(_) => 0.0,
        }
    }

    /// The key of how it unloads wheels: `actuator[1].unloads`, or that of the table within wheels that has it.
    pub fn unloads_key(&self) -> String {
        let beside = self.key.rsplit_once('.').map_or("", |(beside, _)| beside);
        if beside.ends_with(".unloading") { beside.to_owned() } else { format!("{beside}.unloads") }
    }

    /// What of its failures does not fit, of one about so many axes: a key, and why.
    pub fn failure_fault(&self, axes: usize) -> Option<Fault> {
        let names = if let Actuator::Jets(jets) = &*self.kind { jets.names() } else { Vec::new() };
        let parts = match &*self.kind {
            Actuator::Jets(_) => failure::FailingPart::Thrusters(&names),
            Actuator::Wheels(wheels) => failure::FailingPart::Wheels(wheels.count()),
            Actuator::ControlMomentGyros(gyros) => failure::FailingPart::Gimbals(gyros.count()),
            _ => failure::FailingPart::Axes(axes),
        };
        let sines = !matches!(&*self.kind, Actuator::Magnetorquers(_));
        let mut failures = self.kind.failures().iter().enumerate();
        failures.find_map(|(index, failure)| {
            Some(failure.fault(parts, sines)?.within(&format!("{}.faults[{index}]", self.key)))
        })
    }
}

impl Parts<Assigned> {
    /// All of them, those too that are written within others.
    pub fn members(&self) -> Vec<ActuatorMember<'_>> {
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
                let kind = unloading.by();
                let key = format!("{key}.unloading.{}", kind.kind());
                ActuatorMember { key, kind: Cow::Owned(kind), task: ActuatorTask::Unloads(unloading.how()) }
            });
            members.push(ActuatorMember { key, kind: Cow::Borrowed(&assigned.kind), task });
            members.extend(within);
        }
        members
    }

    /// The key of one of them, with its kind.
    fn kind_key(&self, index: usize) -> String {
        format!("{}.{}", self.key("actuator", index), self[index].kind.kind())
    }

    /// The only actuator, if there are no others and it executes all that is demanded.
    pub fn alone(&self) -> Option<&Actuator> {
        match &**self {
            [only] if !only.is_particular() && only.unloading().is_none() => Some(&only.kind),
            _ => None,
        }
    }

    /// Whether laws are executed as they are: no failure changes that.
    pub fn is_ideal(&self) -> bool {
        matches!(self.alone(), Some(Actuator::Ideal(ideal)) if ideal.faults.is_empty())
    }

    /// Whether one of them is of a kind.
    pub fn any(&self, is: impl Fn(&Actuator) -> bool) -> bool {
        self.iter().any(|assigned| is(&assigned.kind))
    }

    /// The first of a kind, and its key.
    fn first<'a, T>(&'a self, of: impl Fn(&'a Actuator) -> Option<T>) -> Option<(T, String)> {
        self.iter()
            .enumerate()
            .find_map(|(index, assigned)| Some((of(&assigned.kind)?, self.kind_key(index))))
    }

    /// The flywheel about the first axis, and its key.
    pub fn wheel(&self) -> Option<(&Wheel, String)> {
        self.first(|kind| if let Actuator::Wheel(wheel) = kind { Some(wheel) } else { None })
    }

    /// The reaction wheels, and their key.
    pub fn wheels(&self) -> Option<(&Wheels, String)> {
        self.first(|kind| if let Actuator::Wheels(wheels) = kind { Some(wheels) } else { None })
    }

    /// The control moment gyros, and their key.
    pub fn control_moment_gyros(&self) -> Option<(&ControlMomentGyros, String)> {
        self.first(|kind| if let Actuator::ControlMomentGyros(gyros) = kind { Some(gyros) } else { None })
    }

    /// The jets, laws act by them or not, and their key.
    pub fn jets(&self) -> Option<(&Jets, String)> {
        self.first(|kind| if let Actuator::Jets(jets) = kind { Some(jets) } else { None }).or_else(|| {
            let (wheels, key) = self.wheels()?;
            Some((wheels.unloading.as_ref()?.jets.as_ref()?, format!("{key}.unloading.jets")))
        })
    }

    /// The magnetorquers, laws act by them or not, and their key.
    pub fn magnetorquers(&self) -> Option<(&Magnetorquers, String)> {
        self.first(|kind| if let Actuator::Magnetorquers(torquers) = kind { Some(torquers) } else { None })
            .or_else(|| {
                let (wheels, key) = self.wheels()?;
                let torquers = wheels.unloading.as_ref()?.magnetorquers.as_ref()?;
                Some((torquers, format!("{key}.unloading.magnetorquers")))
            })
    }
}
