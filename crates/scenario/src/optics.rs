//! Optics of an instrument: how far each turns its line of sight as it rotates and as it is displaced.

use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::Finite;
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Part of the largest row by which the rows of all optics may differ from a sum of zero.
const ROUNDING: f64 = 1e-9;

/// Mirror, lens or detector at a point of the structure. The two rows of each matrix are the rotations of the line of sight
/// about the body axes across it, in cyclic order: about x and y for a line along z.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OpticalElement {
    /// Point of the structure at which it is mounted.
    pub point: String,
    /// Rotation of the line of sight per rotation of the point, about x, y and z (rad/rad).
    #[serde(default)]
    pub rotation: [[Finite; 3]; 2],
    /// Rotation of the line of sight per displacement of the point, along x, y and z (rad/m); the sum over all optics is zero.
    #[serde(default)]
    pub translation: [[Finite; 3]; 2],
}

/// Rotation of a line of sight, about the axes of the body, by a small motion of the body.
#[derive(Clone, Debug, PartialEq)]
pub struct LineSensitivity {
    /// Per rotation of the rigid body (rad/rad).
    pub rigid: Matrix3<f64>,
    /// Per unit of each mode (rad/(m sqrt(kg))).
    pub modes: Vec<Vector>,
}

impl LineSensitivity {
    /// Returns the sensitivity of an instrument that turns with a point and looks along a unit vector.
    pub fn for_point(body: &ThreeAxisModel, point: &str, direction: &Vector) -> Self {
        let across = |rotation: &Vector| rotation - direction * direction.dot(rotation);
        Self {
            rigid: Matrix3::from_columns(&[0, 1, 2].map(|axis| across(&Vector::ith(axis, 1.0)))),
            modes: body.shapes(point).iter().map(|(_, rotation)| across(rotation)).collect(),
        }
    }

    /// Returns the sensitivity to the modes besides the rotation of the hub, where they act back on it.
    #[must_use]
    pub fn besides_hub(mut self, body: &ThreeAxisModel) -> Self {
        let hub = body.coupling.as_ref().map_or(&[][..], |coupling| &coupling.rotations);
        self.modes.iter_mut().zip(hub).for_each(|(mode, hub)| *mode -= self.rigid * hub);
        self
    }

    /// Returns the sensitivity of optics, whose rows are about two axes.
    pub fn for_optics(body: &ThreeAxisModel, optics: &[OpticalElement], about: [Vector; 2]) -> Self {
        let mut all = Self { rigid: Matrix3::zeros(), modes: vec![Vector::zeros(); body.modes.len()] };
        for element in optics {
            let position = body.point(&element.point).unwrap_or_default();
            let shapes = body.shapes(&element.point);
            for (row, axis) in about.iter().enumerate() {
                let (rotation, translation) =
                    (vector(&element.rotation[row]), vector(&element.translation[row]));
                // A rotation w displaces the point by w x r.
                all.rigid += axis * (rotation + position.cross(&translation)).transpose();
                for (mode, (shift, turn)) in all.modes.iter_mut().zip(&shapes) {
                    *mode += axis * (rotation.dot(turn) + translation.dot(shift));
                }
            }
        }
        all
    }
}

/// Checks the optics of a line of sight; returns the inconsistent key and the reason.
pub(super) fn fault(optics: &[OpticalElement], body: &ThreeAxisModel) -> Option<ConfigError> {
    for (index, element) in optics.iter().enumerate() {
        if body.point(&element.point).is_none() {
            let why =
                format!("must be one of the body's points, {}, got `{}`", body.point_names(), element.point);
            return Some(ConfigError::new(format!("optics[{index}].point"), why));
        }
    }
    let rows = [0, 1].map(|row| optics.iter().map(move |element| vector(&element.translation[row])));
    rows.into_iter().find_map(|row| {
        let largest = row.clone().map(|own| own.amax()).fold(0.0, f64::max);
        let sum: Vector = row.sum();
        (sum.amax() > ROUNDING * largest).then(|| {
            let [x, y, z] = [sum.x, sum.y, sum.z];
            ConfigError::new(
                "optics",
                format!(
                    "must have `translation` that sums to zero over all optics, got [{x}, {y}, {z}] rad/m: a displacement of the whole \
                     body does not turn the line of sight to a distant object"
                ),
            )
        })
    })
}
