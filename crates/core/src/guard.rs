//! Guards: levels of the measured angle, and the certified search for the instant at which one is reached.
//!
//! The search strides only as far as the bound of |x''| on the arc proves that no guard can trip, so that
//! no crossing is missed, however brief, and no tolerance exists.

use crate::body::{Arc, Sight, State};
use crate::time::Span;

/// Which way a guard faces.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Side {
    /// Trips at or above its level.
    AtLeast,
    /// Trips at or below its level.
    AtMost,
}

impl Side {
    /// The direction of motion that closes the gap: +1 or -1.
    pub const fn sign(self) -> f64 {
        match self {
            Self::AtLeast => 1.0,
            Self::AtMost => -1.0,
        }
    }
}

/// A level of the measured angle. It is level-sensitive: it trips at once if it already holds when armed.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Guard {
    /// Which way it faces.
    pub side: Side,
    /// The angle (rad).
    pub level: f64,
}

impl Guard {
    /// A guard that trips at or above an angle (rad).
    pub const fn at_least(level: f64) -> Self {
        Self { side: Side::AtLeast, level }
    }

    /// A guard that trips at or below an angle (rad).
    pub const fn at_most(level: f64) -> Self {
        Self { side: Side::AtMost, level }
    }

    /// How far the angle is short of the level (rad): the guard holds at 0 and below.
    #[inline]
    pub fn gap(self, angle: f64) -> f64 {
        self.side.sign() * (self.level - angle)
    }

    /// Whether the guard holds.
    pub fn holds(self, angle: f64) -> bool {
        self.gap(angle) <= 0.0
    }
}

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
