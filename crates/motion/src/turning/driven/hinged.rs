//! Panels that swing on hinges, as rigid bodies at any angle.
//!
//! The mode of a hinge is the angle itself, eta = sqrt(I) th with I the panel's inertia about the axis a. Its participations
//! turn with the panel, so that J, delta and E at the angle make the kinetic energy exact, and the spring's energy is that of the
//! mode. What is left is dT/d eta. With the panel's points at b + r from the centre of mass, S = int r dm, K its inertia about
//! the hinge, its rate u = w + th' a, and the momentum p of all that moves against the hub,
//!
//! ```text
//! dT/dth = (w x b - p/m) . (u x (a x S)) + u . (a x K u) - (w x (a x S)) . p1/m,
//! ```
//!
//! in which p1 is the momentum that displacements of other modes have because the body turns.

use nalgebra::Matrix3;

use super::{Driving, Posed};
use crate::attitude::Vector;

/// A hinge at the root of a panel.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Hinge {
    /// Unit vector along its axis, in the axes of the panel.
    pub about: Vector,
    /// Moment of inertia of the panel about that axis (kg m²).
    pub inertia: f64,
}

impl Hinge {
    /// The angle for a displacement of the mode (rad).
    pub fn angle(&self, eta: f64) -> f64 {
        eta / f64::sqrt(self.inertia)
    }
}

/// A panel on a hinge as it is turned, in the body's axes.
#[derive(Clone, Debug)]
pub struct Swinging {
    /// Its mode.
    mode: usize,
    /// sqrt(I).
    unit: f64,
    /// a, and b (m).
    about: Vector,
    from_centre: Vector,
    /// a x S (kg m), and K (kg m²).
    across: Vector,
    inertia: Matrix3<f64>,
}

impl Swinging {
    /// A panel whose hinge has this axis and is so far from the centre of mass, with this first moment and inertia about it.
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
    /// No hinge turns faster soon (rad/s), where modes have these q and P/W and the body this momentum Gt (N m s).
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
    /// Displacements of the clamped modes without those of hinges, which turn the panels.
    pub fn small(&self, eta: &mut [f64]) {
        for hinge in &self.hinges {
            eta[hinge.mode] = 0.0;
        }
    }

    /// Angle (rad) and rate (rad/s) of each hinge, of displacements and rates of all modes.
    pub fn hinged(&self, eta: &[f64], rates: &[f64]) -> Vec<[f64; 2]> {
        self.hinges
            .iter()
            .map(|hinge| [eta[hinge.mode], rates[hinge.mode]].map(|of| of / hinge.unit))
            .collect()
    }

    /// Gives the modes of hinges dT/d eta at this rate of the hub (rad/s), displacements of other modes, and rates of all.
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
