//! Run-time state of jets in groups: demands, queued pulses, current pulses, and propellant.

use flexsc_dynamics::wrench::Wrench;
use flexsc_flight::jet_pulses::JetPair;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::Report;

use super::valves::Valves;
use super::{
    Actuator, ActuatorEvent, AxisEffort, Capabilities, Demand, GroupEffect, JetCycle, Jets, PulseWidth,
    PulsedActuator, ThrusterEffect,
};
use crate::part::{Occasion, Part, ReportContext};

/// Pulse of thrusters, executed or queued.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Pulse {
    /// Index of the input: the axis of the thruster group.
    pub input: usize,
    /// Rigid acceleration about the group's own axis, signed (rad/s²).
    pub acceleration: f64,
    /// Start of the pulse after the last sample (s).
    pub start: f64,
    /// Length of the pulse (s).
    pub duration: f64,
}

impl Pulse {
    /// Returns true if the values are finite and the length is positive.
    pub fn is_valid(&self) -> bool {
        self.acceleration.is_finite()
            && self.start.is_finite()
            && self.duration.is_finite()
            && self.duration > 0.0
    }
}

/// Run-time state of the jets of a body.
#[derive(Clone, Debug)]
pub struct JetsState {
    groups: [[GroupEffect; 2]; 3],
    width: PulseWidth,
    delayed: bool,
    /// Period of the pulses, and the start of the next cycle unless it is the law's.
    period: Span,
    next: Option<Instant>,
    /// Demands of the laws about the axes.
    demands: [Demand; 3],
    /// Demanded torques about the axes (N m).
    torques: [f64; 3],
    /// Signed on-times commanded in the last cycle, to be executed in the next (s).
    waiting: [f64; 3],
    /// Signed on-times of the current cycle (s).
    executed: [f64; 3],
    /// End of the current pulse about each axis.
    ends: [Option<Instant>; 3],
    fuel: f64,
    /// Propellant used about each axis (kg).
    fuels: [f64; 3],
    /// Number of pulses since the start.
    pulses: u64,
    /// Valves and groups of each thruster, if thrusters have failures.
    valves: Option<(Valves, Vec<Vec<[usize; 2]>>)>,
}

/// Returns the groups about an axis, with their pulses of a period, as flight code has them.
pub fn jet_pair(groups: &[[GroupEffect; 2]; 3], axis: usize, period: Span, width: PulseWidth) -> JetPair {
    let [plus, minus] = &groups[axis];
    JetPair {
        acceleration_plus: plus.acceleration,
        acceleration_minus: minus.acceleration,
        torque_plus: plus.push.torque[axis].abs(),
        torque_minus: minus.push.torque[axis].abs(),
        period: period.seconds(),
        quantum: width.flight(),
    }
}

impl JetsState {
    /// Creates the jets before their first command, with their groups; `period` is the law's, for jets without their
    /// own.
    pub fn new(
        jets: &Jets,
        (groups, nozzles): (&[[GroupEffect; 2]; 3], &[ThrusterEffect]),
        period: Span,
    ) -> Self {
        let valves = Valves::new(jets, nozzles);
        Self {
            valves: valves.have_failures().then(|| (valves, jets.memberships())),
            groups: groups.clone(),
            width: jets.pulse_width(),
            delayed: jets.delay > 0,
            period: jets.period.unwrap_or(period),
            next: jets.period.map(|_| super::first(jets.phase)),
            demands: [Demand::Torque(0.0); 3],
            torques: [0.0; 3],
            waiting: [0.0; 3],
            executed: [0.0; 3],
            ends: [None; 3],
            fuel: 0.0,
            fuels: [0.0; 3],
            pulses: 0,
        }
    }

    /// Returns the group of an axis for pulses of this sign.
    fn group(&self, axis: usize, on: f64) -> &GroupEffect {
        &self.groups[axis][usize::from(on < 0.0)]
    }

    /// Returns the signed on-time of the demand about an axis (s).
    fn on_time(&self, axis: usize) -> f64 {
        let pair = jet_pair(&self.groups, axis, self.period, self.width);
        match self.demands[axis] {
            Demand::Change(change) => pair.on_time_of_change(change),
            Demand::Torque(torque) => pair.on_time_of_torque(torque),
            Demand::Moment(_) => 0.0,
        }
    }

    /// Begins a cycle with the current demands.
    fn begin(&mut self, now: Instant) {
        let commanded = [0, 1, 2].map(|axis| self.on_time(axis));
        self.executed = if self.delayed { self.waiting } else { commanded };
        self.waiting = if self.delayed { commanded } else { [0.0; 3] };
        for axis in 0..3 {
            let on = self.executed[axis];
            self.ends[axis] = (on != 0.0).then(|| now + Span::from_seconds(on.abs()));
            let fuel = on.abs() * self.group(axis, on).flow;
            self.fuel += fuel;
            self.fuels[axis] += fuel;
            self.pulses += u64::from(on != 0.0);
        }
        self.open(now);
    }

    /// Sets the valves according to the groups that fire from `now` on.
    fn open(&mut self, now: Instant) {
        let Self { valves: Some((valves, members)), ends, executed, .. } = self else { return };
        let burns = |[axis, side]: &&[usize; 2]| {
            ends[*axis].is_some_and(|end| end > now) && usize::from(executed[*axis] < 0.0) == *side
        };
        valves.set_open(now, |index| members[index].iter().filter(burns).count() as f64);
    }

    /// Writes the propellant of each group or thruster until the end of the pulses (kg), and returns that of all.
    fn write_fuels(&self, fuels: &mut Vec<f64>) -> f64 {
        let Some((valves, members)) = &self.valves else {
            fuels.clear();
            fuels.extend_from_slice(&self.fuels);
            return self.fuel;
        };
        let remaining = |[axis, side]: &[usize; 2]| {
            let own = usize::from(self.executed[*axis] < 0.0) == *side;
            self.ends[*axis].filter(|_| own).map_or(0.0, |end| end.since(valves.last_change()).seconds())
        };
        let remaining = |index: usize| members[index].iter().map(remaining).fold(0.0, f64::max);
        *fuels = valves.fuels(remaining);
        valves.propellant(remaining)
    }

    /// Returns the torque demanded about an axis (N m).
    fn demanded_torque(&self, axis: usize) -> f64 {
        match self.demands[axis] {
            Demand::Torque(torque) => torque,
            Demand::Change(change) => {
                let group = self.group(axis, change);
                change / group.acceleration * group.push.torque[axis].abs() / self.period.seconds()
            }
            Demand::Moment(_) => 0.0,
        }
    }

    /// Returns the torque about an axis of the jets that are on (N m).
    fn held_torque(&self, axis: usize) -> f64 {
        if let Some((valves, _)) = &self.valves {
            return valves.torque(axis);
        }
        let burning = (0..3).filter(|axis| self.ends[*axis].is_some());
        burning.map(|burning| self.group(burning, self.executed[burning]).push.torque[axis]).sum()
    }

    fn pulses(&self, on: [f64; 3]) -> Vec<Pulse> {
        let pulse = |axis: usize| Pulse {
            input: axis,
            acceleration: on[axis].signum() * self.group(axis, on[axis]).acceleration,
            start: 0.0,
            duration: on[axis].abs(),
        };
        (0..3).filter(|axis| on[*axis] != 0.0).map(pulse).collect()
    }
}

impl Part for JetsState {
    fn due(&self) -> Option<Instant> {
        let failing = self.valves.as_ref().and_then(|(valves, _)| valves.due());
        self.ends.into_iter().flatten().chain(self.next).chain(failing).min()
    }

    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        if at.occasion == Occasion::Cycle {
            JetCycle::report(self, report);
        }
    }
}

impl PulsedActuator for JetsState {
    fn write_cycle(&self, cycle: &mut JetCycle) {
        let sign = |axis: usize| if self.ends[axis].is_some() { self.executed[axis].signum() } else { 0.0 };
        cycle.on = self.executed;
        cycle.fuel = self.write_fuels(&mut cycle.fuels);
        cycle.pulses = self.pulses;
        cycle.burning = [0, 1, 2].map(sign);
        cycle.each.clear();
        cycle.open = self.valves.as_ref().map_or_else(Vec::new, |(valves, _)| valves.open_fractions());
    }

    fn executed_pulses(&self) -> Option<Vec<Pulse>> {
        Some(self.pulses(self.executed))
    }

    fn pending_pulses(&self) -> Vec<Pulse> {
        self.pulses(self.waiting)
    }

    fn commanded_on_times(&self) -> Option<[f64; 3]> {
        let own = self.next.is_none();
        own.then_some(if self.delayed { self.waiting } else { self.executed })
    }

    fn cycle_impulse(&self) -> Vector {
        let pulse =
            |axis: usize| self.group(axis, self.executed[axis]).push.torque * self.executed[axis].abs();
        pulse(0) + pulse(1) + pulse(2)
    }

    fn queued_rate_change(&self) -> [f64; 3] {
        let on = self.waiting;
        std::array::from_fn(|axis| on[axis] * self.group(axis, on[axis]).acceleration)
    }
}

impl Actuator for JetsState {
    fn command(&mut self, now: Instant, demands: &[Demand], _: [f64; 3]) {
        for (own, demand) in self.demands.iter_mut().zip(demands) {
            *own = *demand;
        }
        self.torques = [0, 1, 2].map(|axis| self.demanded_torque(axis));
        if self.next.is_none() {
            self.begin(now);
        }
    }

    fn update(&mut self, now: Instant, event: ActuatorEvent<'_>) {
        let ActuatorEvent::Due(_) = event else { return };
        self.ends = self.ends.map(|end| end.filter(|end| *end > now));
        if self.next == Some(now) {
            self.begin(now);
            self.next = Some(now + self.period);
        }
        self.open(now);
    }

    fn apply(&self, _: Instant, onto: &mut Wrench) {
        if let Some((valves, _)) = &self.valves {
            return valves.exert(onto);
        }
        for axis in (0..3).filter(|axis| self.ends[*axis].is_some()) {
            let group = self.group(axis, self.executed[axis]);
            onto.add_force_effect(&group.push);
        }
    }

    fn effort(&self, axis: usize) -> AxisEffort {
        let on = self.executed[axis];
        let fires = self.ends[axis].is_some();
        AxisEffort {
            demanded: self.torques[axis],
            held: self.held_torque(axis),
            firing: 0.0,
            reduced_moment: if fires { on.signum() * self.group(axis, on).acceleration } else { 0.0 },
        }
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities { pulses: Some(self), ..Capabilities::default() }
    }

    fn copy(&self) -> Box<dyn Actuator> {
        Box::new(self.clone())
    }
}
