//! Ideal sensor: the exact motion.

use flexsc_numerics::time::Instant;

use super::{Reading, Sensor, Truth};
use crate::part::Part;

/// Ideal sensor of orientation and rates, at every instant.
#[derive(Copy, Clone, Debug)]
pub(super) struct IdealSensor;

impl Part for IdealSensor {}

impl Sensor for IdealSensor {
    fn read(&mut self, _: Instant, truth: &Truth, _: Option<&Reading>) -> Option<Reading> {
        Some(Reading {
            at: truth.orientation.rotated_by(truth.sensor_angles()),
            rate: Some(truth.rate),
            sight: None,
        })
    }

    fn copy(&self) -> Box<dyn Sensor> {
        Box::new(*self)
    }
}
