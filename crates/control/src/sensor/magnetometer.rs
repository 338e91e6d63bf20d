//! A magnetometer: the magnetic field along the body's axes.

use flexsc_formats::document;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive, Time};
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Span;
use flexsc_spacecraft::axes::PerAxis;
use flexsc_spacecraft::environment::EnvironmentObservation;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::vector::{VectorErrors, VectorSensor, VectorSensorState};
use super::{MeasuredQuantity, ReferenceNoise, Sensor, SensorFailure, SensorSpec, Subject};
use crate::offers::Offers;
use crate::quantity::QuantityShape;
use crate::requirement::Requirements;

/// A magnetometer on a body with three axes. The body's own magnetorquers do not disturb it.
///
/// A value is one number for all axes, or a list of three.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Magnetometer {
    /// Point of the structure at which it is mounted; default: the first of the body's points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<String>,
    /// Period of its samples (s).
    pub period: Span,
    /// Standard deviation of the white noise along each axis (T).
    #[serde(default)]
    pub noise: PerAxis<NonNegative>,
    /// Constant error along each axis (T).
    #[serde(default)]
    pub bias: PerAxis<Finite>,
    /// Quantum of the output along each axis (T); 0 for none.
    #[serde(default)]
    pub resolution: PerAxis<NonNegative>,
    /// Relative error of the scale along each axis.
    #[serde(default)]
    pub scale: PerAxis<Finite>,
    /// Misalignment (rad): row i gives what axis i measures of the field along the other axes; the diagonal is 0.
    #[serde(default)]
    pub misalignment: [[Finite; 3]; 3],
    /// Time from a sample to its output (s).
    #[serde(default)]
    pub latency: Time,
    /// Largest field that it outputs along each axis (T), at which it clips; default: no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<PerAxis<Positive>>,
    /// Intervals in which the magnetometer fails.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<SensorFailure>,
}

impl SensorSpec for Magnetometer {
    fn start(&self, _: usize, seed: Seed, ordinal: usize) -> Box<dyn Sensor> {
        Box::new(VectorSensorState::new(self, seed, ordinal))
    }

    fn period(&self, _: Option<Span>) -> Option<Span> {
        Some(self.period)
    }

    fn subject(&self) -> Subject {
        Subject::Field
    }

    fn point(&self) -> Option<&str> {
        self.point.as_deref()
    }

    fn faults(&self) -> &[SensorFailure] {
        &self.faults
    }

    fn validate(&self) -> Option<document::ConfigError> {
        self.errors().validate()
    }

    fn requires(&self, _: usize, offers: &Offers, needs: &mut Requirements) {
        super::requirements::require_attitude(offers, needs);
        needs.require(
            offers.environment.magnetic_field,
            "",
            "measures the field of `[environment.magnetic_field]`, and there is none",
        );
    }

    fn reference(&self) -> Option<(Span, ReferenceNoise)> {
        let [_, latency] = self.timing();
        Some((latency, ReferenceNoise::MagneticField(self.errors().covariance())))
    }

    fn measured_quantities(&self, _: bool, _: usize) -> Vec<MeasuredQuantity> {
        vec![MeasuredQuantity::vector("field", "T", QuantityShape::Vector, "magnetic field in body axes")]
    }
}

impl VectorSensor for Magnetometer {
    const STREAM: &'static str = "magnetometer";

    fn inertial_vector(&self, sky: &EnvironmentObservation) -> Option<Vector> {
        sky.field
    }

    fn reading(&self, _: &Vector, measured: Vector) -> Option<Vector> {
        let clipped = |range: PerAxis<Positive>| {
            Vector::from_fn(|axis, _| {
                let most = range.about(axis).get();
                measured[axis].clamp(-most, most)
            })
        };
        Some(self.range.map_or(measured, clipped))
    }

    fn errors(&self) -> VectorErrors {
        let Self { noise, bias, resolution, scale, misalignment, .. } = *self;
        VectorErrors { noise, bias, resolution, scale, misalignment }
    }

    fn timing(&self) -> [Span; 2] {
        [self.period, Span::from_seconds(self.latency.get())]
    }
}

#[cfg(test)]
mod tests {
    use flexsc_numerics::attitude::rotation;
    use flexsc_numerics::time::Instant;

    use super::*;
    use crate::sensor::{Orientation, Truth};

    #[test]
    fn a_field_beyond_the_range_is_clipped_after_the_errors() {
        let text = "period = 1.0\nbias = [1e-6, 0, 0]\nscale = [0, 0.5, 0]\nrange = [2e-5, 4e-5, 5e-5]";
        let sensor: Magnetometer = flexsc_formats::document::from_text(text).unwrap();
        let mut state = sensor.start(3, Seed { scenario: 1, run: 0 }, 0);
        let mut now = Instant::START;
        let mut measure = |field: [f64; 3]| {
            let sky = EnvironmentObservation {
                field: Some(Vector::from(field)),
                ..EnvironmentObservation::default()
            };
            let orientation = Orientation::Attitude(rotation(&Vector::zeros()));
            let [elastic, rate] = [[0.0; 3]; 2];
            let truth =
                Truth { orientation, elastic, rate, rigid_rate: rate, rate_integral: rate, environment: sky };
            let reading = state.read(now, &truth, None).unwrap();
            now += Span::from_seconds(1.0);
            reading.sight.unwrap().vector
        };
        let within = measure([1.8e-5, -2e-5, 4.9e-5]);
        assert!((within - Vector::new(1.9e-5, -3e-5, 4.9e-5)).norm() < 1e-19, "{within}");
        // The bias and the scale lead beyond the range; so does the field itself.
        assert_eq!(measure([1.95e-5, -3e-5, 6e-5]), Vector::new(2e-5, -4e-5, 5e-5));
        assert_eq!(measure([-3e-5, 3e-5, -6e-5]), Vector::new(-2e-5, 4e-5, -5e-5));
    }
}
