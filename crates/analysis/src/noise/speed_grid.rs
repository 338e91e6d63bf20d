//! Speeds of unbalanced wheels at which a sampled loop resonates.
//!
//! The line of a harmonic at the frequency w excites a resonance of the closed loop, whose angle in a period T is theta, where w T =
//! +-theta + 2 pi k. For k = 0 or the turns of a mode that is what moves, else it is an alias, far above the resonance. All are at
//! known speeds, and narrow: steps over the speed pass most of them by.

use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;

use crate::eigenvalues::eigenvalues;
use crate::margins::{resonances, steady_change};
use crate::open_loop::{LoopParts, OpenLoop};

/// Largest number of speeds that are examined beside the steps: those of the modes, then aliases of the lowest frequencies.
const MOST_EXAMINED: usize = 400;
/// Distance of two resonances, relative to the half width of the narrower one, below which one speed shows both.
const APART: f64 = 0.5;
/// Angle (rad) within which the resonance of a mode has the angle of its natural frequency, relative to that frequency.
const OWN: f64 = 0.1;

/// Speed at which a harmonic meets a resonance.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ResonantSpeed {
    /// Speed of the wheel (rad/s).
    pub speed: f64,
    /// Half width of the peak (rad/s).
    pub width: f64,
}

/// Returns the speeds between two (rad/s) at which harmonics of these orders meet resonances of a loop that are narrower than
/// `step`, in increasing order: at most [`MOST_EXAMINED`].
///
/// # Errors
/// See [`OpenLoop::from_scenario`].
pub fn resonant_speeds(
    parts: &LoopParts<'_>,
    orders: &[f64],
    [least, largest]: [f64; 2],
    step: f64,
) -> Result<Vec<ResonantSpeed>, ConfigError> {
    let opened = OpenLoop::from_parts(parts)?;
    let closed = opened.transfer.sensitivity().and_then(|closed| eigenvalues(&closed.a)).unwrap_or_default();
    let own: Vec<f64> =
        eigenvalues(&parts.body.a).unwrap_or_default().iter().map(|pole| pole.im.abs()).collect();
    let mut found: Vec<(f64, ResonantSpeed)> = Vec::new();
    // A motion without damping has no peak of a finite height.
    let damped = |resonance: &(f64, f64)| resonance.1 > steady_change(opened.period);
    for (angle, width) in resonances(&closed, APART).into_iter().filter(damped) {
        for order in orders {
            let turns = libm::ceil(order * largest * opened.period / TAU) as i64;
            for turned in (0..=turns).flat_map(|turn| [angle, -angle].map(|own| own + TAU * turn as f64)) {
                let frequency = turned / opened.period;
                let peak = ResonantSpeed { speed: frequency / order, width: width / (opened.period * order) };
                if peak.width > 0.5 * step || !(least..=largest).contains(&peak.speed) {
                    continue;
                }
                let is_own = own.iter().any(|own| *own > 0.0 && (frequency / own - 1.0).abs() < OWN);
                found.push((if is_own { 0.0 } else { angle }, peak));
            }
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.speed.total_cmp(&b.1.speed)));
    found.truncate(MOST_EXAMINED);
    let mut peaks: Vec<ResonantSpeed> = found.into_iter().map(|(_, peak)| peak).collect();
    peaks.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    peaks.dedup_by(|later, kept| later.speed - kept.speed <= APART * later.width.min(kept.width));
    Ok(peaks)
}
