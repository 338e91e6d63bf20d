//! Custom sensor: an encoder that measures angles in whole steps, and no rates.

use flexsc_core::control::sensor::{Reading, Sensor, SensorSpec, Truth};
use flexsc_core::numerics::random::Seed;
use flexsc_core::numerics::time::{Instant, Span};

/// Encoder with its step (rad) and its period (s).
#[derive(Copy, Clone, Debug)]
pub struct Encoder {
    pub step: f64,
    pub period: f64,
}

impl SensorSpec for Encoder {
    fn start(&self, _: usize, _: Seed) -> Box<dyn Sensor> {
        Box::new(*self)
    }

    fn period(&self) -> Span {
        Span::from_seconds(self.period)
    }

    fn angle_noise(&self) -> f64 {
        self.step / 12.0_f64.sqrt()
    }
}

impl Sensor for Encoder {
    fn read(&mut self, _: Instant, truth: &Truth, _: Option<&Reading>) -> Option<Reading> {
        let steps = truth.sensor_angles().map(|angle| (angle / self.step).round() * self.step);
        Some(Reading { at: truth.orientation.rotated_by(steps), rate: None, sight: None })
    }

    fn copy(&self) -> Box<dyn Sensor> {
        Box::new(*self)
    }
}
