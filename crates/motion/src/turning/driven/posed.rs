//! What a driven body is at an instant: the coefficients of its kinetic energy.

use nalgebra::{Matrix3, Matrix3xX};

use super::hinged::Swinging;
use super::{DrivenPanel, DrivenSpacecraft};
use crate::attitude::Vector;
use crate::turning::free::{ClampedModes, Free};

/// The coefficients at an instant, all in the body's axes and about the centre of mass.
#[derive(Clone, Debug, Default)]
pub struct Posed {
    /// The centre of mass c (m).
    pub centre: Vector,
    /// J (kg m²).
    pub inertia: Matrix3<f64>,
    /// t of each mode (sqrt(kg)).
    pub translations: Vec<Vector>,
    /// delta of each mode (sqrt(kg) m).
    pub rotations: Vec<Vector>,
    /// J1 of each mode (sqrt(kg) m).
    pub moments: Vec<Matrix3<f64>>,
    /// b0 (N m s), and b1 of each mode (N s/sqrt(kg)).
    pub momentum: Vector,
    pub momenta: Vec<Vector>,
    /// k of each mode (sqrt(kg) m/s).
    pub kicks: Vec<f64>,
    /// e0 (J), and a1 of each mode (N/sqrt(kg)).
    pub energy: f64,
    pub pulls: Vec<f64>,
    /// Momentum of the panels that are turned (N s), and what a unit of each mode adds to it.
    pub push: Vector,
    pub pushes: Vec<Vector>,
    /// Total mass (kg).
    pub mass: f64,
    /// (m - sum t t')⁻¹, of which E⁻¹ = 1 + t' (..) t.
    pub share: Matrix3<f64>,
    /// J - delta E⁻¹ delta': the inertia left to the hub.
    pub left: Matrix3<f64>,
    /// The panels on hinges.
    pub hinges: Vec<Swinging>,
}

/// The rotation by an angle about a unit axis.
fn turn(axis: &Vector, angle: f64) -> Matrix3<f64> {
    let (sin, cos) = libm::sincos(angle);
    (1.0 - cos) * axis * axis.transpose() + cos * Matrix3::identity() + sin * axis.cross_matrix()
}

/// What first moments N add to the inertia tensor: 2 tr(N) 1 - N - N'.
fn stretching(n: &Matrix3<f64>) -> Matrix3<f64> {
    2.0 * n.trace() * Matrix3::identity() - n - n.transpose()
}

/// The integral of r x phi dm, from that of r phi' dm.
fn rotation_of(n: &Matrix3<f64>) -> Vector {
    Vector::new(n[(1, 2)] - n[(2, 1)], n[(2, 0)] - n[(0, 2)], n[(0, 1)] - n[(1, 0)])
}

/// The inertia tensor of a point mass at a distance.
fn of_point(mass: f64, at: &Vector) -> Matrix3<f64> {
    mass * (Matrix3::identity() * at.norm_squared() - at * at.transpose())
}

impl DrivenSpacecraft {
    /// Fills in what the body is where drives have these angles (rad) and rates (rad/s), and the modes of hinges these
    /// displacements, all 0 if there are none.
    pub fn pose(&self, at: impl Fn(usize) -> [f64; 2], eta: &[f64], posed: &mut Posed) {
        let (hub_mass, hub_centre, hub_inertia) = &self.hub;
        let mass = self.mass();
        let mut modes = 0;
        let state = |panel: &DrivenPanel| {
            let mode = modes;
            modes += panel.modes.len();
            if let Some(hinge) = &panel.hinge {
                let angle = eta.get(mode).map_or(0.0, |eta| hinge.angle(*eta));
                return (panel.axes * turn(&hinge.about, angle), Vector::zeros(), 0.0);
            }
            panel.drive.map_or((panel.axes, Vector::zeros(), 0.0), |(axis, drive)| {
                let [angle, rate] = at(drive);
                (panel.axes * turn(&axis, angle), panel.axes * axis, rate)
            })
        };
        let turned: Vec<_> = self.panels.iter().map(state).collect();
        let mut centre = hub_centre * *hub_mass;
        let mut push = Vector::zeros();
        for (panel, (axes, about, rate)) in self.panels.iter().zip(&turned) {
            let moment = axes * panel.centre * panel.mass;
            centre += panel.root * panel.mass + moment;
            push += about.cross(&moment) * *rate;
        }
        centre /= mass;
        let mut inertia = hub_inertia + of_point(*hub_mass, &(hub_centre - centre));
        let (mut momentum, mut double) = (Vector::zeros(), -push.norm_squared() / mass);
        let Posed { translations, rotations, moments, momenta, kicks, pulls, pushes, hinges, .. } = posed;
        for list in [&mut *translations, rotations, momenta, pushes] {
            list.clear();
        }
        moments.clear();
        kicks.clear();
        pulls.clear();
        hinges.clear();
        for (panel, (axes, about, rate)) in self.panels.iter().zip(&turned) {
            let from_centre = panel.root - centre;
            let arm = axes * panel.centre;
            let own = axes * panel.inertia * axes.transpose();
            inertia += own + of_point(panel.mass, &(from_centre + arm));
            let about_root = own + of_point(panel.mass, &arm);
            momentum += (from_centre.cross(&about.cross(&(arm * panel.mass))) + about_root * about) * *rate;
            double += rate * rate * about.dot(&(about_root * about));
            if let Some(hinge) = &panel.hinge {
                let (mode, moment) = (translations.len(), arm * panel.mass);
                hinges.push(Swinging::new(
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
                momenta.push(from_centre.cross(&carried) + stretched * *rate - t.cross(&push) / mass);
                kicks.push(rate * about.dot(&rotation_of(&n)) - push.dot(&t) / mass);
                pulls.push(0.5 * rate * rate * about.dot(&stretched) - push.dot(&carried) / mass);
                pushes.push(carried);
            }
        }
        let sum = translations.iter().fold(Matrix3::zeros(), |sum: Matrix3<f64>, t| sum + t * t.transpose());
        posed.share = (Matrix3::identity() * mass - sum).try_inverse().unwrap_or_else(Matrix3::zeros);
        (posed.centre, posed.inertia, posed.momentum) =
            (centre, 0.5 * (inertia + inertia.transpose()), momentum);
        (posed.energy, posed.push, posed.mass) = (0.5 * double, push, mass);
        posed.offset_hinges(eta);
        let (mut carried, mut across) = (Matrix3::zeros(), Matrix3::zeros());
        for (delta, t) in posed.rotations.iter().zip(&posed.translations) {
            carried += delta * delta.transpose();
            across += delta * t.transpose();
        }
        posed.left = posed.inertia - carried - across * posed.share * across.transpose();
    }
}

impl Posed {
    /// The free modes, if there is mass left.
    pub fn free(&self, of: &DrivenSpacecraft) -> Option<Free> {
        let columns = |of: &[Vector]| Matrix3xX::from_fn(of.len(), |row, column| of[column][row]);
        let held = ClampedModes {
            mass: self.mass,
            inertia: self.inertia,
            frequencies: of.modes().map(|mode| mode.frequency).collect(),
            translations: columns(&self.translations),
            rotations: columns(&self.rotations),
        };
        held.free()
    }

    /// E⁻¹ v.
    pub fn freed(&self, v: &mut [f64]) {
        let sum = self.translations.iter().zip(&*v).fold(Vector::zeros(), |sum, (t, v)| sum + t * *v);
        let back = self.share * sum;
        v.iter_mut().zip(&self.translations).for_each(|(v, t)| *v += t.dot(&back));
    }

    /// What the modes change of the inertia (kg m²).
    pub fn changed(&self, eta: &[f64]) -> Matrix3<f64> {
        let modes = self.moments.iter().zip(eta);
        modes.fold(Matrix3::zeros(), |sum: Matrix3<f64>, (moments, eta)| sum + moments * *eta)
    }

    /// The rate of the hub (rad/s), from its momentum without rotors; `rates` hold pi, and then eta'.
    pub fn rates(&self, free: &Vector, eta: &[f64], rates: &mut [f64]) -> Vector {
        rates.iter_mut().zip(&self.kicks).for_each(|(pi, kick)| *pi -= kick);
        self.freed(rates);
        let sum = |of: &[Vector], by: &[f64]| -> Vector {
            of.iter().zip(by).fold(Vector::zeros(), |sum, (of, by)| sum + of * *by)
        };
        let turning = free - self.momentum - sum(&self.momenta, eta) - sum(&self.rotations, rates);
        let whole = self.left + self.changed(eta);
        let rate = whole.lu().solve(&turning).unwrap_or_else(|| Vector::repeat(f64::NAN));
        // eta' = E⁻¹ (pi - k) - E⁻¹ delta' w, of which the first is there.
        let mut turned: Vec<f64> = self.rotations.iter().map(|delta| -delta.dot(&rate)).collect();
        self.freed(&mut turned);
        rates.iter_mut().zip(turned).for_each(|(own, turned)| *own += turned);
        rate
    }

    /// H without rotors, and pi, of a body that turns at this rate (rad/s).
    pub fn momenta(&self, rate: &Vector, eta: &[f64], rates: &[f64]) -> (Vector, Vec<f64>) {
        let sum = |of: &[Vector], by: &[f64]| -> Vector {
            of.iter().zip(by).fold(Vector::zeros(), |sum, (of, by)| sum + of * *by)
        };
        let momentum = (self.inertia + self.changed(eta)) * rate
            + self.momentum
            + sum(&self.momenta, eta)
            + sum(&self.rotations, rates);
        let moved = sum(&self.translations, rates) / self.mass;
        let pi = |(index, own): (usize, &f64)| {
            own + self.rotations[index].dot(rate) + self.kicks[index] - self.translations[index].dot(&moved)
        };
        (momentum, rates.iter().enumerate().map(pi).collect())
    }

    /// The kinetic energy (J).
    pub fn kinetic(&self, rate: &Vector, eta: &[f64], rates: &[f64]) -> f64 {
        let (momentum, pi) = self.momenta(rate, eta, rates);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        // Of T = T2 + T1 + T0 by degree in the rates, the momenta give 2 T2 + T1.
        let first = rate.dot(&self.momentum)
            + dot(&self.kicks, rates)
            + self.momenta.iter().zip(eta).map(|(of, eta)| of.dot(rate) * eta).sum::<f64>();
        0.5 * (rate.dot(&momentum) + dot(&pi, rates) + first) + self.energy + dot(&self.pulls, eta)
    }
}
