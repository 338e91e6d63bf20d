//! Panels that swing on hinges, as rigid bodies at any angle.
//!
//! The mode of a hinge is the angle itself, eta = sqrt(I) th with I the panel's inertia about the axis a. Its
//! participations rotate with the panel, so that J, delta and E at the angle make the kinetic energy exact, and the
//! spring's energy is that of the mode. The remaining force is dT/d eta. With the panel's points at b + r from the
//! centre of mass, S = int r dm, K its inertia about the hinge, its rate u = w + th' a, and the momentum p of all
//! parts that move relative to the hub,
//!
//! ```text
//! dT/dth = (w x b - p/m) . (u x (a x S)) + u . (a x K u) - (w x (a x S)) . p1/m,
//! ```
//!
//! Here p1 is the momentum that displacements of other modes have because the body rotates.

use nalgebra::Matrix3;

use super::{Driving, Posed};
use crate::attitude::Vector;

/// Hinge at the root of a panel.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Hinge {
    /// Unit vector along the hinge axis, in the axes of the panel.
    pub about: Vector,
    /// Moment of inertia of the panel about that axis (kg m²).
    pub inertia: f64,
}

impl Hinge {
    /// Returns the hinge angle for a displacement of its mode (rad).
    pub fn angle(&self, eta: f64) -> f64 {
        eta / f64::sqrt(self.inertia)
    }
}

/// Panel on a hinge at its present angle, in the body's axes.
#[derive(Clone, Debug)]
pub struct Swinging {
    /// Index of the hinge's mode.
    mode: usize,
    /// Factor sqrt(I) from the angle to the mode's displacement.
    unit: f64,
    /// Hinge axis a, and position b of the hinge from the centre of mass (m).
    about: Vector,
    from_centre: Vector,
    /// First moment a x S (kg m), and inertia K about the hinge (kg m²).
    across: Vector,
    inertia: Matrix3<f64>,
}

impl Swinging {
    /// Creates a panel from its hinge axis, the position of the hinge from the centre of mass, and its first moment
    /// and inertia about the hinge.
    pub fn new(
        hinge: &Hinge,
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

impl Driving {
    /// Returns an upper bound of the hinge rates (rad/s) during the next step, from q and P/W of the modes and the
    /// momentum Gt of the body (N m s).
    pub fn swinging(&self, modes: &[[f64; 4]], turning: &Vector) -> f64 {
        let (basis, mut mode, mut fastest) = (&self.basis, 0, 0.0_f64);
        for panel in &self.of.panels {
            if let Some(hinge) = &panel.hinge {
                let parts = basis.shapes.row(mode);
                let each = parts.iter().zip(modes).enumerate();
                let rate: f64 = each
                    .map(|(free, (part, [q, p, ..]))| {
                        let (w, rotation) = (basis.frequencies[free], &basis.rotations[free]);
                        part.abs() * (w * q.abs() + (w * p + rotation.dot(turning)).abs())
                    })
                    .sum();
                fastest = fastest.max(hinge.angle(rate));
            }
            mode += panel.modes.len();
        }
        fastest
    }
}

impl Posed {
    /// Sets the displacements of the hinge modes to zero, because hinges rotate the panels instead.
    pub fn small(&self, eta: &mut [f64]) {
        for hinge in &self.hinges {
            eta[hinge.mode] = 0.0;
        }
    }

    /// Returns angle (rad) and rate (rad/s) of each hinge from the displacements and rates of all modes.
    pub fn hinged(&self, eta: &[f64], rates: &[f64]) -> Vec<[f64; 2]> {
        self.hinges
            .iter()
            .map(|hinge| [eta[hinge.mode], rates[hinge.mode]].map(|of| of / hinge.unit))
            .collect()
    }

    /// Computes the forces dT/d eta on the hinge modes from the hub's rate (rad/s), the displacements of the other
    /// modes, and the rates of all.
    pub fn swing(&self, rate: &Vector, small: &[f64], rates: &[f64], forces: &mut [f64]) {
        if self.hinges.is_empty() {
            return;
        }
        let moved = self.translations.iter().zip(rates).fold(self.push, |sum, (t, rate)| sum + t * *rate);
        let carried = self.translations.iter().zip(&self.pushes).zip(small);
        let carried =
            carried.fold(Vector::zeros(), |sum, ((t, push), eta)| sum + (rate.cross(t) + push) * *eta);
        for hinge in &self.hinges {
            let turned = rate + hinge.about * (rates[hinge.mode] / hinge.unit);
            let root = rate.cross(&hinge.from_centre) - moved / self.mass;
            let force = root.dot(&turned.cross(&hinge.across))
                + turned.dot(&hinge.about.cross(&(hinge.inertia * turned)))
                - rate.cross(&hinge.across).dot(&carried) / self.mass;
            forces[hinge.mode] = force / hinge.unit;
        }
    }
}
