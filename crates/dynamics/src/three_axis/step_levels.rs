//! Available step lengths and the error estimate that selects one: as long as the modes allow, halved as often as the
//! rotation requires. `step_size.rs` applies it to the present motion.
//!
//! Modes are exact oscillators, and their response to constant torques is exact: the error of a step is due to the
//! elastic motion that rotates with the body, in products with the body's rate. With steps of 1.5 rad of the fastest
//! mode coupled to the hub, the attitude error is below 1e-10 rad in 1e4 s of the reference spacecraft's tumbling;
//! with 3 rad, 2e-9 rad; beyond 20 rad the whole displacement of a mode may become a slow drift. A step is longer
//! than 1.5 rad of a mode only where this error, at the present amplitudes, is below [`DRIFT`]: if the body hardly
//! turns, or the modes hardly move. A mode above [`RESOLVED`] is never resolved; steps avoid multiples of its period.

use std::f64::consts::TAU;

use super::constants::{BodyConstants, ModeConstants, tensor};

/// Approximate maximum rotation of the body in a step (rad).
const MAX_ROTATION: f64 = 1.0 / 16.0;

/// Phase of the fastest mode per step at which it counts as resolved, whatever its amplitude (rad).
const PHASE: f64 = 1.5;

/// Maximum phase per step of imbalance excitation (rad): the relative error of the modes' response is below 1e-7.
pub const IMBALANCE_PHASE: f64 = 0.25;

/// Frequency above which modes do not shorten steps (rad/s); the shortest steps due to modes are 15 ms.
const RESOLVED: f64 = 100.0;

/// Minimum distance of a step's phase from multiples of an unresolved mode's period (rad).
const MIN_GAP: f64 = 0.3;

/// Maximum number of reductions of a step by 3 % to avoid such multiples.
const MAX_REDUCTIONS: u32 = 40;

/// Longest step of a body without modes (s).
const LONGEST: f64 = 1024.0;

/// Number of halvings from the longest step to one that resolves all modes.
const HALVINGS: i32 = 6;

/// Finest level, which is used where even its steps are too long.
const FINEST: usize = 60;

/// Admissible estimated attitude drift due to modes that a step does not resolve (rad/s): 1e-10 rad in 1e4 s.
/// Measured on the reference spacecraft, at rates from 1e-6 to 0.03 rad/s and modal rates of 1e-9 to 0.1 m
/// sqrt(kg)/s: less than 2e-15 rad/s where steps are on average at least twice as long as those that resolve all
/// modes. A value of 3e-14 here would give up to 8e-14 at 0.03 rad/s.
const DRIFT: f64 = 1e-14;

/// Duration over which the drift of undamped resonances accumulates (s).
const DURATION: f64 = 1e4;

/// Admissible attitude drift where steps resolve all modes (rad/s): large amplitudes on a turning body shorten steps
/// further.
const RESOLVED_DRIFT: f64 = 1e-11;

/// Fraction of a mode's displacement that is lost per step of 1 rad of its phase; scales with the sixth power of the
/// phase. Measured on the reference spacecraft from 1.5 to 23 rad, and rounded up.
const LOSS: f64 = 1e-8;

/// Available step lengths: level 0 is the longest, each further level about half of the previous one.
#[derive(Clone, Debug)]
pub(super) struct StepLevels {
    levels: Vec<StepLevel>,
    /// Approximate maximum rotation of the body in a step (rad).
    max_rotation: f64,
    modes: Vec<ModeRotationRate>,
    unresolved: Vec<f64>,
}

/// Steps of a level, before their length avoids multiples of periods.
#[derive(Clone, Debug)]
struct StepLevel {
    /// Step length (s).
    length: f64,
    /// True if the steps resolve all modes.
    is_resolved: bool,
    /// Fraction of each mode's displacement that is lost per step.
    losses: Vec<f64>,
}

/// Motion of the body at the start of a step, as upper bounds.
#[derive(Copy, Clone, Debug)]
pub(super) struct BodyMotion<'a> {
    /// Angular rate of the body, plus the rate of change of the environment (rad/s).
    pub rate: f64,
    /// Rate at which elastic effects rotate with the body and its momentum (rad/s).
    pub elastic_rotation_rate: f64,
    /// Angular acceleration of the body (rad/s²).
    pub acceleration: f64,
    /// Amplitude of each mode; `None` if unknown: steps then resolve all modes.
    pub amplitudes: Option<&'a [ModeAmplitude]>,
}

/// Amplitude of a mode (m sqrt(kg)).
#[derive(Copy, Clone, Debug, Default)]
pub(super) struct ModeAmplitude {
    /// Upper bound of the displacement.
    pub displacement: f64,
    /// Amplitude of the oscillation about the static deflection, which steps longer than the period do not resolve.
    pub oscillation: f64,
}

/// Effect of a mode on the attitude per unit of its amplitude: frequency (rad/s), rate of the hub (rad/s/(m
/// sqrt(kg))), and rotation of the body (rad/(m sqrt(kg))) with steps that resolve the mode, and with steps that do
/// not.
#[derive(Clone, Debug)]
struct ModeRotationRate {
    frequency: f64,
    hub_rate: f64,
    rotation: f64,
    unresolved: f64,
}

impl StepLevels {
    /// Computes the step levels of a body.
    pub fn new(model: &BodyConstants) -> Self {
        let coupled = &model.coupled_frequencies;
        let fastest = coupled.iter().copied().fold(0.0, f64::max).min(RESOLVED);
        let resolving = if fastest > 0.0 { PHASE / fastest } else { LONGEST };
        // Damping that couples modes is a force that only resolved modes represent correctly.
        let longest =
            if model.coupled_damping.is_some() { resolving } else { libm::scalbn(resolving, HALVINGS) };
        let modes = attitude_effects(model);
        Self {
            levels: step_levels(longest.min(LONGEST), resolving, &modes),
            max_rotation: MAX_ROTATION,
            modes,
            unresolved: coupled.iter().copied().filter(|w| *w > RESOLVED).collect(),
        }
    }

    /// Creates levels with one step length (s), whatever the rotation.
    #[cfg(test)]
    pub fn fixed(h: f64) -> Self {
        let levels = step_levels(h, h, &[]);
        Self { levels, max_rotation: f64::INFINITY, modes: Vec::new(), unresolved: Vec::new() }
    }

    /// Returns the level for a motion of the body: the first whose steps are short enough.
    pub fn level(&self, motion: BodyMotion<'_>) -> usize {
        let hub_rate = motion.amplitudes.map_or(0.0, |amplitudes| self.hub_rate_bound(amplitudes));
        // Non-finite motions need no short steps.
        let is_too_long = |level: &StepLevel| {
            let h = level.length;
            let turns = h * (motion.rate + motion.acceleration * h) > self.max_rotation;
            turns
                || match motion.amplitudes {
                    Some(amplitudes) => self.exceeds_drift(level, motion, hub_rate, amplitudes),
                    None => !level.is_resolved,
                }
        };
        self.levels[..FINEST].iter().position(|level| !is_too_long(level)).unwrap_or(FINEST)
    }

    /// Returns true if the estimated attitude drift in steps of a level exceeds the admissible one; `hub_rate` bounds the
    /// hub's rate due to oscillating modes (rad/s).
    fn exceeds_drift(
        &self,
        level: &StepLevel,
        motion: BodyMotion<'_>,
        hub_rate: f64,
        amplitudes: &[ModeAmplitude],
    ) -> bool {
        let drift = |((of, amplitude), loss): ((&ModeRotationRate, &ModeAmplitude), &f64)| {
            let rotation = if level.is_resolved {
                of.rotation * amplitude.displacement
            } else {
                of.unresolved * amplitude.oscillation
            };
            rotation * loss
        };
        // Unresolved modes also rotate each other.
        let (limit, hub_rate) = if level.is_resolved { (RESOLVED_DRIFT, 0.0) } else { (DRIFT, hub_rate) };
        let by = motion.elastic_rotation_rate + motion.acceleration * level.length + hub_rate;
        // The last mode, mostly the fastest, often exceeds the limit alone; the sum of non-negative terms is no
        // smaller.
        let last = self.modes.last().zip(amplitudes.last()).zip(level.losses.last());
        last.is_some_and(|last| by * drift(last) > limit)
            || by * self.modes.iter().zip(amplitudes).zip(&level.losses).map(drift).sum::<f64>() > limit
    }

    /// Returns an upper bound of the hub's rate due to oscillating modes (rad/s).
    fn hub_rate_bound(&self, amplitudes: &[ModeAmplitude]) -> f64 {
        let rate = |(of, amplitude): (&ModeRotationRate, &ModeAmplitude)| of.hub_rate * amplitude.oscillation;
        self.modes.iter().zip(amplitudes).map(rate).sum()
    }

    /// Returns `level`, or the first finer level whose steps resolve excitation at `frequency` (rad/s).
    pub fn level_for_frequency(&self, level: usize, frequency: f64) -> usize {
        let mut level = level;
        while frequency > 0.0 && frequency * self.length(level) > IMBALANCE_PHASE && level < FINEST {
            level += 1;
        }
        level
    }

    /// Returns the step length of a level (s), a number of few bits so that sums of steps are exact.
    pub fn length(&self, level: usize) -> f64 {
        let mut h = self.levels[level].length;
        let mut best = (0.0, few_bits(h));
        for _ in 0..MAX_REDUCTIONS {
            let candidate = few_bits(h);
            let gap = self.gap(candidate);
            if gap >= MIN_GAP {
                return candidate;
            }
            if gap > best.0 {
                best = (gap, candidate);
            }
            h *= 0.97;
        }
        best.1
    }

    /// Returns the least phase distance of a step from a multiple of an unresolved mode's period (rad).
    fn gap(&self, h: f64) -> f64 {
        let gap = |w: &f64| {
            let periods = libm::round(w * h / TAU);
            // A mode that is resolved at this level is not near any multiple.
            if periods < 1.0 { MIN_GAP } else { (w * h - periods * TAU).abs() }
        };
        self.unresolved.iter().map(gap).fold(MIN_GAP, f64::min)
    }
}

/// Returns all levels of a body with these modes, from the longest step and the step that resolves all modes (s).
fn step_levels(longest: f64, resolving: f64, modes: &[ModeRotationRate]) -> Vec<StepLevel> {
    let level = |h: f64| {
        let loss = |of: &ModeRotationRate| {
            let square = of.frequency * h * of.frequency * h;
            (LOSS * square * square * square).min(1.0)
        };
        StepLevel { length: h, is_resolved: h <= resolving, losses: modes.iter().map(loss).collect() }
    };
    std::iter::successors(Some(longest), |h| Some(0.5 * h)).take(FINEST + 1).map(level).collect()
}

/// Returns the effect of each mode's amplitude on the attitude: by the hub's rotation, by the change of the inertia,
/// and by coupling to slower modes through the change of inertia. The spurious force of an unresolved mode on a
/// slower one may be resonant: an undamped mode then grows throughout, a damped one up to 1/(2 zeta) of the force.
fn attitude_effects(model: &BodyConstants) -> Vec<ModeRotationRate> {
    let moments = |of: &ModeConstants| tensor(of.moments).norm();
    let couples = |of: &ModeConstants| of.rotation.norm() * moments(of) / of.frequency;
    let grows = |of: &ModeConstants| (1.0 / (2.0 * of.damping * of.frequency * DURATION)).min(1.0);
    let coupled: f64 = model.modes.iter().map(couples).sum();
    let resonant: f64 = model.modes.iter().map(|mode| couples(mode) * grows(mode)).sum();
    let each = model.modes.iter().map(|mode| {
        let by = |coupled: f64| {
            mode.rotation.norm() * (1.0 + mode.frequency * coupled) + moments(mode) * model.mobility
        };
        let hub_rate = mode.rotation.norm() * mode.frequency;
        ModeRotationRate {
            frequency: mode.frequency,
            hub_rate,
            rotation: by(coupled),
            unresolved: by(resonant),
        }
    });
    each.collect()
}

/// Returns the largest number of 12 significant bits that does not exceed `h`.
fn few_bits(h: f64) -> f64 {
    f64::from_bits(h.to_bits() & !((1 << 41) - 1))
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix3;

    use super::super::body::{FlexibleBody, FreeMode};
    use super::*;
    use flexsc_numerics::attitude::Vector;

    /// Returns the step levels of a body with modes of the given frequencies (rad/s).
    fn levels(frequencies: &[f64]) -> StepLevels {
        let mode = |w: &f64| FreeMode {
            frequency: *w,
            damping: 0.0,
            rotation: Vector::new(0.04, 0.0, 0.0),
            moments: Matrix3::zeros(),
        };
        let inertia = Matrix3::from_diagonal_element(300.0);
        let modes = frequencies.iter().map(mode).collect();
        StepLevels::new(&BodyConstants::new(&FlexibleBody { inertia, modes, damping: None }))
    }

    #[test]
    fn steps_resolve_slow_modes_follow_the_rotation_and_keep_off_aliases() {
        let levels = levels(&[1.1475, 50.4, 92.94]);
        let at = |rate, acceleration, amplitudes: &[f64]| {
            let amplitudes: Vec<_> =
                amplitudes.iter().map(|of| ModeAmplitude { displacement: *of, oscillation: *of }).collect();
            let h = levels.length(levels.level(BodyMotion {
                rate,
                elastic_rotation_rate: rate,
                acceleration,
                amplitudes: Some(&amplitudes),
            }));
            h * 92.94
        };
        // Moving modes must be resolved; with modes at rest, or a body that hardly turns, steps are longer.
        let phase = at(0.07, 0.0, &[1e-5; 3]);
        assert!(phase <= 1.5 && phase > 1.49, "{phase}");
        assert!(at(0.07, 0.0, &[1e-1; 3]) < 0.8);
        let unresolved = at(0.0, 0.0, &[1e-9; 3]);
        assert!(unresolved > 95.0, "{unresolved}");
        // On a body at rest, modes rotate each other.
        let phase = at(0.0, 0.0, &[1e-3; 3]);
        assert!(phase <= 1.5 && phase > 1.49, "{phase}");
        assert!(at(1e-6, 0.0, &[1e-6; 3]) > at(1e-3, 0.0, &[1e-6; 3]));
        assert!(at(6.0, 0.0, &[1e-9; 3]) < 0.8);
        // A torque alone shortens steps too.
        assert!(at(0.0, 1000.0, &[0.0; 3]) < 1.0);
        // Aliasing: 418.9 rad/s is a whole period in 15 ms.
        let levels = self::levels(&[1.0, TAU / 0.015, 3.0 * TAU / 0.0149]);
        for level in 0..9 {
            let h = levels.length(level);
            assert!(levels.gap(h) >= MIN_GAP, "{level} {h}");
            let longest = 0.96 / f64::from(1 << level);
            assert!(h <= longest && h > 0.5 * longest, "{level} {h}");
            // About 1e9 such steps add up without rounding.
            assert_eq!((h * 1e9 + h) - h * 1e9, h);
        }
        // Without modes, only rotation and torque count.
        let levels = self::levels(&[]);
        let motion =
            BodyMotion { rate: 1e-3, elastic_rotation_rate: 1e-3, acceleration: 0.0, amplitudes: Some(&[]) };
        assert!(levels.length(levels.level(motion)) * 1e-3 <= MAX_ROTATION);
    }

    #[test]
    fn what_damping_ends_makes_unresolved_steps_no_shorter() {
        let rates = |damping: f64| {
            let mode = |frequency: f64| FreeMode {
                frequency,
                damping,
                rotation: Vector::new(0.04, 0.0, 0.0),
                moments: Matrix3::from_diagonal_element(10.0),
            };
            let inertia = Matrix3::from_diagonal_element(300.0);
            let body = FlexibleBody { inertia, modes: vec![mode(1.0), mode(90.0)], damping: None };
            attitude_effects(&BodyConstants::new(&body))
        };
        for (undamped, damped) in rates(0.0).iter().zip(rates(0.005)) {
            assert_eq!((undamped.rotation, undamped.rotation), (undamped.unresolved, damped.rotation));
        }
        // Amplitude phi m/W of the slow mode, whose oscillation decays within 100 s of 1e4 s.
        let (alone, moments) = (0.04, 10.0 * f64::sqrt(3.0));
        let coupled = 0.04 * 90.0 * 0.04 * moments * (0.01 + 1e-2 / 90.0 / 90.0);
        let sum = alone + coupled + moments * f64::sqrt(3.0) / 300.0;
        let found = rates(0.005)[1].unresolved;
        assert!((found - sum).abs() < 1e-6 * sum, "{found} {sum}");
    }
}
