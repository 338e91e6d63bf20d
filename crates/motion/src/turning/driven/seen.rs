//! View of an articulated body at an instant, and transfer of its state between the modes of two configurations.

use std::sync::Arc;

use nalgebra::Quaternion;

use super::{Driving, Posed};
use crate::attitude::{Vector, rotation};
use crate::turning::flow::Turning;
use crate::turning::model::Model;
use crate::turning::pace::Pace;
use crate::turning::rotation::Bend;
use crate::turning::state::{TurningSight, TurningState};

/// State reduced to quantities that do not depend on the basis: hub attitude, momentum and clamped modes.
struct Bare {
    /// Attitude of the hub, and total momentum in its axes (N m s).
    attitude: Quaternion<f64>,
    momentum: Vector,
    eta: Vec<f64>,
    pi: Vec<f64>,
    bent: Vector,
}

impl Driving {
    fn bare(&self, state: &TurningState) -> Bare {
        let q: Vec<f64> = state.modes.iter().map(|[q, _, lost, _]| q + lost).collect();
        let p = state.modes.iter().zip(&self.basis.frequencies).map(|([_, p, _, lost], w)| w * (p + lost));
        let p: Vec<f64> = p.collect();
        let bent = self.basis.bent(&q);
        Bare {
            attitude: state.attitude * rotation(&bent),
            momentum: Bend::new(bent).back(&(state.momentum + state.lost.1)),
            eta: self.basis.held(&q),
            pi: self.basis.held_rates(&p),
            bent,
        }
    }

    /// Computes the view of a state `now` (s) after the start of the segment, given the momentum of the rotors (N m
    /// s), in the free modes of that instant.
    pub(in crate::turning) fn look(
        &self,
        now: f64,
        state: &TurningState,
        rotors: &Vector,
        seen: &mut TurningSight,
    ) {
        let mut posed = Posed::default();
        let Bare { attitude, momentum, mut eta, mut pi, .. } = self.bare(state);
        // The free modes are those with hinges at angle 0.
        self.posed(self.began + now, &[], &mut posed);
        let Some(free) = posed.free(&self.of) else { return };
        if self.swings {
            self.posed(self.began + now, &eta, &mut posed);
        }
        let all = eta.clone();
        posed.small(&mut eta);
        let rate = posed.rates(&(momentum - rotors), &eta, &mut pi);
        let rates = pi;
        let free = self.basis.followed(&free);
        let inverse = super::basis::inverse(&self.of, &free);
        let of = |held: &[f64]| -> Vec<f64> {
            let rows = inverse.row_iter();
            rows.map(|row| row.iter().zip(held).map(|(part, held)| part * held).sum()).collect()
        };
        (seen.displacements, seen.rates) = (of(&all), of(&rates));
        seen.hinges = posed.hinged(&all, &rates);
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
        seen.shift = Some([self.moved(&posed, &eta), -slid / posed.mass]);
        seen.inertia = Some(posed.inertia + posed.changed(&eta));
    }

    /// Returns the elastic rotation of the hub from the mean axes of the state (rad).
    fn bare_turn(&self, state: &TurningState) -> Vector {
        let q: Vec<f64> = state.modes.iter().map(|[q, ..]| *q).collect();
        self.basis.bent(&q)
    }

    /// Sets the state from the attitude and momentum of the hub and the clamped modes.
    fn carried(&self, bare: &Bare, state: &mut TurningState) {
        let (q, p) = (self.basis.free(&bare.eta), self.basis.forced(&bare.pi));
        let bent = self.basis.bent(&q);
        state.attitude = bare.attitude * rotation(&-bent);
        state.momentum = Bend::new(bent).forward(&bare.momentum);
        state.lost.0 = Quaternion::default();
        state.lost.1 = Vector::zeros();
        state.turned += bare.bent - bent;
        for ((mode, (q, p)), w) in state.modes.iter_mut().zip(q.iter().zip(&p)).zip(&self.basis.frequencies) {
            *mode = [*q, p / w, 0.0, 0.0];
        }
    }
}

impl Turning {
    /// Installs the articulated appendages at the start of the run, before any other call.
    pub fn drive(&mut self, driving: Driving) {
        let mut posed = Posed::default();
        let (eta, rates) =
            (driving.basis.held(&self.seen.displacements), driving.basis.held(&self.seen.rates));
        driving.posed(0.0, &eta, &mut posed);
        let mut small = eta.clone();
        posed.small(&mut small);
        // Initial hinge angles and rates do not contribute to the hub's initial attitude and rate.
        let (mut attitude, mut rate) = (self.seen.attitude, self.seen.rate);
        if driving.swings {
            let bent = |eta: &[f64]| driving.basis.bent(&driving.basis.free(eta));
            let mut others = rates.clone();
            posed.small(&mut others);
            attitude = self.seen.mean * rotation(&bent(&small));
            rate += bent(&others) - bent(&rates);
        }
        let (momentum, pi) = posed.momenta(&rate, &small, &rates);
        let bare = Bare { attitude, momentum, bent: driving.basis.bent(&self.seen.displacements), eta, pi };
        driving.carried(&bare, &mut self.here);
        self.driving = Some(Box::new(driving));
        self.remodel();
        self.departed.copy_from(&self.here);
        self.grid.copy_from(&self.here);
        self.look();
    }

    /// Sets the start of the next segment, as time since the start of the run (s).
    pub fn begins(&mut self, at: f64) {
        if let Some(driving) = &mut self.driving {
            driving.began = at;
        }
    }

    /// Changes the basis of the state to the free modes at a time `t` since the start (s); a new segment must begin
    /// next.
    pub fn recast(&mut self, t: f64) {
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
        let model = Model::new(&driving.flexible());
        self.pace = Arc::new(Pace::new(&model));
        self.model = Arc::new(model);
        self.known = None;
        self.regular.clear();
        self.beside.clear();
        self.next_beside = 0;
        self.ahead = None;
        self.move_on();
    }
}
