//! Active damping with the phase-plane law: while the rigid motion needs no jets, they fire against the elastic rate.
//!
//! In \[Timakov14\] (pages 38 and 48) a relay on the estimated elastic rate acts in the dead zone of the attitude law.
//! Threshold, hysteresis and guards are our design.

use crate::pulse_timing::phase_factor;
use crate::pulse_width::PulseQuantum;

/// Smallest phase factor at which a delayed pulse is worth its propellant.
const ELIGIBLE: f64 = 0.5;
/// Number of cycles with a pulse in a window of the watchdog.
const WINDOW: u32 = 75;
/// Fraction to which the elastic rate must fall from one window to the next.
const FALL: f64 = 0.9;
/// Number of cycles for which the watchdog pauses damping.
const REST: u32 = 300;

/// Estimate of an elastic mode about one axis.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct ElasticRateEstimate {
    /// Elastic rate (rad/s).
    pub rate: f64,
    /// Natural frequency (rad/s).
    pub frequency: f64,
    /// Jump of the elastic rate per unit jump of the rigid rate by the actuator of the axis.
    pub influence: f64,
}

/// Status of active damping about an axis.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct DampingStatus {
    /// Elastic rate on which damping acts (rad/s).
    pub rate: f64,
    /// Threshold (rad/s).
    pub threshold: f64,
    /// True if the elastic rate has exceeded the threshold and has not fallen below the release level.
    pub latched: bool,
    /// True if the watchdog has paused damping.
    pub resting: bool,
    /// Signed on-time of the pulse (s).
    pub on: f64,
    /// Change of the rigid rate by the pulse (rad/s).
    pub change: f64,
}

/// Rate tolerances about a target rate.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct RateTolerance {
    /// Largest deviation above (rad/s).
    pub above: f64,
    /// Largest deviation below (rad/s).
    pub below: f64,
}

impl RateTolerance {
    /// Returns true if a deviation from the target rate (rad/s) is larger than allowed.
    #[inline]
    pub fn is_exceeded_by(&self, excess: f64) -> bool {
        excess > self.above || -excess > self.below
    }
}

/// Active damping about an axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct DampingLaw {
    /// Elastic rate above which damping acts (rad/s).
    pub threshold: f64,
    /// Fraction of the threshold at which the pulses stop.
    pub release: f64,
    /// Cycle (s).
    pub period: f64,
    /// Time from a command to its execution (s).
    pub delay: f64,
    /// Largest acceleration in the positive direction (rad/s²).
    pub acceleration_plus: f64,
    /// Largest acceleration in the negative direction (rad/s²).
    pub acceleration_minus: f64,
    /// Quantisation of pulse lengths.
    pub quantum: PulseQuantum,
    /// True if a pulse is only as long as it takes to stop the elastic motion; otherwise it fills the cycle.
    pub has_pulse_width: bool,
    /// True if the elastic rate is predicted for the middle of the next pulse.
    pub has_predictor: bool,
    /// True if pulses that would drive the rigid motion out of the dead zone are suppressed.
    pub guards_dead_zone: bool,
    /// True if, without the predictor, only modes whose phase factor is at least 0.5 are damped.
    pub guards_eligibility: bool,
    /// True if damping acts only while the innovations of the observer are small.
    pub guards_residual: bool,
    /// True if damping pauses when its pulses do not help.
    pub has_watchdog: bool,
    /// True if the elastic rate has exceeded the threshold and has not fallen below the release level.
    pub latched: bool,
    /// Number of remaining cycles of the watchdog's pause.
    pub rest: u32,
    /// Sum of the absolute elastic rate over the cycles with a pulse (rad/s).
    pub window_sum: f64,
    /// Number of cycles with a pulse in the window.
    pub window_count: u32,
    /// True if there is a window before.
    pub has_window_before: bool,
    /// Mean of the absolute elastic rate in the window before (rad/s).
    pub window_before: f64,
}

impl DampingLaw {
    /// Returns true if damping acts on a mode.
    fn acts_on(&self, mode: &ElasticRateEstimate) -> bool {
        let is_late: bool = !self.has_predictor && self.guards_eligibility;
        mode.influence > 0.0
            && (!is_late || phase_factor(self.period, self.delay, self.period, mode.frequency) >= ELIGIBLE)
    }

    /// Decides on the pulse of a cycle. `is_free` is true if the rigid motion needs no jets, and `is_trusted` if laws may act on
    /// the modes; `excess` is the deviation of the rigid rate from its target (rad/s).
    pub fn decide(
        &mut self,
        modes: &[ElasticRateEstimate],
        is_trusted: bool,
        is_free: bool,
        excess: f64,
        allowed: &RateTolerance,
    ) -> DampingStatus {
        let mut rate: f64 = 0.0;
        let mut influence: f64 = 0.0;
        for index in 0..modes.len() {
            if self.acts_on(&modes[index]) {
                rate += modes[index].rate;
                influence += modes[index].influence;
            }
        }
        if rate.abs() > self.threshold {
            self.latched = true;
        } else if rate.abs() < self.release * self.threshold {
            self.latched = false;
        }
        let resting: bool = self.rest > 0;
        if resting {
            self.rest -= 1;
        }
        let mut damped: DampingStatus = DampingStatus {
            rate,
            threshold: self.threshold,
            latched: self.latched,
            resting,
            on: 0.0,
            change: 0.0,
        };
        if !is_free || !self.latched || resting || (self.guards_residual && !is_trusted) || influence <= 0.0 {
            return damped;
        }
        let sign: f64 = if rate > 0.0 { -1.0 } else { 1.0 };
        let acceleration: f64 = if rate > 0.0 { self.acceleration_minus } else { self.acceleration_plus };
        let demanded: f64 =
            if self.has_pulse_width { rate.abs() / (acceleration * influence) } else { self.period };
        let on: f64 = self.quantum.on_time(demanded, self.period);
        let is_kicked: bool = allowed.is_exceeded_by(excess + sign * acceleration * on);
        if on > 0.0 && !(is_kicked && self.guards_dead_zone) {
            damped.on = sign * on;
            damped.change = sign * acceleration * on;
            self.watch(rate.abs());
        }
        damped
    }

    /// Records a cycle with a pulse; pauses damping if the mean of the window has not fallen enough.
    fn watch(&mut self, rate: f64) {
        self.window_sum += rate;
        self.window_count += 1;
        if self.window_count < WINDOW {
            return;
        }
        let mean: f64 = self.window_sum / f64::from(WINDOW);
        let has_no_effect: bool = self.has_window_before && mean > FALL * self.window_before;
        self.window_sum = 0.0;
        self.window_count = 0;
        self.has_window_before = !has_no_effect;
        self.window_before = mean;
        if has_no_effect && self.has_watchdog {
            self.rest = REST;
        }
    }
}
