//! Pass-through without an estimator: the state estimate is the measurement.

use super::{Estimate, Taken};
use crate::belief::Belief;

/// Pass-through of the measured angle and rate into the state estimate.
#[derive(Copy, Clone, Debug)]
pub struct Direct;

impl Estimate for Direct {
    fn take(&mut self, taken: &Taken<'_>, beliefs: &mut [Belief]) {
        let Some(measured) = taken.measured else { return };
        for (belief, [angle, rate]) in beliefs.iter_mut().zip(measured) {
            (belief.angle, belief.rate) = (*angle, *rate);
        }
    }

    fn copy(&self) -> Box<dyn Estimate> {
        Box::new(*self)
    }
}
