//! The surroundings at work on one body.

use nalgebra::{Matrix3, Quaternion};

use super::Environment;
use super::orbit::into;
use crate::attitude::{Vector, vector};
use crate::motion::turning::Surroundings;

/// The surroundings of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Around {
    environment: Environment,
    /// What rotors have about their axes (kg m²), which the inertia of the body is without and gravity pulls at too.
    spinning: Matrix3<f64>,
    /// Force of sunlight in inertial axes (N), and where it acts from the centre of mass (m).
    sunlight: (Vector, Vector),
    /// See `environment`.
    torque: Vector,
    bound: f64,
    frequency: f64,
}

impl Around {
    /// What surrounds a body of this inertia and rotors that have this about their axes (kg m²), whose centre of mass is here
    /// from the point that positions are from (m).
    pub fn new(environment: &Environment, [inertia, spinning]: [Matrix3<f64>; 2], centre: &Vector) -> Self {
        let sunlight = environment.solar_pressure.as_ref();
        let sunlight = sunlight.map(|sun| (vector(&sun.force), vector(&sun.at) - centre)).unwrap_or_default();
        let torque = vector(&environment.torque);
        let gradient = environment.gravity_gradient.as_ref();
        let dipole = environment.dipole.as_ref();
        let pull = gradient.map_or(0.0, |gradient| gradient.bound(&(inertia + spinning)));
        let push = dipole.map_or(0.0, super::Dipole::bound);
        let orbits = [gradient.map(|of| of.orbit_rate), dipole.map(|of| of.orbit_rate)];
        let fastest = orbits.into_iter().flatten().map(crate::quantity::Positive::get).fold(0.0, f64::max);
        Self {
            environment: environment.clone(),
            spinning,
            bound: torque.norm() + sunlight.0.norm() * sunlight.1.norm() + pull + push,
            // Both are of second order in the local axes' sine and cosine.
            frequency: 2.0 * fastest,
            sunlight,
            torque,
        }
    }
}

impl Surroundings for Around {
    fn torque(&self, t: f64, attitude: &Quaternion<f64>, inertia: &Matrix3<f64>) -> Vector {
        let Environment { gravity_gradient, solar_pressure, dipole, .. } = &self.environment;
        let mut torque = into(attitude, &self.torque);
        if let Some(gradient) = gravity_gradient {
            torque += gradient.torque(t, attitude, &(inertia + self.spinning));
        }
        if solar_pressure.as_ref().is_some_and(|sun| sun.is_lit(t)) {
            let (force, at) = &self.sunlight;
            torque += at.cross(&into(attitude, force));
        }
        if let Some(dipole) = dipole {
            torque += dipole.torque(t, attitude);
        }
        torque
    }

    fn tide(&self, t: f64, attitude: &Quaternion<f64>) -> Option<Matrix3<f64>> {
        self.environment.gravity_gradient.as_ref().map(|gradient| gradient.tide(t, attitude))
    }

    fn bound(&self) -> f64 {
        self.bound
    }

    fn frequency(&self) -> f64 {
        self.frequency
    }
}
