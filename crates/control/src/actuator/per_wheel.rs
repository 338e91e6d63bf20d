//! Values of wheels: one for all wheels, or one for each.

use std::borrow::Cow;

use flexsc_formats::count::counted;
use flexsc_formats::document::{ConfigError, read_value};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// One value for all wheels, or one for each.
#[derive(Clone, Debug, PartialEq)]
pub enum PerWheel<T> {
    /// Value of all wheels.
    All(T),
    /// Value of each wheel, in the order of the scenario.
    Each(Vec<T>),
}

impl<T: Clone + Default> PerWheel<T> {
    /// Returns the value of a wheel.
    pub fn for_wheel(&self, wheel: usize) -> T {
        match self {
            Self::All(value) => value.clone(),
            Self::Each(values) => values.get(wheel).cloned().unwrap_or_default(),
        }
    }

    /// Checks the number of values against the number of wheels.
    ///
    /// # Errors
    /// A `ConfigError` with the key and the reason.
    pub fn validate_count(&self, key: &str, wheels: usize) -> Result<(), ConfigError> {
        match self {
            Self::Each(values) if values.len() != wheels => {
                let why = format!(
                    "must be one for all, or one for each of {}, got {}",
                    counted(wheels, "wheel"),
                    values.len()
                );
                Err(ConfigError::new(key, why))
            }
            _ => Ok(()),
        }
    }
}

impl<T: Default + PartialEq> PerWheel<T> {
    /// Returns true if the value of all wheels is the default.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

impl<T: Default> Default for PerWheel<T> {
    fn default() -> Self {
        Self::All(T::default())
    }
}

impl<T: Serialize> Serialize for PerWheel<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::All(value) => value.serialize(serializer),
            Self::Each(values) => values.serialize(serializer),
        }
    }
}

impl<'de, T: DeserializeOwned> Deserialize<'de> for PerWheel<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        use serde::de::Error;
        let value = toml::Value::deserialize(deserializer)?;
        if value.is_array() {
            return read_value(&value).map(Self::Each).map_err(D::Error::custom);
        }
        read_value(&value).map(Self::All).map_err(D::Error::custom)
    }
}

impl<T: JsonSchema> JsonSchema for PerWheel<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("PerWheel{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let one = generator.subschema_for::<T>();
        let each = generator.subschema_for::<Vec<T>>();
        json_schema!({ "anyOf": [one, each] })
    }
}
