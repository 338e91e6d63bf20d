//! A Sun sensor: the direction to the Sun in the body's axes, if it is visible and within the field of view.

use flexsc_formats::document;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::{Finite, NonNegative, Time};
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Span;
use flexsc_spacecraft::axes::PerAxis;
use flexsc_spacecraft::environment::EnvironmentObservation;
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::vector::{VectorErrors, VectorSensor, VectorSensorState};
use super::{Sensor, SensorFailure};
use crate::offers::Offers;
use crate::requirement::{Requirements, Rule};

/// A Sun sensor on a body with three axes. It measures the direction to the Sun as a unit vector.
///
/// A value is one number for all axes, or a list of three.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SunSensor {
    /// Centre of its field of view, a direction in the body's axes, of any length; default: z.
    #[serde(default = "ahead")]
    pub boresight: [Finite; 3],
    /// Half angle of the field of view (rad); default: all directions are visible.
    #[serde(default = "full_field_of_view")]
    pub field_of_view: NonNegative,
    /// Point of the structure at which it is mounted; default: the first of the body's points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<String>,
    /// Period of its samples (s).
    pub period: Span,
    /// Standard deviation of the white noise along each axis (rad).
    #[serde(default)]
    pub noise: PerAxis<NonNegative>,
    /// Constant error along each axis (rad).
    #[serde(default)]
    pub bias: PerAxis<Finite>,
    /// Quantum of the output along each axis (rad); 0 for none.
    #[serde(default)]
    pub resolution: PerAxis<NonNegative>,
    /// Relative error of the scale along each axis.
    #[serde(default)]
    pub scale: PerAxis<Finite>,
    /// Misalignment (rad): row i gives what axis i measures of the direction along the other axes; the diagonal is 0.
    #[serde(default)]
    pub misalignment: [[Finite; 3]; 3],
    /// Time from a sample to its output (s).
    #[serde(default)]
    pub latency: Time,
    /// Intervals in which the Sun sensor fails.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<SensorFailure>,
}

fn ahead() -> [Finite; 3] {
    [0.0, 0.0, 1.0].map(|part| Finite::new(part).unwrap_or_default())
}

fn full_field_of_view() -> NonNegative {
    NonNegative::new(std::f64::consts::PI).unwrap_or_default()
}

impl SunSensor {
    /// Creates the sensor's run-time state; `ordinal` counts earlier sensors of the same kind.
    pub fn start(&self, seed: Seed, ordinal: usize) -> Box<dyn Sensor> {
        Box::new(VectorSensorState::new(self, seed, ordinal))
    }

    /// Returns the latency of a reading.
    pub fn latency(&self) -> Span {
        Span::from_seconds(self.latency.get())
    }

    /// Returns the covariance of the noise, including quantisation.
    pub fn covariance(&self) -> Matrix3<f64> {
        self.errors().covariance()
    }

    /// Adds the requirements of the sensor on the other parts of a scenario.
    pub(super) fn requires(offers: &Offers, needs: &mut Requirements) {
        super::requirements::require_attitude(offers, needs);
        needs.require(
            Rule::Sensor,
            offers.environment.sun,
            "",
            "measures the direction to `environment.sun`, and there is none",
        );
    }

    /// Checks the settings against each other; returns the first inconsistent key and the reason.
    pub fn inconsistency(&self) -> Option<document::ConfigError> {
        if self.boresight.iter().all(|part| part.get() == 0.0) {
            return Some(document::ConfigError::new("boresight", "must not be zero, got [0, 0, 0]"));
        }
        self.errors().fault()
    }
}

impl VectorSensor for SunSensor {
    const STREAM: &'static str = "sun sensor";

    fn reference(&self, sky: &EnvironmentObservation) -> Option<Vector> {
        sky.sun
    }

    fn reading(&self, exact: &Vector, measured: Vector) -> Option<Vector> {
        let boresight = vector(&self.boresight);
        // The angle itself is compared, because its cosine is insensitive for a narrow field.
        let off = libm::atan2(boresight.cross(exact).norm(), boresight.dot(exact));
        (off <= self.field_of_view.get()).then(|| measured.normalize())
    }

    fn is_direction(&self) -> bool {
        true
    }

    fn errors(&self) -> VectorErrors {
        let Self { noise, bias, resolution, scale, misalignment, .. } = *self;
        VectorErrors { noise, bias, resolution, scale, misalignment }
    }

    fn timing(&self) -> [Span; 2] {
        [self.period, self.latency()]
    }

    fn faults(&self) -> &[SensorFailure] {
        &self.faults
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Quaternion;

    use super::*;
    use crate::sensor::{Orientation, Truth};
    use flexsc_numerics::attitude::rotation;
    use flexsc_numerics::time::Instant;

    fn truth(attitude: Quaternion<f64>, sun: Option<Vector>) -> Truth {
        let sky = EnvironmentObservation { field: Some(Vector::new(2e-5, -1e-5, 3e-5)), sun, nadir: None };
        let [elastic, rate] = [[0.0; 3]; 2];
        Truth { orientation: Orientation::Attitude(attitude), elastic, rate, rigid: rate, turned: rate, sky }
    }

    #[test]
    fn it_sees_the_sun_within_its_field_of_view_alone() {
        let sensor: SunSensor =
            flexsc_formats::document::from_text("period = 1.0\nboresight = [2, 0, 0]\nfield_of_view = 0.5")
                .unwrap();
        let mut state = sensor.start(Seed { scenario: 1, run: 0 }, 0);
        let mut measure = |t: f64, rotation_angle: f64, sun: Option<Vector>| {
            let now = Instant::START + Span::from_seconds(t);
            let attitude = rotation(&Vector::new(0.0, 0.0, rotation_angle));
            state.read(now, &truth(attitude, sun), None).and_then(|reading| reading.sight)
        };
        let sun = Some(Vector::x());
        let measurement = measure(0.0, 0.499, sun).unwrap();
        assert!((measurement.vector - Vector::new(libm::cos(0.499), -libm::sin(0.499), 0.0)).norm() < 1e-15);
        assert!(measurement.is_direction && measurement.inertial == Vector::x());
        assert!(
            measure(1.0, 0.501, sun).is_none()
                && measure(2.0, 3.0, sun).is_none()
                && measure(3.0, 0.0, None).is_none()
        );
        assert!(measure(4.0, -0.499, sun).is_some());
    }

    #[test]
    fn noise_is_across_and_errors_are_those_that_are_asked_for() {
        let sensor: SunSensor = flexsc_formats::document::from_text("period = 1.0\nnoise = 1e-3").unwrap();
        let mut state = sensor.start(Seed { scenario: 1, run: 0 }, 0);
        let count = 20_000;
        let mut squares = Vector::zeros();
        for k in 0..count {
            let now = Instant::START + Span::from_seconds(f64::from(k));
            let truth = truth(rotation(&Vector::zeros()), Some(Vector::z()));
            let direction = state.read(now, &truth, None).unwrap().sight.unwrap().vector;
            assert!((direction.norm() - 1.0).abs() < 1e-15);
            squares += direction.component_mul(&direction) / f64::from(count);
        }
        // Three standard errors: 3 sqrt(2/n).
        assert!((squares.x / 1e-6 - 1.0).abs() < 0.03 && (squares.y / 1e-6 - 1.0).abs() < 0.03, "{squares}");
        let magnetometer: crate::sensor::Magnetometer = flexsc_formats::document::from_text(
            "period = 1.0\nlatency = 0.5\nbias = [1e-6, 0, 0]\nscale = 0.01\nmisalignment = [[0, 0, 0], [0.1, 0, 0], [0, 0, 0]]\n\
             resolution = [0, 0, 7e-6]\nfaults = [{ stuck = { from = 2.0, to = 3.0 } }, { silent = { from = 3.0 } }]",
        )
        .unwrap();
        assert_eq!(magnetometer.inconsistency(), None);
        let mut state = magnetometer.start(Seed { scenario: 1, run: 0 }, 0);
        let (mut now, mut readings, mut last) = (Instant::START, Vec::new(), None);
        while now.seconds() < 5.0 {
            let attitude = rotation(&Vector::new(0.0, 0.0, 0.1 * now.seconds()));
            if let Some(reading) = state.read(now, &truth(attitude, None), last.as_ref()) {
                readings.push((now.seconds(), reading.sight.unwrap().vector));
                last = Some(reading);
            }
            now = state.next_due(now, Span::TICK);
        }
        let times: Vec<f64> = readings.iter().map(|(t, _)| *t).collect();
        assert_eq!(times, [0.0, 1.5, 2.5]);
        let exact = Vector::new(2.02e-5 + 1e-6, -1.01e-5 + 2e-6, 2.8e-5);
        assert!((readings[0].1 - exact).norm() < 1e-19, "{}", readings[0].1);
        assert!(readings[1].1 != readings[0].1 && readings[2].1 == readings[1].1);
    }
}
