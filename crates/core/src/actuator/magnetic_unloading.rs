//! Magnetorquers that unload wheels: they push against the wheels' momentum as far as it is across the field (\[Wertz78\]).
//!
//! With the momentum h of the wheels and the field B the moment is k h x B/B²: its torque is -k times the part of h across B, which
//! the wheels hold against. What is along the field waits for the orbit to turn it: over an orbit h falls at the mean rate
//! k (1 - <b b'>), with b the field's direction.

use super::{Actuate, Demand, Spinning, Torquing};
use crate::attitude::Vector;
use crate::body::Wrench;
use crate::record;
use crate::time::{Instant, Span};

/// Wheels and torquers at work.
#[derive(Clone, Debug)]
pub struct Magnetic {
    pub(super) wheels: Spinning,
    pub(super) torquers: Torquing,
    /// Momenta at which it begins and ends (N m s).
    pub(super) limits: [f64; 2],
    /// The gain k (1/s).
    pub(super) gain: f64,
    pub(super) period: Span,
    /// When the torquers are commanded next.
    pub(super) next: Instant,
    pub(super) active: bool,
    /// What laws demand.
    pub(super) demands: [Demand; 3],
}

impl Magnetic {
    /// Whether laws command the torquers themselves.
    fn is_taken(&self) -> bool {
        self.demands.iter().any(|demand| matches!(demand, Demand::Moment(_)))
    }

    /// Commands the torquers: as long as there is too much momentum they take of it what they can.
    fn begin(&mut self, now: Instant, rigid: [f64; 3]) {
        let stored = Vector::from(self.wheels.stored(now));
        let [above, below] = self.limits;
        self.active = stored.norm() > if self.active { below } else { above };
        self.torquers.give(if self.active { stored * -self.gain } else { Vector::zeros() });
        self.wheels.hold_against(self.torquers.given());
        self.wheels.command(now, &self.demands, rigid);
    }
}

impl Actuate for Magnetic {
    fn feel(&mut self, field: Vector) {
        self.torquers.feel(field);
    }

    fn command(&mut self, now: Instant, demands: &[Demand], rigid: [f64; 3]) {
        self.demands.iter_mut().zip(demands).for_each(|(own, demand)| *own = *demand);
        if self.is_taken() {
            self.torquers.command(now, demands, rigid);
            self.wheels.hold_against(Vector::zeros());
            self.active = false;
        }
        self.wheels.command(now, demands, rigid);
    }

    fn due(&self) -> Option<Instant> {
        self.wheels.due().into_iter().chain(self.torquers.due()).chain([self.next]).min()
    }

    fn serve(&mut self, now: Instant, rigid: [f64; 3]) {
        if self.next == now {
            self.next = now + self.period;
            if !self.is_taken() {
                self.begin(now, rigid);
            }
        }
        self.torquers.serve(now, rigid);
        self.wheels.serve(now, rigid);
    }

    fn exert(&self, now: Instant, onto: &mut Wrench) {
        self.wheels.exert(now, onto);
        self.torquers.exert(now, onto);
    }

    fn asked(&self, axis: usize) -> f64 {
        self.wheels.asked(axis)
    }

    fn torque(&self, axis: usize) -> f64 {
        self.wheels.torque(axis) + self.torquers.torque(axis)
    }

    /// Of the wheels alone: the plant tells what the moments give.
    fn applied(&self, _: Instant, axis: usize, _: [f64; 2]) -> f64 {
        self.wheels.torque(axis)
    }

    fn moment(&self, axis: usize) -> f64 {
        self.wheels.moment(axis) + self.torquers.moment(axis)
    }

    fn wheels(&self, now: Instant, rate: [f64; 3]) -> Vec<record::Wheel> {
        self.wheels.wheels(now, rate)
    }

    fn magnetic(&self) -> Option<record::Magnetorquers> {
        self.torquers.magnetic()
    }

    fn stored(&self, now: Instant) -> [f64; 3] {
        self.wheels.stored(now)
    }

    fn copy(&self) -> Box<dyn Actuate> {
        Box::new(self.clone())
    }
}
