//! A Sun sensor: the direction to the Sun in the body's axes, if it is visible and within the field of view.

use flexsc_numerics::attitude::Vector;
use flexsc_spacecraft::environment::EnvironmentObservation;
use nalgebra::Matrix3;
use schemars::JsonSchema;

use super::ReferenceNoise;
use super::direction_sensor::{DirectionSensor, SensedBody};
use crate::offers::EnvironmentOffers;

/// Sensor of the direction to the Sun.
pub type SunSensor = DirectionSensor<SensedSun>;

/// The Sun, as a Sun sensor measures it.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, JsonSchema)]
#[schemars(rename = "Sun")]
pub struct SensedSun;

impl SensedBody for SensedSun {
    const STREAM: &'static str = "sun sensor";
    const DESCRIPTION: &'static str = "A Sun sensor on a body with three axes. It measures the direction to the Sun as a unit vector.\n\nA value \
                                       is one number for all axes, or a list of three.";
    const UNDEFINED: &'static str = "measures the direction to `environment.sun`, and there is none";

    const MEANING: &'static str = "direction to the Sun in body axes";

    fn reference(covariance: Matrix3<f64>) -> ReferenceNoise {
        ReferenceNoise::Sun(covariance)
    }

    fn direction(sky: &EnvironmentObservation) -> Option<Vector> {
        sky.sun
    }

    fn is_defined(environment: EnvironmentOffers) -> bool {
        environment.sun
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Quaternion;

    use super::*;
    use crate::sensor::{Orientation, SensorSpec, Truth};
    use flexsc_numerics::attitude::rotation;
    use flexsc_numerics::random::Seed;
    use flexsc_numerics::time::{Instant, Span};

    fn truth(attitude: Quaternion<f64>, sun: Option<Vector>) -> Truth {
        let field = Some(Vector::new(2e-5, -1e-5, 3e-5));
        let sky = EnvironmentObservation { field, sun, ..EnvironmentObservation::default() };
        let [elastic, rate] = [[0.0; 3]; 2];
        Truth {
            orientation: Orientation::Attitude(attitude),
            elastic,
            rate,
            rigid_rate: rate,
            rate_integral: rate,
            environment: sky,
        }
    }

    #[test]
    fn it_sees_the_sun_within_its_field_of_view_alone() {
        let sensor: SunSensor =
            flexsc_formats::document::from_text("period = 1.0\nboresight = [2, 0, 0]\nfield_of_view = 0.5")
                .unwrap();
        let mut state = sensor.start(3, Seed { scenario: 1, run: 0 }, 0);
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
        let mut state = sensor.start(3, Seed { scenario: 1, run: 0 }, 0);
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
        assert_eq!(magnetometer.validate(), None);
        let mut state = magnetometer.start(3, Seed { scenario: 1, run: 0 }, 0);
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
