//! What jets and forces move a spacecraft by: its mass, and where the point is that is watched.

use nalgebra::Quaternion;

use crate::attitude::{Vector, vector};
use crate::body::spatial::Spatial;
use crate::motion::turning::TurningSight;

/// A spacecraft that is pushed, and the point of its hub whose place is told.
#[derive(Clone, Debug, PartialEq)]
pub struct Moving {
    /// Total mass (kg).
    mass: f64,
    /// Where the point is while nothing is bent, from the centre of mass (m).
    at: Vector,
    /// By how much it moves from there for a unit of each free mode, in the hub's axes (1/sqrt(kg)).
    shifts: Vec<Vector>,
}

impl Moving {
    /// The first point of a body of this mass (kg).
    pub fn new(body: &Spatial, mass: f64) -> Self {
        let first = body.points.first();
        let at = first.map_or_else(Vector::zeros, |point| vector(&point.position));
        let shifts = body.shifts(first.map_or("", |point| &point.name), &Vector::zeros());
        Self { mass, at, shifts }
    }

    /// The acceleration of the centre of mass under a force (N), in m/s².
    pub fn acceleration(&self, force: &Vector) -> Vector {
        force / self.mass
    }

    /// Where the point is, in inertial axes from where the centre of mass was at the start (m), and how fast it moves (m/s).
    pub fn place(&self, seen: &TurningSight) -> [Vector; 2] {
        let sum = |of: &[f64]| -> Vector {
            self.shifts.iter().zip(of).fold(Vector::zeros(), |sum, (shift, q)| sum + shift * *q)
        };
        let bent = || [sum(&seen.displacements), sum(&seen.rates)];
        let [moved, speed] = seen.shift.unwrap_or_else(bent);
        let arm = self.at + moved;
        let rate = seen.rate.cross(&arm) + speed;
        let q = seen.attitude;
        let inertial = |v: Vector| (q * Quaternion::from_imag(v) * q.conjugate()).vector().into_owned();
        let [position, velocity] = seen.moved;
        [position + inertial(arm), velocity + inertial(rate)]
    }
}
