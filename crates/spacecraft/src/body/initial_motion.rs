//! Attitude and rates of a three-axis body at the start: as written or those of the target, and an error beside them.

use std::borrow::Cow;
use std::f64::consts::TAU;
use std::fmt;
use std::marker::PhantomData;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Attitude, Vector, rotation, vector};
use flexsc_numerics::quantity::Finite;
use nalgebra::Quaternion;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Word of the scenario for the value of the target.
const TARGET: &str = "target";
/// Largest rate about an axis in addition to another (rad/s).
const FASTEST: f64 = 1e3;

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
    /// Attitude without its error, and the rotation vector (rad) from it to the one of the start, in the body's axes.
    attitude: (StartValue<Attitude>, Option<[Finite; 3]>),
    /// Rates (rad/s) without their error, and those in addition, in the body's axes.
    rate: (StartValue<[Finite; 3]>, Option<[Finite; 3]>),
}

impl InitialMotion {
    /// Creates the motion at the start from the keys `attitude` and `attitude_error`, and `rate` and `rate_error`.
    pub(super) const fn new(
        attitude: (StartValue<Attitude>, Option<[Finite; 3]>),
        rate: (StartValue<[Finite; 3]>, Option<[Finite; 3]>),
    ) -> Self {
        Self { attitude, rate }
    }

    /// Returns true if the attitude or the rates are those of the target.
    pub const fn depends_on_target(&self) -> bool {
        matches!(self.attitude.0, StartValue::Target) || matches!(self.rate.0, StartValue::Target)
    }

    /// Checks the errors; returns the key of one that is too large, and the reason.
    pub(super) fn fault(&self) -> Option<ConfigError> {
        for (key, error, most, unit) in
            [("attitude_error", self.attitude.1, TAU, "rad"), ("rate_error", self.rate.1, FASTEST, "rad/s")]
        {
            let largest = error.iter().flatten().find(|part| part.get().abs() > most);
            if let Some(part) = largest {
                let why = format!(
                    "must be from {:.4} to {most:.4} {unit} about each axis, got {}",
                    -most,
                    part.get()
                );
                return Some(ConfigError::new(key, why));
            }
        }
        None
    }

    /// Returns the attitude and the rates (rad/s) at the start, with a target at rest in the inertial axes.
    pub(super) fn as_written(&self) -> (Attitude, [Finite; 3]) {
        self.resolve(&Attitude::default().get(), &Vector::zeros())
    }

    /// Returns the attitude and the rates (rad/s, in the body's axes) at the start, with a target that has this attitude
    /// then and this rate (rad/s) in its own axes.
    pub fn resolve(&self, target: &Quaternion<f64>, target_rate: &Vector) -> (Attitude, [Finite; 3]) {
        let written = match self.attitude.0 {
            StartValue::Written(attitude) => attitude,
            StartValue::Target => Attitude::new(*target),
        };
        let attitude =
            self.attitude.1.map_or(written, |error| Attitude::new(written.get() * rotation(&vector(&error))));
        let rate = match self.rate.0 {
            StartValue::Written(rate) => rate,
            StartValue::Target => {
                let axes = attitude.get().conjugate() * target;
                let turned = axes * Quaternion::from_imag(*target_rate) * axes.conjugate();
                [turned.i, turned.j, turned.k].map(|part| Finite::new(part).unwrap_or_default())
            }
        };
        let sum = |axis: usize, error: &[Finite; 3]| Finite::new(rate[axis].get() + error[axis].get());
        let with = |error: [Finite; 3]| [0, 1, 2].map(|axis| sum(axis, &error).unwrap_or(rate[axis]));
        (attitude, self.rate.1.map_or(rate, with))
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
