//! Hinge at the root of an appendage, which swings on it as a rigid body, at any angle, against a spring.

use flexsc_dynamics::three_axis;
use flexsc_formats::document::ConfigError;
use flexsc_formats::structure::Shape;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::{Finite, Frequency, NonNegative, Positive};
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::clamped::ClampedMode;
use crate::body::spatial::NamedPoint;

/// A hinge: a spring and a damper about one axis at the root.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hinge {
    /// Axis through the root, in the axes of the appendage, of any nonzero length.
    pub about: [Finite; 3],
    /// Stiffness of its spring, above 0 (N m/rad); the spring is relaxed at angle 0.
    pub stiffness: Positive,
    /// Viscous damping (N m s/rad).
    #[serde(default)]
    pub damping: NonNegative,
    /// Angle at the start (rad), -3.2 to 3.2; the hub starts with the attitude of the spacecraft whatever the
    /// angle.
    #[serde(default)]
    pub angle: Finite,
    /// Rate at the start (rad/s); the hub starts with the rate of the spacecraft.
    #[serde(default)]
    pub rate: Finite,
}

/// Largest angle of a hinge at the start (rad).
const MOST_ANGLE: f64 = 3.2;

/// Smallest moment of inertia about the hinge, relative to the appendage's inertia about the root.
const LEAST: f64 = 1e-9;

/// Appendage as a rigid body, in its own axes.
pub(super) struct RigidBody<'a> {
    /// Mass (kg).
    pub mass: f64,
    /// Centre of mass from the root (m).
    pub centre: Vector,
    /// Inertia tensor about the centre of mass (kg m²).
    pub inertia: Matrix3<f64>,
    /// Named points of the appendage.
    pub points: &'a [NamedPoint],
}

impl Hinge {
    /// Returns the unit vector along the hinge's axis, in the axes of the appendage.
    pub fn axis(&self) -> Vector {
        vector(&self.about).normalize()
    }

    /// Returns the hinge in the integrator's form.
    pub(super) fn for_integrator(&self, body: &RigidBody<'_>) -> three_axis::HingeGeometry {
        three_axis::HingeGeometry { about: self.axis(), inertia: body.inertia_about(&self.axis()) }
    }

    /// Returns the mode of the hinge, in which the appendage turns as a whole, by 1/sqrt(I) per unit; `None` if its
    /// frequency is out of range.
    pub(super) fn mode(&self, body: &RigidBody<'_>) -> Option<ClampedMode> {
        let (axis, centre) = (self.axis(), body.centre);
        let inertia = body.inertia_about(&axis);
        let unit = f64::sqrt(inertia);
        let frequency = f64::sqrt(self.stiffness.get() / inertia);
        // Integral of r r' dm. That of r (a x r)' is its product with [a]'.
        let moments = body.second_moment() * axis.cross_matrix().transpose() / unit;
        let three = |v: Vector| [v.x, v.y, v.z].map(|component| Finite::new(component).unwrap_or_default());
        let shape = |position: &[Finite; 3]| Shape {
            translation: three(axis.cross(&vector(position)) / unit),
            rotation: three(axis / unit),
        };
        Some(ClampedMode {
            frequency: Frequency::new(frequency)?,
            damping: NonNegative::new(0.5 * self.damping.get() / (inertia * frequency))?,
            translation: three(axis.cross(&centre) * (body.mass / unit)),
            along: None,
            rotation: None,
            moments: Some([0, 1, 2].map(|row| three(moments.row(row).transpose()))),
            displacement: Finite::new(self.angle.get() * unit)?,
            rate: Finite::new(self.rate.get() * unit)?,
            shapes: body.points.iter().map(|point| (point.name.clone(), shape(&point.position))).collect(),
        })
    }

    /// Checks the hinge for values that are inconsistent with each other or with the appendage.
    ///
    /// # Errors
    /// A key within the hinge, and the reason.
    pub(super) fn check(&self, body: &RigidBody<'_>) -> Result<(), ConfigError> {
        let length = vector(&self.about).norm();
        if !(1e-6..=1e6).contains(&length) {
            return Err(ConfigError::new(
                "about",
                format!("must have a length of 1e-6 to 1e6, got {length}"),
            ));
        }
        let angle = self.angle.get();
        if angle.abs() > MOST_ANGLE {
            let why = format!("must be an angle of -{MOST_ANGLE} to {MOST_ANGLE} rad, got {angle}");
            return Err(ConfigError::new("angle", why));
        }
        let inertia = body.inertia_about(&self.axis());
        let whole = 0.5 * body.inertia.trace() + body.mass * body.centre.norm_squared();
        if !(inertia > LEAST * whole && inertia.is_finite()) {
            let why = format!(
                "must be an axis about which the appendage has inertia, got one of {inertia} kg m²: give it an `inertia`, or its \
                 `centre`"
            );
            return Err(ConfigError::new("about", why));
        }
        if self.mode(body).is_none() {
            let why = format!(
                "must give a frequency of {} to {} rad/s, with an inertia of {inertia} kg m² about the hinge, got {}",
                Frequency::SMALLEST,
                Frequency::LARGEST,
                f64::sqrt(self.stiffness.get() / inertia)
            );
            return Err(ConfigError::new("stiffness", why));
        }
        Ok(())
    }
}

impl RigidBody<'_> {
    /// Returns the moment of inertia about an axis through the root (kg m²).
    fn inertia_about(&self, axis: &Vector) -> f64 {
        axis.dot(&(self.inertia * axis)) + self.mass * axis.cross(&self.centre).norm_squared()
    }
}
