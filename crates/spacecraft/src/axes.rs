//! Axes of a body, and values about them: one for all, or one for each of three.

use std::borrow::Cow;

use flexsc_formats::document::read_value;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// An axis of a body with three.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// About x.
    Roll,
    /// About y.
    Pitch,
    /// About z.
    Yaw,
}

impl Axis {
    /// Returns the index of the axis: 0, 1 or 2.
    pub fn index(self) -> usize {
        match self {
            Self::Roll => 0,
            Self::Pitch => 1,
            Self::Yaw => 2,
        }
    }
}

/// One value for all axes, or one each for roll, pitch and yaw.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum PerAxis<T> {
    /// One value for all axes.
    All(T),
    /// One value each for roll, pitch and yaw.
    Three([T; 3]),
}

impl<T: Copy> PerAxis<T> {
    /// Returns the value about the axis of index `axis`.
    pub fn about(&self, axis: usize) -> T {
        match self {
            Self::All(value) => *value,
            Self::Three(values) => values[axis.min(2)],
        }
    }

    /// Returns true if there is one value for each of three axes.
    pub fn is_three(&self) -> bool {
        matches!(self, Self::Three(_))
    }
}

impl<T: Default> Default for PerAxis<T> {
    fn default() -> Self {
        Self::All(T::default())
    }
}

impl<T: Serialize> Serialize for PerAxis<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::All(value) => value.serialize(serializer),
            Self::Three(values) => values.serialize(serializer),
        }
    }
}

impl<'de, T: DeserializeOwned> Deserialize<'de> for PerAxis<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        use serde::de::Error;
        let value = toml::Value::deserialize(deserializer)?;
        if let toml::Value::Array(values) = &value {
            let found = values.len();
            if found != 3 {
                let why = format!("must be one number, or three for roll, pitch and yaw, got {found}");
                return Err(D::Error::custom(why));
            }
            return read_value(&value).map(Self::Three).map_err(D::Error::custom);
        }
        read_value(&value).map(Self::All).map_err(D::Error::custom)
    }
}

impl<T: JsonSchema> JsonSchema for PerAxis<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("Each{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let one = generator.subschema_for::<T>();
        let three = generator.subschema_for::<[T; 3]>();
        json_schema!({ "anyOf": [one, three] })
    }
}
