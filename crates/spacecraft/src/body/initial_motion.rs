//! Attitude and rates of a three-axis body at the start: as written or those of the target, and an error beside them.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use flexsc_numerics::attitude::{Attitude, Vector, rotation, vector};
use flexsc_numerics::quantity::Finite;
use nalgebra::Quaternion;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Word of the scenario for the value of the target.
const TARGET: &str = "target";

/// Value at the start of a run: as written, or that of the target at that instant.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum StartValue<T> {
    /// As written.
    Written(T),
    /// Value of the target.
    Target,
}

/// Attitude and rates of a three-axis body at the start, with the errors that a scenario adds to them.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct InitialMotion {
    /// Attitude without its error.
    pub attitude: StartValue<Attitude>,
    /// Rotation vector (rad) from that attitude to the one of the start, in the body's axes.
    pub attitude_error: Option<[Finite; 3]>,
    /// Rates (rad/s) without their error, in the body's axes.
    pub rate: StartValue<[Finite; 3]>,
    /// Rates (rad/s) in addition, in the body's axes.
    pub rate_error: Option<[Finite; 3]>,
}

impl InitialMotion {
    /// Returns the attitude and the rates (rad/s) at the start, with a target at rest in the inertial axes.
    pub(super) fn as_written(&self) -> (Attitude, [Finite; 3]) {
        self.resolve(&Attitude::default().get(), &Vector::zeros())
    }

    /// Returns the attitude and the rates (rad/s, in the body's axes) at the start, with a target that has this attitude
    /// then and this rate (rad/s) in its own axes.
    pub fn resolve(&self, target: &Quaternion<f64>, target_rate: &Vector) -> (Attitude, [Finite; 3]) {
        let written = match self.attitude {
            StartValue::Written(attitude) => attitude,
            StartValue::Target => Attitude::new(*target),
        };
        let attitude = self
            .attitude_error
            .map_or(written, |error| Attitude::new(written.get() * rotation(&vector(&error))));
        let rate = match self.rate {
            StartValue::Written(rate) => rate,
            StartValue::Target => {
                let axes = attitude.get().conjugate() * target;
                let turned = axes * Quaternion::from_imag(*target_rate) * axes.conjugate();
                [turned.i, turned.j, turned.k].map(|part| Finite::new(part).unwrap_or_default())
            }
        };
        let sum = |axis: usize, error: &[Finite; 3]| Finite::new(rate[axis].get() + error[axis].get());
        let with = |error: [Finite; 3]| [0, 1, 2].map(|axis| sum(axis, &error).unwrap_or(rate[axis]));
        (attitude, self.rate_error.map_or(rate, with))
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
