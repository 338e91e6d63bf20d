//! Rigid rate estimator: predicted by the actuator's pulses and a steady torque, corrected slightly by the measured
//! rates.

use flexsc_flight::rigid_rate::RigidRateFilter;
use flexsc_numerics::quantity::{Finite, Fraction};
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Instant;
use flexsc_spacecraft::axes::PerAxis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{AppliedPulses, Estimator, EstimatorContext, EstimatorSpec, SampleContext};
use crate::offers::{EstimatorOffers, Offers};
use crate::part::Part;
use crate::requirement::{ONE_NUMBER, Requirements};
use crate::state_estimate::StateEstimate;

/// w^(n) = w^- + l (y - w^-), w^- = w^(n-1) + du + c^(n-1), c^(n) = c^(n-1) + l²/4 (y - w^-): for what is no pulse a low pass of
/// T/l seconds, so that the elastic part of the measured rates is mostly left out. It is the observer of \[Timakov14\] with its
/// modes left out, and with c, what a steady torque changes in a cycle: without it the rate would stay c (1 - l)/l behind. The
/// two poles are near 1 - l/2 both, those of an alpha-beta filter that is critically damped (\[Brookner98\]).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidRate {
    /// Fraction l of the innovation, between 0 and 1, by which each sample corrects the rate.
    pub correction: Fraction,
    /// Estimated rates before the first sample (rad/s).
    #[serde(default)]
    pub rate: PerAxis<Finite>,
}

/// Run-time state of the rigid rate estimator.
#[derive(Clone, Debug)]
pub struct RigidRateState {
    /// Filter about each axis.
    filters: Vec<RigidRateFilter>,
    /// Change of the rate about each axis by the pulses before the last sample (rad/s).
    pushed: [f64; 3],
    applied_pulses: AppliedPulses,
}

impl EstimatorSpec for RigidRate {
    fn start(&self, known: &EstimatorContext<'_>, _: Seed) -> Box<dyn Estimator> {
        Box::new(RigidRateState {
            filters: (0..known.axes.len()).map(|axis| self.flight_filter(axis)).collect(),
            pushed: [0.0; 3],
            applied_pulses: AppliedPulses::default(),
        })
    }

    fn offers(&self) -> EstimatorOffers {
        EstimatorOffers { estimates_rates_only: true, needs_reader: true, ..EstimatorOffers::default() }
    }

    fn requires(&self, offers: &Offers, needs: &mut Requirements) {
        let is_one = offers.body.axes == 3 || !self.rate.is_three();
        needs.require(is_one, "rate", ONE_NUMBER);
    }
}

impl RigidRate {
    /// Returns the filter about an axis before the first sample, as flight code has it.
    pub fn flight_filter(&self, axis: usize) -> RigidRateFilter {
        RigidRateFilter { correction: self.correction.get(), rate: self.rate.about(axis).get(), drift: 0.0 }
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
            self.pushed[axis] = pushed;
            let measured = context.measured.map(|measured| measured[axis]);
            let [angle, rate] = measured.unwrap_or_default();
            self.filters[axis].take(measured.is_some(), rate, pushed);
            state_estimate.rate = self.filters[axis].rate;
            if measured.is_some() {
                state_estimate.angle = angle;
            }
        }
    }

    fn known_inputs(&self) -> [f64; 3] {
        self.pushed
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
            let mut filter = RigidRate { correction, rate: PerAxis::default() }.flight_filter(0);
            let (mut rate, mut behind) = (0.0, 0.0_f64);
            for _ in 0..3000 {
                rate += change;
                filter.take(true, rate, 0.0);
                behind = rate - filter.rate;
            }
            assert!(behind.abs() <= 2e-3 * change.abs(), "{behind:e} after {change:e} a cycle");
        }
    }
}
