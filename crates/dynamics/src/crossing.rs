//! Certified search for the first instant at which a guard trips.
//!
//! The search strides only as far as bounds on the motion prove that no guard can trip, so that no crossing is
//! missed, however brief, and no tolerance is needed. `docs/events.md` derives the stride.

use flexsc_numerics::time::Span;

use super::AngleObservation;
use super::guard::Guard;

/// Guard that tripped, with the instant and the observation there.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Crossing<S = AngleObservation> {
    /// Time since the start of the segment.
    pub after: Span,
    /// Index of the guard.
    pub guard: usize,
    /// Observation at the instant of the trip.
    pub observation: S,
}

/// Motion in closed form with bounded derivatives, on which guards can be searched.
pub trait BoundedMotion {
    /// Threshold that is monitored.
    type Guard: Copy;
    /// Scratch state of the motion at one instant, with its bounds.
    type State;
    /// Observed quantities at one instant.
    type Observation: Copy;

    /// Evaluates the start of the segment and returns the observation there.
    fn initial(&self, state: &mut Self::State) -> Self::Observation;
    /// Evaluates the motion `h` (s) after the start of the segment and returns the observation.
    fn evaluate(&self, h: f64, state: &mut Self::State) -> Self::Observation;
    /// Returns true if the evaluated motion is finite.
    fn is_finite(state: &Self::State, sensed: Self::Observation) -> bool;
    /// Returns true if the guard's condition holds.
    fn holds(guard: Self::Guard, state: &Self::State, sensed: Self::Observation) -> bool;
    /// Returns the time for which the current bounds are valid (s).
    fn bounds_valid_for(state: &Self::State) -> f64;
    /// Returns a time (s) after the start of the segment before which the guard cannot trip, for a motion of length
    /// `horizon`; 0 if none is known at once.
    fn earliest_crossing(&self, guard: Self::Guard, horizon: Span, state: &Self::State) -> f64;
    /// Returns a time (s) for which the guard cannot trip, starting at the current instant.
    fn safe_stride(&self, guard: Self::Guard, state: &Self::State, sensed: Self::Observation) -> f64;
    /// Returns true if the guard cannot trip within `time` (s) from the current instant.
    fn has_no_crossing(
        &self,
        guard: Self::Guard,
        state: &Self::State,
        sensed: Self::Observation,
        time: f64,
    ) -> bool;
}

/// Upper bounds of |x''| (rad/s²) and |x'''| (rad/s³) of an angle x on a segment.
#[derive(Copy, Clone, Debug, Default)]
pub struct DerivativeBounds {
    /// Upper bound of |x''| (rad/s²).
    pub curvature: f64,
    /// Upper bound of |x'''| (rad/s³).
    pub jerk: f64,
}

impl DerivativeBounds {
    /// Returns a time (s) for which the guard cannot trip, given the present motion.
    ///
    /// With the bounds M of |x''| and J of |x'''| the gap left after t is at least gap - speed t - M t²/2, and at least
    /// gap - speed t - a t²/2 - J t³/6 with the acceleration a now. Let q be the first root of gap - speed t - a t²/2.
    /// Up to q, J t³/6 is at most (J q/3) t²/2, so that the first root with the acceleration a + J q/3, which is not
    /// after q, is certain too. The lesser of the two accelerations gives the longer stride.
    #[inline]
    pub fn safe_stride(self, guard: Guard, now: AngleObservation) -> f64 {
        let towards = guard.side.sign();
        let (gap, speed, acceleration) =
            (guard.gap(now.angle), towards * now.rate, towards * now.acceleration);
        let q = first_root(gap, speed, acceleration);
        // Without modes an infinite q makes J q a NaN, and the minimum selects M.
        first_root(gap, speed, self.curvature.min(acceleration + self.jerk * q / 3.0))
    }

    /// Returns true if the guard cannot trip within `time` (s), given the present motion.
    #[inline]
    pub fn has_no_crossing(self, guard: Guard, now: AngleObservation, time: f64) -> bool {
        let speed = guard.side.sign() * now.rate;
        guard.gap(now.angle) > time * (speed + 0.5 * self.curvature * time)
    }
}

/// Number of strides between two calls of `poll` (cancellation check).
const STRIDES: u32 = 256;

/// Returns the first tick within `horizon` of the start of the segment at which one of the guards holds; the state
/// there is left in `state`.
///
/// # Errors
/// The error of `go_on`, which is called regularly, ends the search, however small its strides are.
pub fn first_crossing<M: BoundedMotion, E>(
    motion: &M,
    guards: &[M::Guard],
    horizon: Span,
    state: &mut M::State,
    mut poll: impl FnMut() -> Result<(), E>,
) -> Result<Option<Crossing<M::Observation>>, E> {
    let mut sensed = motion.initial(state);
    if let Some(guard) = guards.iter().position(|guard| M::holds(*guard, state, sensed)) {
        motion.evaluate(0.0, state);
        return Ok(Some(Crossing { after: Span::ZERO, guard, observation: sensed }));
    }
    let first = |&guard| match motion.earliest_crossing(guard, horizon, state) {
        0.0 => motion.safe_stride(guard, state, sensed),
        jump => jump,
    };
    let mut stride = guards.iter().map(first).fold(f64::INFINITY, f64::min);
    // Ticks are counted in 64 bits, relative to a base that advances.
    let mut base = Span::ZERO;
    let mut strides = 0_u32;
    loop {
        let (base_s, last) = (base.seconds(), horizon.remaining_after(base).leading_femtoseconds());
        let mut ticks = 0;
        while ticks < last && M::is_finite(state, sensed) {
            strides = strides.wrapping_add(1);
            if strides.is_multiple_of(STRIDES) {
                poll()?;
            }
            // The tick before the stride's end cannot trip: the next one is the first that can.
            ticks = ticks.saturating_add((stride * 1e15) as i64).saturating_add(1).min(last);
            sensed = motion.evaluate(base_s + ticks as f64 / 1e15, state);
            stride = M::bounds_valid_for(state);
            for (index, &guard) in guards.iter().enumerate() {
                if M::holds(guard, state, sensed) {
                    let after = base + Span::from_femtoseconds(ticks);
                    return Ok(Some(Crossing { after, guard: index, observation: sensed }));
                }
                if !motion.has_no_crossing(guard, state, sensed, stride) {
                    stride = stride.min(motion.safe_stride(guard, state, sensed));
                }
            }
        }
        base = base + Span::from_femtoseconds(last);
        if base >= horizon || !M::is_finite(state, sensed) {
            return Ok(None);
        }
    }
}

/// Returns the first root t >= 0 of gap - speed t - acceleration t²/2 for a gap >= 0, or infinity.
#[inline]
pub fn first_root(gap: f64, speed: f64, acceleration: f64) -> f64 {
    let discriminant = speed * speed + 2.0 * acceleration * gap;
    if discriminant < 0.0 {
        return f64::INFINITY;
    }
    let root = f64::sqrt(discriminant);
    if speed > 0.0 {
        2.0 * gap / (speed + root)
    } else if acceleration > 0.0 {
        (root - speed) / acceleration
    } else {
        f64::INFINITY
    }
}
