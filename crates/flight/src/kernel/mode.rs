//! A mode of the body in the lanes of a flight.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]

use flexsc_motion::damping::Damping;
use flexsc_motion::guess::GuessOscillator;
use flexsc_motion::lanes::Real;

/// A mode: what it is, where it is at departure, and where the motion that departed ends. Its numbers do not straddle lines of
/// the cache.
#[derive(Copy, Clone)]
#[repr(align(64))]
pub struct LaneMode<R, D> {
    /// Natural frequency (rad/s).
    pub frequency: R,
    /// Static displacement for each unit of moment (s²).
    pub excitability: R,
    pub damping: D,
    /// Displacement from 0 and quadrature (rad).
    pub at: [R; 2],
    pub end: [R; 2],
}

impl<R: Real, D: Damping<R>> LaneMode<R, D> {
    /// The mode about its equilibrium under a moment.
    #[inline(always)]
    pub fn depart(&self, moment: R) -> GuessOscillator<R, D> {
        let equilibrium = self.excitability * moment;
        GuessOscillator {
            frequency: self.frequency,
            equilibrium,
            displacement: self.at[0] - equilibrium,
            quadrature: self.at[1],
            damping: self.damping,
        }
    }

    /// Keeps where the motion ends.
    #[inline(always)]
    pub fn arrive(&mut self, moved: &GuessOscillator<R, D>) {
        self.end = [moved.equilibrium + moved.displacement, moved.quadrature];
    }
}
