//! Evaluation of an articulated body at a stage of a step.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::gauss_legendre::NODES;
use nalgebra::Matrix3;

use super::{ArticulatedMotion, Configuration};
use crate::three_axis::Surroundings;

/// Working memory of the steps of an articulated body.
#[derive(Clone, Debug, Default)]
pub struct StageScratch {
    /// Configurations at the start of the step and at its nodes, and their times since the start of the run (s).
    posed: [Configuration; 4],
    times: [f64; 4],
    /// Displacements q and canonical rates P of the free modes.
    pub q: Vec<f64>,
    pub p: Vec<f64>,
    /// Displacements of the clamped modes without those of hinges, and rates of all clamped modes.
    eta: Vec<f64>,
    rates: Vec<f64>,
    /// Rates q', and forces on the free modes (N/sqrt(kg)).
    pub speeds: Vec<f64>,
    pub forces: Vec<f64>,
}

/// Motion of an articulated body at a stage.
pub struct StageRates {
    /// Rate of the hub (rad/s), and its elastic part (rad/s).
    pub rate: Vector,
    pub elastic: Vector,
    /// Inertia of the deformed body (kg m²).
    pub inertia: Matrix3<f64>,
    /// Torque on the hub by forces, as their points of application and the centre of mass move (N m).
    pub levered: Vector,
}

/// Sources of modal forces on an articulated body.
pub struct StageForces<'a> {
    pub around: Option<(&'a dyn Surroundings, f64)>,
    pub tide: Option<Matrix3<f64>>,
    /// Acceleration of the centre of mass (m/s²).
    pub push: Option<Vector>,
}

impl ArticulatedMotion {
    /// Computes the configurations for a step of `h` (s) that begins `t` (s) after the start of the segment.
    pub fn prepare(&self, t: f64, h: f64, scratch: &mut StageScratch) {
        let modes = self.basis.frequencies.len();
        scratch.q.resize(modes, 0.0);
        scratch.p.resize(modes, 0.0);
        let StageScratch { posed, times, .. } = scratch;
        for ((posed, at), part) in posed.iter_mut().zip(times).zip([0.0].into_iter().chain(NODES)) {
            // Angles are continuous within the segment, even if they jump at its start.
            *at = self.began + (t + part * h);
            if !self.swings {
                self.configuration(*at, &[], posed);
            }
        }
    }

    /// Evaluates the motion at a stage for the momentum `free` without rotors (N m s); `scratch` holds q and P.
    pub fn turns(
        &self,
        stage: usize,
        free: &Vector,
        push: Option<Vector>,
        scratch: &mut StageScratch,
    ) -> StageRates {
        scratch.eta = self.basis.to_clamped(&scratch.q);
        if self.swings {
            self.configuration(scratch.times[stage], &scratch.eta, &mut scratch.posed[stage]);
        }
        let posed = &scratch.posed[stage];
        posed.without_hinges(&mut scratch.eta);
        scratch.rates = self.basis.held_rates(&scratch.p);
        let rate = posed.rates(free, &scratch.eta, &mut scratch.rates);
        scratch.speeds = self.basis.to_free(&scratch.rates);
        let levered = push.map_or_else(Vector::zeros, |push| {
            let moved = self.centre_shift(posed, &scratch.eta);
            moved.cross(&(push * posed.mass))
        });
        StageRates {
            rate,
            elastic: self.basis.hub_rotation(&scratch.speeds),
            inertia: posed.inertia + posed.changed(&scratch.eta),
            levered,
        }
    }

    /// Returns the shift of the hub's points relative to the centre of mass since the start (m).
    pub fn centre_shift(&self, posed: &Configuration, eta: &[f64]) -> Vector {
        let bent = posed.translations.iter().zip(eta).fold(Vector::zeros(), |sum, (t, eta)| sum + t * *eta);
        self.basis.first_centre - posed.centre - bent / posed.mass
    }

    /// Computes the forces on the modes at a stage, `t` (s) after the start of the step, for the hub's rate (rad/s).
    pub fn compute_forces(
        &self,
        (stage, t): (usize, f64),
        rate: &Vector,
        pulls: &StageForces<'_>,
        scratch: &mut StageScratch,
    ) {
        let posed = &scratch.posed[stage];
        let moved = |index: usize| {
            0.5 * rate.dot(&(posed.moments[index] * rate))
                + posed.momenta[index].dot(rate)
                + posed.pulls[index]
        };
        let mut forces: Vec<f64> = (0..posed.moments.len()).map(moved).collect();
        posed.add_hinge_terms(rate, &scratch.eta, &scratch.rates, &mut forces);
        for (index, force) in forces.iter_mut().enumerate() {
            if let Some(tide) = &pulls.tide {
                *force += posed.moments[index].component_mul(tide).sum();
            }
            if let Some(push) = &pulls.push {
                *force -= posed.translations[index].dot(push);
            }
        }
        scratch.forces = self.basis.force_to_free(&forces);
        let Some((around, since)) = pulls.around else { return };
        for heated in around.thermal_forces() {
            let level = heated.level(since + t);
            for (index, force) in scratch.forces.iter_mut().enumerate() {
                let row = self.basis.from_start.row(index);
                *force += level * row.iter().zip(&heated.forces).map(|(part, own)| part * own).sum::<f64>();
            }
        }
    }
}
