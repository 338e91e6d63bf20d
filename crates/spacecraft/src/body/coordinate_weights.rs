//! Weights of a structure's coordinates in an observed one: all in order, or some by name.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

use flexsc_numerics::quantity::Finite;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Weights of coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum CoordinateWeights {
    /// One weight for each coordinate.
    Each(Vec<Finite>),
    /// Weights by the coordinate's name; 0 for the other coordinates.
    Named(BTreeMap<String, Finite>),
}

impl CoordinateWeights {
    /// Returns one weight for each coordinate, or an error message.
    pub fn resolve(&self, coordinates: &[String]) -> Result<Vec<f64>, String> {
        match self {
            Self::Each(weights) if weights.len() == coordinates.len() => {
                Ok(weights.iter().map(|weight| weight.get()).collect())
            }
            Self::Each(weights) => {
                let (order, found) = (coordinates.len(), weights.len());
                Err(format!("must have one number for each of {order} coordinates, got {found}"))
            }
            Self::Named(named) => {
                let mut weights = vec![0.0; coordinates.len()];
                for (name, weight) in named {
                    let index = coordinates.iter().position(|coordinate| coordinate == name);
                    let index = index.ok_or_else(|| {
                        let ends = coordinates.first().zip(coordinates.last());
                        let (first, last) = ends.map_or(("", ""), |(first, last)| (first, last));
                        format!("must name coordinates (`{first}` to `{last}`), got `{name}`")
                    })?;
                    weights[index] = weight.get();
                }
                Ok(weights)
            }
        }
    }
}

impl Serialize for CoordinateWeights {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Each(weights) => weights.serialize(serializer),
            Self::Named(named) => named.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for CoordinateWeights {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(WeightsSpec)
    }
}

struct WeightsSpec;

impl<'de> Visitor<'de> for WeightsSpec {
    type Value = CoordinateWeights;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an array with a weight for each coordinate, or a table of weights by coordinate")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<CoordinateWeights, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(seq)).map(CoordinateWeights::Each)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<CoordinateWeights, A::Error> {
        BTreeMap::deserialize(MapAccessDeserializer::new(map)).map(CoordinateWeights::Named)
    }
}

impl JsonSchema for CoordinateWeights {
    fn schema_name() -> Cow<'static, str> {
        "Weights".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A weight for each coordinate, or weights by the names of coordinates",
            "anyOf": [
                {"type": "array", "items": {"type": "number"}},
                {"type": "object", "additionalProperties": {"type": "number"}}
            ]
        })
    }
}
