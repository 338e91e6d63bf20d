//! Settings of active damping with the phase-plane law, and the default of its threshold.

use flexsc_flight::active_damping::DampingLaw;
use flexsc_numerics::delay_margin::delay_margin;
use flexsc_numerics::quantity::{Fraction, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Authority;

/// Factors of the default threshold: on the amplitude of the limit cycle, and cycles of elastic acceleration at least.
const LIMIT_CYCLES: f64 = 1.5;
const CYCLES: f64 = 2.0;

/// Active damping.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ActiveDamping {
    /// Elastic rate about each axis above which the jets fire (rad/s), three numbers, of which one axis uses the
    /// first; default, for the mode that a long burn excites most: 1.5 times the amplitude of the limit cycle due
    /// to the delay, and at least the change by two whole cycles of firing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub threshold: Option<[Positive; 3]>,
    /// Fraction of the threshold at which the pulses of active damping stop.
    pub release: Fraction,
    /// Whether a pulse is only as long as it takes to stop the elastic motion; otherwise it fills the cycle.
    pub pulse_width: bool,
    /// Whether the elastic rate is predicted for the middle of the next pulse.
    pub predictor: bool,
    /// Guards against exciting the motion.
    pub guards: DampingGuards,
}

/// Guards of active damping.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a key that stands alone")]
pub struct DampingGuards {
    /// Suppress pulses after which the rigid motion would need one.
    pub dead_zone: bool,
    /// Without the predictor, damp only modes whose phase factor is at least 0.5.
    pub eligibility: bool,
    /// Act only while the observer tracks: the mean square innovation is below a tenth of that of the elastic rate,
    /// or below (3.16e-6 rad/s)².
    pub residual: bool,
    /// Pause active damping for 300 cycles if the mean elastic rate of 75 cycles with a pulse exceeds 0.9 times
    /// that of the 75 before.
    pub watchdog: bool,
}

impl Default for ActiveDamping {
    fn default() -> Self {
        let guards = DampingGuards::default();
        Self { threshold: None, release: Fraction::HALF, pulse_width: true, predictor: true, guards }
    }
}

impl Default for DampingGuards {
    fn default() -> Self {
        Self { dead_zone: true, eligibility: true, residual: true, watchdog: true }
    }
}

impl ActiveDamping {
    /// Returns the threshold about an axis (rad/s): the given one, or that of the mode that a long burn excites most.
    /// Each of `modes` has a frequency (rad/s) and an elastic acceleration a (rad/s²); `period` and `delay` are in s,
    /// `damping` is a ratio.
    pub fn threshold(&self, axis: usize, modes: &[[f64; 2]], period: f64, delay: f64, damping: f64) -> f64 {
        if let Some(threshold) = &self.threshold {
            return threshold[axis].get();
        }
        let curve_point = |[frequency, acceleration]: &[f64; 2]| {
            let margin = delay_margin(*frequency, delay, damping);
            let cycle = margin.map_or(0.0, |margin| margin.limit_cycle(*acceleration));
            (LIMIT_CYCLES * cycle).max(CYCLES * acceleration * period)
        };
        let excited = |[frequency, acceleration]: &[f64; 2]| acceleration / frequency;
        modes.iter().max_by(|a, b| excited(a).total_cmp(&excited(b))).map_or(0.0, curve_point)
    }

    /// Returns the lead time after a sample for which the elastic rate is predicted (s), in cycles of `period` (s).
    pub fn lead_time(&self, period: f64, authority: &Authority) -> f64 {
        if self.predictor { authority.delay + 0.5 * period } else { 0.0 }
    }

    /// Returns the law about an axis at the start, in cycles of `period` (s).
    pub fn start(&self, period: f64, authority: &Authority) -> DampingLaw {
        let [acceleration_plus, acceleration_minus] = authority.accelerations;
        DampingLaw {
            threshold: authority.threshold,
            release: self.release.get(),
            period,
            delay: authority.delay,
            acceleration_plus,
            acceleration_minus,
            quantum: authority.width.flight(),
            has_pulse_width: self.pulse_width,
            has_predictor: self.predictor,
            guards_dead_zone: self.guards.dead_zone,
            guards_eligibility: self.guards.eligibility,
            guards_residual: self.guards.residual,
            has_watchdog: self.guards.watchdog,
            latched: false,
            rest: 0,
            window_sum: 0.0,
            window_count: 0,
            has_window_before: false,
            window_before: 0.0,
        }
    }
}
