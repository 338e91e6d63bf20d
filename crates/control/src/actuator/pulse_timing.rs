//! Timing of pulses relative to their samples: how effectively they damp a mode, and the longest delay.

use std::f64::consts::{FRAC_PI_2, PI};

use flexsc_flight::pulse_timing::phase_factor;

/// Timing of a relay that reads the elastic rate and fires against it.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct PulseTiming {
    /// Time from one sample to the next (s); 0 for a relay that reads and fires continuously.
    pub period: f64,
    /// Time from a sample to its pulse (s).
    pub delay: f64,
    /// Length of a pulse (s), at most the period.
    pub on_time: f64,
}

impl PulseTiming {
    /// Returns the fraction of the time under thrust.
    pub fn duty(&self) -> f64 {
        if self.period > 0.0 { self.on_time / self.period } else { 1.0 }
    }

    /// Returns the mean time from a sample to its pulse (s).
    pub fn mean_delay(&self) -> f64 {
        if self.period > 0.0 { self.delay + 0.5 * self.on_time } else { self.delay }
    }

    /// Returns E(w) = (tau/T) cos(w (h + tau/2)) sin(w tau/2)/(w tau/2) with the delay h and the on-time tau in a
    /// period T: the relay reduces the amplitude by (2 a/pi) E per second. Averaged over the phase of the samples, so
    /// not valid where the mode's period is a small multiple of T. Our derivation.
    pub fn phase_factor(&self, frequency: f64) -> f64 {
        phase_factor(self.period, self.delay, self.on_time, frequency)
    }

    /// Returns the natural frequency from which on the relay no longer damps (rad/s), pi/(2 h + tau); infinite without
    /// any delay. A pure delay allows 1/(4 h) Hz (\[Timakov14\], page 50), a pulse over the whole period 1/(2 T) Hz
    /// without a delay and 1/(6 T) Hz with a delay of one period.
    pub fn frequency_limit(&self) -> f64 {
        FRAC_PI_2 / self.mean_delay()
    }

    /// Returns the longest delay with which the relay damps a mode of this natural frequency (s): pi/(2 w) - tau/2.
    pub fn delay_limit(&self, frequency: f64) -> f64 {
        let on_time = if self.period > 0.0 { self.on_time } else { 0.0 };
        0.5 * (PI / frequency - on_time)
    }
}
