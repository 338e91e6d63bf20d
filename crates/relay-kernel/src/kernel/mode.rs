//! Elastic mode of the body in SIMD lanes.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]

use flexsc_dynamics::damping::DampingRule;
use flexsc_dynamics::predicted_crossing::PredictedMode;
use flexsc_numerics::lanes::LaneFloat;

/// Mode with its constants, its state at the start of the motion, and its state at the end. Aligned so that its
/// numbers do not straddle cache lines.
#[derive(Copy, Clone)]
#[repr(align(64))]
pub struct LaneMode<R, D> {
    /// Natural frequency (rad/s).
    pub frequency: R,
    /// Static displacement per unit of angular acceleration (s²).
    pub excitability: R,
    pub damping: D,
    /// Displacement from 0 and quadrature (rad), at the start and at the end of the motion.
    pub start: [R; 2],
    pub end: [R; 2],
}

impl<R: LaneFloat, D: DampingRule<R>> LaneMode<R, D> {
    /// Returns the mode about its equilibrium under an angular acceleration (rad/s²).
    #[inline(always)]
    pub fn about_equilibrium(&self, moment: R) -> PredictedMode<R, D> {
        let equilibrium = self.excitability * moment;
        PredictedMode {
            frequency: self.frequency,
            equilibrium,
            displacement: self.start[0] - equilibrium,
            quadrature: self.start[1],
            damping: self.damping,
        }
    }

    /// Stores the state at the end of the motion.
    #[inline(always)]
    pub fn store_end(&mut self, motion: &PredictedMode<R, D>) {
        self.end = [motion.equilibrium + motion.displacement, motion.quadrature];
    }
}
