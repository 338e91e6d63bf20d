//! Envelope of modes in SIMD lanes, equal to `estimator::envelope` to the bit.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#![allow(clippy::needless_range_loop, reason = "adaptors of iterators lack the processor's instructions")]

use flexsc_dynamics::damping::{DampingRule, Undamped};
use flexsc_numerics::exp_branch_free::exp;
use flexsc_numerics::lanes::{LaneFloat, Mask, SimdTask, SimdWidth4};
use flexsc_numerics::swing_damped::damped;
use flexsc_numerics::swing_integral::undamped;
use flexsc_numerics::trig::sincos;

/// Number of phasors per register group.
const SIDE: usize = SimdWidth4::LANES;

/// Phasor of one mode. Aligned so that its numbers do not straddle cache lines.
#[derive(Copy, Clone, Debug)]
#[repr(align(64))]
pub struct EnvelopePhasor<R, D> {
    /// Natural frequency (rad/s).
    pub frequency: R,
    /// Static displacement per unit of angular acceleration (s²).
    pub excitability: R,
    /// Real part of the equilibrium; the imaginary part follows from the damping.
    pub equilibrium: R,
    pub damping: D,
    pub now: PhasorState<R>,
}

/// State of a phasor at one instant.
#[derive(Copy, Clone, Debug)]
pub struct PhasorState<R> {
    /// Phasor in the rotating frame, and axis of that frame.
    pub frame: [R; 2],
    pub axis: [R; 2],
    /// Deviation from the equilibrium.
    pub deviation: [R; 2],
}

impl<R: LaneFloat, D: DampingRule<R>> EnvelopePhasor<R, D> {
    /// Returns the phasor at `time` (s), a span (s) later than now, and the integral of its envelope over the span.
    #[inline(always)]
    pub fn advance(&self, time: R, span: R) -> (PhasorState<R>, R) {
        if D::IS_DAMPED {
            return self.advance_damped(time, span);
        }
        let PhasorState { frame: [re, im], axis: from, deviation: before } = self.now;
        let (sin, cos) = sincos(self.frequency * time);
        let re = re + self.equilibrium * (cos - from[0]);
        let im = im + self.equilibrium * (sin - from[1]);
        let deviation = [(re * cos + im * sin) - self.equilibrium, im * cos - re * sin];
        let integral = undamped(self.equilibrium, [before, deviation], self.frequency, span);
        (PhasorState { frame: [re, im], axis: [cos, sin], deviation }, integral)
    }

    /// Advances a phasor as [`Self::advance`] does, for modes that may be damped.
    #[inline(always)]
    fn advance_damped(&self, time: R, span: R) -> (PhasorState<R>, R) {
        let (PhasorState { frame: [re, im], axis: from, deviation: before }, decay) =
            (self.now, self.damping.decay_rate(time));
        let damped_frequency = self.damping.frequency(self.frequency);
        let (sin, cos) = sincos(damped_frequency * time);
        let decay_factor = exp(-(decay * span));
        let equilibrium = self.imaginary(self.equilibrium);
        let (c, s) = (cos - from[0] * decay_factor, sin - from[1] * decay_factor);
        let re = re * decay_factor + (self.equilibrium * c - equilibrium * s);
        let im = im * decay_factor + (self.equilibrium * s + equilibrium * c);
        let deviation = [(re * cos + im * sin) - self.equilibrium, (im * cos - re * sin) - equilibrium];
        let ends = [before, deviation];
        let mut integral = damped([self.equilibrium, equilibrium], ends, decay, damped_frequency, span);
        let is_undamped = decay.le(decay.splat(0.0));
        if is_undamped.any() {
            let undamped = undamped(self.equilibrium, ends, self.frequency, span);
            integral = R::select(is_undamped, undamped, integral);
        }
        (PhasorState { frame: [re, im], axis: [cos, sin], deviation }, integral)
    }

    /// Returns the imaginary part of an equilibrium.
    #[inline(always)]
    fn imaginary(&self, equilibrium: R) -> R {
        if D::IS_DAMPED {
            (self.damping.decay_rate(equilibrium) * equilibrium) / self.damping.frequency(self.frequency)
        } else {
            equilibrium.splat(0.0)
        }
    }

    /// Sets the angular acceleration (rad/s²) that acts from now on.
    #[inline(always)]
    pub fn command(&mut self, moment: R) {
        let before = self.imaginary(self.equilibrium);
        let equilibrium = self.excitability * moment;
        let shift = self.equilibrium - equilibrium;
        self.equilibrium = equilibrium;
        self.now.deviation[0] = self.now.deviation[0] + shift;
        if D::IS_DAMPED {
            self.now.deviation[1] = self.now.deviation[1] + (before - self.imaginary(equilibrium));
        }
    }
}

impl<R: LaneFloat> PhasorState<R> {
    /// Selects one of two states per lane.
    #[inline(always)]
    pub fn select(mask: R::Mask, chosen: &Self, otherwise: &Self) -> Self {
        let mut one = *chosen;
        for part in 0..2 {
            one.frame[part] = R::select(mask, chosen.frame[part], otherwise.frame[part]);
            one.axis[part] = R::select(mask, chosen.axis[part], otherwise.axis[part]);
            one.deviation[part] = R::select(mask, chosen.deviation[part], otherwise.deviation[part]);
        }
        one
    }
}

/// Advances the undamped modes of one run to a time (s), over a span (s), in groups of four; adds the integrals of
/// their envelopes to `integral`.
#[inline(always)]
pub fn advance_group<R: LaneFloat, D: DampingRule<R>>(
    four: SimdWidth4,
    tracks: &mut [EnvelopePhasor<R, D>],
    time: R,
    span: R,
    mut integral: R,
) -> R {
    for group in tracks.chunks_mut(SIDE) {
        let count = group.len();
        let each = four.run(PhasorGroupTask { tracks: group, time: time.lane(0), span: span.lane(0) });
        for window_integral in &each[..count] {
            integral = integral + *window_integral;
        }
    }
    integral
}

/// SIMD task that advances at most four undamped modes of one run to a time (s), over a span (s).
struct PhasorGroupTask<'a, R, D> {
    tracks: &'a mut [EnvelopePhasor<R, D>],
    time: f64,
    span: f64,
}

impl<R: LaneFloat, D: DampingRule<R>> SimdTask for PhasorGroupTask<'_, R, D> {
    type Output = [f64; SIDE];

    #[inline(always)]
    fn run<K: LaneFloat>(self, kind: K) -> [f64; SIDE] {
        let last = self.tracks.len() - 1;
        // Unused lanes repeat the last phasor.
        macro_rules! load {
            ($($part:tt)+) => {{
                let mut each = [0.0; SIDE];
                for lane in 0..SIDE {
                    each[lane] = self.tracks[lane.min(last)].$($part)+.lane(0);
                }
                kind.load(&each)
            }};
        }
        let all = EnvelopePhasor {
            frequency: load!(frequency),
            excitability: load!(excitability),
            equilibrium: load!(equilibrium),
            damping: Undamped,
            now: PhasorState {
                frame: [load!(now.frame[0]), load!(now.frame[1])],
                axis: [load!(now.axis[0]), load!(now.axis[1])],
                deviation: [load!(now.deviation[0]), load!(now.deviation[1])],
            },
        };
        let (advanced, integral) = all.advance(kind.splat(self.time), kind.splat(self.span));
        macro_rules! store {
            ($($part:tt)+) => {{
                let mut each = [0.0; SIDE];
                advanced.$($part)+.store(&mut each);
                for lane in 0..=last {
                    let to = &mut self.tracks[lane].now.$($part)+;
                    *to = to.splat(each[lane]);
                }
            }};
        }
        for part in 0..2 {
            store!(frame[part]);
            store!(axis[part]);
            store!(deviation[part]);
        }
        let mut integrals = [0.0; SIDE];
        integral.store(&mut integrals);
        integrals
    }
}
