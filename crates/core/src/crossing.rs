//! The certified search for the instant at which a guard trips.
//!
//! It strides only as far as the bounds on the arc prove that no guard can trip, so that no crossing is missed, however
//! brief, and no tolerance exists. `docs/events.md` derives the stride.

use crate::body::{Arc, Sight, State};
use crate::guard::Guard;
use crate::record::{Record, RecordError};
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

/// Strides after which a search asks whether it may go on.
const STRIDES: u32 = 256;

/// The first tick within `horizon` of departure at which one of the guards holds. The state there is put into
/// `state`.
///
/// # Errors
/// The record ends the search, however small its strides.
pub fn locate(
    arc: &Arc,
    guards: &[Guard],
    horizon: Span,
    state: &mut State,
    record: &mut impl Record,
) -> Result<Option<Trip>, RecordError> {
    let mut sight = arc.origin();
    if let Some(guard) = guards.iter().position(|guard| guard.holds(sight.angle)) {
        arc.at(0.0, state);
        return Ok(Some(Trip { after: Span::ZERO, guard, sight }));
    }
    let first = |&guard| match arc.earliest(guard) {
        0.0 => arc.stride(guard, sight),
        jump => jump,
    };
    let mut stride = guards.iter().map(first).fold(f64::INFINITY, f64::min);
    // Ticks are counted in 64 bits, from the latest of a row of bases.
    let mut base = Span::ZERO;
    let mut strides = 0_u32;
    loop {
        let (base_s, last) = (base.seconds(), horizon.minus(base).leading_femtoseconds());
        let mut ticks = 0;
        while ticks < last && sight.angle.is_finite() {
            strides = strides.wrapping_add(1);
            if strides.is_multiple_of(STRIDES) {
                record.poll()?;
            }
            // The tick before the stride's end is certain not to trip: the next one is the first that can.
            ticks = ticks.saturating_add((stride * 1e15) as i64).saturating_add(1).min(last);
            sight = arc.at(base_s + ticks as f64 / 1e15, state);
            stride = f64::INFINITY;
            for (index, &guard) in guards.iter().enumerate() {
                if guard.holds(sight.angle) {
                    let after = base + Span::from_femtoseconds(ticks);
                    return Ok(Some(Trip { after, guard: index, sight }));
                }
                if !arc.is_clear(guard, sight, stride) {
                    stride = stride.min(arc.stride(guard, sight));
                }
            }
        }
        base = base + Span::from_femtoseconds(last);
        if base >= horizon || !sight.angle.is_finite() {
            return Ok(None);
        }
    }
}
