//! Convergence of the stage iteration: changes of an iteration, and a bound of the next ones.

use super::model::BodyConstants;
use super::step::{IntegrationStep, StageValues};

/// Relative change of the state by the next iteration below which the iteration has converged.
pub(super) const SETTLED: f64 = 1e-18;

/// Largest changes of one iteration, and magnitudes of the quantities involved; for vectors, the squares of their
/// norms.
#[derive(Default)]
pub(super) struct IterationChange {
    /// Changes of H_m' (N m), w_m (rad/s) and Gt (N m s), squared.
    pub push: f64,
    pub mean: f64,
    pub turning: f64,
    /// Change of the modal forces (N/sqrt(kg)).
    pub forced: f64,
    /// Relative change of the momenta of rotors in bearings.
    pub spun: f64,
    /// Change of the inertia by the modes (kg m²) and rate of the hub (rad/s), squared.
    pub stretched: f64,
    pub rate: f64,
}

impl IterationChange {
    /// Includes the change of a stage from its `last` value to the one `found`.
    pub fn add(&mut self, last: &StageValues, found: &StageValues) {
        self.push = self.push.max((found.push - last.push).norm_squared());
        self.mean = self.mean.max((found.mean - last.mean).norm_squared());
        self.turning = self.turning.max((found.turning - last.turning).norm_squared());
    }

    /// Returns the largest relative change.
    #[inline(always)]
    pub fn largest(&self, h: f64, size: f64, speed: f64) -> f64 {
        let mut most = self.spun.max(0.5 * h * f64::sqrt(self.mean));
        if size > 0.0 {
            most = most.max(f64::sqrt(self.push) * h / size);
        }
        if speed > 0.0 {
            most = most.max(self.forced * h / speed);
        }
        most
    }
}

impl IntegrationStep<'_> {
    /// Returns true if the next iteration would change nothing significant: judged by the convergence rate of the
    /// last two iterations (`before` is the change of the previous one), or by the bound of `leaves`.
    #[inline(always)]
    pub(super) fn has_converged(&self, change: &IterationChange, size: f64, speed: f64, before: f64) -> bool {
        let most = change.largest(self.h, size, speed);
        most <= SETTLED
            || most * most <= SETTLED * before
            || self.next_change_bound(change, size, speed) <= SETTLED
    }

    /// Bounds the relative change of the next iteration if only modes, momentum and a constant torque are involved;
    /// infinite otherwise. Each iteration starts from the rates, momenta and forces of the last, whose errors are
    /// about the size of its changes.
    #[inline(always)]
    pub(super) fn next_change_bound(&self, change: &IterationChange, size: f64, speed: f64) -> f64 {
        let plain = self.around.is_none()
            && self.driven.is_none()
            && self.borne.is_none()
            && self.levers.is_empty()
            && self.model.beside.is_none();
        if !plain {
            return f64::INFINITY;
        }
        let (model, h) = (self.model, self.h);
        let BodyConstants { mobility, reach, bendable, stretchable, .. } = model;
        let [push, turning] = [change.push, change.turning].map(f64::sqrt);
        let [stretched, rate] = [change.stretched, change.rate].map(f64::sqrt);
        // Errors of the elastic rate, of the deformation and of the momentum; from these, the error of the hub's
        // rate.
        let elastic = reach * h * change.forced + 2.0 * bendable * turning;
        let bent = h * elastic;
        let momentum = h * push + size * bent;
        let stretch = stretchable * h * (h * change.forced + reach * turning);
        let hub = 2.0 * ((mobility + bendable) * (momentum + stretch * rate) + elastic) + rate * bent;
        let mut next = h * hub;
        if size > 0.0 {
            next = next.max(h * (rate * h * push / size + hub) + bent);
        }
        if speed > 0.0 && model.stretches {
            let forced = stretchable * rate * hub;
            next = next.max(h * forced / speed);
        }
        // The effect of the rate error on Gt through the change of inertia appears one iteration later.
        next.max(h * (mobility + bendable) * (stretched * hub + momentum))
    }
}
