//! The certified search for the instant at which a guard trips.
//!
//! It strides only as far as the bounds on the motion prove that no guard can trip, so that no crossing is missed, however
//! brief, and no tolerance exists. `docs/events.md` derives the stride.

use super::Sensed;
use crate::time::Span;

/// A guard that tripped.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Trip<S = Sensed> {
    /// The span since departure.
    pub after: Span,
    /// The index of the guard.
    pub guard: usize,
    /// What is seen there.
    pub sight: S,
}

/// A motion in closed form whose derivatives are bounded.
pub trait Approach {
    /// A level that is watched.
    type Guard: Copy;
    /// Where the motion is at one instant.
    type State;
    /// What is seen of it.
    type Sensed: Copy;

    /// What is seen at departure.
    fn begin(&self, state: &mut Self::State) -> Self::Sensed;
    /// The state `h` seconds after it, and what is seen.
    fn go(&self, h: f64, state: &mut Self::State) -> Self::Sensed;
    /// Whether it is a number.
    fn is_finite(state: &Self::State, sensed: Self::Sensed) -> bool;
    /// Whether a guard holds.
    fn holds(guard: Self::Guard, state: &Self::State, sensed: Self::Sensed) -> bool;
    /// For how long the bounds hold that are in use now (s).
    fn window(state: &Self::State) -> f64;
    /// A time after departure (s) before which the guard cannot trip, of a motion that lasts so long (s); 0 if it is not
    /// known at once.
    fn earliest(&self, guard: Self::Guard, horizon: Span, state: &Self::State) -> f64;
    /// A time (s) for which the guard cannot trip, given what is seen now.
    fn stride(&self, guard: Self::Guard, state: &Self::State, sensed: Self::Sensed) -> f64;
    /// Whether the guard cannot trip within a time (s), given what is seen now.
    fn is_clear(&self, guard: Self::Guard, state: &Self::State, sensed: Self::Sensed, time: f64) -> bool;
}

/// Strides after which a search asks whether it may go on.
const STRIDES: u32 = 256;

/// The first tick within `horizon` of departure at which one of the guards holds. The state there is put into
/// `state`.
///
/// # Errors
/// What `go_on` answers ends the search, however small its strides: it is asked now and then.
pub fn locate<M: Approach, E>(
    motion: &M,
    guards: &[M::Guard],
    horizon: Span,
    state: &mut M::State,
    mut go_on: impl FnMut() -> Result<(), E>,
) -> Result<Option<Trip<M::Sensed>>, E> {
    let mut sensed = motion.begin(state);
    if let Some(guard) = guards.iter().position(|guard| M::holds(*guard, state, sensed)) {
        motion.go(0.0, state);
        return Ok(Some(Trip { after: Span::ZERO, guard, sight: sensed }));
    }
    let first = |&guard| match motion.earliest(guard, horizon, state) {
        0.0 => motion.stride(guard, state, sensed),
        jump => jump,
    };
    let mut stride = guards.iter().map(first).fold(f64::INFINITY, f64::min);
    // Ticks are counted in 64 bits, from the latest of a row of bases.
    let mut base = Span::ZERO;
    let mut strides = 0_u32;
    loop {
        let (base_s, last) = (base.seconds(), horizon.minus(base).leading_femtoseconds());
        let mut ticks = 0;
        while ticks < last && M::is_finite(state, sensed) {
            strides = strides.wrapping_add(1);
            if strides.is_multiple_of(STRIDES) {
                go_on()?;
            }
            // The tick before the stride's end is certain not to trip: the next one is the first that can.
            ticks = ticks.saturating_add((stride * 1e15) as i64).saturating_add(1).min(last);
            sensed = motion.go(base_s + ticks as f64 / 1e15, state);
            stride = M::window(state);
            for (index, &guard) in guards.iter().enumerate() {
                if M::holds(guard, state, sensed) {
                    let after = base + Span::from_femtoseconds(ticks);
                    return Ok(Some(Trip { after, guard: index, sight: sensed }));
                }
                if !motion.is_clear(guard, state, sensed, stride) {
                    stride = stride.min(motion.stride(guard, state, sensed));
                }
            }
        }
        base = base + Span::from_femtoseconds(last);
        if base >= horizon || !M::is_finite(state, sensed) {
            return Ok(None);
        }
    }
}

/// The first root t >= 0 of gap - speed t - acceleration t²/2 for a gap >= 0, or infinity.
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
