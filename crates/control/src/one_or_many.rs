//! One or several parts of a kind in a scenario: a table, or an array of tables.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut};

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// One or more parts of a kind.
#[derive(Clone, Debug, PartialEq)]
pub struct OneOrMany<T> {
    parts: Vec<T>,
    /// True if the parts were written as an array, even of one part.
    listed: bool,
}

impl<T> OneOrMany<T> {
    /// Creates a single part, not written as an array.
    pub fn one(part: T) -> Self {
        Self { parts: vec![part], listed: false }
    }

    /// Keeps the parts, each with its index, that a test selects; all of them if it selects none.
    pub fn retain(&mut self, keeps: impl Fn(usize, &T) -> bool) {
        let kept: Vec<bool> = self.parts.iter().enumerate().map(|(index, part)| keeps(index, part)).collect();
        if kept.contains(&true) {
            let mut kept = kept.into_iter();
            self.parts.retain(|_| kept.next().unwrap_or(true));
        }
    }

    /// Returns the key of a part: `name` for a single part, else with its index.
    pub fn key(&self, name: &str, index: usize) -> String {
        if self.listed { format!("{name}[{index}]") } else { name.to_owned() }
    }
}

impl<T: Default> Default for OneOrMany<T> {
    fn default() -> Self {
        Self::one(T::default())
    }
}

impl<T> Deref for OneOrMany<T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        &self.parts
    }
}

impl<T> DerefMut for OneOrMany<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.parts
    }
}

impl<T: Serialize> Serialize for OneOrMany<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.parts[..] {
            [part] if !self.listed => part.serialize(serializer),
            parts => parts.serialize(serializer),
        }
    }
}

/// Visitor that reads a table or an array of tables.
struct OneOrManySpec<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for OneOrManySpec<T> {
    type Value = OneOrMany<T>;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("a table, or an array of tables")
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<OneOrMany<T>, E> {
        T::deserialize(serde::de::value::StrDeserializer::new(value)).map(OneOrMany::one)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<OneOrMany<T>, A::Error> {
        T::deserialize(MapAccessDeserializer::new(map)).map(OneOrMany::one)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<OneOrMany<T>, A::Error> {
        let parts = Vec::deserialize(SeqAccessDeserializer::new(seq))?;
        if parts.is_empty() {
            Err(A::Error::invalid_length(0, &"one part or more"))
        } else {
            Ok(OneOrMany { parts, listed: true })
        }
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for OneOrMany<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OneOrManySpec(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for OneOrMany<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("{}s", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let one = generator.subschema_for::<T>();
        let several = generator.subschema_for::<Vec<T>>();
        json_schema!({ "anyOf": [one, several] })
    }
}
