//! An Earth sensor: the direction to the planet's centre in the body's axes, from the horizon, if it is within the field
//! of view.

use flexsc_numerics::attitude::Vector;
use flexsc_spacecraft::environment::EnvironmentObservation;
use nalgebra::Matrix3;
use schemars::JsonSchema;

use super::ReferenceNoise;
use super::direction_sensor::{DirectionSensor, SensedBody};
use crate::offers::EnvironmentOffers;

/// Horizon sensor: it measures the direction to the centre of the orbit's planet.
pub type EarthSensor = DirectionSensor<SensedPlanet>;

/// Planet of the orbit, as an Earth sensor measures it.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, JsonSchema)]
#[schemars(rename = "Earth")]
pub struct SensedPlanet;

impl SensedBody for SensedPlanet {
    const STREAM: &'static str = "earth sensor";
    const DESCRIPTION: &'static str = "An Earth sensor on a body with three axes: a horizon sensor. It measures the direction to the centre of the \
                                       orbit's planet as a unit vector, by day and by night.\n\nA value is one number for all axes, or a list of \
                                       three.";
    const UNDEFINED: &'static str =
        "measures the direction to the planet of `environment.orbit`, and there is none";

    const MEANING: &'static str = "direction to the planet's centre in body axes";

    fn reference(covariance: Matrix3<f64>) -> ReferenceNoise {
        ReferenceNoise::Earth(covariance)
    }

    fn direction(sky: &EnvironmentObservation) -> Option<Vector> {
        sky.nadir
    }

    fn is_defined(environment: EnvironmentOffers) -> bool {
        environment.orbit
    }
}

#[cfg(test)]
mod tests {
    use flexsc_numerics::attitude::rotation;
    use flexsc_numerics::random::Seed;
    use flexsc_numerics::time::{Instant, Span};

    use super::*;
    use crate::sensor::{Orientation, SensorSpec, Truth};

    #[test]
    fn it_measures_the_nadir_within_its_field_of_view() {
        let sensor: EarthSensor =
            flexsc_formats::document::from_text("period = 1.0\nboresight = [0, 0, 2]\nfield_of_view = 0.5")
                .unwrap();
        assert_eq!(sensor.validate(), None);
        let mut state = sensor.start(3, Seed { scenario: 1, run: 0 }, 0);
        let mut measure = |t: f64, rotation_angle: f64, nadir: Option<Vector>| {
            let sky = EnvironmentObservation { nadir, ..EnvironmentObservation::default() };
            let orientation = Orientation::Attitude(rotation(&Vector::new(rotation_angle, 0.0, 0.0)));
            let [elastic, rate] = [[0.0; 3]; 2];
            let truth =
                Truth { orientation, elastic, rate, rigid_rate: rate, rate_integral: rate, environment: sky };
            let now = Instant::START + Span::from_seconds(t);
            state.read(now, &truth, None).and_then(|reading| reading.sight)
        };
        let sight = measure(0.0, 0.499, Some(Vector::z())).unwrap();
        assert!((sight.vector - Vector::new(0.0, libm::sin(0.499), libm::cos(0.499))).norm() < 1e-15);
        assert!(sight.is_direction && sight.inertial == Vector::z());
        assert!(measure(1.0, 0.501, Some(Vector::z())).is_none() && measure(2.0, 0.0, None).is_none());
    }
}
