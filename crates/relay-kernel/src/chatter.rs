//! Switching without end: more switchings than a motion can need, in a span in which no mode has moved.

/// Number of switchings in a window: whole cycles of the relay law, as the kernel checks at the end of a cycle.
pub const SWITCHINGS: u64 = 3 * CYCLES;
/// Cycles of a window.
pub const CYCLES: u64 = 341;
/// The part of the shortest period that a window lasts at least.
const PART: f64 = 1e-3;
/// A body without modes, or with slow ones, has no shorter windows than of such a period (s).
const SLOWEST: f64 = 1.0;

/// Returns the shortest span (s) of a window of switchings without chatter, for a body whose fastest mode has this
/// frequency (rad/s), 0 without modes.
pub fn shortest_window(fastest: f64) -> f64 {
    PART * (std::f64::consts::TAU / fastest).min(SLOWEST)
}
