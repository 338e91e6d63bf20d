//! Active damping with the phase-plane law: while the rigid motion needs no jets, they fire against the elastic rate.
//!
//! In \[Timakov14\] (pages 37 and 48) a relay on the estimated elastic rate acts in the dead zone of the attitude law.
//! Threshold, hysteresis and guards are our design.

use flexsc_numerics::delay_margin::delay_margin;
use flexsc_numerics::quantity::{Fraction, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Authority;
use crate::actuator::PulseTiming;
use crate::state_estimate::{DampingStatus, ElasticRateEstimate, StateEstimate};

/// Smallest phase factor at which a delayed pulse is worth its propellant.
const ELIGIBLE: f64 = 0.5;
/// Number of cycles with a pulse in a window of the watchdog.
const WINDOW: u32 = 75;
/// Fraction to which the elastic rate must fall from one window to the next.
const FALL: f64 = 0.9;
/// Number of cycles for which the watchdog pauses damping.
const REST: u32 = 300;
/// Factors of the default threshold: on the amplitude of the limit cycle, and cycles of elastic acceleration at least.
const LIMIT_CYCLES: f64 = 1.5;
const CYCLES: f64 = 2.0;

/// Active damping.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ActiveDamping {
    /// Elastic rate about each axis above which the jets fire (rad/s); default, for the mode that a long burn excites most:
    /// 1.5 times the amplitude of the limit cycle due to the delay, and at least the change by two whole cycles of firing.
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
    /// Suppress pulses that would drive the rigid motion out of the dead zone.
    pub dead_zone: bool,
    /// Without the predictor, damp only modes whose phase factor is at least 0.5.
    pub eligibility: bool,
    /// Act only while the innovations of the observer are small.
    pub residual: bool,
    /// Pause active damping when the pulses do not help.
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
}

/// Run-time state of active damping about one axis.
#[derive(Clone, Debug)]
pub struct ActiveDampingState {
    spec: ActiveDamping,
    authority: Authority,
    period: f64,
    latched: bool,
    /// Number of remaining cycles of the watchdog's pause.
    rest: u32,
    /// Sum of the absolute elastic rate over the cycles with a pulse (rad/s), their number, and the mean of the window
    /// before.
    window: (f64, u32, Option<f64>),
}

impl ActiveDampingState {
    /// Creates the state at the start, for cycles of `period` (s).
    pub fn new(spec: &ActiveDamping, period: f64, authority: &Authority) -> Self {
        let (spec, authority) = (spec.clone(), *authority);
        Self { spec, authority, period, latched: false, rest: 0, window: (0.0, 0, None) }
    }

    /// Returns the lead time after a sample for which the elastic rate is predicted (s).
    pub fn lead_time(&self) -> f64 {
        if self.spec.predictor { self.authority.delay + 0.5 * self.period } else { 0.0 }
    }

    fn acts_on(&self, mode: &ElasticRateEstimate) -> bool {
        let timing = PulseTiming { period: self.period, delay: self.authority.delay, on_time: self.period };
        let late = !self.spec.predictor && self.spec.guards.eligibility;
        mode.influence > 0.0 && (!late || timing.phase_factor(mode.frequency) >= ELIGIBLE)
    }

    /// Decides on the pulse of a cycle. `free` is true if the rigid motion needs no jets; `excess` is the deviation of
    /// the rigid rate from its target, and `allowed` its largest values above and below (rad/s).
    pub fn decide(
        &mut self,
        state_estimate: &StateEstimate,
        free: bool,
        (excess, allowed): (f64, [f64; 2]),
    ) -> DampingStatus {
        let StateEstimate { elastic: modes, elastic_is_trusted: trusted, .. } = state_estimate;
        let threshold = self.authority.threshold;
        let acted = || modes.iter().filter(|mode| self.acts_on(mode));
        let (rate, influence) =
            acted().fold((0.0, 0.0), |(rate, sum), mode| (rate + mode.rate, sum + mode.influence));
        if rate.abs() > threshold {
            self.latched = true;
        } else if rate.abs() < self.spec.release.get() * threshold {
            self.latched = false;
        }
        let resting = self.rest > 0;
        self.rest = self.rest.saturating_sub(1);
        let mut damped =
            DampingStatus { rate, threshold, latched: self.latched, resting, on: 0.0, change: 0.0 };
        if !free || !self.latched || resting || (self.spec.guards.residual && !*trusted) || influence <= 0.0 {
            return damped;
        }
        let [plus, minus] = self.authority.accelerations;
        let (sign, acceleration) = if rate > 0.0 { (-1.0, minus) } else { (1.0, plus) };
        let demanded =
            if self.spec.pulse_width { rate.abs() / (acceleration * influence) } else { self.period };
        let on = self.authority.width.on_time(demanded, self.period);
        let kicked = exceeds(excess + sign * acceleration * on, allowed);
        if on > 0.0 && !(kicked && self.spec.guards.dead_zone) {
            damped.on = sign * on;
            damped.change = sign * acceleration * on;
            self.watch(rate.abs());
        }
        damped
    }

    /// Records a cycle with a pulse; pauses damping if the mean of the window has not fallen enough.
    fn watch(&mut self, rate: f64) {
        let (sum, count, before) = &mut self.window;
        *sum += rate;
        *count += 1;
        if *count < WINDOW {
            return;
        }
        let mean = *sum / f64::from(WINDOW);
        let has_no_effect = before.is_some_and(|before| mean > FALL * before);
        self.window = (0.0, 0, (!has_no_effect).then_some(mean));
        if has_no_effect && self.spec.guards.watchdog {
            self.rest = REST;
        }
    }
}

/// Returns true if a rate deviates from its target by more than the limits above and below (rad/s).
pub(super) fn exceeds(excess: f64, [above, below]: [f64; 2]) -> bool {
    excess > above || -excess > below
}
