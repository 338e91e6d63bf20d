//! Configuration of an articulated body at an instant: the coefficients of its kinetic energy.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::inverse::inverse_3x3;
use nalgebra::{Matrix3, Matrix3xX};

use super::hinge::HingedPanel;
use super::{ArticulatedBody, ArticulatedPanel};
use crate::three_axis::free_modes::{ClampedModes, FreeModes};

/// Coefficients of the kinetic energy at an instant, in the body's axes and about the centre of mass.
#[derive(Clone, Debug, Default)]
pub struct Configuration {
    /// Centre of mass c (m).
    pub centre: Vector,
    /// Rotation from the axes of each appendage to the body's.
    pub panel_axes: Vec<Matrix3<f64>>,
    /// Inertia J (kg m²).
    pub inertia: Matrix3<f64>,
    /// Participation t of each mode in translation (sqrt(kg)).
    pub translations: Vec<Vector>,
    /// Participation delta of each mode in rotation (sqrt(kg) m).
    pub rotations: Vec<Vector>,
    /// Change J1 of the inertia per unit of each mode (sqrt(kg) m).
    pub moments: Vec<Matrix3<f64>>,
    /// Angular momentum b0 due to drive rates (N m s), and b1 of each mode (N s/sqrt(kg)).
    pub momentum: Vector,
    pub momenta: Vec<Vector>,
    /// Modal momentum k of each mode due to drive rates (sqrt(kg) m/s).
    pub modal_momenta: Vec<f64>,
    /// Kinetic energy e0 due to drive rates (J), and generalised force a1 on each mode (N/sqrt(kg)).
    pub energy: f64,
    pub modal_forces: Vec<f64>,
    /// Linear momentum of the driven panels (N s), and its change per unit of each mode.
    pub panel_momentum: Vector,
    pub panel_momentum_per_mode: Vec<Vector>,
    /// Total mass (kg).
    pub mass: f64,
    /// Matrix (m - sum t t')⁻¹, with which E⁻¹ = 1 + t' (m - sum t t')⁻¹ t.
    pub mass_inverse: Matrix3<f64>,
    /// Residual inertia J - delta E⁻¹ delta' of the hub (kg m²).
    pub residual_inertia: Matrix3<f64>,
    /// Panels on hinges.
    pub hinges: Vec<HingedPanel>,
}

/// Returns the rotation matrix for an angle (rad) about a unit axis.
fn axis_rotation(axis: &Vector, angle: f64) -> Matrix3<f64> {
    let (sin, cos) = libm::sincos(angle);
    (1.0 - cos) * axis * axis.transpose() + cos * Matrix3::identity() + sin * axis.cross_matrix()
}

/// Returns the change of the inertia tensor by first moments N: 2 tr(N) 1 - N - N'.
fn stretching(n: &Matrix3<f64>) -> Matrix3<f64> {
    2.0 * n.trace() * Matrix3::identity() - n - n.transpose()
}

/// Returns the integral of r x phi dm from that of r phi' dm.
fn rotation_of(n: &Matrix3<f64>) -> Vector {
    Vector::new(n[(1, 2)] - n[(2, 1)], n[(2, 0)] - n[(0, 2)], n[(0, 1)] - n[(1, 0)])
}

/// Returns the inertia tensor of a point mass at a position.
fn point_inertia(mass: f64, at: &Vector) -> Matrix3<f64> {
    mass * (Matrix3::identity() * at.norm_squared() - at * at.transpose())
}

impl ArticulatedBody {
    /// Updates the configuration for drive angles (rad) and rates (rad/s) and displacements `eta` of the hinge modes
    /// (empty for zero).
    pub fn update(&self, at: impl Fn(usize) -> [f64; 2], eta: &[f64], configuration: &mut Configuration) {
        let (hub_mass, hub_centre, hub_inertia) = &self.hub;
        let mass = self.mass();
        let mut modes = 0;
        let state = |panel: &ArticulatedPanel| {
            let mode = modes;
            modes += panel.modes.len();
            if let Some(hinge) = &panel.hinge {
                let angle = eta.get(mode).map_or(0.0, |eta| hinge.angle(*eta));
                return (panel.axes * axis_rotation(&hinge.about, angle), Vector::zeros(), 0.0);
            }
            panel.drive.map_or((panel.axes, Vector::zeros(), 0.0), |(axis, drive)| {
                let [angle, rate] = at(drive);
                (panel.axes * axis_rotation(&axis, angle), panel.axes * axis, rate)
            })
        };
        let states: Vec<_> = self.panels.iter().map(state).collect();
        let mut centre = hub_centre * *hub_mass;
        let mut panel_momentum = Vector::zeros();
        for (panel, (axes, about, rate)) in self.panels.iter().zip(&states) {
            let moment = axes * panel.centre * panel.mass;
            centre += panel.root * panel.mass + moment;
            panel_momentum += about.cross(&moment) * *rate;
        }
        centre /= mass;
        let mut inertia = hub_inertia + point_inertia(*hub_mass, &(hub_centre - centre));
        let (mut momentum, mut twice_energy) = (Vector::zeros(), -panel_momentum.norm_squared() / mass);
        let Configuration {
            translations,
            rotations,
            moments,
            momenta,
            modal_momenta,
            modal_forces,
            panel_momentum_per_mode,
            hinges,
            panel_axes,
            ..
        } = configuration;
        panel_axes.clear();
        panel_axes.extend(states.iter().map(|(axes, ..)| axes));
        for list in [&mut *translations, rotations, momenta, panel_momentum_per_mode] {
            list.clear();
        }
        moments.clear();
        modal_momenta.clear();
        modal_forces.clear();
        hinges.clear();
        for (panel, (axes, about, rate)) in self.panels.iter().zip(&states) {
            let from_centre = panel.root - centre;
            let arm = axes * panel.centre;
            let own = axes * panel.inertia * axes.transpose();
            inertia += own + point_inertia(panel.mass, &(from_centre + arm));
            let about_root = own + point_inertia(panel.mass, &arm);
            momentum += (from_centre.cross(&about.cross(&(arm * panel.mass))) + about_root * about) * *rate;
            twice_energy += rate * rate * about.dot(&(about_root * about));
            if let Some(hinge) = &panel.hinge {
                let (mode, moment) = (translations.len(), arm * panel.mass);
                hinges.push(HingedPanel::new(
                    hinge,
                    mode,
                    &(panel.axes * hinge.about),
                    from_centre,
                    moment,
                    about_root,
                ));
            }
            for mode in &panel.modes {
                let t = axes * mode.translation;
                let n = axes * mode.moments * axes.transpose();
                let whole = n + from_centre * t.transpose();
                let (stretched, carried) = (stretching(&n) * about, about.cross(&t) * *rate);
                translations.push(t);
                rotations.push(rotation_of(&whole));
                moments.push(stretching(&whole));
                momenta
                    .push(from_centre.cross(&carried) + stretched * *rate - t.cross(&panel_momentum) / mass);
                modal_momenta.push(rate * about.dot(&rotation_of(&n)) - panel_momentum.dot(&t) / mass);
                modal_forces
                    .push(0.5 * rate * rate * about.dot(&stretched) - panel_momentum.dot(&carried) / mass);
                panel_momentum_per_mode.push(carried);
            }
        }
        let sum = translations.iter().fold(Matrix3::zeros(), |sum: Matrix3<f64>, t| sum + t * t.transpose());
        configuration.mass_inverse =
            inverse_3x3(Matrix3::identity() * mass - sum).unwrap_or_else(Matrix3::zeros);
        (configuration.centre, configuration.inertia, configuration.momentum) =
            (centre, 0.5 * (inertia + inertia.transpose()), momentum);
        (configuration.energy, configuration.panel_momentum, configuration.mass) =
            (0.5 * twice_energy, panel_momentum, mass);
        configuration.offset_hinges(eta);
        let (mut carried, mut across) = (Matrix3::zeros(), Matrix3::zeros());
        for (delta, t) in configuration.rotations.iter().zip(&configuration.translations) {
            carried += delta * delta.transpose();
            across += delta * t.transpose();
        }
        configuration.residual_inertia =
            configuration.inertia - carried - across * configuration.mass_inverse * across.transpose();
    }
}

impl Configuration {
    /// Returns the free modes; `None` if the mass matrix is not positive definite.
    pub fn free_modes(&self, of: &ArticulatedBody) -> Option<FreeModes> {
        let columns = |of: &[Vector]| Matrix3xX::from_fn(of.len(), |row, column| of[column][row]);
        let held = ClampedModes {
            mass: self.mass,
            inertia: self.inertia,
            frequencies: of.modes().map(|mode| mode.frequency).collect(),
            translations: columns(&self.translations),
            rotations: columns(&self.rotations),
        };
        held.free_modes()
    }

    /// Multiplies a vector by E⁻¹ in place.
    pub fn solve_mass(&self, v: &mut [f64]) {
        let sum = self.translations.iter().zip(&*v).fold(Vector::zeros(), |sum, (t, v)| sum + t * *v);
        let back = self.mass_inverse * sum;
        v.iter_mut().zip(&self.translations).for_each(|(v, t)| *v += t.dot(&back));
    }

    /// Returns the change of the inertia by the modes (kg m²).
    pub fn inertia_change(&self, eta: &[f64]) -> Matrix3<f64> {
        let modes = self.moments.iter().zip(eta);
        modes.fold(Matrix3::zeros(), |sum: Matrix3<f64>, (moments, eta)| sum + moments * *eta)
    }

    /// Returns the rate w of the hub (rad/s) for the momentum without rotors (N m s) and the displacements `eta` of the
    /// clamped modes; replaces their momenta pi in `rates` by their rates eta'.
    pub fn rates(&self, body_momentum: &Vector, eta: &[f64], rates: &mut [f64]) -> Vector {
        rates.iter_mut().zip(&self.modal_momenta).for_each(|(pi, modal_momentum)| *pi -= modal_momentum);
        self.solve_mass(rates);
        let sum = |of: &[Vector], by: &[f64]| -> Vector {
            of.iter().zip(by).fold(Vector::zeros(), |sum, (of, by)| sum + of * *by)
        };
        let remaining = body_momentum - self.momentum - sum(&self.momenta, eta) - sum(&self.rotations, rates);
        let whole = self.residual_inertia + self.inertia_change(eta);
        let rate = whole.lu().solve(&remaining).unwrap_or_else(|| Vector::repeat(f64::NAN));
        // Here eta' = E⁻¹ (pi - k) - E⁻¹ delta' w; `rates` already holds the first term.
        let mut rigid_part: Vec<f64> = self.rotations.iter().map(|delta| -delta.dot(&rate)).collect();
        self.solve_mass(&mut rigid_part);
        rates.iter_mut().zip(rigid_part).for_each(|(own, rigid_part)| *own += rigid_part);
        rate
    }

    /// Returns H without rotors (N m s), and pi, for a body with the given hub rate (rad/s) and modal rates.
    pub fn momenta(&self, rate: &Vector, eta: &[f64], rates: &[f64]) -> (Vector, Vec<f64>) {
        let sum = |of: &[Vector], by: &[f64]| -> Vector {
            of.iter().zip(by).fold(Vector::zeros(), |sum, (of, by)| sum + of * *by)
        };
        let momentum = (self.inertia + self.inertia_change(eta)) * rate
            + self.momentum
            + sum(&self.momenta, eta)
            + sum(&self.rotations, rates);
        let centre_rate = sum(&self.translations, rates) / self.mass;
        let pi = |(index, own): (usize, &f64)| {
            own + self.rotations[index].dot(rate) + self.modal_momenta[index]
                - self.translations[index].dot(&centre_rate)
        };
        (momentum, rates.iter().enumerate().map(pi).collect())
    }

    /// Returns the kinetic energy (J).
    pub fn kinetic(&self, rate: &Vector, eta: &[f64], rates: &[f64]) -> f64 {
        let (momentum, pi) = self.momenta(rate, eta, rates);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        // With T = T2 + T1 + T0 by degree in the rates, the momenta give 2 T2 + T1.
        let first = rate.dot(&self.momentum)
            + dot(&self.modal_momenta, rates)
            + self.momenta.iter().zip(eta).map(|(of, eta)| of.dot(rate) * eta).sum::<f64>();
        0.5 * (rate.dot(&momentum) + dot(&pi, rates) + first) + self.energy + dot(&self.modal_forces, eta)
    }
}
