//! The certified search for the instant at which a guard trips.
//!
//! It strides only as far as the bounds on the arc prove that no guard can trip, so that no crossing is missed, however
//! brief, and no tolerance exists. `docs/events.md` derives the stride.

use crate::body::{Arc, Sight, State};
use crate::guard::Guard;
use crate::time::Span;

/// A guard that tripped.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Trip {
    /// The span since the arc's departure.
    pub after: Span,
    /// The index of the guard.
    pub guard: usize,
    /// What a sensor sees there.
    pub sight: Sight,
}

/// The first tick within `horizon` of departure at which one of the guards holds. The state there is put into
/// `state`.
pub fn locate(arc: &Arc, guards: &[Guard], horizon: Span, state: &mut State) -> Option<Trip> {
    let mut sight = arc.origin();
    if let Some(guard) = guards.iter().position(|guard| guard.holds(sight.angle)) {
        arc.at(0.0, state);
        return Some(Trip { after: Span::ZERO, guard, sight });
    }
    let first = |&guard| match arc.earliest(guard) {
        0.0 => arc.stride(guard, sight),
        jump => jump,
    };
    let mut stride = guards.iter().map(first).fold(f64::INFINITY, f64::min);
    // Ticks are counted in 64 bits, from the latest of a row of bases.
    let mut base = Span::ZERO;
    loop {
        let (base_s, last) = (base.seconds(), horizon.minus(base).leading_femtoseconds());
        let mut ticks = 0;
        while ticks < last && sight.angle.is_finite() {
            // The tick before the stride's end is certain not to trip: the next one is the first that can.
            ticks = ticks.saturating_add((stride * 1e15) as i64).saturating_add(1).min(last);
            sight = arc.at(base_s + ticks as f64 / 1e15, state);
            stride = f64::INFINITY;
            for (index, &guard) in guards.iter().enumerate() {
                if guard.holds(sight.angle) {
                    return Some(Trip { after: base + Span::from_femtoseconds(ticks), guard: index, sight });
                }
                if !arc.is_clear(guard, sight, stride) {
                    stride = stride.min(arc.stride(guard, sight));
                }
            }
        }
        base = base + Span::from_femtoseconds(last);
        if base >= horizon || !sight.angle.is_finite() {
            return None;
        }
    }
}
