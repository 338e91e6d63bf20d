//! The envelope of undamped modes in lanes: what `estimator::envelope` does, to the bit.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#![allow(clippy::needless_range_loop, reason = "adaptors of iterators lack the processor's instructions")]

use crate::lanes::Real;
use crate::numerics::swing_integral::undamped;
use crate::numerics::trig::sincos;

/// One mode's phasor.
#[derive(Copy, Clone, Debug)]
pub struct Track<R> {
    /// Natural frequency (rad/s).
    pub frequency: R,
    /// Static displacement for each unit of moment (s²).
    pub excitability: R,
    /// The phasor in the turning frame; the axis of that frame now.
    pub frame: [R; 2],
    pub axis: [R; 2],
    /// The equilibrium, which is real, and the deviation from it now.
    pub equilibrium: R,
    pub deviation: [R; 2],
}

impl<R: Real> Track<R> {
    /// Follows the mode to a time (s), over a span (s), and returns the integral of its envelope over it.
    #[inline(always)]
    pub fn advance(&mut self, time: R, span: R) -> R {
        let (from, before) = (self.axis, self.deviation);
        let (sin, cos) = sincos(self.frequency * time);
        self.axis = [cos, sin];
        let [re, im] = self.frame;
        let re = re + self.equilibrium * (cos - from[0]);
        let im = im + self.equilibrium * (sin - from[1]);
        self.frame = [re, im];
        self.deviation = [(re * cos + im * sin) - self.equilibrium, im * cos - re * sin];
        undamped(self.equilibrium, [before, self.deviation], self.frequency, span)
    }

    /// Takes over a moment that holds from now on.
    #[inline(always)]
    pub fn command(&mut self, moment: R) {
        let equilibrium = self.excitability * moment;
        let shift = self.equilibrium - equilibrium;
        self.equilibrium = equilibrium;
        self.deviation[0] = self.deviation[0] + shift;
    }

    /// One or the other.
    #[inline(always)]
    pub fn select(mask: R::Mask, yes: &Self, no: &Self) -> Self {
        let mut one = *yes;
        for part in 0..2 {
            one.frame[part] = R::select(mask, yes.frame[part], no.frame[part]);
            one.axis[part] = R::select(mask, yes.axis[part], no.axis[part]);
            one.deviation[part] = R::select(mask, yes.deviation[part], no.deviation[part]);
        }
        one.equilibrium = R::select(mask, yes.equilibrium, no.equilibrium);
        one
    }
}
