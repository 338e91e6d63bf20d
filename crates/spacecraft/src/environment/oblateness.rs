//! Oblateness of a planet: the mean rates with which its coefficient J2 turns an orbit.
//!
//! With k = 1.5 n J2 (Re/p)², the node moves at -k cos i, the perigee at k (2 - 2.5 sin² i), and the mean anomaly by
//! k sqrt(1 - e²) (1 - 1.5 sin² i) faster than n (\[Wertz78\]).

use std::borrow::Cow;
use std::fmt;

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::NonNegative;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::Kepler;

/// Coefficient J2 of a planet: 0 of a sphere, `true` for that of the Earth.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Oblateness(f64);

/// Mean rates of an orbit's elements (rad/s).
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub(super) struct SecularRates {
    /// Rate of the longitude of the ascending node.
    pub node: f64,
    /// Rate of the argument of perigee.
    pub perigee: f64,
    /// Rate of the mean anomaly beyond the mean motion.
    pub anomaly: f64,
}

impl SecularRates {
    /// Returns the rotation rate (rad/s) of the orbit's plane and perigee in inertial axes, with the unit vector along the normal.
    pub fn rotation(&self, normal: &Vector) -> Vector {
        Vector::z() * self.node + normal * self.perigee
    }

    /// Returns the unit vector along the normal with its first two derivatives.
    pub fn normal_motion(&self, normal: Vector) -> [Vector; 3] {
        let turn = Vector::z() * self.node;
        let rate = turn.cross(&normal);
        [normal, rate, turn.cross(&rate)]
    }
}

impl Oblateness {
    /// Coefficient of the Earth (EGM96).
    pub const EARTH: Self = Self(1.082_626_1e-3);

    /// Returns true for a sphere.
    pub fn is_zero(&self) -> bool {
        self.0 == 0.0
    }

    /// Returns the coefficient.
    pub fn coefficient(&self) -> f64 {
        self.0
    }
}

impl Kepler {
    /// Returns the mean rates of the elements: zero about a sphere.
    pub(super) fn secular_rates(&self) -> SecularRates {
        if self.j2.is_zero() {
            return SecularRates::default();
        }
        let e = self.eccentricity.get();
        let (sin, cos) = libm::sincos(self.inclination.get());
        let flat = (1.0 - e) * (1.0 + e);
        let reach = self.planet_radius.get() / (self.semi_major_axis.get() * flat);
        let k = 1.5 * self.mean_motion() * self.j2.coefficient() * reach * reach;
        SecularRates {
            node: -k * cos,
            perigee: k * (2.0 - 2.5 * sin * sin),
            anomaly: k * f64::sqrt(flat) * (1.0 - 1.5 * sin * sin),
        }
    }
}

impl Serialize for Oblateness {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64(self.0)
    }
}

impl<'de> Deserialize<'de> for Oblateness {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OblatenessSpec;
        impl Visitor<'_> for OblatenessSpec {
            type Value = Oblateness;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("true for the Earth's, or a number from 0")
            }

            fn visit_bool<E: Error>(self, is_oblate: bool) -> Result<Oblateness, E> {
                Ok(if is_oblate { Oblateness::EARTH } else { Oblateness::default() })
            }

            fn visit_f64<E: Error>(self, number: f64) -> Result<Oblateness, E> {
                let wrong = || E::invalid_value(Unexpected::Float(number), &self);
                NonNegative::new(number).map(|number| Oblateness(number.get())).ok_or_else(wrong)
            }

            fn visit_i64<E: Error>(self, number: i64) -> Result<Oblateness, E> {
                self.visit_f64(number as f64)
            }

            fn visit_u64<E: Error>(self, number: u64) -> Result<Oblateness, E> {
                self.visit_f64(number as f64)
            }
        }
        deserializer.deserialize_any(OblatenessSpec)
    }
}

impl JsonSchema for Oblateness {
    fn schema_name() -> Cow<'static, str> {
        "Oblateness".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let coefficient = generator.subschema_for::<NonNegative>();
        json_schema!({ "anyOf": [{ "type": "boolean" }, coefficient] })
    }
}
