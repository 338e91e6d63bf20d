//! Forces of panels that swing on hinges, as rigid bodies at any angle.
//!
//! The mode of a hinge is the angle itself, eta = sqrt(I) th with I the panel's inertia about the axis a. Its
//! participations rotate with the panel, so that J, delta and E at the angle make the kinetic energy exact, and the
//! spring's energy is that of the mode. The remaining force is dT/d eta. With the panel's points at b + r from the
//! centre of mass, S = int r dm, K its inertia about the hinge, its rate u = w + th' a, and the momentum p of all
//! parts that move relative to the hub,
//!
//! ```text
//! dT/dth = (w x b - (p + p1)/m) . (u x (a x S)) + u . (a x K u),
//! ```
//!
//! in which p1 = w x s + g is the momentum of the displacements of the other modes due to the rotation of the body and of the
//! drives, with s = sum t eta and g (`panel_momentum_per_mode`) times eta, summed over these modes. The momentum p of a hinge is not small, so that its product with p1 counts: T has -p . p1/m. With t of the
//! hinge, that changes its delta by -s x t/m and its k by -t . g/m, and dT/d eta of another mode by -p . (w x t + its part of g)/m.

use flexsc_numerics::attitude::Vector;

use super::ArticulatedMotion;
use super::configuration::Configuration;

impl ArticulatedMotion {
    /// Returns an upper bound of the hinge rates (rad/s) during the next step, from q and P/W of the modes and the
    /// momentum Gt of the body (N m s).
    pub fn rate_bound(&self, modes: &[[f64; 4]], rigid_momentum: &Vector) -> f64 {
        let (basis, mut mode, mut fastest) = (&self.basis, 0, 0.0_f64);
        for panel in &self.body.panels {
            if let Some(hinge) = &panel.hinge {
                let parts = basis.shapes.row(mode);
                let each = parts.iter().zip(modes).enumerate();
                let rate: f64 = each
                    .map(|(free, (part, [q, p, ..]))| {
                        let (w, rotation) = (basis.frequencies[free], &basis.rotations[free]);
                        part.abs() * (w * q.abs() + (w * p + rotation.dot(rigid_momentum)).abs())
                    })
                    .sum();
                fastest = fastest.max(hinge.angle(rate));
            }
            mode += panel.modes.len();
        }
        fastest
    }
}

impl Configuration {
    /// Sets the displacements of the hinge modes to zero, because hinges rotate the panels instead.
    pub fn without_hinges(&self, eta: &mut [f64]) {
        for hinge in &self.hinges {
            eta[hinge.mode] = 0.0;
        }
    }

    /// Returns angle (rad) and rate (rad/s) of each hinge from the displacements and rates of all modes.
    pub fn hinge_motion(&self, eta: &[f64], rates: &[f64]) -> Vec<[f64; 2]> {
        self.hinges
            .iter()
            .map(|hinge| [eta[hinge.mode], rates[hinge.mode]].map(|of| of / hinge.unit))
            .collect()
    }

    /// Corrects delta and k of the hinge modes for the shift of the centre of mass by the displacements `eta` of the other
    /// modes: by -s x t/m and -t . g/m.
    pub(super) fn offset_hinges(&mut self, eta: &[f64]) {
        let Self { hinges, translations, panel_momentum_per_mode, rotations, modal_momenta, mass, .. } = self;
        let (mut offset, mut carried) = (Vector::zeros(), Vector::zeros());
        for (mode, eta) in eta.iter().enumerate() {
            if hinges.iter().all(|hinge| hinge.mode != mode) {
                offset += translations[mode] * *eta;
                carried += panel_momentum_per_mode[mode] * *eta;
            }
        }
        for hinge in hinges {
            let t = translations[hinge.mode];
            rotations[hinge.mode] -= offset.cross(&t) / *mass;
            modal_momenta[hinge.mode] -= t.dot(&carried) / *mass;
        }
    }

    /// Sets the forces on the hinge modes to dT/d eta, and adds the effect of the hinges' momentum to the forces on the
    /// other modes (N/sqrt(kg)): for the rate of the hub (rad/s), the displacements `small` of the other modes, and the
    /// rates of all modes.
    pub fn add_hinge_terms(&self, rate: &Vector, small: &[f64], rates: &[f64], forces: &mut [f64]) {
        if self.hinges.is_empty() {
            return;
        }
        let (mut momentum, mut hinge_momentum) = (self.panel_momentum, Vector::zeros());
        for (t, rate) in self.translations.iter().zip(rates) {
            momentum += t * *rate;
        }
        for hinge in &self.hinges {
            hinge_momentum += self.translations[hinge.mode] * rates[hinge.mode];
        }
        for (((t, per_mode), eta), force) in
            self.translations.iter().zip(&self.panel_momentum_per_mode).zip(small).zip(&mut *forces)
        {
            let carried = rate.cross(t) + per_mode;
            momentum += carried * *eta;
            *force -= hinge_momentum.dot(&carried) / self.mass;
        }
        for hinge in &self.hinges {
            let panel_rate = rate + hinge.about * (rates[hinge.mode] / hinge.unit);
            let root = rate.cross(&hinge.from_centre) - momentum / self.mass;
            let force = root.dot(&panel_rate.cross(&hinge.across))
                + panel_rate.dot(&hinge.about.cross(&(hinge.inertia * panel_rate)));
            forces[hinge.mode] = force / hinge.unit;
        }
    }
}
