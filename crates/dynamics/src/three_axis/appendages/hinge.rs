//! Hinges of panels: the axis in the panel, and the panel at its present angle.

use flexsc_numerics::attitude::Vector;
use nalgebra::Matrix3;

/// Hinge at the root of a panel.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct HingeGeometry {
    /// Unit vector along the hinge axis, in the axes of the panel.
    pub about: Vector,
    /// Moment of inertia of the panel about that axis (kg m²).
    pub inertia: f64,
}

impl HingeGeometry {
    /// Returns the hinge angle for a displacement of its mode (rad).
    pub fn angle(&self, eta: f64) -> f64 {
        eta / f64::sqrt(self.inertia)
    }
}

/// Panel on a hinge at its present angle, in the body's axes.
#[derive(Clone, Debug)]
pub struct HingedPanel {
    /// Index of the hinge's mode.
    pub(super) mode: usize,
    /// Factor sqrt(I) from the angle to the mode's displacement.
    pub(super) unit: f64,
    /// Hinge axis a, and position b of the hinge from the centre of mass (m).
    pub(super) about: Vector,
    pub(super) from_centre: Vector,
    /// First moment a x S (kg m), and inertia K about the hinge (kg m²).
    pub(super) across: Vector,
    pub(super) inertia: Matrix3<f64>,
}

impl HingedPanel {
    /// Creates a panel from its hinge axis, the position of the hinge from the centre of mass, and its first moment
    /// and inertia about the hinge.
    pub fn new(
        hinge: &HingeGeometry,
        mode: usize,
        about: &Vector,
        from_centre: Vector,
        moment: Vector,
        inertia: Matrix3<f64>,
    ) -> Self {
        let unit = f64::sqrt(hinge.inertia);
        Self { mode, unit, about: *about, from_centre, across: about.cross(&moment), inertia }
    }
}
