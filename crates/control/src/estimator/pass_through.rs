//! Pass-through without an estimator: the state estimate is the measurement.

use super::{Estimator, SampleContext};
use crate::part::Part;
use crate::state_estimate::StateEstimate;

/// Pass-through of the measured angle and rate into the state estimate.
#[derive(Copy, Clone, Debug)]
pub struct PassThrough;

impl Part for PassThrough {}

impl Estimator for PassThrough {
    fn update(&mut self, context: &SampleContext<'_>, state_estimates: &mut [StateEstimate]) {
        let Some(measured) = context.measured else { return };
        for (state_estimate, [angle, rate]) in state_estimates.iter_mut().zip(measured) {
            (state_estimate.angle, state_estimate.rate) = (*angle, *rate);
        }
    }

    fn copy(&self) -> Box<dyn Estimator> {
        Box::new(*self)
    }
}
