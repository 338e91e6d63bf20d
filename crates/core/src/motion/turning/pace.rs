//! How long steps are: a base length that resolves the modes, halved as often as the rotation needs.
//!
//! Of 1.5 radians of the fastest mode that the hub feels, the attitude errs by less than 1e-10 rad in 1e4 s of the reference
//! craft's tumbling; of 3 radians by 2e-9. A mode above [`RESOLVED`] is left unresolved: it stays an exact oscillator, and what
//! is lost is what steps make of it that are a multiple of its period, a slow error of up to 1e-8 rad/s for each 2e-5 rad/s of
//! its rate at the hub. Steps keep off such multiples.

use std::f64::consts::TAU;

/// A step turns the body by at most about this (rad).
const TURN: f64 = 1.0 / 16.0;

/// The phase of the fastest mode that is resolved, in a step (rad).
const PHASE: f64 = 1.5;

/// The phase of what shakes the body, in a step (rad): what modes make of it errs by less than 1e-7 of itself.
pub const SHAKE: f64 = 0.25;

/// Modes above this frequency make no step shorter (rad/s): steps of 15 ms are the shortest for the sake of modes.
const RESOLVED: f64 = 100.0;

/// So near to a multiple of its period a step is not to be to that of an unresolved mode (rad).
const NEAR: f64 = 0.3;

/// A step is shortened so often at most, by 3 % each time.
const NUDGES: u32 = 40;

/// The longest step of a body without modes (s).
const LONGEST: f64 = 1024.0;

/// The lengths that steps can have: 0 the longest, each next about half of it.
#[derive(Clone, Debug)]
pub(super) struct Pace {
    base: f64,
    /// A step turns the body by at most about this (rad).
    turn: f64,
    unresolved: Vec<f64>,
}

impl Pace {
    /// The pace for modes of these frequencies (rad/s).
    pub fn new(felt: &[f64]) -> Self {
        let resolved = felt.iter().copied().filter(|w| *w <= RESOLVED).fold(0.0, f64::max);
        let unresolved: Vec<f64> = felt.iter().copied().filter(|w| *w > RESOLVED).collect();
        let fastest = if unresolved.is_empty() { resolved } else { RESOLVED };
        Self { base: if fastest > 0.0 { PHASE / fastest } else { LONGEST }, turn: TURN, unresolved }
    }

    /// Steps of one length (s), whatever the rotation.
    #[cfg(test)]
    pub fn fixed(h: f64) -> Self {
        Self { base: h, turn: f64::INFINITY, unresolved: Vec::new() }
    }

    /// The level of steps of a body that turns, or whose torque changes, at this rate (rad/s), with this acceleration
    /// (rad/s²).
    pub fn level(&self, rate: f64, acceleration: f64) -> usize {
        let mut level = 0;
        let mut h = self.base;
        // What is not finite needs no short steps.
        while h * (rate + acceleration * h) > self.turn && level < 60 {
            h *= 0.5;
            level += 1;
        }
        level
    }

    /// This level, or the first beyond it whose steps follow what shakes the body at a frequency (rad/s).
    pub fn resolving(&self, level: usize, frequency: f64) -> usize {
        let mut level = level;
        while frequency > 0.0 && frequency * self.length(level) > SHAKE && level < 60 {
            level += 1;
        }
        level
    }

    /// The length of a step (s), a number of few bits so that sums of steps are exact.
    pub fn length(&self, level: usize) -> f64 {
        let longest = (0..level).fold(self.base, |h, _| 0.5 * h);
        let mut best = (0.0, few_bits(longest));
        let mut h = longest;
        for _ in 0..NUDGES {
            let candidate = few_bits(h);
            let gap = self.gap(candidate);
            if gap >= NEAR {
                return candidate;
            }
            if gap > best.0 {
                best = (gap, candidate);
            }
            h *= 0.97;
        }
        best.1
    }

    /// The least phase by which a step misses a multiple of an unresolved mode's period (rad).
    fn gap(&self, h: f64) -> f64 {
        let gap = |w: &f64| {
            let turns = libm::round(w * h / TAU);
            // What is resolved at this level is near none.
            if turns < 1.0 { NEAR } else { (w * h - turns * TAU).abs() }
        };
        self.unresolved.iter().map(gap).fold(NEAR, f64::min)
    }
}

/// The largest number of 12 bits that is not above `h`.
fn few_bits(h: f64) -> f64 {
    f64::from_bits(h.to_bits() & !((1 << 41) - 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_resolve_slow_modes_follow_the_rotation_and_keep_off_aliases() {
        let pace = Pace::new(&[1.1475, 50.4, 92.94]);
        let h = pace.length(0);
        assert!(h * 92.94 <= 1.5 && h * 92.94 > 1.49, "{h}");
        assert_eq!(pace.level(0.07, 0.0), 0);
        assert_eq!(pace.level(6.0, 0.0), 1);
        // A torque alone makes steps shorter too.
        assert!(pace.level(0.0, 1000.0) > 0);
        // 418.9 rad/s is a whole turn in 15 ms.
        let pace = Pace::new(&[1.0, TAU / 0.015, 3.0 * TAU / 0.0149]);
        for level in 0..3 {
            let h = pace.length(level);
            assert!(pace.gap(h) >= NEAR, "{level} {h}");
            assert!(h <= 0.015 / f64::from(1 << level) && h > 0.008 / f64::from(1 << level));
            // Some 1e9 of them add up without rounding.
            assert_eq!((h * 1e9 + h) - h * 1e9, h);
        }
        // Without modes, rotation and torque alone.
        let pace = Pace::new(&[]);
        assert!(pace.length(pace.level(1e-3, 0.0)) * 1e-3 <= TURN);
    }
}
