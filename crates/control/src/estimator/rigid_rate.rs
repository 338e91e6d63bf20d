//! Rigid rate estimator: predicted by the actuator's pulses and a steady torque, corrected slightly by the measured
//! rates.

use flexsc_numerics::quantity::{Finite, Fraction};
use flexsc_numerics::time::Instant;
use flexsc_spacecraft::axes::PerAxis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{AppliedPulses, Estimator, SampleContext};
use crate::offers::Offers;
use crate::part::Part;
use crate::requirement::{ONE_NUMBER, Requirements, Rule};
use crate::state_estimate::StateEstimate;

/// w^(n) = w^- + l (y - w^-), w^- = w^(n-1) + du + c^(n-1), c^(n) = c^(n-1) + l²/4 (y - w^-): for what is no pulse a low pass of
/// T/l seconds, so that the elastic part of the measured rates is mostly left out. It is the observer of \[Timakov14\] with its
/// modes left out, and with c, what a steady torque changes in a cycle: without it the rate would stay c (1 - l)/l behind. The
/// two poles are near 1 - l/2 both, those of an alpha-beta filter that is critically damped (\[Brookner98\]).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidRate {
    /// Fraction l of the innovation by which each sample corrects the rate.
    pub correction: Fraction,
    /// Estimated rates before the first sample (rad/s).
    #[serde(default)]
    pub rate: PerAxis<Finite>,
}

/// Run-time state of the rigid rate estimator.
#[derive(Clone, Debug)]
pub struct RigidRateState {
    correction: f64,
    rates: Vec<f64>,
    /// Rate change per sample due to a steady torque (rad/s).
    drifts: Vec<f64>,
    applied_pulses: AppliedPulses,
}

impl RigidRate {
    /// Adds the requirements of the estimator on the other parts of a scenario.
    pub(super) fn requires(&self, offers: &Offers, needs: &mut Requirements) {
        let is_one = offers.body.axes == 3 || !self.rate.is_three();
        needs.require(Rule::Filter, is_one, "rate", ONE_NUMBER);
    }

    /// Returns the estimator's state at the start of a run of a body with `axes` axes.
    pub fn start(&self, axes: usize) -> RigidRateState {
        RigidRateState {
            correction: self.correction.get(),
            rates: (0..axes).map(|axis| self.rate.about(axis).get()).collect(),
            drifts: vec![0.0; axes],
            applied_pulses: AppliedPulses::default(),
        }
    }
}

impl RigidRateState {
    /// Updates the estimate about an axis with the measured rate (rad/s), if any, and the rate change `pushed` (rad/s)
    /// by the pulses since the last sample. Returns the estimated rigid rate (rad/s).
    fn step(&mut self, axis: usize, measured: Option<f64>, pushed: f64) -> f64 {
        let predicted = self.rates[axis] + pushed + self.drifts[axis];
        let innovation = measured.map_or(0.0, |measured| measured - predicted);
        self.rates[axis] = predicted + self.correction * innovation;
        self.drifts[axis] += 0.25 * self.correction * self.correction * innovation;
        self.rates[axis]
    }
}

impl Part for RigidRateState {}

impl Estimator for RigidRateState {
    fn input_changed(&mut self, now: Instant, moments: [f64; 3]) {
        self.applied_pulses.input_changed(now, moments);
    }

    fn update(&mut self, context: &SampleContext<'_>, state_estimates: &mut [StateEstimate]) {
        let pulses = self.applied_pulses.take_executed(context.now, context.pulses);
        for (axis, state_estimate) in state_estimates.iter_mut().enumerate() {
            let own = pulses.iter().filter(|pulse| pulse.input == axis);
            let pushed = own.map(|pulse| pulse.acceleration * pulse.duration).sum();
            state_estimate.rate = self.step(axis, context.measured.map(|measured| measured[axis][1]), pushed);
            if let Some(measured) = context.measured {
                state_estimate.angle = measured[axis][0];
            }
        }
    }

    fn copy(&self) -> Box<dyn Estimator> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks the drift term, without which the rates would stay (1 - l)/l = 99 cycles behind.
    #[test]
    fn rates_do_not_stay_behind_a_steady_torque() {
        let correction = Fraction::new(0.01).expect("a fraction");
        for change in [1e-6, 0.0, -2e-6] {
            let mut filter = RigidRate { correction, rate: PerAxis::default() }.start(1);
            let (mut rate, mut behind) = (0.0, 0.0_f64);
            for _ in 0..3000 {
                rate += change;
                behind = rate - filter.step(0, Some(rate), 0.0);
            }
            assert!(behind.abs() <= 2e-3 * change.abs(), "{behind:e} after {change:e} a cycle");
        }
    }
}
