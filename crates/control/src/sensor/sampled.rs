//! A sampled sensor of the angle, or of a three-axis attitude: noise, bias, resolution, faults, and an optional rate
//! gyro.

use flexsc_numerics::quantity::{Finite, NonNegative, Positive};
use flexsc_numerics::random::{Seed, Stream};
use flexsc_numerics::time::{Instant, Span};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::failure::{SensorFailure, with_failures};
use super::linear_noise::{KeyNoise, SensorNoise, diagonal, existing, rounding};
use super::{LinearMeasurement, Reading, ReferenceNoise, Sensor, SensorSpec, Truth, stream};
use crate::part::Part;

/// A sampled angle sensor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sampled {
    /// Period of the samples (s), at which guards of the law are tested.
    pub period: Span,
    /// Standard deviation of the white noise (rad), on three axes about each of them.
    #[serde(default)]
    pub noise: NonNegative,
    /// Constant error (rad).
    #[serde(default)]
    pub bias: Finite,
    /// Quantum of the output (rad); 0 for none.
    #[serde(default)]
    pub resolution: NonNegative,
    /// Standard deviation of the white noise of a rate gyro (rad/s); default: there is no gyro, and the rate is the
    /// difference of the last two angles divided by the period.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_noise: Option<Positive>,
    /// Point of the structure at which it is mounted, on a body with three axes; default: the first of the body's points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<String>,
    /// Intervals in which the sensor fails.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<SensorFailure>,
}

impl SensorSpec for Sampled {
    fn start(&self, axes: usize, seed: Seed, ordinal: usize) -> Box<dyn Sensor> {
        let draws = |axis: usize| stream("sensor", (axis, axes), ordinal, seed);
        Box::new(SampledState { sampled: self.clone(), noise: (0..axes).map(draws).collect() })
    }

    fn period(&self, _: Option<Span>) -> Option<Span> {
        Some(self.period)
    }

    fn point(&self) -> Option<&str> {
        self.point.as_deref()
    }

    fn faults(&self) -> &[SensorFailure] {
        &self.faults
    }

    fn angle_noise(&self) -> f64 {
        let (noise, resolution) = (self.noise.get(), self.resolution.get());
        f64::sqrt(noise * noise + resolution * resolution / 12.0)
    }

    fn rate_noise(&self, _: usize) -> Option<f64> {
        self.rate_noise.map(Positive::get)
    }

    fn reference(&self) -> Option<(Span, ReferenceNoise)> {
        Some((Span::ZERO, ReferenceNoise::Attitude([self.angle_noise(); 3])))
    }

    fn linear_measurement(&self) -> Option<LinearMeasurement> {
        Some(LinearMeasurement::Samples { period: self.period, is_difference: self.rate_noise.is_none() })
    }

    fn linear_noise(&self, axes: usize, _: f64) -> Option<Vec<KeyNoise>> {
        let angle = |deviation: f64| diagonal(axes, |_| deviation).map(SensorNoise::Angle);
        let rate = self.rate_noise.map_or(0.0, Positive::get);
        Some(existing([
            ("noise", angle(self.noise.get())),
            ("resolution", angle(rounding(self.resolution.get()))),
            ("rate_noise", diagonal(axes, |_| rate).map(SensorNoise::Rate)),
        ]))
    }
}

impl Sampled {
    fn measure(&self, angle: f64, noise: &mut Stream) -> f64 {
        let mut output = angle + self.bias.get();
        if self.noise.get() > 0.0 {
            output += self.noise.get() * noise.normal();
        }
        let quantum = self.resolution.get();
        if quantum > 0.0 { libm::round(output / quantum) * quantum } else { output }
    }
}

/// Run-time state of the sensor, with a stream of noise for each axis.
#[derive(Clone, Debug)]
pub struct SampledState {
    sampled: Sampled,
    noise: Vec<Stream>,
}

impl Part for SampledState {}

impl Sensor for SampledState {
    fn read(&mut self, now: Instant, truth: &Truth, last: Option<&Reading>) -> Option<Reading> {
        let Self { sampled, noise } = self;
        // Random numbers are drawn during a failure too, so that later ones do not depend on it.
        let mut angles = truth.sensor_angles();
        let mut rate = truth.rate;
        let gyro = sampled.rate_noise.map(Positive::get);
        for ((angle, rate), noise) in angles.iter_mut().zip(&mut rate).zip(noise) {
            *angle = sampled.measure(*angle, noise);
            if let Some(sd) = gyro {
                *rate += sd * noise.normal();
            }
        }
        let reading =
            Reading { at: truth.orientation.rotated_by(angles), rate: gyro.map(|_| rate), sight: None };
        with_failures(&sampled.faults, now, Some(reading), last)
    }

    fn copy(&self) -> Box<dyn Sensor> {
        Box::new(self.clone())
    }
}
