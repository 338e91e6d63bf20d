//! Several actuators in one: each executes its share of the demand about each axis, or unloads the wheels or gyros.

use super::unloading::Unloader;
use super::{Actuate, Actuator, ActuatorTask, Demand, JetCycle, Pulse};
use crate::attitude::Vector;
use crate::motion::turning::SlippedRotor;
use crate::own::Halt;
use crate::record::{self, WheelMotion};
use crate::time::Instant;
use crate::wrench::Wrench;

/// Run-time state of several actuators.
#[derive(Clone, Debug)]
pub struct Several {
    /// Actuators with their shares about the axes, in the order of the scenario.
    executing: Vec<(Box<dyn Actuate>, [f64; 3])>,
    /// Indices of the actuators that store momentum; the first can be unloaded.
    keepers: Vec<usize>,
    unloader: Option<Unloader>,
    /// Demand of the laws about each axis.
    demands: Vec<Demand>,
}

/// Returns the share of a demand. Magnetic moments are not shared: they are for magnetorquers alone.
fn shared(demand: Demand, share: f64) -> Demand {
    match demand {
        Demand::Moment(_) => demand,
        _ if share == 0.0 => Demand::Torque(0.0),
        Demand::Torque(torque) => Demand::Torque(share * torque),
        Demand::Change(change) => Demand::Change(share * change),
    }
}

impl Several {
    /// Creates the actuators of a body with `axes` axes, before their first command.
    pub fn new(axes: usize, members: Vec<(&Actuator, &ActuatorTask, Box<dyn Actuate>)>) -> Self {
        let mut several = Self {
            executing: Vec::with_capacity(members.len()),
            keepers: Vec::new(),
            unloader: None,
            demands: vec![Demand::Torque(0.0); axes],
        };
        for (kind, task, actuator) in members {
            match task {
                ActuatorTask::Executes(shares) => {
                    if let Actuator::Wheels(_) | Actuator::ControlMomentGyros(_) = kind {
                        several.keepers.push(several.executing.len());
                    }
                    several.executing.push((actuator, *shares));
                }
                ActuatorTask::Unloads(unloads) => {
                    several.unloader = Some(Unloader::new(unloads, kind, actuator));
                }
            }
        }
        several
    }

    /// Iterates over all actuators, the unloading one included.
    fn each(&self) -> impl Iterator<Item = &dyn Actuate> {
        let executing = self.executing.iter().map(|(actuator, _)| &**actuator);
        executing.chain(self.unloader.iter().map(|unloader| &*unloader.actuator))
    }

    fn sum(&self, of: impl Fn(&dyn Actuate) -> f64) -> f64 {
        self.each().map(of).reduce(|sum, next| sum + next).unwrap_or(0.0)
    }

    /// Commands one of the actuators with its share of the demands.
    fn pass_on(&mut self, index: usize, now: Instant, rigid: [f64; 3]) {
        let (actuator, shares) = &mut self.executing[index];
        let mut own = [Demand::Torque(0.0); 3];
        for ((own, demand), share) in own.iter_mut().zip(&self.demands).zip(shares) {
            *own = shared(*demand, *share);
        }
        actuator.command(now, &own[..self.demands.len()], rigid);
    }

    /// Makes the actuator that stores momentum counteract a torque (N m) from the next command on.
    fn hold(&mut self, torque: Vector) {
        if let Some(index) = self.keepers.first() {
            self.executing[*index].0.hold_against(torque);
        }
    }
}

impl Actuate for Several {
    fn feel(&mut self, field: Vector) {
        self.executing.iter_mut().for_each(|(actuator, _)| actuator.feel(field));
        self.unloader.iter_mut().for_each(|unloader| unloader.actuator.feel(field));
    }

    fn command(&mut self, now: Instant, demands: &[Demand], rigid: [f64; 3]) {
        self.demands.iter_mut().zip(demands).for_each(|(own, demand)| *own = *demand);
        if let Some(unloader) = self.unloader.as_mut().filter(|unloader| unloader.is_taken(demands)) {
            unloader.take(now, demands, rigid);
            self.hold(Vector::zeros());
        }
        (0..self.executing.len()).for_each(|index| self.pass_on(index, now, rigid));
    }

    fn due(&self) -> Option<Instant> {
        let executing = self.executing.iter().filter_map(|(actuator, _)| actuator.due());
        executing.chain(self.unloader.as_ref().and_then(Unloader::due)).min()
    }

    fn serve(&mut self, now: Instant, rigid: [f64; 3]) {
        let stored = Vector::from(self.stored(now));
        let held = self.unloader.as_mut().and_then(|of| of.serve(now, rigid, stored, &self.demands));
        self.executing.iter_mut().for_each(|(actuator, _)| actuator.serve(now, rigid));
        if let (Some(held), Some(index)) = (held, self.keepers.first().copied()) {
            self.hold(held);
            self.pass_on(index, now, rigid);
        }
    }

    fn turned(&mut self, now: Instant, rotors: &[SlippedRotor]) {
        self.executing.iter_mut().for_each(|(actuator, _)| actuator.turned(now, rotors));
    }

    fn exert(&self, now: Instant, onto: &mut Wrench) {
        self.each().for_each(|actuator| actuator.exert(now, onto));
    }

    /// Returns the total torque demanded of the actuators that execute demands (N m).
    fn asked(&self, axis: usize) -> f64 {
        let asked = self.executing.iter().map(|(actuator, _)| actuator.asked(axis));
        asked.reduce(|sum, next| sum + next).unwrap_or(0.0)
    }

    fn torque(&self, axis: usize) -> f64 {
        self.sum(|actuator| actuator.torque(axis))
    }

    fn firing(&self, axis: usize) -> f64 {
        self.sum(|actuator| actuator.firing(axis))
    }

    fn applied(&self, now: Instant, axis: usize, rates: [f64; 2]) -> f64 {
        self.sum(|actuator| actuator.applied(now, axis, rates))
    }

    fn moment(&self, axis: usize) -> f64 {
        self.sum(|actuator| actuator.moment(axis))
    }

    fn waveform_impulse(&self, from: f64, to: f64) -> f64 {
        self.sum(|actuator| actuator.waveform_impulse(from, to))
    }

    fn back_emf(&self) -> (f64, bool) {
        self.each().map(Actuate::back_emf).find(|(of, _)| *of != 0.0).unwrap_or_default()
    }

    fn wheel(&self, axis: usize, rigid_rate: f64) -> Option<WheelMotion> {
        self.each().find_map(|actuator| actuator.wheel(axis, rigid_rate))
    }

    fn wheels(&self, now: Instant, rate: [f64; 3]) -> Vec<record::Wheel> {
        self.each().flat_map(|actuator| actuator.wheels(now, rate)).collect()
    }

    fn gimbals(&self, now: Instant) -> Option<record::ControlMomentGyros> {
        self.each().find_map(|actuator| actuator.gimbals(now))
    }

    fn steered(&self) -> Option<record::Steered> {
        self.each().find_map(Actuate::steered)
    }

    fn magnetic(&self) -> Option<record::Magnetorquers> {
        self.each().find_map(Actuate::magnetic)
    }

    fn known_speeds(&self) -> Vec<f64> {
        self.each().flat_map(Actuate::known_speeds).collect()
    }

    fn stored(&self, now: Instant) -> [f64; 3] {
        let stored = self.keepers.iter().map(|index| Vector::from(self.executing[*index].0.stored(now)));
        stored.reduce(|sum, next| sum + next).unwrap_or_default().into()
    }

    fn cycle(&self) -> Option<JetCycle> {
        self.each().find_map(Actuate::cycle)
    }

    fn queued(&self) -> [f64; 3] {
        let queued = self.each().map(Actuate::queued);
        queued.fold([0.0; 3], |sum, next| [0, 1, 2].map(|axis| sum[axis] + next[axis]))
    }

    fn waiting(&self) -> Vec<Pulse> {
        self.each().flat_map(Actuate::waiting).collect()
    }

    fn halted(&self) -> Option<Halt> {
        self.each().find_map(Actuate::halted)
    }

    fn copy(&self) -> Box<dyn Actuate> {
        Box::new(self.clone())
    }
}
