//! All that acts on a body from an instant on: torques, forces at points, rotors, a waveform.

use std::ops::AddAssign;

use crate::attitude::Vector;
use crate::body::Spatial;
use crate::flow::Forced;
use crate::motion::turning::{Gimbal, Rotor};
use crate::sine::Sine;

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
