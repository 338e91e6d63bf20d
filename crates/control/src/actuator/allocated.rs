//! Jets by themselves, in any number and on any axis: in each cycle those on-times that give what is demanded with the least propellant.
//!
//! That is a linear programme in the on-times t: the least sum of flows times t with B t = impulse and 0 <= t <= period, where the
//! columns of B are the torques of the thrusters, and their forces too where these shall cancel. Of an impulse that is more than there is
//! the largest part in its direction is given.

use super::valves::Valves;
use super::{Actuate, Demand, FiringGroup, JetCycle, Jets, OpenThruster, PulseWidth};
use crate::attitude::Vector;
use crate::document::Fault;
use crate::numerics::simplex::LinearProgramme;
use crate::time::{Instant, Span};
use crate::wrench::{Push, Wrench};

/// Jets at work.
#[derive(Clone, Debug)]
pub struct Allocated {
    programme: LinearProgramme,
    /// Torques (N m), and propellant in a second (kg/s), of each thruster.
    torques: Vec<Vector>,
    flows: Vec<f64>,
    /// What a unit of torque accelerates about each axis (kg m²), and the largest torques one way and the other (N m).
    inertia: [f64; 3],
    largest: [[f64; 2]; 3],
    width: PulseWidth,
    delayed: bool,
    /// The cycle of the pulses, and when the next begins where it is not the law's.
    period: Span,
    next: Option<Instant>,
    demands: [Demand; 3],
    /// On-times of the next cycle and of this one (s), and when each of these pulses ends.
    waiting: Vec<f64>,
    executed: Vec<f64>,
    ends: Vec<Option<Instant>>,
    valves: Valves,
    pulses: u64,
}

/// The programme of thrusters: their largest on-time (s), and whether their forces shall cancel.
fn programme(nozzles: &[OpenThruster], most: f64, force_free: bool) -> LinearProgramme {
    let column = |nozzle: &OpenThruster| {
        let force = nozzle.push.force.iter().copied().filter(|_| force_free);
        nozzle.push.torque.iter().copied().chain(force).collect()
    };
    let rows = if force_free { 6 } else { 3 };
    LinearProgramme::new(rows, nozzles.iter().map(column).collect(), vec![most; nozzles.len()])
}

/// What is asked of a programme: a torque or an impulse, and no force.
fn asked(wanted: &Vector, force_free: bool) -> Vec<f64> {
    wanted.iter().copied().chain([0.0; 3].into_iter().filter(|_| force_free)).collect()
}

/// What the thrusters do together that give the largest torque about each axis about which they act, one way and the other, for the
/// least propellant.
///
/// # Errors
/// They cannot turn the body about such an axis.
pub(super) fn largest(
    jets: &Jets,
    nozzles: &[OpenThruster],
    inertia: [f64; 3],
    acts: [bool; 3],
) -> Result<[[FiringGroup; 2]; 3], Fault> {
    let programme = programme(nozzles, 1.0, jets.force_free);
    let costs: Vec<f64> = nozzles.iter().map(|nozzle| nozzle.flow).collect();
    // More than all of them have.
    let beyond: f64 = nozzles.iter().map(|nozzle| nozzle.push.torque.norm()).sum::<f64>().max(1.0) * 2.0;
    let group = |axis: usize, sign: f64| {
        let mut wanted = Vector::zeros();
        wanted[axis] = sign * beyond;
        let (parts, _) = programme.cheapest(&asked(&wanted, jets.force_free), &costs);
        let mut push = Push::default();
        let mut flow = 0.0;
        for (nozzle, part) in nozzles.iter().zip(parts) {
            push += &super::valves::scaled(&nozzle.push, part);
            flow += nozzle.flow * part;
        }
        if sign * push.torque[axis] <= 1e-9 * beyond {
            let (name, way) = (crate::attitude::AXES[axis], if sign > 0.0 { "plus" } else { "minus" });
            let alone = if jets.force_free { " without a force" } else { "" };
            let why = format!("must be able to turn the body to {way} {name}{alone} and about no other axis");
            return Err(Fault::new("thrusters", why));
        }
        let acceleration = push.torque[axis].abs() / inertia[axis];
        Ok(FiringGroup { push, flow, acceleration })
    };
    let pair = |axis: usize| {
        let modes = nozzles.first().map_or(0, |nozzle| nozzle.push.forces.len());
        if acts[axis] { Ok([group(axis, 1.0)?, group(axis, -1.0)?]) } else { Ok(FiringGroup::idle(modes)) }
    };
    Ok([pair(0)?, pair(1)?, pair(2)?])
}

impl Allocated {
    /// The jets before the first command; `period` is that of the law, for jets without one of their own.
    pub fn new(
        jets: &Jets,
        (groups, nozzles): (&[[FiringGroup; 2]; 3], &[OpenThruster]),
        period: Span,
    ) -> Self {
        let count = nozzles.len();
        let cycle = jets.period.unwrap_or(period);
        let torque = |axis: usize, side: usize| groups[axis][side].push.torque[axis].abs();
        Self {
            programme: programme(nozzles, cycle.seconds(), jets.force_free),
            torques: nozzles.iter().map(|nozzle| nozzle.push.torque).collect(),
            flows: nozzles.iter().map(|nozzle| nozzle.flow).collect(),
            // Nothing is asked about an axis without a group.
            inertia: [0, 1, 2].map(|axis| match torque(axis, 0) {
                0.0 => f64::INFINITY,
                torque => torque / groups[axis][0].acceleration,
            }),
            largest: [0, 1, 2].map(|axis| [torque(axis, 0), torque(axis, 1)]),
            width: jets.width(),
            delayed: jets.delay > 0,
            period: cycle,
            next: jets.period.map(|_| super::first(jets.phase)),
            demands: [Demand::Torque(0.0); 3],
            waiting: vec![0.0; count],
            executed: vec![0.0; count],
            ends: vec![None; count],
            valves: Valves::new(jets, nozzles),
            pulses: 0,
        }
    }

    /// The impulse that is demanded over a cycle (N m s).
    fn wanted(&self) -> Vector {
        let about = |axis: usize| match self.demands[axis] {
            Demand::Torque(torque) => torque * self.period.seconds(),
            Demand::Change(0.0) | Demand::Moment(_) => 0.0,
            Demand::Change(change) => change * self.inertia[axis],
        };
        Vector::from_fn(|axis, _| about(axis))
    }

    /// Begins a cycle with what is commanded.
    fn begin(&mut self, now: Instant) {
        let period = self.period.seconds();
        let b = asked(&self.wanted(), self.programme.rows() > 3);
        let (times, _) = self.programme.cheapest(&b, &self.flows);
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
        self.open(now);
    }

    fn open(&mut self, now: Instant) {
        let Self { valves, ends, .. } = self;
        valves.set(now, |index| f64::from(u8::from(ends[index].is_some_and(|end| end > now))));
    }

    /// What on-times turn the body by (N m s).
    fn turned_by(&self, times: &[f64]) -> Vector {
        self.torques.iter().zip(times).fold(Vector::zeros(), |sum, (torque, on)| sum + torque * *on)
    }
}

impl Actuate for Allocated {
    fn command(&mut self, now: Instant, demands: &[Demand], _: [f64; 3]) {
        self.demands.iter_mut().zip(demands).for_each(|(own, demand)| *own = *demand);
        if self.next.is_none() {
            self.begin(now);
        }
    }

    fn due(&self) -> Option<Instant> {
        self.ends.iter().flatten().copied().chain(self.next).chain(self.valves.due()).min()
    }

    fn serve(&mut self, now: Instant, _: [f64; 3]) {
        self.ends.iter_mut().for_each(|end| *end = end.filter(|end| *end > now));
        if self.next == Some(now) {
            self.begin(now);
            self.next = Some(now + self.period);
        }
        self.open(now);
    }

    fn exert(&self, _: Instant, onto: &mut Wrench) {
        self.valves.exert(onto);
    }

    fn asked(&self, axis: usize) -> f64 {
        self.wanted()[axis] / self.period.seconds()
    }

    fn torque(&self, axis: usize) -> f64 {
        self.valves.torque(axis)
    }

    /// As it is without a failure.
    fn moment(&self, axis: usize) -> f64 {
        let burning = self.torques.iter().zip(&self.ends).filter(|(_, end)| end.is_some());
        burning.map(|(torque, _)| torque[axis]).sum::<f64>() / self.inertia[axis]
    }

    fn impulse(&self) -> Vector {
        self.turned_by(&self.executed)
    }

    fn cycle(&self) -> Option<JetCycle> {
        let turned = self.impulse();
        let on = [0, 1, 2].map(|axis| match self.largest[axis][usize::from(turned[axis] < 0.0)] {
            0.0 => 0.0,
            largest => turned[axis] / largest,
        });
        let since = self.valves.since();
        let left = |index: usize| self.ends[index].map_or(0.0, |end| end.since(since).seconds());
        Some(JetCycle {
            on,
            fuel: self.valves.fuel(left),
            fuels: self.valves.fuels(left),
            pulses: self.pulses,
            burning: [0.0; 3],
            each: self.executed.clone(),
            open: self.valves.open(),
        })
    }

    fn queued(&self) -> [f64; 3] {
        let turned = self.turned_by(&self.waiting);
        [0, 1, 2].map(|axis| turned[axis] / self.inertia[axis])
    }

    fn copy(&self) -> Box<dyn Actuate> {
        Box::new(self.clone())
    }
}
