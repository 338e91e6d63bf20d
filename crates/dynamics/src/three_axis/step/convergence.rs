//! Convergence of the stage iteration: changes of an iteration, and a bound of the next ones.

use super::IntegrationStep;
use super::stage_values::StageValues;
use crate::three_axis::constants::BodyConstants;

/// Relative change of the state by the next iteration below which the iteration has converged.
pub const TOLERANCE: f64 = 1e-18;

/// Largest changes of one iteration, and magnitudes of the quantities involved; for vectors, the squares of their
/// norms.
#[derive(Default)]
pub struct IterationChange {
    /// Changes of H_m' (N m), w_m (rad/s) and Gt (N m s), squared.
    pub momentum_rate: f64,
    pub mean_rate: f64,
    pub rigid_momentum: f64,
    /// Change of the modal forces (N/sqrt(kg)).
    pub modal_force: f64,
    /// Relative change of the momenta of rotors in bearings.
    pub rotor_momentum: f64,
    /// Change of the inertia by the modes (kg m²) and rate of the hub (rad/s), squared.
    pub inertia_change: f64,
    pub rate: f64,
}

impl IterationChange {
    /// Includes the change of a stage from its `last` value to the one `found`.
    pub fn add(&mut self, last: &StageValues, found: &StageValues) {
        self.momentum_rate =
            self.momentum_rate.max((found.momentum_rate - last.momentum_rate).norm_squared());
        self.mean_rate = self.mean_rate.max((found.mean_rate - last.mean_rate).norm_squared());
        self.rigid_momentum =
            self.rigid_momentum.max((found.rigid_momentum - last.rigid_momentum).norm_squared());
    }

    /// Returns the largest relative change.
    #[inline(always)]
    pub fn largest(&self, h: f64, momentum_scale: f64, modal_rate_scale: f64) -> f64 {
        let mut largest = self.rotor_momentum.max(0.5 * h * f64::sqrt(self.mean_rate));
        if momentum_scale > 0.0 {
            largest = largest.max(f64::sqrt(self.momentum_rate) * h / momentum_scale);
        }
        if modal_rate_scale > 0.0 {
            largest = largest.max(self.modal_force * h / modal_rate_scale);
        }
        largest
    }
}

impl IntegrationStep<'_> {
    /// Returns true if the next iteration would change nothing significant: judged by the convergence rate of the
    /// last two iterations (`previous` is the change of the previous one), or by the bound of [`IntegrationStep::next_change_bound`].
    #[inline(always)]
    pub(super) fn has_converged(
        &self,
        change: &IterationChange,
        momentum_scale: f64,
        modal_rate_scale: f64,
        previous: f64,
    ) -> bool {
        let largest = change.largest(self.h, momentum_scale, modal_rate_scale);
        largest <= TOLERANCE
            || largest * largest <= TOLERANCE * previous
            || self.next_change_bound(change, momentum_scale, modal_rate_scale) <= TOLERANCE
    }

    /// Bounds the relative change of the next iteration if only modes, momentum and a constant torque are involved;
    /// infinite otherwise. Above the tolerance, returns only a part of the bound. Each iteration starts from the rates, momenta and forces of the last, whose errors are
    /// about the size of its changes.
    #[inline(always)]
    pub(super) fn next_change_bound(
        &self,
        change: &IterationChange,
        momentum_scale: f64,
        modal_rate_scale: f64,
    ) -> f64 {
        let simple = self.surroundings.is_none()
            && self.appendages.is_none()
            && self.bearings.is_none()
            && self.force_arms.is_empty()
            && self.model.coupled_damping.is_none();
        if !simple {
            return f64::INFINITY;
        }
        let (model, h) = (self.model, self.h);
        let BodyConstants { mobility, rotation_sum, bending_bound, inertia_change_bound, .. } = model;
        let momentum_rate = f64::sqrt(change.momentum_rate);
        // In most iterations, this part of the bound alone is too large.
        let part = 2.0 * h * ((mobility + bending_bound) * (h * momentum_rate));
        if part > TOLERANCE {
            return part;
        }
        let rigid_momentum = f64::sqrt(change.rigid_momentum);
        let [inertia_change, rate] = [change.inertia_change, change.rate].map(f64::sqrt);
        // Errors of the elastic rate, of the deformation and of the momentum; from these, the error of the hub's
        // rate.
        let elastic_rate = rotation_sum * h * change.modal_force + 2.0 * bending_bound * rigid_momentum;
        let elastic_rotation = h * elastic_rate;
        let momentum = h * momentum_rate + momentum_scale * elastic_rotation;
        let stretch = inertia_change_bound * h * (h * change.modal_force + rotation_sum * rigid_momentum);
        let hub = 2.0 * ((mobility + bending_bound) * (momentum + stretch * rate) + elastic_rate)
            + rate * elastic_rotation;
        let mut bound = h * hub;
        if momentum_scale > 0.0 {
            bound = bound.max(h * (rate * h * momentum_rate / momentum_scale + hub) + elastic_rotation);
        }
        if modal_rate_scale > 0.0 && model.changes_inertia {
            let force = inertia_change_bound * rate * hub;
            bound = bound.max(h * force / modal_rate_scale);
        }
        // The effect of the rate error on Gt through the change of inertia appears one iteration later.
        bound.max(h * (mobility + bending_bound) * (inertia_change * hub + momentum))
    }
}
