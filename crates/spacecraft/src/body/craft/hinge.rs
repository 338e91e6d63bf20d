//! A hinge at the root of an appendage: the appendage is a rigid body that swings on it, at any angle, against a spring.

use std::borrow::Cow;

use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::appendage::Appendage;
use super::clamped::ClampedMode;
use crate::attitude::{Vector, tensor, vector};
use crate::document::Fault;
use crate::motion::turning;
use crate::quantity::{Finite, Frequency, NonNegative, Positive};
use crate::structure::Shape;

/// A hinge: a spring and a damper about one axis at the root.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hinge {
    /// Axis through the root, in the axes of the appendage, of any nonzero length.
    pub about: [Finite; 3],
    /// Stiffness of its spring (N m/rad).
    pub stiffness: Positive,
    /// Viscous damping (N m s/rad).
    #[serde(default)]
    pub damping: NonNegative,
    /// Angle at the start (rad); at 0 the spring is relaxed.
    #[serde(default)]
    pub angle: Finite,
    /// Its rate at the start (rad/s).
    #[serde(default)]
    pub rate: Finite,
}

/// No hinge is further turned at the start (rad).
const MOST_ANGLE: f64 = 3.2;

/// An appendage has at least such a part of its inertia about its hinge.
const LEAST: f64 = 1e-9;

impl Hinge {
    /// The unit vector along its axis, in the axes of the appendage.
    pub fn axis(&self) -> Vector {
        vector(&self.about).normalize()
    }
}

impl Appendage {
    /// Its clamped modes: those it is written with, or that of its hinge.
    pub fn clamped_modes(&self) -> Cow<'_, [ClampedMode]> {
        match &self.hinge {
            None => Cow::Borrowed(&self.modes),
            Some(hinge) => self.swing(hinge).map_or(Cow::Borrowed(&[]), |mode| Cow::Owned(vec![mode])),
        }
    }

    /// Its hinge in terms of the motion, if it has one.
    pub(super) fn hinge_of_motion(&self) -> Option<turning::Hinge> {
        let hinge = self.hinge.as_ref()?;
        Some(turning::Hinge { about: hinge.axis(), inertia: self.about_root(&hinge.axis()) })
    }

    /// Moment of inertia about an axis through the root (kg m²).
    fn about_root(&self, axis: &Vector) -> f64 {
        let arm = axis.cross(&vector(&self.centre));
        axis.dot(&(tensor(&self.inertia) * axis)) + self.mass.get() * arm.norm_squared()
    }

    /// The mode of a hinge: the appendage turns about it as a whole, by 1/sqrt(I) for a unit.
    fn swing(&self, hinge: &Hinge) -> Option<ClampedMode> {
        let (axis, centre) = (hinge.axis(), vector(&self.centre));
        let inertia = self.about_root(&axis);
        let unit = f64::sqrt(inertia);
        let frequency = f64::sqrt(hinge.stiffness.get() / inertia);
        let own = tensor(&self.inertia);
        // The integral of r r' dm, of which r (a x r)' is the product with [a]'.
        let second =
            0.5 * own.trace() * Matrix3::identity() - own + self.mass.get() * centre * centre.transpose();
        let moments = second * axis.cross_matrix().transpose() / unit;
        let three = |v: Vector| [v.x, v.y, v.z].map(|of| Finite::new(of).unwrap_or_default());
        let shape = |position: &[Finite; 3]| Shape {
            translation: three(axis.cross(&vector(position)) / unit),
            rotation: three(axis / unit),
        };
        Some(ClampedMode {
            frequency: Frequency::new(frequency)?,
            damping: NonNegative::new(0.5 * hinge.damping.get() / (inertia * frequency))?,
            translation: three(axis.cross(&centre) * (self.mass.get() / unit)),
            along: None,
            rotation: None,
            moments: Some([0, 1, 2].map(|row| three(moments.row(row).transpose()))),
            displacement: Finite::new(hinge.angle.get() * unit)?,
            rate: Finite::new(hinge.rate.get() * unit)?,
            shapes: self.points.iter().map(|point| (point.name.clone(), shape(&point.position))).collect(),
        })
    }

    /// What is wrong with a hinge, and what does not go with one.
    ///
    /// # Errors
    /// A key within, and why.
    pub(super) fn check_hinge(&self) -> Result<(), Fault> {
        let Some(hinge) = &self.hinge else { return Ok(()) };
        let others = [
            ("drive", self.drive.is_some()),
            ("modes", self.modes.file().is_some() || !self.modes.is_empty()),
            ("plate", self.plate.is_some()),
            ("thermal", self.thermal.is_some()),
        ];
        if let Some((key, _)) = others.into_iter().find(|(_, there)| *there) {
            let why = "must be left out: an appendage with a `hinge` is rigid, and swings on the hinge alone";
            return Err(Fault::new(key, why));
        }
        let length = vector(&hinge.about).norm();
        if !(1e-6..=1e6).contains(&length) {
            let why = format!("must have a length of 1e-6 to 1e6, got {length}");
            return Err(Fault::new("hinge.about", why));
        }
        let angle = hinge.angle.get();
        if angle.abs() > MOST_ANGLE {
            let why = format!("must be an angle of -{MOST_ANGLE} to {MOST_ANGLE} rad, got {angle}");
            return Err(Fault::new("hinge.angle", why));
        }
        let (inertia, own) = (self.about_root(&hinge.axis()), tensor(&self.inertia));
        let whole = 0.5 * own.trace() + self.mass.get() * vector(&self.centre).norm_squared();
        if !(inertia > LEAST * whole && inertia.is_finite()) {
            let why = format!(
                "must be an axis about which the appendage has inertia, got one of {inertia} kg m²: give it an `inertia`, or its `centre`"
            );
            return Err(Fault::new("hinge.about", why));
        }
        if self.swing(hinge).is_none() {
            let why = format!(
                "must give a frequency of {} to {} rad/s, with an inertia of {inertia} kg m² about the hinge, got {}",
                Frequency::SMALLEST,
                Frequency::LARGEST,
                f64::sqrt(hinge.stiffness.get() / inertia)
            );
            return Err(Fault::new("hinge.stiffness", why));
        }
        Ok(())
    }
}
