//! How long steps are: as long as the modes allow, halved as often as the rotation needs.
//!
//! Modes are exact oscillators, and what constant torques do to them is exact: a step errs where the elastic motion turns
//! with the body, in products with the body's rate. Of 1.5 radians of the fastest mode that the hub feels, the attitude errs by
//! less than 1e-10 rad in 1e4 s of the reference craft's tumbling; of 3 radians by 2e-9; beyond 20 radians the whole
//! displacement of a mode may come out as a slow drift. A step is longer than 1.5 radians of a mode where this error, at the
//! amplitudes that the modes have, is below [`DRIFT`]: with a body that hardly turns, or modes that hardly move. A mode above
//! [`RESOLVED`] is left unresolved in any case; steps keep off the multiples of its period.

use std::f64::consts::TAU;

use super::model::{Constants, Model, tensor};

/// A step turns the body by at most about this (rad).
const TURN: f64 = 1.0 / 16.0;

/// The phase of the fastest mode that is resolved whatever its amplitude, in a step (rad).
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

/// How often the longest step is halved until it resolves all modes.
const DOUBLINGS: i32 = 6;

/// The attitude may drift so fast, by the estimate, for the sake of modes that a step does not resolve (rad/s): 1e-10 rad in
/// 1e4 s. Measured on the reference craft, at rates from 1e-6 to 0.03 rad/s and with modes that swing at 1e-9 to 0.1 m
/// sqrt(kg)/s: less than 2e-15 rad/s where steps are on average twice those that resolve all modes, or longer. With 3e-14 here,
/// it would be up to 8e-14 at 0.03 rad/s.
const DRIFT: f64 = 1e-14;

/// For so long (s).
const LASTS: f64 = 1e4;

/// The same where steps resolve all modes (rad/s): large amplitudes of a body that turns make steps shorter still.
const RESOLVED_DRIFT: f64 = 1e-11;

/// The part of a mode's displacement that a step of a radian of it loses, by the sixth power of the radians: measured on the
/// reference craft, from 1.5 to 23 radians, and rounded up.
const LOST: f64 = 1e-8;

/// The lengths that steps can have: 0 the longest, each next about half of it.
#[derive(Clone, Debug)]
pub(super) struct Pace {
    base: f64,
    /// A step turns the body by at most about this (rad).
    turn: f64,
    /// A step of this length resolves all modes (s).
    resolving: f64,
    modes: Vec<Turns>,
    unresolved: Vec<f64>,
}

/// How a body moves at the start of a step.
#[derive(Copy, Clone, Debug)]
pub(super) struct Pose<'a> {
    /// Its rate, at most (rad/s), with that of the surroundings.
    pub rate: f64,
    /// The rates at which what modes do turns with the body and with its momentum (rad/s).
    pub carried: f64,
    /// Its angular acceleration, at most (rad/s²).
    pub acceleration: f64,
    /// The amplitude of each mode where it is known: else steps resolve all modes.
    pub amplitudes: Option<&'a [Amplitude]>,
}

/// The amplitude of a mode (m sqrt(kg)).
#[derive(Copy, Clone, Debug, Default)]
pub(super) struct Amplitude {
    /// At most.
    pub most: f64,
    /// By which it swings about what holds it, and which no step longer than its period sees.
    pub swings: f64,
}

/// The frequency of a mode (rad/s), at what rate a unit of its amplitude turns the hub (rad/s/(m sqrt(kg))), and how much it turns
/// the body (rad/(m sqrt(kg))): where steps resolve it, and where they do not.
#[derive(Clone, Debug)]
struct Turns {
    frequency: f64,
    shakes: f64,
    turned: f64,
    unresolved: f64,
}

impl Pace {
    /// The pace of a body.
    pub fn new(model: &Model) -> Self {
        let felt = &model.felt;
        let fastest = felt.iter().copied().fold(0.0, f64::max).min(RESOLVED);
        let resolving = if fastest > 0.0 { PHASE / fastest } else { LONGEST };
        // Damping that couples modes is a force that only resolved modes feel rightly.
        let longest = if model.beside.is_some() { resolving } else { libm::scalbn(resolving, DOUBLINGS) };
        Self {
            base: longest.min(LONGEST),
            turn: TURN,
            resolving,
            modes: turning(model),
            unresolved: felt.iter().copied().filter(|w| *w > RESOLVED).collect(),
        }
    }

    /// Steps of one length (s), whatever the rotation.
    #[cfg(test)]
    pub fn fixed(h: f64) -> Self {
        Self { base: h, turn: f64::INFINITY, resolving: h, modes: Vec::new(), unresolved: Vec::new() }
    }

    /// The level of steps of a body in such a motion.
    pub fn level(&self, pose: Pose<'_>) -> usize {
        let mut level = 0;
        let mut h = self.base;
        // What is not finite needs no short steps.
        let drifts = |h: f64| match pose.amplitudes {
            Some(amplitudes) => {
                let most = if h > self.resolving { DRIFT } else { RESOLVED_DRIFT };
                self.drifts(h, pose, amplitudes, most)
            }
            None => h > self.resolving,
        };
        while level < 60 && (h * (pose.rate + pose.acceleration * h) > self.turn || drifts(h)) {
            h *= 0.5;
            level += 1;
        }
        level
    }

    /// Whether the attitude may drift faster than so (rad/s) for the sake of modes that steps of `h` seconds do not resolve.
    fn drifts(&self, h: f64, pose: Pose<'_>, amplitudes: &[Amplitude], most: f64) -> bool {
        let resolved = h <= self.resolving;
        let lost = |(of, amplitude): (&Turns, &Amplitude)| {
            let square = of.frequency * h * of.frequency * h;
            let turned = if resolved { of.turned * amplitude.most } else { of.unresolved * amplitude.swings };
            turned * (LOST * square * square * square).min(1.0)
        };
        // Modes that a step does not resolve turn each other too.
        let shaken = if resolved { 0.0 } else { self.shaken(amplitudes) };
        let by = pose.carried + pose.acceleration * h + shaken;
        // The last mode, mostly the fastest, is often too much alone: no sum of what is not negative is less than a part of it.
        let alone = self.modes.last().zip(amplitudes.last()).is_some_and(|last| by * lost(last) > most);
        alone || by * self.modes.iter().zip(amplitudes).map(lost).sum::<f64>() > most
    }

    /// The rate at which swinging modes turn the hub, at most (rad/s).
    fn shaken(&self, amplitudes: &[Amplitude]) -> f64 {
        let rate = |(of, amplitude): (&Turns, &Amplitude)| of.shakes * amplitude.swings;
        self.modes.iter().zip(amplitudes).map(rate).sum()
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

/// How much a unit of each mode's amplitude turns the body: by the hub's rotation, by the change of the inertia, and by what its
/// motion does to slower modes, which the inertia's change couples. What an unresolved mode seems to force a slower one by may
/// be at its resonance, where an undamped one grows all along, a damped one up to 1/(2 zeta) of the force.
fn turning(model: &Model) -> Vec<Turns> {
    let moments = |of: &Constants| tensor(of.moments).norm();
    let couples = |of: &Constants| of.rotation.norm() * moments(of) / of.frequency;
    let grows = |of: &Constants| (1.0 / (2.0 * of.damping * of.frequency * LASTS)).min(1.0);
    let coupled: f64 = model.modes.iter().map(couples).sum();
    let driven: f64 = model.modes.iter().map(|mode| couples(mode) * grows(mode)).sum();
    let each = model.modes.iter().map(|mode| {
        let by = |coupled: f64| {
            mode.rotation.norm() * (1.0 + mode.frequency * coupled) + moments(mode) * model.mobility
        };
        let shakes = mode.rotation.norm() * mode.frequency;
        Turns { frequency: mode.frequency, shakes, turned: by(coupled), unresolved: by(driven) }
    });
    each.collect()
}

/// The largest number of 12 bits that is not above `h`.
fn few_bits(h: f64) -> f64 {
    f64::from_bits(h.to_bits() & !((1 << 41) - 1))
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix3;

    use super::super::model::{Flexible, FreeMode};
    use super::*;
    use crate::attitude::Vector;

    /// The pace of a body with modes of these frequencies (rad/s).
    fn pace(frequencies: &[f64]) -> Pace {
        let mode = |w: &f64| FreeMode {
            frequency: *w,
            damping: 0.0,
            rotation: Vector::new(0.04, 0.0, 0.0),
            moments: Matrix3::zeros(),
        };
        let inertia = Matrix3::from_diagonal_element(300.0);
        let modes = frequencies.iter().map(mode).collect();
        Pace::new(&Model::new(&Flexible { inertia, modes, damping: None }))
    }

    #[test]
    fn steps_resolve_slow_modes_follow_the_rotation_and_keep_off_aliases() {
        let pace = pace(&[1.1475, 50.4, 92.94]);
        let at = |rate, acceleration, amplitudes: &[f64]| {
            let amplitudes: Vec<_> =
                amplitudes.iter().map(|of| Amplitude { most: *of, swings: *of }).collect();
            let h = pace.length(pace.level(Pose {
                rate,
                carried: rate,
                acceleration,
                amplitudes: Some(&amplitudes),
            }));
            h * 92.94
        };
        // Modes that move resolve; with those at rest, or a body that hardly turns, steps are longer.
        let phase = at(0.07, 0.0, &[1e-5; 3]);
        assert!(phase <= 1.5 && phase > 1.49, "{phase}");
        assert!(at(0.07, 0.0, &[1e-1; 3]) < 0.8);
        let unresolved = at(0.0, 0.0, &[1e-9; 3]);
        assert!(unresolved > 95.0, "{unresolved}");
        // Of a body at rest, modes turn each other.
        let phase = at(0.0, 0.0, &[1e-3; 3]);
        assert!(phase <= 1.5 && phase > 1.49, "{phase}");
        assert!(at(1e-6, 0.0, &[1e-6; 3]) > at(1e-3, 0.0, &[1e-6; 3]));
        assert!(at(6.0, 0.0, &[1e-9; 3]) < 0.8);
        // A torque alone makes steps shorter too.
        assert!(at(0.0, 1000.0, &[0.0; 3]) < 1.0);
        // 418.9 rad/s is a whole turn in 15 ms.
        let pace = self::pace(&[1.0, TAU / 0.015, 3.0 * TAU / 0.0149]);
        for level in 0..9 {
            let h = pace.length(level);
            assert!(pace.gap(h) >= NEAR, "{level} {h}");
            let longest = 0.96 / f64::from(1 << level);
            assert!(h <= longest && h > 0.5 * longest, "{level} {h}");
            // Some 1e9 of them add up without rounding.
            assert_eq!((h * 1e9 + h) - h * 1e9, h);
        }
        // Without modes, rotation and torque alone.
        let pace = self::pace(&[]);
        let pose = Pose { rate: 1e-3, carried: 1e-3, acceleration: 0.0, amplitudes: Some(&[]) };
        assert!(pace.length(pace.level(pose)) * 1e-3 <= TURN);
    }

    #[test]
    fn what_damping_ends_makes_unresolved_steps_no_shorter() {
        let turns = |damping: f64| {
            let mode = |frequency: f64| FreeMode {
                frequency,
                damping,
                rotation: Vector::new(0.04, 0.0, 0.0),
                moments: Matrix3::from_diagonal_element(10.0),
            };
            let inertia = Matrix3::from_diagonal_element(300.0);
            let body = Flexible { inertia, modes: vec![mode(1.0), mode(90.0)], damping: None };
            turning(&Model::new(&body))
        };
        for (undamped, damped) in turns(0.0).iter().zip(turns(0.005)) {
            assert_eq!((undamped.turned, undamped.turned), (undamped.unresolved, damped.turned));
        }
        // phi m/W of the slow mode, whose swing ends within 100 s of 1e4 s.
        let (alone, moments) = (0.04, 10.0 * f64::sqrt(3.0));
        let coupled = 0.04 * 90.0 * 0.04 * moments * (0.01 + 1e-2 / 90.0 / 90.0);
        let sum = alone + coupled + moments * f64::sqrt(3.0) / 300.0;
        let found = turns(0.005)[1].unresolved;
        assert!((found - sum).abs() < 1e-6 * sum, "{found} {sum}");
    }
}
