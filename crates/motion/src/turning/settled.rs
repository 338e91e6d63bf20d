//! When the stages of a step have settled: what a pass changed, and what the next one would.

use super::model::Model;
use super::step::{StepStage, TurningStep};

/// Passes end when the next would change less than this part of the state.
pub(super) const SETTLED: f64 = 1e-18;

/// What a pass changed, at most, and how large what it works with was; of vectors the squares.
#[derive(Default)]
pub(super) struct Change {
    /// Of H_m' (N m), w_m (rad/s) and Gt (N m s).
    pub push: f64,
    pub mean: f64,
    pub turning: f64,
    /// Of the forces on modes (N/sqrt(kg)).
    pub forced: f64,
    /// Of rotors in bearings, as a part of them.
    pub spun: f64,
    /// What modes change of the inertia (kg m²), and the rate of the hub (rad/s).
    pub stretched: f64,
    pub rate: f64,
}

impl Change {
    /// Takes a stage into account.
    pub fn see(&mut self, last: &StepStage, found: &StepStage) {
        self.push = self.push.max((found.push - last.push).norm_squared());
        self.mean = self.mean.max((found.mean - last.mean).norm_squared());
        self.turning = self.turning.max((found.turning - last.turning).norm_squared());
    }

    /// The largest change, as a part of what changes.
    #[inline(always)]
    pub fn most(&self, h: f64, size: f64, speed: f64) -> f64 {
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

impl TurningStep<'_> {
    /// Whether the next pass would change nothing that counts: by the rate of the last two, or by what this one changed.
    #[inline(always)]
    pub(super) fn settles(&self, change: &Change, size: f64, speed: f64, before: f64) -> bool {
        let most = change.most(self.h, size, speed);
        most <= SETTLED || most * most <= SETTLED * before || self.leaves(change, size, speed) <= SETTLED
    }

    /// A bound of what the next pass changes, as a part of what changes, where nothing but modes, momentum and a constant torque
    /// take part; none otherwise. Every pass begins with the rates, momenta and forces of the last, whose errors are about what
    /// that changed.
    #[inline(always)]
    pub(super) fn leaves(&self, change: &Change, size: f64, speed: f64) -> f64 {
        let plain = self.around.is_none()
            && self.driven.is_none()
            && self.borne.is_none()
            && self.levers.is_empty()
            && self.model.beside.is_none();
        if !plain {
            return f64::INFINITY;
        }
        let (model, h) = (self.model, self.h);
        let Model { mobility, reach, bendable, stretchable, .. } = model;
        let [push, turning] = [change.push, change.turning].map(f64::sqrt);
        let [stretched, rate] = [change.stretched, change.rate].map(f64::sqrt);
        // Errors of the elastic rate, how far the body is bent, and the momentum; by these of the hub's rate.
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
        // What the rate makes of Gt by the change of the inertia counts with the next pass.
        next.max(h * (mobility + bendable) * (stretched * hub + momentum))
    }
}
