//! Ideal sensor: the exact motion.

use flexsc_numerics::random::Seed;
use flexsc_numerics::time::{Instant, Span};

use super::linear_noise::KeyNoise;
use super::{LinearMeasurement, Reading, Sensor, SensorSpec, Truth};
use crate::offers::Offers;
use crate::part::Part;
use crate::requirement::Requirements;

/// Settings of the ideal sensor: none.
#[derive(Copy, Clone, Debug)]
pub(super) struct Continuous;

impl SensorSpec for Continuous {
    fn start(&self, _: usize, _: Seed, _: usize) -> Box<dyn Sensor> {
        Box::new(IdealSensor)
    }

    fn period(&self, _: Option<Span>) -> Option<Span> {
        None
    }

    fn is_continuous(&self) -> bool {
        true
    }

    fn requires(&self, _: usize, offers: &Offers, needs: &mut Requirements) {
        let is_alone = offers.sensors.motion_sensors <= 1;
        let why = if offers.sensors.vector_sensors + 1 == offers.sensors.motion_sensors {
            "has no samples, and sensors of the field and of directions have: use a `sampled` sensor beside them"
        } else {
            "gives the motion at every instant, so other sensors add nothing"
        };
        needs.require(is_alone, "", why);
    }

    fn linear_measurement(&self) -> Option<LinearMeasurement> {
        Some(LinearMeasurement::Motion)
    }

    fn linear_noise(&self, _: usize, _: f64) -> Option<Vec<KeyNoise>> {
        Some(Vec::new())
    }
}

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
