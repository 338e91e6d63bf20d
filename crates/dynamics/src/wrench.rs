//! Wrench: torques, forces at points, rotors and a waveform that act on a body from an instant on.

use std::ops::AddAssign;

use flexsc_numerics::attitude::Vector;

use crate::flow::ActiveWaveform;
use crate::sine::SineTorque;
use crate::three_axis::{Gimbal, Rotor};
use crate::three_axis_model::ThreeAxisModel;

/// Torques, forces, rotors and waveform that act on a body from an instant on.
#[derive(Clone, Debug, Default)]
pub struct Wrench {
    /// Torques about the axes at the hub (N m). One-axis body: only the first, in rad/s² if the hub's motion is
    /// commanded. Three-axis body: at the point named by its actuators.
    pub hub: [f64; 3],
    /// Torque of jets and of forces at points, about the centre of mass (N m).
    pub torque: Vector,
    /// Modal forces of jets and of forces at points (N/sqrt(kg)); empty if there are none.
    pub forces: Vec<f64>,
    /// Sum of the forces of jets and at points, in the body's axes (N).
    pub force: Vector,
    /// Change of these forces' torque per unit of each mode, which moves the points of action (N/sqrt(kg)); as
    /// `forces`.
    pub levers: Vec<Vector>,
    /// Rotors that store momentum, each with its motor torque.
    pub rotors: Vec<Rotor>,
    /// Rotors in gimbals, each with its present gimbal angle and rate.
    pub gimbals: Vec<Gimbal>,
    /// Magnetic moment of torquers, in the body's axes (A m²).
    pub moment: Vector,
    /// Sine terms of time in the torque at the hub of a spacecraft, each with its axis.
    pub sines: Vec<(Vector, SineTorque)>,
    /// Waveform about the first axis, and the time reached within it.
    pub waveform: Option<ActiveWaveform>,
}

impl Wrench {
    /// Removes all contributions and keeps the allocated memory.
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

    /// Adds a waveform that began at the same instant as the present one, if there is one.
    pub fn add_waveform(&mut self, by: Option<ActiveWaveform>) {
        self.waveform = match (self.waveform.take(), by) {
            (Some(own), Some(by)) => Some(own.scaled_and_added(1.0, &by.waveform)),
            (own, by) => own.or(by),
        };
    }

    /// Adds the effect of forces at points.
    pub fn add_force_effect(&mut self, push: &ForceEffect) {
        self.torque += push.torque;
        self.force += push.force;
        self.forces.resize(push.forces.len().max(self.forces.len()), 0.0);
        self.forces.iter_mut().zip(&push.forces).for_each(|(sum, force)| *sum += force);
        self.levers.resize(push.levers.len().max(self.levers.len()), Vector::zeros());
        self.levers.iter_mut().zip(&push.levers).for_each(|(sum, lever)| *sum += lever);
    }
}

/// Effect of forces at points on a body, in the body's axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForceEffect {
    /// Torque about the centre of mass of the undeformed body (N m).
    pub torque: Vector,
    /// Modal forces (N/sqrt(kg)).
    pub forces: Vec<f64>,
    /// Sum of the forces (N).
    pub force: Vector,
    /// Change of the torque per unit of each mode (N/sqrt(kg)).
    pub levers: Vec<Vector>,
}

impl AddAssign<&Self> for ForceEffect {
    fn add_assign(&mut self, other: &Self) {
        self.torque += other.torque;
        self.force += other.force;
        self.forces.resize(other.forces.len(), 0.0);
        self.forces.iter_mut().zip(&other.forces).for_each(|(sum, force)| *sum += force);
        self.levers.resize(other.levers.len(), Vector::zeros());
        self.levers.iter_mut().zip(&other.levers).for_each(|(sum, lever)| *sum += lever);
    }
}

impl ForceEffect {
    /// Returns the effect of a unit of the force along, or of the torque about, x, y or z at a named point: the force first.
    pub fn unit(body: &ThreeAxisModel, point: &str, part: usize) -> Self {
        let mut unit = Self::default();
        let direction = Vector::ith(part % 3, 1.0);
        if part < 3 {
            unit.add(body, point, &Vector::zeros(), &direction);
        } else {
            unit.add_torque(body, point, &direction);
        }
        unit
    }

    /// Adds another effect, multiplied by a number.
    pub fn add_scaled(&mut self, other: &Self, by: f64) {
        self.torque += other.torque * by;
        self.force += other.force * by;
        self.forces.resize(other.forces.len().max(self.forces.len()), 0.0);
        self.forces.iter_mut().zip(&other.forces).for_each(|(sum, force)| *sum += force * by);
        self.levers.resize(other.levers.len().max(self.levers.len()), Vector::zeros());
        self.levers.iter_mut().zip(&other.levers).for_each(|(sum, lever)| *sum += lever * by);
    }

    /// Adds the effect of a torque (N m) at a named point.
    pub fn add_torque(&mut self, body: &ThreeAxisModel, point: &str, torque: &Vector) {
        self.torque += torque;
        let shapes = body.shapes(point);
        self.forces.resize(shapes.len(), 0.0);
        for (sum, (_, rotation)) in self.forces.iter_mut().zip(shapes) {
            *sum += rotation.dot(torque);
        }
        self.levers.resize(self.forces.len(), Vector::zeros());
    }

    /// Adds the effect of a force (N) that acts at an offset (m) from a named point.
    pub fn add(&mut self, body: &ThreeAxisModel, point: &str, offset: &Vector, force: &Vector) {
        let moment = offset.cross(force);
        self.torque += body.point(point).unwrap_or_default().cross(force) + moment;
        self.force += force;
        let shapes = body.shapes(point);
        self.forces.resize(shapes.len(), 0.0);
        for (sum, (translation, rotation)) in self.forces.iter_mut().zip(shapes) {
            *sum += translation.dot(force) + rotation.dot(&moment);
        }
        let shifts = body.displacements(point, offset);
        self.levers.resize(shifts.len(), Vector::zeros());
        self.levers.iter_mut().zip(shifts).for_each(|(sum, shift)| *sum += shift.cross(force));
    }
}
