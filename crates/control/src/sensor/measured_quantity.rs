//! Quantities that a sensor measures, with their values in a reading, for programs outside the run.

use std::ops::Deref;

use super::Reading;
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

    /// Creates the quantity of a sensor of a vector, such as a magnetic field.
    pub(super) fn vector(
        name: &'static str,
        unit: &'static str,
        shape: QuantityShape,
        meaning: &'static str,
    ) -> Self {
        let read = |reading: &Reading| {
            reading.sight.map(|measured| measured.vector).unwrap_or_default().iter().copied().collect()
        };
        Self::new(name, unit, shape, meaning, read)
    }

    /// Creates the quantity of the reference of a measured vector with this unit, with which an attitude filter compares it.
    pub fn reference(unit: &'static str) -> Self {
        let meaning = "reference of the vector at its exposure in inertial axes, by the ephemeris of the attitude filter";
        let read = |reading: &Reading| {
            reading.sight.map(|measured| measured.inertial).unwrap_or_default().iter().copied().collect()
        };
        Self::new("reference", unit, QuantityShape::Vector, meaning, read)
    }

    /// Iterates over the values in a reading.
    pub fn values(&self, reading: &Reading) -> impl Iterator<Item = f64> + use<> {
        (self.read)(reading).into_iter().take(self.width())
    }
}

/// Returns the quantities of a sensor of the motion about `axes` axes, which measures rates or not and is the source of the
/// attitude or not.
pub(super) fn quantities_of_motion(
    provides_attitude: bool,
    has_rate: bool,
    axes: usize,
) -> Vec<MeasuredQuantity> {
    let attitude = if axes > 1 { measured_attitude } else { measured_angle };
    let attitude = provides_attitude.then(attitude);
    attitude.into_iter().chain(has_rate.then(|| measured_rate(axes))).collect()
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
