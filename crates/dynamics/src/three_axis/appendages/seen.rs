//! View of an articulated body at an instant, and transfer of its state between the modes of two configurations.

use std::sync::Arc;

use flexsc_numerics::attitude::{Vector, rotation};
use nalgebra::Quaternion;

use super::{ArticulatedMotion, Configuration};
use crate::three_axis::flow::ThreeAxisMotion;
use crate::three_axis::model::BodyConstants;
use crate::three_axis::pace::StepLevels;
use crate::three_axis::rotation::SmallRotation;
use crate::three_axis::state::{BodyView, IntegratorState};

/// State reduced to quantities that do not depend on the basis: hub attitude, momentum and clamped modes.
struct ReducedState {
    /// Attitude of the hub, and total momentum in its axes (N m s).
    attitude: Quaternion<f64>,
    momentum: Vector,
    eta: Vec<f64>,
    pi: Vec<f64>,
    bent: Vector,
}

impl ArticulatedMotion {
    fn bare(&self, state: &IntegratorState) -> ReducedState {
        let q: Vec<f64> = state.modes.iter().map(|[q, _, lost, _]| q + lost).collect();
        let p = state.modes.iter().zip(&self.basis.frequencies).map(|([_, p, _, lost], w)| w * (p + lost));
        let p: Vec<f64> = p.collect();
        let bent = self.basis.hub_rotation(&q);
        ReducedState {
            attitude: state.attitude * rotation(&bent),
            momentum: SmallRotation::new(bent).to_hub_axes(&(state.momentum + state.lost.1)),
            eta: self.basis.to_clamped(&q),
            pi: self.basis.held_rates(&p),
            bent,
        }
    }

    /// Computes the view of a state `now` (s) after the start of the segment, given the momentum of the rotors (N m
    /// s), in the free modes of that instant.
    pub(in crate::three_axis) fn look(
        &self,
        now: f64,
        state: &IntegratorState,
        rotors: &Vector,
        seen: &mut BodyView,
    ) {
        let mut posed = Configuration::default();
        let ReducedState { attitude, momentum, mut eta, mut pi, .. } = self.bare(state);
        // The free modes are those with hinges at angle 0.
        self.configuration(self.began + now, &[], &mut posed);
        let Some(free) = posed.free(&self.of) else { return };
        if self.swings {
            self.configuration(self.began + now, &eta, &mut posed);
        }
        let all = eta.clone();
        posed.without_hinges(&mut eta);
        let rate = posed.rates(&(momentum - rotors), &eta, &mut pi);
        let rates = pi;
        let free = self.basis.reordered(&free);
        let inverse = super::basis::inverse(&self.of, &free);
        let of = |held: &[f64]| -> Vec<f64> {
            let rows = inverse.row_iter();
            rows.map(|row| row.iter().zip(held).map(|(part, held)| part * held).sum()).collect()
        };
        (seen.displacements, seen.rates) = (of(&all), of(&rates));
        seen.hinges = posed.hinge_motion(&all, &rates);
        seen.rotations = (0..free.frequencies.len()).map(|mode| free.rotation(mode)).collect();
        let sum = |of: &[Vector], by: &[f64]| -> Vector {
            of.iter().zip(by).fold(Vector::zeros(), |sum, (of, by)| sum + of * *by)
        };
        let (bent, elastic) = (sum(&seen.rotations, &seen.displacements), sum(&seen.rotations, &seen.rates));
        let slid = posed.push + sum(&posed.pushes, &eta) + sum(&posed.translations, &rates);
        seen.attitude = attitude;
        seen.mean = attitude * rotation(&-bent);
        (seen.rate, seen.rigid, seen.momentum) = (rate, rate - elastic, momentum);
        let modal: f64 = seen.rates.iter().map(|rate| rate * rate).sum();
        seen.rotational = posed.kinetic(&rate, &eta, &rates) - 0.5 * modal;
        seen.turned = state.turned + self.bare_turn(state) - bent;
        seen.moved = state.moved;
        seen.frequencies = free.frequencies;
        seen.shift = Some([self.centre_shift(&posed, &eta), -slid / posed.mass]);
        seen.inertia = Some(posed.inertia + posed.changed(&eta));
    }

    /// Returns the elastic rotation of the hub from the mean axes of the state (rad).
    fn bare_turn(&self, state: &IntegratorState) -> Vector {
        let q: Vec<f64> = state.modes.iter().map(|[q, ..]| *q).collect();
        self.basis.hub_rotation(&q)
    }

    /// Sets the state from the attitude and momentum of the hub and the clamped modes.
    fn carried(&self, bare: &ReducedState, state: &mut IntegratorState) {
        let (q, p) = (self.basis.to_free(&bare.eta), self.basis.force_to_free(&bare.pi));
        let bent = self.basis.hub_rotation(&q);
        state.attitude = bare.attitude * rotation(&-bent);
        state.momentum = SmallRotation::new(bent).to_mean_axes(&bare.momentum);
        state.lost.0 = Quaternion::default();
        state.lost.1 = Vector::zeros();
        state.turned += bare.bent - bent;
        for ((mode, (q, p)), w) in state.modes.iter_mut().zip(q.iter().zip(&p)).zip(&self.basis.frequencies) {
            *mode = [*q, p / w, 0.0, 0.0];
        }
    }
}

impl ThreeAxisMotion {
    /// Installs the articulated appendages at the start of the run, before any other call.
    pub fn start_drives(&mut self, driving: ArticulatedMotion) {
        let mut posed = Configuration::default();
        let (eta, rates) =
            (driving.basis.to_clamped(&self.seen.displacements), driving.basis.to_clamped(&self.seen.rates));
        driving.configuration(0.0, &eta, &mut posed);
        let mut small = eta.clone();
        posed.without_hinges(&mut small);
        // Initial hinge angles and rates do not contribute to the hub's initial attitude and rate.
        let (mut attitude, mut rate) = (self.seen.attitude, self.seen.rate);
        if driving.swings {
            let bent = |eta: &[f64]| driving.basis.hub_rotation(&driving.basis.to_free(eta));
            let mut others = rates.clone();
            posed.without_hinges(&mut others);
            attitude = self.seen.mean * rotation(&bent(&small));
            rate += bent(&others) - bent(&rates);
        }
        let (momentum, pi) = posed.momenta(&rate, &small, &rates);
        let bare = ReducedState {
            attitude,
            momentum,
            bent: driving.basis.hub_rotation(&self.seen.displacements),
            eta,
            pi,
        };
        driving.carried(&bare, &mut self.here);
        self.driving = Some(Box::new(driving));
        self.remodel();
        self.departed.copy_from(&self.here);
        self.grid.copy_from(&self.here);
        self.look();
    }

    /// Sets the start of the next segment, as time since the start of the run (s).
    pub fn set_segment_start(&mut self, at: f64) {
        if let Some(driving) = &mut self.driving {
            driving.began = at;
        }
    }

    /// Changes the basis of the state to the free modes at a time `t` since the start (s); a new segment must begin
    /// next.
    pub fn change_basis(&mut self, t: f64) {
        let Some(driving) = &mut self.driving else { return };
        let Some(basis) = driving.basis.at(&driving.of, &*driving.angles, t) else { return };
        let bare = driving.bare(&self.here);
        driving.basis = basis;
        driving.carried(&bare, &mut self.here);
        self.remodel();
    }

    /// Updates the integrator's constants to the modes in which the state is carried.
    fn remodel(&mut self) {
        let Some(driving) = &self.driving else { return };
        let model = BodyConstants::new(&driving.flexible());
        self.pace = Arc::new(StepLevels::new(&model));
        self.model = Arc::new(model);
        self.known = None;
        self.regular.clear();
        self.beside.clear();
        self.next_beside = 0;
        self.ahead = None;
        self.move_on();
    }
}
