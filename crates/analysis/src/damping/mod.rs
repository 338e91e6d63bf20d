//! Active damping of an elastic mode by the spacecraft's own relay thrusters, in closed form.
//!
//! The thrusters push against the elastic rate g' that an observer estimates: g'' + 2 zeta w g' + w² g = -a sign g',
//! with a = mu m, the influence of the thrusters times their rigid acceleration (\[Timakov14\], page 48). The module
//! also analyses the convergence of this adaptive observer.

mod convergence;
mod excitation;
mod floquet;
mod relay_decay;

use flexsc_control::actuator::PulseTiming;
use flexsc_numerics::delay_margin::delay_margin;
use flexsc_numerics::quantity::shortest;
use serde::Serialize;

pub use convergence::{Convergence, RegionEdge};
pub use excitation::{Excitation, persistence};
pub use floquet::GainMargin;
pub use relay_decay::Decay;

/// No mode turns further (rad) from a sample to its push.
const FARTHEST: f64 = 1e5;

/// Result of active damping of one mode by a relay.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct DampedMode {
    /// Natural frequency (rad/s).
    pub frequency_rad_s: f64,
    /// Fraction of the push that damps: negative where the push drives the mode.
    pub phase_factor: f64,
    /// Decrease rate of the amplitude of the elastic rate by the relay, at any amplitude (rad/s²).
    pub slope_rad_s2: f64,
    /// Longest delay with which the relay still damps (s); negative where it does not even without a delay.
    pub delay_limit_s: f64,
    /// Largest stable gain of a linear rate feedback with the mean delay (1/s); none without a delay.
    pub gain_limit_1_s: Option<f64>,
    /// Amplitude of the limit cycle in which the relay ends (rad/s); none without a delay.
    pub limit_cycle_rate_rad_s: Option<f64>,
    /// Frequency of the limit cycle in which the relay ends (rad/s); none without a delay.
    pub limit_cycle_frequency_rad_s: Option<f64>,
    /// Time in which the amplitude falls to the threshold (s); none if it does not.
    pub decay_s: Option<f64>,
    /// Time under thrust within `decay_s` (s).
    pub thrust_s: Option<f64>,
}

/// Relay that damps modes of one damping ratio.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct PulsedDamping {
    /// Timing of the relay's pushes.
    pub timing: PulseTiming,
    /// Damping ratio of the modes.
    pub damping: f64,
    /// Elastic acceleration a of a push (rad/s²).
    pub acceleration: f64,
    /// Amplitude of the elastic rate at the start (rad/s).
    pub amplitude: f64,
    /// Amplitude below which no thruster fires (rad/s).
    pub threshold: f64,
}

impl PulsedDamping {
    /// Returns the name of the first number that is out of range, and the reason.
    pub fn inconsistency(&self) -> Option<(&'static str, String)> {
        let Self { timing, damping, acceleration, amplitude, threshold } = *self;
        let from_zero = [
            ("period", timing.period),
            ("delay", timing.delay),
            ("on_time", timing.on_time),
            ("amplitude", amplitude),
            ("threshold", threshold),
        ];
        if let Some((name, value)) = from_zero.into_iter().find(|(_, value)| !(0.0..1e100).contains(value)) {
            return Some((name, format!("must be a number of 0 or more, got {}", shortest(value))));
        }
        if !(0.0..1.0).contains(&damping) {
            return Some(("damping", format!("must be 0 or more and below 1, got {}", shortest(damping))));
        }
        if !(acceleration > 0.0 && acceleration < 1e100) {
            return Some((
                "acceleration",
                format!("must be a positive number, got {}", shortest(acceleration)),
            ));
        }
        let PulseTiming { period, on_time, .. } = timing;
        if period > 0.0 && !(on_time > 0.0 && on_time <= period) {
            return Some((
                "on_time",
                format!("must be above 0 and at most the period of {period} s, got {on_time}"),
            ));
        }
        None
    }

    /// Returns why natural frequencies (rad/s) cannot be analysed with this relay: the pushes come too many turns of a
    /// mode after their samples. The work grows with these turns, and real loops have few.
    pub fn beyond(&self, frequencies: &[f64]) -> Option<String> {
        let (fastest, delay) = (frequencies.iter().copied().fold(0.0, f64::max), self.timing.mean_delay());
        (fastest * delay > FARTHEST).then(|| {
            format!(
                "must be at most {FARTHEST:e} rad later than its sample for each mode: at {} rad/s a push comes {} s after it, on average",
                shortest(fastest),
                shortest(delay)
            )
        })
    }

    /// Returns the result of the relay for a mode of each of these natural frequencies (rad/s).
    pub fn table(&self, frequencies: &[f64]) -> Vec<DampedMode> {
        frequencies.iter().map(|frequency| self.mode(*frequency)).collect()
    }

    /// Computes the effect of the relay on a mode of this natural frequency (rad/s).
    pub fn mode(&self, frequency: f64) -> DampedMode {
        let Self { timing, damping, acceleration, amplitude, threshold } = *self;
        let factor = timing.phase_factor(frequency);
        let decay = Decay::new(acceleration * factor, damping * frequency);
        let margin = delay_margin(frequency, timing.mean_delay(), damping);
        let reached = decay.threshold_time(amplitude, threshold);
        let thrust = decay.thrust_time(amplitude, threshold);
        DampedMode {
            frequency_rad_s: frequency,
            phase_factor: factor,
            slope_rad_s2: decay.slope,
            delay_limit_s: timing.delay_limit(frequency),
            gain_limit_1_s: margin.map(|margin| margin.gain),
            limit_cycle_rate_rad_s: margin.map(|margin| margin.limit_cycle(acceleration * timing.duty())),
            limit_cycle_frequency_rad_s: margin.map(|margin| margin.frequency),
            decay_s: reached,
            thrust_s: thrust.map(|time| time * timing.duty()),
        }
    }
}
