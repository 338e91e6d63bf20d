//! An Earth sensor: the direction to the planet's centre in the body's axes, from the horizon, if it is within the field
//! of view.

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

/// An Earth sensor on a body with three axes: a horizon sensor. It measures the direction to the centre of the orbit's
/// planet as a unit vector, by day and by night.
///
/// A value is one number for all axes, or a list of three.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EarthSensor {
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
    /// Intervals in which the Earth sensor fails.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<SensorFailure>,
}

fn ahead() -> [Finite; 3] {
    [0.0, 0.0, 1.0].map(|part| Finite::new(part).unwrap_or_default())
}

fn full_field_of_view() -> NonNegative {
    NonNegative::new(std::f64::consts::PI).unwrap_or_default()
}

impl EarthSensor {
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
            offers.environment.orbit,
            "",
            "measures the direction to the planet of `environment.orbit`, and there is none",
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

impl VectorSensor for EarthSensor {
    const STREAM: &'static str = "earth sensor";

    fn reference(&self, sky: &EnvironmentObservation) -> Option<Vector> {
        sky.nadir
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
    use flexsc_numerics::attitude::rotation;
    use flexsc_numerics::time::Instant;

    use super::*;
    use crate::sensor::{Orientation, Truth};

    #[test]
    fn it_measures_the_nadir_within_its_field_of_view() {
        let sensor: EarthSensor =
            flexsc_formats::document::from_text("period = 1.0\nboresight = [0, 0, 2]\nfield_of_view = 0.5")
                .unwrap();
        assert_eq!(sensor.inconsistency(), None);
        let mut state = sensor.start(Seed { scenario: 1, run: 0 }, 0);
        let mut measure = |t: f64, rotation_angle: f64, nadir: Option<Vector>| {
            let sky = EnvironmentObservation { nadir, ..EnvironmentObservation::default() };
            let orientation = Orientation::Attitude(rotation(&Vector::new(rotation_angle, 0.0, 0.0)));
            let [elastic, rate] = [[0.0; 3]; 2];
            let truth = Truth { orientation, elastic, rate, rigid: rate, turned: rate, sky };
            let now = Instant::START + Span::from_seconds(t);
            state.read(now, &truth, None).and_then(|reading| reading.sight)
        };
        let sight = measure(0.0, 0.499, Some(Vector::z())).unwrap();
        assert!((sight.vector - Vector::new(0.0, libm::sin(0.499), libm::cos(0.499))).norm() < 1e-15);
        assert!(sight.is_direction && sight.inertial == Vector::z());
        assert!(measure(1.0, 0.501, Some(Vector::z())).is_none() && measure(2.0, 0.0, None).is_none());
    }
}
