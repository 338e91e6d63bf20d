//! How an actuator is written: `[actuator.KIND]`, or `actuator = "ideal"` for one without keys.

use std::fmt;

use schemars::Schema;
use serde::de::value::{MapAccessDeserializer, StrDeserializer};
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde::ser::{Serialize, Serializer};
use serde_json::{Value, json};

use super::{Actuator, Ideal};

/// The name of the kind that needs no keys.
const IDEAL: &str = "ideal";

/// Adds the word to what a scenario may have.
pub(super) fn or_a_word(schema: &mut Schema) {
    if let Some(kinds) = schema.get_mut("oneOf").and_then(Value::as_array_mut) {
        kinds.push(json!({ "const": IDEAL, "description": "The command itself, at every instant." }));
    }
}

struct Kind;

impl<'de> Visitor<'de> for Kind {
    type Value = Actuator;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an actuator")
    }

    fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<Actuator, E> {
        if name == IDEAL {
            return Ok(Actuator::Ideal(Ideal::default()));
        }
        Actuator::deserialize(StrDeserializer::new(name))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Actuator, A::Error> {
        Actuator::deserialize(MapAccessDeserializer::new(map))
    }
}

impl<'de> Deserialize<'de> for Actuator {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Kind)
    }
}

impl Serialize for Actuator {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Ideal(ideal) if ideal.faults.is_empty() => serializer.serialize_str(IDEAL),
            _ => Self::serialize(self, serializer),
        }
    }
}
