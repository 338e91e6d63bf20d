//! Numbers that are valid by construction: a deserialised scenario cannot contain others.

use std::borrow::Cow;
use std::f64::consts::{FRAC_PI_2, TAU};

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize};

/// Returns a number in the shortest form with all its digits: with an exponent where zeros would fill a line.
pub fn shortest(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || !value.is_finite() || (1e-6..1e16).contains(&size) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// Defines a number type with a range: its deserialiser rejects every other number and reports the value.
macro_rules! quantity {
    ($(#[$doc:meta])* $name:ident, $accepts:expr, $words:literal, $schema:tt) => {
        $(#[$doc])*
        #[derive(Copy, Clone, Debug, PartialEq, PartialOrd, Serialize)]
        #[serde(transparent)]
        pub struct $name(f64);

        impl $name {
            /// Returns the number if it is in range.
            pub fn new(value: f64) -> Option<Self> {
                let accepts: fn(f64) -> bool = $accepts;
                accepts(value).then_some(Self(value))
            }

            /// Returns the number itself.
            pub const fn get(self) -> f64 {
                self.0
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let value = f64::deserialize(deserializer)?;
                Self::new(value).ok_or_else(|| {
                    let found = shortest(value);
                    serde::de::Error::custom(format!(concat!("must be ", $words, ", got {}"), found))
                })
            }
        }

        impl JsonSchema for $name {
            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                json_schema!($schema)
            }
        }
    };
}

quantity!(
    /// Any finite number.
    Finite, f64::is_finite, "a finite number", {"type": "number"}
);
quantity!(
    /// A number above zero.
    Positive, |v| v.is_finite() && v > 0.0, "a positive number",
    {"type": "number", "exclusiveMinimum": 0}
);
quantity!(
    /// Zero or a number above it.
    NonNegative, |v| v.is_finite() && v >= 0.0, "a number of 0 or more",
    {"type": "number", "minimum": 0}
);
quantity!(
    /// A number strictly between 0 and 1.
    Fraction, |v| v > 0.0 && v < 1.0, "a number between 0 and 1",
    {"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1}
);
quantity!(
    /// A part of a whole, or all of it.
    Share, |v| v > 0.0 && v <= 1.0, "a number above 0 and at most 1",
    {"type": "number", "exclusiveMinimum": 0, "maximum": 1}
);
quantity!(
    /// The natural frequency of an elastic mode (rad/s).
    Frequency, |v| (1e-4..=1e4).contains(&v), "a natural frequency of 1e-4 to 1e4 rad/s",
    {"type": "number", "minimum": 1e-4, "maximum": 1e4}
);

quantity!(
    /// A geodetic latitude (rad).
    Latitude, |v| v.abs() <= FRAC_PI_2, "a latitude of -pi/2 to pi/2 rad, such as \"67.9 deg\"",
    {"type": "number", "minimum": -FRAC_PI_2, "maximum": FRAC_PI_2}
);
quantity!(
    /// A longitude (rad).
    Longitude, |v| v.abs() <= TAU, "a longitude of -2 pi to 2 pi rad, such as \"21.1 deg\"",
    {"type": "number", "minimum": -TAU, "maximum": TAU}
);

quantity!(
    /// A time from the start of a run, or for which something waits (s): no run is longer.
    Time, |v| (0.0..=1e13).contains(&v), "a time of 0 to 1e13 s",
    {"type": "number", "minimum": 0, "maximum": 1e13}
);

quantity!(
    /// A factor of the density of the air, whose models err by less.
    DensityFactor, |v| (1e-3..=1e3).contains(&v), "a factor of 0.001 to 1000",
    {"type": "number", "minimum": 1e-3, "maximum": 1e3}
);

quantity!(
    /// The error that an integration may make in each step, relative to 1 or to the largest angle.
    Tolerance, |v| (1e-14..=1e-3).contains(&v), "a tolerance of 1e-14 to 1e-3",
    {"type": "number", "minimum": 1e-14, "maximum": 1e-3}
);

impl Tolerance {
    /// Tolerance close to rounding errors.
    pub const TIGHT: Self = Self(1e-12);
}

/// Defines zero as the default value of an omitted key.
macro_rules! zero_by_default {
    ($($name:ident),*) => {
        $(impl $name {
            /// Value zero.
            pub const ZERO: Self = Self(0.0);
        }

        impl Default for $name {
            fn default() -> Self {
                Self(0.0)
            }
        })*
    };
}

zero_by_default!(Finite, NonNegative, Time);

impl Frequency {
    /// Lowest natural frequency (rad/s).
    pub const SMALLEST: f64 = 1e-4;
    /// Highest natural frequency (rad/s).
    pub const LARGEST: f64 = 1e4;
}

impl Fraction {
    /// Value one half.
    pub const HALF: Self = Self(0.5);
}

impl Positive {
    /// Value one.
    pub const ONE: Self = Self(1.0);
}
