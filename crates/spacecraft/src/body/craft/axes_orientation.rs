//! Orientation of an appendage's axes relative to those of the body: one rotation, or a sequence.

use std::borrow::Cow;
use std::fmt;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::vector;
use flexsc_numerics::quantity::Finite;
use nalgebra::Matrix3;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

const EXPECTED: &str = "a turn `{ about = [x, y, z], by = ANGLE }`, or an array of turns";

/// A turn about a fixed axis.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Turn")]
pub struct AxisRotation {
    /// Axis, of any nonzero length; of several turns, each is about axes turned by those before.
    pub about: [Finite; 3],
    /// The angle (rad).
    pub by: Finite,
}

/// One rotation, or a sequence in which each is about the axes rotated by those before it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum AxesOrientation {
    /// A single rotation.
    Once(AxisRotation),
    /// A sequence of rotations.
    InOrder(Vec<AxisRotation>),
}

impl Default for AxesOrientation {
    fn default() -> Self {
        Self::InOrder(Vec::new())
    }
}

impl AxesOrientation {
    fn turns(&self) -> &[AxisRotation] {
        match self {
            Self::Once(turn) => std::slice::from_ref(turn),
            Self::InOrder(turns) => turns,
        }
    }

    /// Returns true if there is no rotation.
    pub fn is_identity(&self) -> bool {
        self.turns().is_empty()
    }

    /// Returns the matrix that transforms vectors from the rotated axes to the original ones.
    pub fn matrix(&self) -> Matrix3<f64> {
        self.turns().iter().fold(Matrix3::identity(), |matrix, turn| matrix * turn.matrix())
    }

    /// Checks the axis and the angle of each rotation.
    ///
    /// # Errors
    /// A key within the orientation, and the reason.
    pub fn check(&self) -> Result<(), ConfigError> {
        for (index, turn) in self.turns().iter().enumerate() {
            let place = if let Self::Once(_) = self { String::new() } else { format!("[{index}]") };
            turn.check().map_err(|fault| if place.is_empty() { fault } else { fault.within(&place) })?;
        }
        Ok(())
    }
}

impl AxisRotation {
    /// Returns the rotation matrix (1 - cos) a a' + cos 1 + sin \[a\], with the unit axis a.
    fn matrix(&self) -> Matrix3<f64> {
        let axis = vector(&self.about);
        let axis = axis / axis.norm();
        let (sin, cos) = libm::sincos(self.by.get());
        (1.0 - cos) * axis * axis.transpose() + cos * Matrix3::identity() + sin * axis.cross_matrix()
    }

    fn check(&self) -> Result<(), ConfigError> {
        let (length, by) = (vector(&self.about).norm(), self.by.get());
        if !(1e-6..=1e6).contains(&length) {
            return Err(ConfigError::new(
                "about",
                format!("must have a length of 1e-6 to 1e6, got {length}"),
            ));
        }
        if by.abs() > 2.0 * std::f64::consts::PI {
            let why = format!("must be an angle of -2 pi to 2 pi, in rad, or such as \"30 deg\", got {by}");
            return Err(ConfigError::new("by", why));
        }
        Ok(())
    }
}

impl<'de> Deserialize<'de> for AxesOrientation {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AxesOrientationSpec)
    }
}

struct AxesOrientationSpec;

impl<'de> Visitor<'de> for AxesOrientationSpec {
    type Value = AxesOrientation;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(EXPECTED)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<AxesOrientation, A::Error> {
        AxisRotation::deserialize(MapAccessDeserializer::new(map)).map(AxesOrientation::Once)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<AxesOrientation, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(seq)).map(AxesOrientation::InOrder)
    }
}

impl JsonSchema for AxesOrientation {
    fn schema_name() -> Cow<'static, str> {
        "Turned".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let turn = generator.subschema_for::<AxisRotation>();
        json_schema!({
            "description": "A turn, or turns one after another",
            "anyOf": [turn, {"type": "array", "items": turn}]
        })
    }
}
