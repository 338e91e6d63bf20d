//! The jets at work: what is commanded, what waits, what burns, and the propellant.

use crate::actuator::Group;
use crate::body::spatial::Vector;
use crate::estimator::adaptive::Pulse;
use crate::scenario::SpatialLoop;
use crate::time::{Instant, Span};

/// What jets exert on a body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Push {
    /// Torque about the centre of mass (N m).
    pub torque: Vector,
    /// Modal forces (N/sqrt(kg)); none at all if no jet is on.
    pub forces: Vec<f64>,
}

/// The jets of a loop.
#[derive(Clone, Debug)]
pub struct JetsAtWork {
    groups: [[Group; 2]; 3],
    delayed: bool,
    /// Signed on-times that were commanded in the last cycle, and are executed in the next (s).
    waiting: [f64; 3],
    /// Signed on-times of this cycle (s).
    executed: [f64; 3],
    /// When the pulse of each axis ends.
    ends: [Option<Instant>; 3],
    fuel: f64,
}

impl JetsAtWork {
    /// The jets before the first command.
    pub fn new(spatial: &SpatialLoop) -> Self {
        Self {
            groups: spatial.groups.clone(),
            delayed: spatial.jets.delay > 0,
            waiting: [0.0; 3],
            executed: [0.0; 3],
            ends: [None; 3],
            fuel: 0.0,
        }
    }

    /// Accelerations of plus and minus about each axis (rad/s²).
    pub fn accelerations(&self) -> [[f64; 2]; 3] {
        [0, 1, 2].map(|axis| [0, 1].map(|sign| self.groups[axis][sign].acceleration))
    }

    /// The group of an axis whose pulse has this sign.
    fn group(&self, axis: usize, on: f64) -> &Group {
        &self.groups[axis][usize::from(on < 0.0)]
    }

    /// What signed on-times change about each axis (rad/s).
    fn changes(&self, on: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| on[axis] * self.group(axis, on[axis]).acceleration)
    }

    /// Changes of the rigid rates by the pulses of the cycle that ends (rad/s).
    pub fn pushed(&self) -> [f64; 3] {
        self.changes(self.executed)
    }

    /// Changes of the rigid rates by the pulses that wait for the cycle that begins (rad/s).
    pub fn queued(&self) -> [f64; 3] {
        self.changes(self.waiting)
    }

    /// The pulses of this cycle.
    pub fn pulses(&self) -> Vec<Pulse> {
        self.as_pulses(self.executed)
    }

    /// The pulses that wait for the cycle that begins.
    pub fn pulses_waiting(&self) -> Vec<Pulse> {
        self.as_pulses(self.waiting)
    }

    fn as_pulses(&self, on: [f64; 3]) -> Vec<Pulse> {
        let pulse = |axis: usize| Pulse {
            input: axis,
            acceleration: on[axis].signum() * self.group(axis, on[axis]).acceleration,
            start: 0.0,
            duration: on[axis].abs(),
        };
        (0..3).filter(|axis| on[*axis] != 0.0).map(pulse).collect()
    }

    /// Begins a cycle with new commands: signed on-times about each axis (s). Returns those that are executed in it.
    pub fn begin(&mut self, now: Instant, commanded: [f64; 3]) -> [f64; 3] {
        self.executed = if self.delayed { self.waiting } else { commanded };
        self.waiting = if self.delayed { commanded } else { [0.0; 3] };
        for axis in 0..3 {
            let on = self.executed[axis];
            self.ends[axis] = (on != 0.0).then(|| now + Span::from_seconds(on.abs()));
            self.fuel += on.abs() * self.group(axis, on).flow;
        }
        self.executed
    }

    /// When the next pulse ends.
    pub fn due(&self) -> Option<Instant> {
        self.ends.into_iter().flatten().min()
    }

    /// Ends the pulses whose time has come; tells whether any did.
    pub fn end(&mut self, now: Instant) -> bool {
        let burning = self.ends;
        self.ends = burning.map(|end| end.filter(|end| *end > now));
        self.ends != burning
    }

    /// What the jets exert now.
    pub fn push(&self) -> Push {
        let mut push = Push::default();
        for axis in (0..3).filter(|axis| self.ends[*axis].is_some()) {
            let group = self.group(axis, self.executed[axis]);
            push.torque += group.torque;
            push.forces.resize(group.forces.len(), 0.0);
            push.forces.iter_mut().zip(&group.forces).for_each(|(sum, force)| *sum += force);
        }
        push
    }

    /// The signs of the pulses that burn about each axis, 0 for none.
    pub fn burning(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| if self.ends[axis].is_some() { self.executed[axis].signum() } else { 0.0 })
    }

    /// Propellant until the end of the pulses that burn (kg).
    pub fn fuel(&self) -> f64 {
        self.fuel
    }
}
