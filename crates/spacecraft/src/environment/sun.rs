//! Direction to the Sun: given in the scenario, or computed from the date of the start.

use std::borrow::Cow;
use std::fmt;

use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::Finite;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::date::{DAY, J2000};

/// Word of the scenario for the Sun at the date of the start.
const EPOCH: &str = "epoch";

/// Direction from the body to the Sun, constant during a run.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Sun {
    /// Fixed direction in inertial axes, of any length.
    Towards([Finite; 3]),
    /// Direction as seen from the Earth at the date of the start, in axes of the Earth's equator, x to the equinox.
    Epoch,
}

impl Sun {
    /// Returns the direction as a unit vector, for a scenario that begins `epoch_ns` nanoseconds after 1970, UTC.
    pub fn direction(&self, epoch_ns: u64) -> Vector {
        match self {
            Self::Towards(direction) => vector(direction).normalize(),
            Self::Epoch => direction_at(epoch_ns as f64 / 1e9),
        }
    }

    /// Returns true if the direction is the zero vector.
    pub fn has_no_direction(&self) -> bool {
        matches!(self, Self::Towards(direction) if direction.iter().all(|part| part.get() == 0.0))
    }
}

/// Returns the direction to the Sun at `seconds` after 1970, within 0.01 degrees from 1950 to 2050: the low-precision
/// formulas of \[AstronomicalAlmanac\].
fn direction_at(seconds: f64) -> Vector {
    let days = (seconds - J2000) / DAY;
    let anomaly = (357.528 + 0.985_600_3 * days).to_radians();
    let longitude =
        280.460 + 0.985_647_4 * days + 1.915 * libm::sin(anomaly) + 0.020 * libm::sin(2.0 * anomaly);
    let (sin, cos) = libm::sincos(longitude.to_radians());
    let (up, along) = libm::sincos((23.439 - 4e-7 * days).to_radians());
    Vector::new(cos, along * sin, up * sin)
}

impl Serialize for Sun {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Towards(direction) => direction.serialize(serializer),
            Self::Epoch => serializer.serialize_str(EPOCH),
        }
    }
}

impl<'de> Deserialize<'de> for Sun {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct SunSpec;
        impl<'de> Visitor<'de> for SunSpec {
            type Value = Sun;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a direction of three numbers, or \"epoch\"")
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<Sun, E> {
                let unknown = || E::unknown_variant(word, &[EPOCH]);
                (word == EPOCH).then_some(Sun::Epoch).ok_or_else(unknown)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Sun, A::Error> {
                <[Finite; 3]>::deserialize(SeqAccessDeserializer::new(seq)).map(Sun::Towards)
            }
        }
        deserializer.deserialize_any(SunSpec)
    }
}

impl JsonSchema for Sun {
    fn schema_name() -> Cow<'static, str> {
        "Sun".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let direction = generator.subschema_for::<[Finite; 3]>();
        json_schema!({ "anyOf": [direction, { "const": EPOCH }] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_is_where_almanacs_have_it() {
        // Seconds since 1970, right ascension and declination (degrees): the apparent Sun of Meeus, Astronomical
        // Algorithms, example 25.a (1992-10-13), the equinox of 2026-03-20 14:46 UTC, the solstice of 2024-06-20 20:51
        // UTC.
        for (seconds, ascension, declination) in [
            (718_934_400.0, 198.380_83, -7.785_07),
            (1_774_017_960.0, 0.0, 0.0),
            (1_718_916_660.0, 90.0, 23.436),
        ] {
            let sun = direction_at(seconds);
            let found = libm::atan2(sun.y, sun.x).to_degrees().rem_euclid(360.0);
            let apart = libm::remainder(found - ascension, 360.0);
            assert!(apart.abs() < 0.02, "{seconds}: {found}");
            assert!((libm::asin(sun.z).to_degrees() - declination).abs() < 0.012, "{seconds}: {}", sun.z);
        }
    }
}
