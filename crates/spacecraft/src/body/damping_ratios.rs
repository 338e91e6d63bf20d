//! Damping ratios of a structure's modes: one for all, or one for each.

use std::borrow::Cow;
use std::fmt;

use flexsc_formats::count::counted;
use flexsc_numerics::quantity::NonNegative;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Damping ratios of modes.
#[derive(Clone, Debug, PartialEq)]
pub enum DampingRatios {
    /// One ratio for all modes.
    All(NonNegative),
    /// One ratio for each mode, from the lowest on.
    Each(Vec<NonNegative>),
}

impl Default for DampingRatios {
    fn default() -> Self {
        Self::All(NonNegative::default())
    }
}

impl DampingRatios {
    /// Returns the damping ratios of `modes` modes, or the reason why the number of ratios does not fit.
    pub fn for_modes(&self, modes: usize) -> Result<Vec<NonNegative>, String> {
        match self {
            Self::All(ratio) => Ok(vec![*ratio; modes]),
            Self::Each(ratios) if ratios.len() == modes => Ok(ratios.clone()),
            Self::Each(ratios) => Err(format!(
                "must be one number, or one for each of {}, got {}",
                counted(modes, "mode"),
                ratios.len()
            )),
        }
    }
}

impl Serialize for DampingRatios {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::All(ratio) => ratio.serialize(serializer),
            Self::Each(ratios) => ratios.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for DampingRatios {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(RatiosSpec)
    }
}

struct RatiosSpec;

impl<'de> Visitor<'de> for RatiosSpec {
    type Value = DampingRatios;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a damping ratio, or an array of them")
    }

    fn visit_f64<E: Error>(self, ratio: f64) -> Result<DampingRatios, E> {
        let refused = || E::custom(format!("must be a number of 0 or more, got {ratio}"));
        NonNegative::new(ratio).map(DampingRatios::All).ok_or_else(refused)
    }

    fn visit_i64<E: Error>(self, ratio: i64) -> Result<DampingRatios, E> {
        self.visit_f64(ratio as f64)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<DampingRatios, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(seq)).map(DampingRatios::Each)
    }
}

impl JsonSchema for DampingRatios {
    fn schema_name() -> Cow<'static, str> {
        "Damping".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A damping ratio for all modes, or one for each",
            "anyOf": [
                {"type": "number", "minimum": 0},
                {"type": "array", "items": {"type": "number", "minimum": 0}}
            ]
        })
    }
}
