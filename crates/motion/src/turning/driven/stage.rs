//! A driven body at a stage of a step.

use nalgebra::Matrix3;

use super::{Driving, Posed};
use crate::attitude::Vector;
use crate::numerics::gauss_legendre::NODES;
use crate::turning::Surroundings;

/// The memory of the steps of a driven body.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// What it is at the start of the step and at its nodes, and when those are (s since the start).
    posed: [Posed; 4],
    times: [f64; 4],
    /// q of the free modes, P.
    pub q: Vec<f64>,
    pub p: Vec<f64>,
    /// Displacements of the clamped modes but for those of hinges, and rates of all.
    eta: Vec<f64>,
    rates: Vec<f64>,
    /// q', and the forces on the free modes.
    pub speeds: Vec<f64>,
    pub forces: Vec<f64>,
}

/// How a driven body turns.
pub struct Turns {
    /// The rate of the hub (rad/s), and what the modes make of it.
    pub rate: Vector,
    pub elastic: Vector,
    /// Inertia of the body as it is bent (kg m²).
    pub inertia: Matrix3<f64>,
    /// What forces add to the torque on the hub, as places and the centre of mass move (N m).
    pub levered: Vector,
}

/// What forces the modes of a driven body.
pub struct Pulls<'a> {
    pub around: Option<(&'a dyn Surroundings, f64)>,
    pub tide: Option<Matrix3<f64>>,
    /// The acceleration of the centre of mass (m/s²).
    pub push: Option<Vector>,
}

impl Driving {
    /// Poses the body for a step of `h` seconds that begins `t` seconds after the departure.
    pub fn prepare(&self, t: f64, h: f64, scratch: &mut Scratch) {
        let modes = self.basis.frequencies.len();
        scratch.q.resize(modes, 0.0);
        scratch.p.resize(modes, 0.0);
        let Scratch { posed, times, .. } = scratch;
        for ((posed, at), part) in posed.iter_mut().zip(times).zip([0.0].into_iter().chain(NODES)) {
            // Angles are known from the departure on, whatever jumps there.
            *at = self.began + (t + part * h);
            if !self.swings {
                self.posed(*at, &[], posed);
            }
        }
    }

    /// How the body turns at a stage with this momentum without rotors, where scratch holds q and P.
    pub fn turns(&self, stage: usize, free: &Vector, push: Option<Vector>, scratch: &mut Scratch) -> Turns {
        scratch.eta = self.basis.held(&scratch.q);
        if self.swings {
            self.posed(scratch.times[stage], &scratch.eta, &mut scratch.posed[stage]);
        }
        let posed = &scratch.posed[stage];
        posed.small(&mut scratch.eta);
        scratch.rates = self.basis.held_rates(&scratch.p);
        let rate = posed.rates(free, &scratch.eta, &mut scratch.rates);
        scratch.speeds = self.basis.free(&scratch.rates);
        let levered = push.map_or_else(Vector::zeros, |push| {
            let moved = self.moved(posed, &scratch.eta);
            moved.cross(&(push * posed.mass))
        });
        Turns {
            rate,
            elastic: self.basis.bent(&scratch.speeds),
            inertia: posed.inertia + posed.changed(&scratch.eta),
            levered,
        }
    }

    /// By how much places of the hub are further from the centre of mass than at the start (m).
    pub fn moved(&self, posed: &Posed, eta: &[f64]) -> Vector {
        let bent = posed.translations.iter().zip(eta).fold(Vector::zeros(), |sum, (t, eta)| sum + t * *eta);
        self.basis.first_centre - posed.centre - bent / posed.mass
    }

    /// Fills in the forces on the modes at a stage, `t` seconds after the start of the step, at which the hub has this rate (rad/s).
    pub fn pull(&self, (stage, t): (usize, f64), rate: &Vector, pulls: &Pulls<'_>, scratch: &mut Scratch) {
        let posed = &scratch.posed[stage];
        let moved = |index: usize| {
            0.5 * rate.dot(&(posed.moments[index] * rate))
                + posed.momenta[index].dot(rate)
                + posed.pulls[index]
        };
        let mut forces: Vec<f64> = (0..posed.moments.len()).map(moved).collect();
        posed.swing(rate, &scratch.eta, &scratch.rates, &mut forces);
        for (index, force) in forces.iter_mut().enumerate() {
            if let Some(tide) = &pulls.tide {
                *force += posed.moments[index].component_mul(tide).sum();
            }
            if let Some(push) = &pulls.push {
                *force -= posed.translations[index].dot(push);
            }
        }
        scratch.forces = self.basis.forced(&forces);
        let Some((around, since)) = pulls.around else { return };
        for heated in around.heated() {
            let level = heated.level(since + t);
            for (index, force) in scratch.forces.iter_mut().enumerate() {
                let row = self.basis.from_start.row(index);
                *force += level * row.iter().zip(&heated.forces).map(|(part, own)| part * own).sum::<f64>();
            }
        }
    }
}
