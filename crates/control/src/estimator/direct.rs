//! No estimator: what is measured is believed.

use super::{Estimate, Taken};
use crate::belief::Belief;

/// The belief is the measurement.
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
