//! Attitude and rates of a three-axis body at the start: as written or those of the target, and an error beside them.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use flexsc_numerics::attitude::{Attitude, rotation, vector};
use flexsc_numerics::quantity::Finite;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::manoeuvre::AttitudeMotion;

/// Word of the scenario for the value of the target.
const TARGET: &str = "target";

/// Value at the start of a run: as written, or that of the target at that instant.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum StartValue<T> {
    /// As written.
    Written(T),
    /// That of the target.
    Target,
}

/// Returns true if all components are zero.
pub(super) fn is_zero(components: &[Finite; 3]) -> bool {
    components.iter().all(|part| part.get() == 0.0)
}

/// Attitude and rates of a three-axis body at the start, with the errors that a scenario adds to them.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct InitialMotion {
    /// Attitude without its error.
    pub attitude: StartValue<Attitude>,
    /// Rotation vector (rad) from that attitude to the one of the start, in the body's axes.
    pub attitude_error: [Finite; 3],
    /// Rates (rad/s) without their error, in the body's axes.
    pub rate: StartValue<[Finite; 3]>,
    /// Rates (rad/s) in addition, in the body's axes.
    pub rate_error: [Finite; 3],
}

impl InitialMotion {
    /// Returns the attitude and the rates (rad/s, in the body's axes) at the start, when the target moves like this.
    pub fn resolve(&self, target: &AttitudeMotion) -> (Attitude, [Finite; 3]) {
        let written = match self.attitude {
            StartValue::Written(attitude) => attitude,
            StartValue::Target => Attitude::new(target.attitude),
        };
        // A product with the identity could change the sign of a zero.
        let attitude = if is_zero(&self.attitude_error) {
            written
        } else {
            Attitude::new(written.get() * rotation(&vector(&self.attitude_error)))
        };
        let rate = match self.rate {
            StartValue::Written(rate) => rate,
            StartValue::Target => {
                let axes = attitude.get().conjugate() * target.attitude;
                let turned = axes * nalgebra::Quaternion::from_imag(target.rate) * axes.conjugate();
                [turned.i, turned.j, turned.k].map(|part| Finite::new(part).unwrap_or_default())
            }
        };
        if is_zero(&self.rate_error) {
            return (attitude, rate);
        }
        let sum = |axis: usize| Finite::new(rate[axis].get() + self.rate_error[axis].get());
        (attitude, [0, 1, 2].map(|axis| sum(axis).unwrap_or(rate[axis])))
    }
}

impl<T: Default> Default for StartValue<T> {
    fn default() -> Self {
        Self::Written(T::default())
    }
}

impl<T: Serialize> Serialize for StartValue<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Written(value) => value.serialize(serializer),
            Self::Target => TARGET.serialize(serializer),
        }
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for StartValue<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Start<T>(PhantomData<T>);

        impl<'de, T: Deserialize<'de>> Visitor<'de> for Start<T> {
            type Value = StartValue<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an array of numbers, or \"target\"")
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<StartValue<T>, E> {
                let unknown = || E::unknown_variant(word, &[TARGET]);
                (word == TARGET).then_some(StartValue::Target).ok_or_else(unknown)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<StartValue<T>, A::Error> {
                T::deserialize(SeqAccessDeserializer::new(seq)).map(StartValue::Written)
            }
        }
        deserializer.deserialize_any(Start(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for StartValue<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("{}OrTarget", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let written = generator.subschema_for::<T>();
        json_schema!({ "anyOf": [written, { "const": TARGET }] })
    }
}
