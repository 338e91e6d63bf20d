//! When pulses come after the sample that decides them: how much of a push damps a mode, and how late it may come.

use std::f64::consts::{FRAC_PI_2, PI};

/// When a relay reads the elastic rate and pushes against it.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct PulseTiming {
    /// Time from one sample to the next (s); 0 for a relay that reads and pushes all the time.
    pub period: f64,
    /// Time from a sample to the push that it decides (s).
    pub delay: f64,
    /// How long a push lasts (s), at most the period.
    pub on_time: f64,
}

impl PulseTiming {
    /// The part of the time under thrust.
    pub fn duty(&self) -> f64 {
        if self.period > 0.0 { self.on_time / self.period } else { 1.0 }
    }

    /// Mean time from a sample to its push (s).
    pub fn mean_delay(&self) -> f64 {
        if self.period > 0.0 { self.delay + 0.5 * self.on_time } else { self.delay }
    }

    /// E(w) = (tau/T) cos(w (h + tau/2)) sin(w tau/2)/(w tau/2) with the delay h and the on-time tau in a period T: the
    /// relay takes (2 a/pi) E off the amplitude in each second. Averaged over the phase of the samples, so not where the
    /// mode's period is a small multiple of T. Ours.
    pub fn phase_factor(&self, frequency: f64) -> f64 {
        let half = if self.period > 0.0 { 0.5 * frequency * self.on_time } else { 0.0 };
        let blur = if half == 0.0 { 1.0 } else { libm::sin(half) / half };
        self.duty() * libm::cos(frequency * self.mean_delay()) * blur
    }

    /// The natural frequency from which on the relay no longer damps (rad/s), pi/(2 h + tau); infinite without any delay.
    /// A pure delay allows 1/(4 h) Hz (\[Timakov14\], page 50), a push over the whole period 1/(2 T) Hz at once and 1/(6 T) Hz
    /// one period late.
    pub fn frequency_limit(&self) -> f64 {
        FRAC_PI_2 / self.mean_delay()
    }

    /// The longest delay with which the relay damps a mode of this natural frequency (s): pi/(2 w) - tau/2.
    pub fn delay_limit(&self, frequency: f64) -> f64 {
        let on_time = if self.period > 0.0 { self.on_time } else { 0.0 };
        0.5 * (PI / frequency - on_time)
    }
}
