//! Translation of a spacecraft under jets and forces: its mass, and the position of its first point.

use flexsc_dynamics::three_axis::BodyView;
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_numerics::attitude::Vector;
use nalgebra::Quaternion;

/// Mass of a spacecraft, and the point of its hub whose position is logged.
#[derive(Clone, Debug, PartialEq)]
pub struct Translation {
    /// Total mass (kg).
    mass: f64,
    /// Position of the point on the undeformed body, from the centre of mass (m).
    position: Vector,
    /// Displacement of the point per unit of each free mode, in the hub's axes (1/sqrt(kg)).
    shifts: Vec<Vector>,
}

impl Translation {
    /// Creates the translation of a body of the given mass (kg), for its first point.
    pub fn new(body: &ThreeAxisModel, mass: f64) -> Self {
        let first = body.points.first();
        let position = first.map_or_else(Vector::zeros, |point| point.position);
        let shifts = body.displacements(first.map_or("", |point| &point.name), &Vector::zeros());
        Self { mass, position, shifts }
    }

    /// Returns the acceleration of the centre of mass under a force (N), in m/s².
    pub fn acceleration(&self, force: &Vector) -> Vector {
        force / self.mass
    }

    /// Returns the point's position, in inertial axes from the centre of mass at the start (m), and its velocity (m/s).
    pub fn position(&self, view: &BodyView) -> [Vector; 2] {
        let sum = |of: &[f64]| -> Vector {
            self.shifts.iter().zip(of).fold(Vector::zeros(), |sum, (shift, q)| sum + shift * *q)
        };
        let bent = || [sum(&view.displacements), sum(&view.rates)];
        let [moved, speed] = view.shift.unwrap_or_else(bent);
        let arm = self.position + moved;
        let rate = view.rate.cross(&arm) + speed;
        let q = view.attitude;
        let inertial = |v: Vector| (q * Quaternion::from_imag(v) * q.conjugate()).vector().into_owned();
        let [position, velocity] = view.com;
        [position + inertial(arm), velocity + inertial(rate)]
    }
}
