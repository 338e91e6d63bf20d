//! Several actuators in one: each executes its share of the demand about each axis, or unloads the wheels or gyros.

use flexsc_dynamics::three_axis::RotorObservation;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::Instant;
use flexsc_record::{self, WheelMotion};
use flexsc_spacecraft::wrench::Wrench;

use super::unloading::UnloaderState;
use super::{Actuator, ActuatorKind, ActuatorTask, Demand, JetCycle, Pulse};
use crate::custom::PartError;

/// Run-time state of several actuators.
#[derive(Clone, Debug)]
pub struct ActuatorSet {
    /// Actuators with their shares about the axes, in the order of the scenario.
    executing: Vec<(Box<dyn Actuator>, [f64; 3])>,
    /// Indices of the actuators that store momentum; the first can be unloaded.
    keepers: Vec<usize>,
    unloader: Option<UnloaderState>,
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

impl ActuatorSet {
    /// Creates the actuators of a body with `axes` axes, before their first command.
    pub fn new(axes: usize, members: Vec<(&ActuatorKind, &ActuatorTask, Box<dyn Actuator>)>) -> Self {
        let mut several = Self {
            executing: Vec::with_capacity(members.len()),
            keepers: Vec::new(),
            unloader: None,
            demands: vec![Demand::Torque(0.0); axes],
        };
        for (kind, task, actuator) in members {
            match task {
                ActuatorTask::Executes(shares) => {
                    if let ActuatorKind::Wheels(_) | ActuatorKind::ControlMomentGyros(_) = kind {
                        several.keepers.push(several.executing.len());
                    }
                    several.executing.push((actuator, *shares));
                }
                ActuatorTask::Unloads(unloads) => {
                    several.unloader = Some(UnloaderState::new(unloads, kind, actuator));
                }
            }
        }
        several
    }

    /// Iterates over all actuators, the unloading one included.
    fn each(&self) -> impl Iterator<Item = &dyn Actuator> {
        let executing = self.executing.iter().map(|(actuator, _)| &**actuator);
        executing.chain(self.unloader.iter().map(|unloader| &*unloader.actuator))
    }

    fn sum(&self, value_of: impl Fn(&dyn Actuator) -> f64) -> f64 {
        self.each().map(value_of).reduce(|sum, next| sum + next).unwrap_or(0.0)
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
            self.executing[*index].0.set_counter_torque(torque);
        }
    }
}

impl Actuator for ActuatorSet {
    fn set_magnetic_field(&mut self, field: Vector) {
        self.executing.iter_mut().for_each(|(actuator, _)| actuator.set_magnetic_field(field));
        self.unloader.iter_mut().for_each(|unloader| unloader.actuator.set_magnetic_field(field));
    }

    fn command(&mut self, now: Instant, demands: &[Demand], rigid: [f64; 3]) {
        self.demands.iter_mut().zip(demands).for_each(|(own, demand)| *own = *demand);
        if let Some(unloader) = self.unloader.as_mut().filter(|unloader| unloader.is_commanded(demands)) {
            unloader.execute(now, demands, rigid);
            self.hold(Vector::zeros());
        }
        (0..self.executing.len()).for_each(|index| self.pass_on(index, now, rigid));
    }

    fn due(&self) -> Option<Instant> {
        let executing = self.executing.iter().filter_map(|(actuator, _)| actuator.due());
        executing.chain(self.unloader.as_ref().and_then(UnloaderState::due)).min()
    }

    fn update(&mut self, now: Instant, rigid: [f64; 3]) {
        let stored = Vector::from(self.stored_momentum(now));
        let held =
            self.unloader.as_mut().and_then(|unloader| unloader.serve(now, rigid, stored, &self.demands));
        self.executing.iter_mut().for_each(|(actuator, _)| actuator.update(now, rigid));
        if let (Some(held), Some(index)) = (held, self.keepers.first().copied()) {
            self.hold(held);
            self.pass_on(index, now, rigid);
        }
    }

    fn set_rotor_states(&mut self, now: Instant, rotors: &[RotorObservation]) {
        self.executing.iter_mut().for_each(|(actuator, _)| actuator.set_rotor_states(now, rotors));
    }

    fn apply(&self, now: Instant, onto: &mut Wrench) {
        self.each().for_each(|actuator| actuator.apply(now, onto));
    }

    /// Returns the total torque demanded of the actuators that execute demands (N m).
    fn demanded_torque(&self, axis: usize) -> f64 {
        let demanded = self.executing.iter().map(|(actuator, _)| actuator.demanded_torque(axis));
        demanded.reduce(|sum, next| sum + next).unwrap_or(0.0)
    }

    fn held_torque(&self, axis: usize) -> f64 {
        self.sum(|actuator| actuator.held_torque(axis))
    }

    fn firing(&self, axis: usize) -> f64 {
        self.sum(|actuator| actuator.firing(axis))
    }

    fn applied_torque(&self, now: Instant, axis: usize, rates: [f64; 2]) -> f64 {
        self.sum(|actuator| actuator.applied_torque(now, axis, rates))
    }

    fn reduced_moment(&self, axis: usize) -> f64 {
        self.sum(|actuator| actuator.reduced_moment(axis))
    }

    fn waveform_impulse(&self, from: f64, to: f64) -> f64 {
        self.sum(|actuator| actuator.waveform_impulse(from, to))
    }

    fn back_emf(&self) -> (f64, bool) {
        self.each().map(Actuator::back_emf).find(|(back_emf, _)| *back_emf != 0.0).unwrap_or_default()
    }

    fn wheel(&self, axis: usize, rigid_rate: f64) -> Option<WheelMotion> {
        self.each().find_map(|actuator| actuator.wheel(axis, rigid_rate))
    }

    fn wheels(&self, now: Instant, rate: [f64; 3]) -> Vec<flexsc_record::Wheel> {
        self.each().flat_map(|actuator| actuator.wheels(now, rate)).collect()
    }

    fn gimbal_row(&self, now: Instant) -> Option<flexsc_record::ControlMomentGyros> {
        self.each().find_map(|actuator| actuator.gimbal_row(now))
    }

    fn steering_record(&self) -> Option<flexsc_record::SteeringRecord> {
        self.each().find_map(Actuator::steering_record)
    }

    fn magnetorquer_row(&self) -> Option<flexsc_record::Magnetorquers> {
        self.each().find_map(Actuator::magnetorquer_row)
    }

    fn measured_wheel_speeds(&self) -> Vec<f64> {
        self.each().flat_map(Actuator::measured_wheel_speeds).collect()
    }

    fn stored_momentum(&self, now: Instant) -> [f64; 3] {
        let stored =
            self.keepers.iter().map(|index| Vector::from(self.executing[*index].0.stored_momentum(now)));
        stored.reduce(|sum, next| sum + next).unwrap_or_default().into()
    }

    fn jet_cycle(&self) -> Option<JetCycle> {
        self.each().find_map(Actuator::jet_cycle)
    }

    fn queued_rate_change(&self) -> [f64; 3] {
        let queued = self.each().map(Actuator::queued_rate_change);
        queued.fold([0.0; 3], |sum, next| [0, 1, 2].map(|axis| sum[axis] + next[axis]))
    }

    fn pending_pulses(&self) -> Vec<Pulse> {
        self.each().flat_map(Actuator::pending_pulses).collect()
    }

    fn failure(&self) -> Option<PartError> {
        self.each().find_map(Actuator::failure)
    }

    fn copy(&self) -> Box<dyn Actuator> {
        Box::new(self.clone())
    }
}
