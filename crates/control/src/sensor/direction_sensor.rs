//! A sensor of the direction to a body in the sky, in the body's axes, if it is within the field of view.

use std::fmt;
use std::marker::PhantomData;

use flexsc_formats::document;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::{Finite, NonNegative, Time};
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Span;
use flexsc_spacecraft::axes::PerAxis;
use flexsc_spacecraft::environment::EnvironmentObservation;
use nalgebra::Matrix3;
use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};

use super::vector::{VectorErrors, VectorSensor, VectorSensorState};
use super::{FieldOfView, MeasuredQuantity, ReferenceNoise, Sensor, SensorFailure, SensorSpec, Subject};
use crate::offers::{EnvironmentOffers, Offers};
use crate::quantity::QuantityShape;
use crate::requirement::Requirements;

/// Body to which a sensor measures the direction.
pub trait SensedBody: Copy + Default + PartialEq + fmt::Debug + Send + Sync + JsonSchema + 'static {
    /// Name of the random stream of the sensor's noise, which is that of the sensor.
    const STREAM: &'static str;
    /// Description of the sensor in the schema.
    const DESCRIPTION: &'static str;
    /// Reason why there is no direction, as a text that follows the key.
    const UNDEFINED: &'static str;

    /// Meaning of the measured direction, as a noun phrase.
    const MEANING: &'static str;

    /// Returns the noise of the direction with this covariance.
    fn reference(covariance: Matrix3<f64>) -> ReferenceNoise;

    /// Returns the direction in inertial axes, if it can be measured.
    fn direction(sky: &EnvironmentObservation) -> Option<Vector>;

    /// Returns true if an environment has the body.
    fn is_defined(environment: EnvironmentOffers) -> bool;
}

/// Sets the descriptions of a sensor of a body in the schema.
fn describe<B: SensedBody>(schema: &mut Schema) {
    schema.insert("description".to_owned(), B::DESCRIPTION.into());
    let sensor = B::STREAM.replacen("earth", "Earth", 1).replacen("sun", "Sun", 1);
    if let Some(text) = schema.pointer_mut("/properties/faults/description") {
        *text = format!("Intervals in which the {sensor} fails.").into();
    }
}

/// A sensor of a direction on a body with three axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound = "B: SensedBody")]
#[schemars(rename = "{B}Sensor", transform = describe::<B>)]
pub struct DirectionSensor<B: SensedBody> {
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
    /// Intervals in which the sensor fails.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<SensorFailure>,
    #[serde(skip)]
    body: PhantomData<B>,
}

fn ahead() -> [Finite; 3] {
    [0.0, 0.0, 1.0].map(|part| Finite::new(part).unwrap_or_default())
}

fn full_field_of_view() -> NonNegative {
    NonNegative::new(std::f64::consts::PI).unwrap_or_default()
}

impl<B: SensedBody> SensorSpec for DirectionSensor<B> {
    fn start(&self, _: usize, seed: Seed, ordinal: usize) -> Box<dyn Sensor> {
        Box::new(VectorSensorState::new(self, seed, ordinal))
    }

    fn period(&self, _: Option<Span>) -> Option<Span> {
        Some(self.period)
    }

    fn subject(&self) -> Subject {
        Subject::Direction
    }

    fn point(&self) -> Option<&str> {
        self.point.as_deref()
    }

    fn faults(&self) -> &[SensorFailure] {
        &self.faults
    }

    fn validate(&self) -> Option<document::ConfigError> {
        if self.boresight.iter().all(|part| part.get() == 0.0) {
            return Some(document::ConfigError::new("boresight", "must not be zero, got [0, 0, 0]"));
        }
        self.errors().validate()
    }

    fn requires(&self, _: usize, offers: &Offers, needs: &mut Requirements) {
        super::requirements::require_attitude(offers, needs);
        needs.require(B::is_defined(offers.environment), "", B::UNDEFINED);
    }

    fn field_of_view(&self) -> Option<FieldOfView> {
        let half_angle = self.field_of_view.get();
        let boresight = vector(&self.boresight).normalize();
        (half_angle < std::f64::consts::PI).then_some(FieldOfView { boresight, half_angle })
    }

    fn reference(&self) -> Option<(Span, ReferenceNoise)> {
        let [_, latency] = self.timing();
        Some((latency, B::reference(self.errors().covariance())))
    }

    fn measured_quantities(&self, _: bool, _: usize) -> Vec<MeasuredQuantity> {
        vec![MeasuredQuantity::vector("direction", "", QuantityShape::Vector, B::MEANING)]
    }
}

impl<B: SensedBody> VectorSensor for DirectionSensor<B> {
    const STREAM: &'static str = B::STREAM;

    fn inertial_vector(&self, sky: &EnvironmentObservation) -> Option<Vector> {
        B::direction(sky)
    }

    fn reading(&self, exact: &Vector, measured: Vector) -> Option<Vector> {
        let boresight = vector(&self.boresight);
        // The angle itself is compared, because its cosine is insensitive for a narrow field.
        let off = libm::atan2(boresight.cross(exact).norm(), boresight.dot(exact));
        (off <= self.field_of_view.get()).then(|| measured.normalize())
    }

    fn errors(&self) -> VectorErrors {
        let Self { noise, bias, resolution, scale, misalignment, .. } = *self;
        VectorErrors { noise, bias, resolution, scale, misalignment }
    }

    fn timing(&self) -> [Span; 2] {
        [self.period, Span::from_seconds(self.latency.get())]
    }
}
