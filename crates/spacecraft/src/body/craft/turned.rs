//! How the axes of an appendage are turned against those of the body: one turn, or one after another.

use std::borrow::Cow;
use std::fmt;

use nalgebra::Matrix3;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::attitude::vector;
use crate::document::Fault;
use crate::quantity::Finite;

const EXPECTED: &str = "a turn `{ about = [x, y, z], by = ANGLE }`, or an array of turns";

/// A turn about a fixed axis.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Turn {
    /// Axis, of any nonzero length.
    pub about: [Finite; 3],
    /// The angle (rad).
    pub by: Finite,
}

/// One turn, or several of which each is about the axes that those before it have turned.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Turned {
    /// One.
    Once(Turn),
    /// One after another.
    InOrder(Vec<Turn>),
}

impl Default for Turned {
    fn default() -> Self {
        Self::InOrder(Vec::new())
    }
}

impl Turned {
    fn turns(&self) -> &[Turn] {
        match self {
            Self::Once(turn) => std::slice::from_ref(turn),
            Self::InOrder(turns) => turns,
        }
    }

    /// Whether nothing is turned.
    pub fn is_none(&self) -> bool {
        self.turns().is_empty()
    }

    /// The matrix that brings vectors from the turned axes to those before.
    pub fn matrix(&self) -> Matrix3<f64> {
        self.turns().iter().fold(Matrix3::identity(), |matrix, turn| matrix * turn.matrix())
    }

    /// What single values cannot show to be wrong.
    ///
    /// # Errors
    /// A key within, and why.
    pub fn check(&self) -> Result<(), Fault> {
        for (index, turn) in self.turns().iter().enumerate() {
            let place = if let Self::Once(_) = self { String::new() } else { format!("[{index}]") };
            turn.check().map_err(|fault| if place.is_empty() { fault } else { fault.within(&place) })?;
        }
        Ok(())
    }
}

impl Turn {
    /// (1 - cos) a a' + cos 1 + sin \[a\], with the unit axis a.
    fn matrix(&self) -> Matrix3<f64> {
        let axis = vector(&self.about);
        let axis = axis / axis.norm();
        let (sin, cos) = libm::sincos(self.by.get());
        (1.0 - cos) * axis * axis.transpose() + cos * Matrix3::identity() + sin * axis.cross_matrix()
    }

    fn check(&self) -> Result<(), Fault> {
        let (length, by) = (vector(&self.about).norm(), self.by.get());
        if !(1e-6..=1e6).contains(&length) {
            return Err(Fault::new("about", format!("must have a length of 1e-6 to 1e6, got {length}")));
        }
        if by.abs() > 2.0 * std::f64::consts::PI {
            let why = format!("must be an angle of -2 pi to 2 pi, in rad, or such as \"30 deg\", got {by}");
            return Err(Fault::new("by", why));
        }
        Ok(())
    }
}

impl<'de> Deserialize<'de> for Turned {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OneOrMore)
    }
}

struct OneOrMore;

impl<'de> Visitor<'de> for OneOrMore {
    type Value = Turned;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(EXPECTED)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Turned, A::Error> {
        Turn::deserialize(MapAccessDeserializer::new(map)).map(Turned::Once)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Turned, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(seq)).map(Turned::InOrder)
    }
}

impl JsonSchema for Turned {
    fn schema_name() -> Cow<'static, str> {
        "Turned".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let turn = generator.subschema_for::<Turn>();
        json_schema!({
            "description": "A turn, or turns one after another",
            "anyOf": [turn, {"type": "array", "items": turn}]
        })
    }
}
