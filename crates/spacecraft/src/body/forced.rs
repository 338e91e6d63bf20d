//! What a waveform adds to the motion of the planar body, in closed form.

use std::ops::AddAssign;
use std::sync::Arc as Shared;

use super::mode::ModeFlow;
use super::spatial::Spatial;
use crate::attitude::Vector;
use crate::motion::turning::{Gimbal, Rotor};
use crate::numerics::phasor::Phasor;
use crate::numerics::polynomial::Series;
use crate::sine::Sine;
use crate::waveform::Waveform;

/// What drives a body from an instant on.
#[derive(Clone, Debug, Default)]
pub struct ForcedInput {
    /// A constant (N m; rad/s² where the hub's motion is commanded).
    pub constant: f64,
    /// A waveform, and the time on it at that instant (s).
    pub waveform: Option<Forced>,
}

impl ForcedInput {
    /// A constant alone (N m).
    pub fn constant(constant: f64) -> Self {
        Self { constant, waveform: None }
    }
}

/// All that acts on a body from an instant on.
#[derive(Clone, Debug, Default)]
pub struct Wrench {
    /// Torques about the axes at the hub (N m): on a body with one angle the first alone, rad/s² where the hub's motion is
    /// commanded; on one with three axes at the point that its actuators name.
    pub hub: [f64; 3],
    /// Torque of jets and of forces at points, about the centre of mass (N m).
    pub torque: Vector,
    /// Modal forces of jets and of forces at points (N/sqrt(kg)); none at all if there are none.
    pub forces: Vec<f64>,
    /// The sum of these forces, in the body's axes (N).
    pub force: Vector,
    /// What a unit of each mode adds to their torque, for it moves the places where they act (N/sqrt(kg)); as `forces`.
    pub levers: Vec<Vector>,
    /// Rotors that store momentum, each with the torque on it.
    pub rotors: Vec<Rotor>,
    /// Rotors in gimbals, each with its angle now and its rate.
    pub gimbals: Vec<Gimbal>,
    /// Magnetic moment of torquers, in the body's axes (A m²).
    pub moment: Vector,
    /// Sines of the time in the torque at the hub of a spacecraft, each with its axis.
    pub sines: Vec<(Vector, Sine)>,
    /// A waveform about the first axis, and the time on it at that instant.
    pub waveform: Option<Forced>,
}

impl Wrench {
    /// Nothing acts any more; what was allocated stays so.
    pub fn clear(&mut self) {
        let Self { hub, torque, forces, force, levers, rotors, gimbals, moment, sines, waveform } = self;
        *hub = [0.0; 3];
        (*torque, *force, *moment) = (Vector::zeros(), Vector::zeros(), Vector::zeros());
        forces.clear();
        levers.clear();
        rotors.clear();
        gimbals.clear();
        sines.clear();
        *waveform = None;
    }

    /// Adds a waveform, which is on its way since the same instant as any other.
    pub fn force(&mut self, by: Option<Forced>) {
        self.waveform = match (self.waveform.take(), by) {
            (Some(own), Some(by)) => Some(own.changed(1.0, &by.waveform)),
            (own, by) => own.or(by),
        };
    }

    /// Adds a push.
    pub fn push(&mut self, push: &Push) {
        self.torque += push.torque;
        self.force += push.force;
        self.forces.resize(push.forces.len(), 0.0);
        self.forces.iter_mut().zip(&push.forces).for_each(|(sum, force)| *sum += force);
        self.levers.resize(push.levers.len(), Vector::zeros());
        self.levers.iter_mut().zip(&push.levers).for_each(|(sum, lever)| *sum += lever);
    }
}

/// What forces at points do to a body, in its axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Push {
    /// Torque about the centre of mass of the body as it is not bent (N m).
    pub torque: Vector,
    /// Modal forces (N/sqrt(kg)).
    pub forces: Vec<f64>,
    /// The forces together (N).
    pub force: Vector,
    /// What a unit of each mode adds to the torque (N/sqrt(kg)).
    pub levers: Vec<Vector>,
}

impl AddAssign<&Self> for Push {
    fn add_assign(&mut self, other: &Self) {
        self.torque += other.torque;
        self.force += other.force;
        self.forces.resize(other.forces.len(), 0.0);
        self.forces.iter_mut().zip(&other.forces).for_each(|(sum, force)| *sum += force);
        self.levers.resize(other.levers.len(), Vector::zeros());
        self.levers.iter_mut().zip(&other.levers).for_each(|(sum, lever)| *sum += lever);
    }
}

impl Push {
    /// Adds a force (N) at an offset (m) from a point.
    pub fn add(&mut self, body: &Spatial, point: &str, offset: &Vector, force: &Vector) {
        let moment = offset.cross(force);
        self.torque += body.point(point).unwrap_or_default().cross(force) + moment;
        self.force += force;
        let shapes = body.shapes(point);
        self.forces.resize(shapes.len(), 0.0);
        for (sum, (translation, rotation)) in self.forces.iter_mut().zip(shapes) {
            *sum += translation.dot(force) + rotation.dot(&moment);
        }
        let shifts = body.shifts(point, offset);
        self.levers.resize(shifts.len(), Vector::zeros());
        self.levers.iter_mut().zip(shifts).for_each(|(sum, shift)| *sum += shift.cross(force));
    }
}

/// A waveform under way.
#[derive(Clone, Debug)]
pub struct Forced {
    waveform: Shared<Waveform>,
    since: f64,
}

/// The forced part of a motion: angle (rad), rate (rad/s), acceleration (rad/s²).
#[derive(Copy, Clone, Debug)]
pub struct ForcedResponse {
    pub angle: f64,
    pub rate: f64,
    pub acceleration: f64,
}

impl ForcedResponse {
    /// The same for so many times the command.
    pub fn times(self, factor: f64) -> Self {
        let Self { angle, rate, acceleration } = self;
        Self { angle: angle * factor, rate: rate * factor, acceleration: acceleration * factor }
    }
}

impl Forced {
    /// A waveform from this time on it (s).
    pub fn new(waveform: Shared<Waveform>, since: f64) -> Self {
        Self { waveform, since }
    }

    /// So many times the command, and another waveform beside it.
    #[must_use]
    pub fn changed(&self, factor: f64, beside: &Waveform) -> Self {
        let mut waveform = self.waveform.shifted(0.0, factor);
        waveform.terms.extend_from_slice(&beside.terms);
        Self { waveform: Shared::new(waveform), since: self.since }
    }

    /// The command `h` seconds later.
    pub fn at(&self, h: f64) -> f64 {
        self.waveform.at(self.since + h)
    }

    /// The Taylor series of the command `h` seconds later, on the piece that holds a time `middle` seconds later.
    pub fn series(&self, middle: f64, h: f64) -> Series {
        self.waveform.series(self.since + middle, self.since + h)
    }

    /// The largest frequency in the command (rad/s).
    pub fn fastest(&self) -> f64 {
        self.waveform.fastest()
    }

    /// What it adds to the rigid motion of a body of unit inertia within `h` seconds.
    pub fn rigid(&self, h: f64) -> ForcedResponse {
        let to = self.since + h;
        ForcedResponse {
            angle: self.waveform.travel(self.since, to),
            rate: self.waveform.impulse(self.since, to),
            acceleration: self.waveform.at(to),
        }
    }

    /// What it adds to a mode of a body of unit inertia within `h` seconds.
    pub fn mode(&self, flow: &ModeFlow, h: f64) -> ForcedResponse {
        // A scenario with a manoeuvre has no mode without a pole.
        let Some(pole) = flow.pole() else {
            return ForcedResponse { angle: 0.0, rate: 0.0, acceleration: 0.0 };
        };
        let to = self.since + h;
        let driven: Phasor = self.waveform.response(pole, self.since, to) * (flow.gain / pole.im);
        let (angle, rate) = (driven.im, (pole * driven).im);
        let [_, back] = flow.velocity(angle, rate / flow.frequency);
        ForcedResponse { angle, rate, acceleration: flow.gain * self.waveform.at(to) + flow.frequency * back }
    }
}
