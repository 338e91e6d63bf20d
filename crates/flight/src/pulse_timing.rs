//! Phase of pulses relative to the mode that they damp.

use crate::trigonometry::{cos, sin};

/// Returns (tau/T) cos(w (h + tau/2)) sin(w tau/2)/(w tau/2): how effectively pulses of length tau (s) after a delay h (s), in
/// cycles of a period T (s), damp a mode of frequency w (rad/s). With a period of 0 the relay fires continuously.
#[inline]
pub fn phase_factor(period: f64, delay: f64, on_time: f64, frequency: f64) -> f64 {
    let is_sampled: bool = period > 0.0;
    let half: f64 = if is_sampled { 0.5 * frequency * on_time } else { 0.0 };
    let blur: f64 = if half == 0.0 { 1.0 } else { sin(half) / half };
    let duty: f64 = if is_sampled { on_time / period } else { 1.0 };
    let mean_delay: f64 = if is_sampled { delay + 0.5 * on_time } else { delay };
    duty * cos(frequency * mean_delay) * blur
}
