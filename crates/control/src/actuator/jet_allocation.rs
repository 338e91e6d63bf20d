//! Individually allocated jets, in any number and on any axis: each cycle's on-times meet the demand with the least
//! propellant.
//!
//! The on-times t solve a linear programme: the smallest sum of flows times t with B t = impulse and 0 <= t <= period,
//! where the columns of B are the torques of the thrusters, and also their forces if these must cancel. An impulse
//! beyond the capability is scaled down to the largest one in its direction. In a burn a force is commanded as well: its
//! on-times meet the torque first, and then the force as closely as they can.

use flexsc_dynamics::wrench::{ForceEffect, Wrench};
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::simplex::LinearProgramme;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::Report;

use super::burns::BurnProgramme;
use super::valves::Valves;
use super::{
    Actuator, ActuatorEvent, AxisEffort, Capabilities, Demand, GroupEffect, JetCycle, Jets, PulseWidth,
    PulsedActuator, ThrusterEffect,
};
use crate::part::{Occasion, Part, ReportContext};

/// Run-time state of individually allocated jets.
#[derive(Clone, Debug)]
pub struct AllocatedJets {
    programme: LinearProgramme,
    burns: BurnProgramme,
    /// Torque (N m) and propellant flow (kg/s) of each thruster.
    torques: Vec<Vector>,
    flows: Vec<f64>,
    /// Inertia about each axis (kg m²), and largest torque in the positive and the negative direction (N m).
    inertia: [f64; 3],
    largest: [[f64; 2]; 3],
    width: PulseWidth,
    delayed: bool,
    /// Period of the pulses, and the start of the next cycle unless it is the law's.
    period: Span,
    next: Option<Instant>,
    demands: [Demand; 3],
    /// On-times of the next cycle and of the current one (s), and the end of each current pulse.
    waiting: Vec<f64>,
    executed: Vec<f64>,
    ends: Vec<Option<Instant>>,
    /// Directions of the forces commanded in the next cycle and in the current one; zero for none.
    thrust_directions: [Vector; 2],
    valves: Valves,
    pulses: u64,
}

/// Creates the linear programme of thrusters with the largest on-time `most` (s); `force_free`: their forces must
/// cancel.
fn programme(nozzles: &[ThrusterEffect], most: f64, force_free: bool) -> LinearProgramme {
    let column = |nozzle: &ThrusterEffect| {
        let force = nozzle.push.force.iter().copied().filter(|_| force_free);
        nozzle.push.torque.iter().copied().chain(force).collect()
    };
    let rows = if force_free { 6 } else { 3 };
    LinearProgramme::new(rows, nozzles.iter().map(column).collect(), vec![most; nozzles.len()])
}

/// Returns the right-hand side of a programme: a torque or an impulse, and zero force.
fn right_hand_side(demand: &Vector, force_free: bool) -> Vec<f64> {
    demand.iter().copied().chain([0.0; 3].into_iter().filter(|_| force_free)).collect()
}

/// Returns, for each axis about which the jets act, the combined effects of the thrusters that give the largest
/// positive and negative torque with the least propellant.
///
/// # Errors
/// A `ConfigError` if the thrusters cannot rotate the body about such an axis.
pub(super) fn largest_torques(
    jets: &Jets,
    nozzles: &[ThrusterEffect],
    inertia: [f64; 3],
    acts: [bool; 3],
) -> Result<[[GroupEffect; 2]; 3], ConfigError> {
    let programme = programme(nozzles, 1.0, jets.force_free);
    let costs: Vec<f64> = nozzles.iter().map(|nozzle| nozzle.flow).collect();
    // More than all thrusters together can give.
    let beyond: f64 = nozzles.iter().map(|nozzle| nozzle.push.torque.norm()).sum::<f64>().max(1.0) * 2.0;
    let sign_name = |axis: usize, sign: f64| {
        let mut demand = Vector::zeros();
        demand[axis] = sign * beyond;
        let (parts, _) = programme.cheapest(&right_hand_side(&demand, jets.force_free), &costs);
        let mut effect = ForceEffect::default();
        let mut flow = 0.0;
        for (nozzle, part) in nozzles.iter().zip(parts) {
            effect += &super::valves::scaled(&nozzle.push, part);
            flow += nozzle.flow * part;
        }
        if sign * effect.torque[axis] <= 1e-9 * beyond {
            let (name, sign_name) =
                (flexsc_numerics::attitude::AXES[axis], if sign > 0.0 { "plus" } else { "minus" });
            let condition = if jets.force_free { " without a force" } else { "" };
            let why = format!(
                "must be able to turn the body to {sign_name} {name}{condition} and about no other axis"
            );
            return Err(ConfigError::new("thrusters", why));
        }
        let acceleration = effect.torque[axis].abs() / inertia[axis];
        Ok(GroupEffect { push: effect, flow, acceleration })
    };
    let pair = |axis: usize| {
        let modes = nozzles.first().map_or(0, |nozzle| nozzle.push.forces.len());
        if acts[axis] {
            Ok([sign_name(axis, 1.0)?, sign_name(axis, -1.0)?])
        } else {
            Ok(GroupEffect::without_effect(modes))
        }
    };
    Ok([pair(0)?, pair(1)?, pair(2)?])
}

impl AllocatedJets {
    /// Creates the jets before their first command; `period` is the law's, for jets without their own.
    pub fn new(
        jets: &Jets,
        (groups, nozzles): (&[[GroupEffect; 2]; 3], &[ThrusterEffect]),
        period: Span,
    ) -> Self {
        let count = nozzles.len();
        let cycle = jets.period.unwrap_or(period);
        let torque = |axis: usize, side: usize| groups[axis][side].push.torque[axis].abs();
        Self {
            programme: programme(nozzles, cycle.seconds(), jets.force_free),
            burns: BurnProgramme::new(&jets.burns, nozzles, cycle.seconds()),
            torques: nozzles.iter().map(|nozzle| nozzle.push.torque).collect(),
            flows: nozzles.iter().map(|nozzle| nozzle.flow).collect(),
            // There is no demand about an axis without a group.
            inertia: [0, 1, 2].map(|axis| match torque(axis, 0) {
                0.0 => f64::INFINITY,
                torque => torque / groups[axis][0].acceleration,
            }),
            largest: [0, 1, 2].map(|axis| [torque(axis, 0), torque(axis, 1)]),
            width: jets.pulse_width(),
            delayed: jets.delay > 0,
            period: cycle,
            next: jets.period.map(|_| super::first(jets.phase)),
            demands: [Demand::Torque(0.0); 3],
            waiting: vec![0.0; count],
            executed: vec![0.0; count],
            ends: vec![None; count],
            thrust_directions: [Vector::zeros(); 2],
            valves: Valves::new(jets, nozzles),
            pulses: 0,
        }
    }

    /// Returns the demanded angular impulse over a cycle (N m s).
    fn torque_demand(&self) -> Vector {
        let demand_about = |axis: usize| match self.demands[axis] {
            Demand::Torque(torque) => torque * self.period.seconds(),
            Demand::Change(0.0) | Demand::Moment(_) => 0.0,
            Demand::Change(change) => change * self.inertia[axis],
        };
        Vector::from_fn(|axis, _| demand_about(axis))
    }

    /// Begins a cycle with the current demands.
    fn begin(&mut self, now: Instant) {
        let period = self.period.seconds();
        let b = right_hand_side(&self.torque_demand(), self.programme.rows() > 3);
        let (mut times, attainable) = self.programme.cheapest(&b, &self.flows);
        let executed_at = if self.delayed { now + self.period } else { now };
        let burn = self.burns.demand(executed_at, self.period);
        if let Some((impulse, _)) = &burn {
            times = self.burns.on_times(&(self.torque_demand() * attainable), impulse);
        }
        let direction = burn.map_or_else(Vector::zeros, |(_, direction)| direction);
        let commanded: Vec<f64> = times.into_iter().map(|t| self.width.on_time(t, period)).collect();
        let before = std::mem::replace(&mut self.waiting, commanded);
        if self.delayed {
            self.executed = before;
        } else {
            self.executed.clone_from(&self.waiting);
            self.waiting.fill(0.0);
        }
        for (on, end) in self.executed.iter().zip(&mut self.ends) {
            *end = (*on > 0.0).then(|| now + Span::from_seconds(*on));
            self.pulses += u64::from(*on > 0.0);
        }
        self.thrust_directions =
            if self.delayed { [direction, self.thrust_directions[0]] } else { [Vector::zeros(), direction] };
        self.open(now);
        self.valves.set_commanded(self.thrust_directions[1]);
    }

    fn open(&mut self, now: Instant) {
        let Self { valves, ends, .. } = self;
        valves.set_open(now, |index| f64::from(u8::from(ends[index].is_some_and(|end| end > now))));
    }

    /// Returns the angular impulse of these on-times (N m s).
    fn impulse_of(&self, times: &[f64]) -> Vector {
        self.torques.iter().zip(times).fold(Vector::zeros(), |sum, (torque, on)| sum + torque * *on)
    }
}

impl Part for AllocatedJets {
    fn due(&self) -> Option<Instant> {
        self.ends.iter().flatten().copied().chain(self.next).chain(self.valves.due()).min()
    }

    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        if at.occasion == Occasion::Cycle {
            JetCycle::report(self, report);
        }
    }
}

impl PulsedActuator for AllocatedJets {
    fn write_cycle(&self, cycle: &mut JetCycle) {
        let turned = self.cycle_impulse();
        let on = [0, 1, 2].map(|axis| match self.largest[axis][usize::from(turned[axis] < 0.0)] {
            0.0 => 0.0,
            largest => turned[axis] / largest,
        });
        let since = self.valves.last_change();
        let left = |index: usize| self.ends[index].map_or(0.0, |end| end.since(since).seconds());
        cycle.on = on;
        cycle.fuel = self.valves.propellant(left);
        cycle.fuels = self.valves.fuels(left);
        cycle.burn_impulse = self.valves.burn_impulse(left);
        cycle.pulses = self.pulses;
        cycle.burning = [0.0; 3];
        cycle.each.clone_from(&self.executed);
        cycle.open = self.valves.open_fractions();
    }

    fn cycle_impulse(&self) -> Vector {
        self.impulse_of(&self.executed)
    }

    fn queued_rate_change(&self) -> [f64; 3] {
        let turned = self.impulse_of(&self.waiting);
        [0, 1, 2].map(|axis| turned[axis] / self.inertia[axis])
    }
}

impl Actuator for AllocatedJets {
    fn command(&mut self, now: Instant, demands: &[Demand], _: [f64; 3]) {
        self.demands.iter_mut().zip(demands).for_each(|(own, demand)| *own = *demand);
        if self.next.is_none() {
            self.begin(now);
        }
    }

    fn update(&mut self, now: Instant, event: ActuatorEvent<'_>) {
        let ActuatorEvent::Due(_) = event else { return };
        self.ends.iter_mut().for_each(|end| *end = end.filter(|end| *end > now));
        if self.next == Some(now) {
            self.begin(now);
            self.next = Some(now + self.period);
        }
        self.open(now);
    }

    fn apply(&self, _: Instant, onto: &mut Wrench) {
        self.valves.exert(onto);
    }

    fn effort(&self, axis: usize) -> AxisEffort {
        // Estimators assume that no thruster fails.
        let burning = self.torques.iter().zip(&self.ends).filter(|(_, end)| end.is_some());
        AxisEffort {
            demanded: self.torque_demand()[axis] / self.period.seconds(),
            held: self.valves.torque(axis),
            firing: 0.0,
            reduced_moment: burning.map(|(torque, _)| torque[axis]).sum::<f64>() / self.inertia[axis],
        }
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities { pulses: Some(self), ..Capabilities::default() }
    }

    fn copy(&self) -> Box<dyn Actuator> {
        Box::new(self.clone())
    }
}
