//! Mass, centre of mass and inertia of rigid parts, and of their sum.

use flexsc_numerics::attitude::Vector;
use nalgebra::Matrix3;

/// Mass properties of a rigid part, in the body's axes.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass (kg).
    pub mass: f64,
    /// Centre of mass (m).
    pub centre: Vector,
    /// Inertia tensor about the part's centre of mass (kg m²).
    pub inertia: Matrix3<f64>,
}

impl MassProperties {
    /// Returns the mass properties of several parts joined rigidly.
    pub fn sum(parts: &[Self]) -> Self {
        let mass: f64 = parts.iter().map(|part| part.mass).sum();
        let centre = parts.iter().map(|part| part.centre * part.mass).sum::<Vector>() / mass;
        let inertia_about_centre =
            |part: &Self| part.inertia + point_mass_inertia(part.mass, &(part.centre - centre));
        let inertia: Matrix3<f64> = parts.iter().map(inertia_about_centre).sum();
        // Rotated tensors are symmetric only within rounding.
        Self { mass, centre, inertia: 0.5 * (inertia + inertia.transpose()) }
    }
}

/// Returns the inertia tensor of a point mass (kg) at a position (m).
pub fn point_mass_inertia(mass: f64, position: &Vector) -> Matrix3<f64> {
    mass * (Matrix3::identity() * position.norm_squared() - position * position.transpose())
}
