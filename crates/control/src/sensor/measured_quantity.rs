//! Quantities that a sensor measures, with their values in a reading, for programs outside the run.

use std::ops::Deref;

use super::{Reading, SensorKind};
use crate::quantity::{Meaning, QuantityDescription, QuantityShape};

/// Quantity of a sensor's readings.
#[derive(Copy, Clone, Debug)]
pub struct MeasuredQuantity {
    quantity: QuantityDescription,
    read: fn(&Reading) -> Vec<f64>,
}

impl Deref for MeasuredQuantity {
    type Target = QuantityDescription;

    fn deref(&self) -> &QuantityDescription {
        &self.quantity
    }
}

impl MeasuredQuantity {
    fn new(
        name: &'static str,
        unit: &'static str,
        shape: QuantityShape,
        meaning: &'static str,
        read: fn(&Reading) -> Vec<f64>,
    ) -> Self {
        Self { quantity: QuantityDescription { name, unit, shape, meaning: Meaning::Text(meaning) }, read }
    }

    /// Creates a quantity that is a vector, such as a magnetic field.
    fn vector(name: &'static str, unit: &'static str, shape: QuantityShape, meaning: &'static str) -> Self {
        let read = |reading: &Reading| {
            reading.sight.map(|measured| measured.vector).unwrap_or_default().iter().copied().collect()
        };
        Self::new(name, unit, shape, meaning, read)
    }

    /// Iterates over the values in a reading.
    pub fn values(&self, reading: &Reading) -> impl Iterator<Item = f64> + use<> {
        (self.read)(reading).into_iter().take(self.width())
    }
}

impl SensorKind {
    /// Returns the quantities that the sensor measures on a body with `axes` axes, of which it is the source of the attitude
    /// or not; none of a tachometer, whose readings are the speeds of the wheels.
    pub fn measured_quantities(&self, provides_attitude: bool, axes: usize) -> Vec<MeasuredQuantity> {
        let vector = MeasuredQuantity::vector;
        match self {
            Self::Tachometer(_) => Vec::new(),
            Self::Accelerometer(accelerometer) => {
                let shape = QuantityShape::List(accelerometer.axis_count());
                vec![vector("specific_force", "m/s²", shape, "specific force along the axes of the sensor")]
            }
            Self::Magnetometer(_) => {
                vec![vector("field", "T", QuantityShape::Vector, "magnetic field in body axes")]
            }
            Self::SunSensor(_) | Self::SunCells(_) => {
                vec![vector("direction", "", QuantityShape::Vector, "direction to the Sun in body axes")]
            }
            Self::EarthSensor(_) => {
                vec![vector(
                    "direction",
                    "",
                    QuantityShape::Vector,
                    "direction to the planet's centre in body axes",
                )]
            }
            Self::Continuous | Self::Sampled(_) | Self::Gyro(_) | Self::StarTracker(_) | Self::Own(_) => {
                let attitude = if axes > 1 { measured_attitude } else { measured_angle };
                let has_rate = self.is_continuous() || self.rate_noise(0).is_some();
                let attitude = provides_attitude.then(attitude);
                attitude.into_iter().chain(has_rate.then(|| measured_rate(axes))).collect()
            }
        }
    }
}

fn measured_attitude() -> MeasuredQuantity {
    let meaning = "measured rotation from body axes to inertial axes";
    MeasuredQuantity::new("attitude", "", QuantityShape::Quaternion, meaning, |reading| {
        let attitude = reading.at.attitude().unwrap_or_default();
        vec![attitude.w, attitude.i, attitude.j, attitude.k]
    })
}

fn measured_angle() -> MeasuredQuantity {
    MeasuredQuantity::new("angle", "rad", QuantityShape::Scalar, "measured angle", |reading| {
        reading.at.error_from(&reading.at.difference_origin()).to_vec()
    })
}

fn measured_rate(axes: usize) -> MeasuredQuantity {
    MeasuredQuantity::new(
        "rate",
        "rad/s",
        QuantityShape::about_axes(axes),
        "measured rate in body axes",
        |reading| reading.rate.unwrap_or_default().to_vec(),
    )
}
