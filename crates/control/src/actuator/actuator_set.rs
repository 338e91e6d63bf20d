//! Several actuators in one: each executes its share of the demand about each axis, or unloads the wheels or gyros.

use flexsc_dynamics::wrench::Wrench;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::Instant;
use flexsc_record::{self, Report};

use super::unloading::UnloaderState;
use super::{
    Actuator, ActuatorEvent, ActuatorKind, ActuatorTask, AxisEffort, AxisResponse, Capabilities, Demand,
    JetCycle, MomentumStorage, Pulse, PulsedActuator, WaveformActuator,
};
use crate::custom::PartError;
use crate::part::{Part, ReportContext};

/// Run-time state of several actuators.
#[derive(Clone, Debug)]
pub struct ActuatorSet {
    /// Actuators with their shares about the axes, in the order of the scenario.
    executing: Vec<(Box<dyn Actuator>, [f64; 3])>,
    /// Indices of the actuators that store momentum; the first can be unloaded.
    keepers: Vec<usize>,
    /// True if an actuator acts by pulses.
    has_pulses: bool,
    /// Back-EMF torque per unit of the rate about the first axis (N m s) of the first actuator that has one, and true if the
    /// elastic rate is included.
    back_emf: (f64, bool),
    unloader: Option<UnloaderState>,
    /// Estimated rate about each axis (rad/s).
    estimated_rate: [f64; 3],
    /// Demand of the laws about each axis.
    demands: Vec<Demand>,
    /// For each stage of the law, its start and which actuators execute demands; empty if all do throughout.
    stages: Vec<(Instant, Vec<bool>)>,
    /// Index of the mode of operation, if there are modes, whose stage is the one of this index.
    mode: Option<usize>,
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
            has_pulses: false,
            back_emf: Default::default(),
            unloader: None,
            estimated_rate: [0.0; 3],
            demands: vec![Demand::Torque(0.0); axes],
            stages: Vec::new(),
            mode: None,
        };
        for (kind, task, actuator) in members {
            match task {
                ActuatorTask::Executes(shares) => {
                    let offers = kind.offers();
                    if offers.has_reaction_wheels || offers.turns_with_gimbals {
                        several.keepers.push(several.executing.len());
                    }
                    several.executing.push((actuator, *shares));
                }
                ActuatorTask::Unloads(unloads) => {
                    several.unloader = Some(UnloaderState::new(unloads, kind, actuator));
                }
            }
        }
        let has_pulses = several.pulsed().next().is_some();
        let mut each = several.each().map(|actuator| actuator.capabilities().back_emf);
        let back_emf = each.find(|(of, _)| *of != 0.0).unwrap_or_default();
        drop(each);
        Self { has_pulses, back_emf, ..several }
    }

    /// Limits the execution of demands to some of the actuators, in the order of the scenario without the unloading
    /// one, from each of these instants on; the first is the start of the run.
    #[must_use]
    pub fn in_stages(self, stages: Vec<(Instant, Vec<bool>)>) -> Self {
        Self { stages, ..self }
    }

    /// Limits the execution of demands to some of the actuators in each mode of operation, from the first mode on.
    #[must_use]
    pub fn in_modes(self, modes: Vec<Vec<bool>>) -> Self {
        let stages = modes.into_iter().map(|executing| (Instant::START, executing)).collect();
        Self { stages, mode: Some(0), ..self }
    }

    /// Returns true if an actuator executes demands at an instant.
    fn executes(&self, index: usize, now: Instant) -> bool {
        let stage = match self.mode {
            Some(mode) => self.stages.get(mode),
            None => self.stages.iter().rfind(|(from, _)| *from <= now),
        };
        stage.is_none_or(|(_, executing)| executing[index])
    }

    /// Iterates over all actuators, the unloading one included.
    fn each(&self) -> impl Iterator<Item = &dyn Actuator> {
        let executing = self.executing.iter().map(|(actuator, _)| &**actuator);
        executing.chain(self.unloader.iter().map(|unloader| &*unloader.actuator))
    }

    fn sum(&self, value_of: impl Fn(&dyn Actuator) -> f64) -> f64 {
        self.each().map(value_of).reduce(|sum, next| sum + next).unwrap_or(0.0)
    }

    /// Iterates over the actuators that act by pulses.
    fn pulsed(&self) -> impl Iterator<Item = &dyn PulsedActuator> {
        self.each().filter_map(|actuator| actuator.capabilities().pulses)
    }

    /// Commands one of the actuators with its share of the demands.
    fn pass_on(&mut self, index: usize, now: Instant, rigid: [f64; 3]) {
        let executes = self.executes(index, now);
        let (actuator, shares) = &mut self.executing[index];
        let mut own = [Demand::Torque(0.0); 3];
        if executes {
            for ((own, demand), share) in own.iter_mut().zip(&self.demands).zip(shares) {
                *own = shared(*demand, *share);
            }
        }
        actuator.command(now, &own[..self.demands.len()], rigid);
    }

    /// Makes the actuator that stores momentum counteract a torque (N m) from the next command on.
    fn hold(&mut self, now: Instant, torque: Vector) {
        if let Some(index) = self.keepers.first() {
            self.executing[*index].0.update(now, ActuatorEvent::CounterTorque(torque));
        }
    }

    /// Executes the changes that are due, and unloads the rotors.
    fn serve(&mut self, now: Instant, rigid: [f64; 3]) {
        let stored = Vector::from(self.known_momentum(now, rigid, self.estimated_rate));
        let held = self.unloader.as_mut().and_then(|of| of.serve(now, rigid, stored, &self.demands));
        let executing = self.executing.iter_mut();
        executing.for_each(|(actuator, _)| actuator.update(now, ActuatorEvent::Due(rigid)));
        if let (Some(held), Some(index)) = (held, self.keepers.first().copied()) {
            self.hold(now, held);
            self.pass_on(index, now, rigid);
        }
    }
}

impl Part for ActuatorSet {
    fn due(&self) -> Option<Instant> {
        let executing = self.executing.iter().filter_map(|(actuator, _)| actuator.due());
        executing.chain(self.unloader.as_ref().and_then(UnloaderState::due)).min()
    }

    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        self.each().for_each(|actuator| actuator.report(at, report));
    }

    fn failure(&self) -> Option<PartError> {
        self.each().find_map(Part::failure)
    }
}

impl Actuator for ActuatorSet {
    fn command(&mut self, now: Instant, demands: &[Demand], rigid: [f64; 3]) {
        self.demands.iter_mut().zip(demands).for_each(|(own, demand)| *own = *demand);
        if let Some(unloader) = self.unloader.as_mut().filter(|unloader| unloader.is_commanded(demands)) {
            unloader.execute(now, demands, rigid);
            self.hold(now, Vector::zeros());
        }
        (0..self.executing.len()).for_each(|index| self.pass_on(index, now, rigid));
    }

    fn update(&mut self, now: Instant, event: ActuatorEvent<'_>) {
        match event {
            ActuatorEvent::Due(rigid) => self.serve(now, rigid),
            ActuatorEvent::CounterTorque(torque) => self.hold(now, torque),
            ActuatorEvent::MagneticField(_) => {
                self.executing.iter_mut().for_each(|(actuator, _)| actuator.update(now, event));
                self.unloader.iter_mut().for_each(|unloader| unloader.actuator.update(now, event));
            }
            ActuatorEvent::EstimatedRate(rate) => self.estimated_rate = rate,
            ActuatorEvent::Mode(mode) => self.mode = self.mode.map(|_| mode),
            ActuatorEvent::Rotors(_) => {
                self.executing.iter_mut().for_each(|(actuator, _)| actuator.update(now, event));
            }
        }
    }

    fn apply(&self, now: Instant, onto: &mut Wrench) {
        self.each().for_each(|actuator| actuator.apply(now, onto));
    }

    /// Returns the total effort; the demanded torque is that of the actuators that execute demands.
    fn effort(&self, axis: usize) -> AxisEffort {
        let plus = |a: AxisEffort, b: AxisEffort| AxisEffort {
            demanded: a.demanded + b.demanded,
            held: a.held + b.held,
            firing: a.firing + b.firing,
            reduced_moment: a.reduced_moment + b.reduced_moment,
        };
        let executing = self.executing.iter().map(|(actuator, _)| actuator.effort(axis)).reduce(plus);
        let Some(unloader) = &self.unloader else { return executing.unwrap_or_default() };
        let unloading = unloader.actuator.effort(axis);
        executing.map_or(AxisEffort { demanded: 0.0, ..unloading }, |executing| AxisEffort {
            demanded: executing.demanded,
            ..plus(executing, unloading)
        })
    }

    fn response(&self, now: Instant, axis: usize, rates: [f64; 2]) -> AxisResponse {
        AxisResponse {
            applied: self.sum(|actuator| actuator.response(now, axis, rates).applied),
            rotor: self.each().find_map(|actuator| actuator.response(now, axis, rates).rotor),
        }
    }

    fn ignores(&self, now: Instant, axis: usize, demands: &[Demand]) -> bool {
        let executing = self.executing.iter().enumerate().filter(|(index, _)| self.executes(*index, now));
        let mut own = executing
            .filter(|(_, (_, shares))| shares[axis] != 0.0 || matches!(demands[axis], Demand::Moment(_)));
        let unloads = self.unloader.as_ref().filter(|unloader| unloader.is_commanded(demands));
        own.all(|(_, (actuator, _))| actuator.ignores(now, axis, demands))
            && unloads.is_none_or(|unloader| unloader.actuator.ignores(now, axis, demands))
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            momentum: Some(self),
            pulses: self.has_pulses.then_some(self as &dyn PulsedActuator),
            waveform: Some(self),
            back_emf: self.back_emf,
            unloading: self.unloader.as_ref().map(|unloader| &unloader.cycle),
        }
    }

    fn copy(&self) -> Box<dyn Actuator> {
        Box::new(self.clone())
    }
}

impl MomentumStorage for ActuatorSet {
    fn stored_momentum(&self, now: Instant) -> [f64; 3] {
        let keepers = self.keepers.iter().map(|index| self.executing[*index].0.capabilities());
        let stored = keepers.map(|of| Vector::from(of.stored_momentum(now)));
        stored.reduce(|sum, next| sum + next).unwrap_or_default().into()
    }

    fn known_momentum(&self, now: Instant, rate: [f64; 3], estimated: [f64; 3]) -> [f64; 3] {
        let keepers = self.keepers.iter().map(|index| self.executing[*index].0.capabilities());
        let known = keepers.map(|of| Vector::from(of.known_momentum(now, rate, estimated)));
        known.reduce(|sum, next| sum + next).unwrap_or_default().into()
    }

    fn wheel_speeds(&self, now: Instant, rate: [f64; 3]) -> Vec<f64> {
        self.each().flat_map(|actuator| actuator.capabilities().wheel_speeds(now, rate)).collect()
    }

    fn wheels(&self, now: Instant, rate: [f64; 3]) -> Vec<flexsc_record::Wheel> {
        self.each().flat_map(|actuator| actuator.capabilities().wheels(now, rate)).collect()
    }

    fn commanded_torques(&self) -> Vec<f64> {
        let keepers =
            self.keepers.iter().filter_map(|index| self.executing[*index].0.capabilities().momentum);
        keepers.flat_map(MomentumStorage::commanded_torques).collect()
    }

    fn gyros(&self, now: Instant) -> Option<flexsc_record::ControlMomentGyros> {
        self.each().find_map(|actuator| actuator.capabilities().momentum?.gyros(now))
    }
}

/// The pulses of all jets; those executed are known only from the held torques.
impl PulsedActuator for ActuatorSet {
    fn write_cycle(&self, cycle: &mut JetCycle) {
        match self.pulsed().next() {
            Some(jets) => jets.write_cycle(cycle),
            None => *cycle = JetCycle::default(),
        }
    }

    fn pending_pulses(&self) -> Vec<Pulse> {
        self.pulsed().flat_map(PulsedActuator::pending_pulses).collect()
    }

    /// Returns 0: several actuators do not unload others together.
    fn cycle_impulse(&self) -> Vector {
        Vector::zeros()
    }

    fn commanded_on_times(&self) -> Option<[f64; 3]> {
        self.pulsed().find_map(PulsedActuator::commanded_on_times)
    }

    fn queued_rate_change(&self) -> [f64; 3] {
        let queued = self.pulsed().map(PulsedActuator::queued_rate_change);
        queued.fold([0.0; 3], |sum, next| [0, 1, 2].map(|axis| sum[axis] + next[axis]))
    }
}

impl WaveformActuator for ActuatorSet {
    fn waveform_impulse(&self, from: f64, to: f64) -> f64 {
        self.sum(|actuator| {
            let waveform = actuator.capabilities().waveform;
            waveform.map_or(0.0, |waveform| waveform.waveform_impulse(from, to))
        })
    }
}
