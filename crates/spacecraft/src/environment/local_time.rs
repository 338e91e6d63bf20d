//! Local solar time of a node: a time of day, such as `10:30` or `6 h`.

use std::borrow::Cow;
use std::f64::consts::TAU;
use std::fmt;
use std::str::FromStr;

use flexsc_formats::document::number_in;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::date::DAY;

/// Texts that are accepted.
const ACCEPTED: &str = "a time of day below 24 h, such as \"10:30\" or \"6 h\"";

/// Time of day by the mean Sun, in seconds since midnight.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct LocalTime(f64);

impl LocalTime {
    /// Creates a time of day; `None` unless it is from 0 to below a day.
    pub fn from_seconds(seconds: f64) -> Option<Self> {
        (0.0..DAY).contains(&seconds).then_some(Self(seconds))
    }

    /// Returns the angle from the mean Sun eastwards (rad, from -pi to below pi): 0 at noon.
    pub fn from_sun(self) -> f64 {
        (self.0 / DAY - 0.5) * TAU
    }

    fn read(text: &str) -> Option<Self> {
        let text = text.trim();
        if !text.contains(':') {
            return number_in(text, "s")
                .ok()
                .filter(|_| text.parse::<f64>().is_err())
                .and_then(Self::from_seconds);
        }
        let parts: Vec<u32> = text.split(':').map(|part| part.parse().ok()).collect::<Option<_>>()?;
        let (hours, minutes, seconds) = match parts[..] {
            [hours, minutes] => (hours, minutes, 0),
            [hours, minutes, seconds] => (hours, minutes, seconds),
            _ => return None,
        };
        let whole = minutes < 60 && seconds < 60;
        Self::from_seconds(3600.0 * f64::from(hours) + 60.0 * f64::from(minutes) + f64::from(seconds))
            .filter(|_| whole)
    }
}

impl FromStr for LocalTime {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::read(text).ok_or_else(|| format!("must be {ACCEPTED}, got `{text}`"))
    }
}

impl fmt::Display for LocalTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let whole = self.0.round() as u32;
        write!(f, "{:02}:{:02}", whole / 3600, whole / 60 % 60)?;
        if whole.is_multiple_of(60) { Ok(()) } else { write!(f, ":{:02}", whole % 60) }
    }
}

impl Serialize for LocalTime {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64(self.0)
    }
}

impl<'de> Deserialize<'de> for LocalTime {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct LocalTimeVisitor;
        impl Visitor<'_> for LocalTimeVisitor {
            type Value = LocalTime;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(
                    "a time of day below 24 h, such as \"10:30\" or \"6 h\", or seconds since midnight",
                )
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<LocalTime, E> {
                LocalTime::read(text).ok_or_else(|| E::invalid_value(serde::de::Unexpected::Str(text), &self))
            }

            fn visit_f64<E: Error>(self, seconds: f64) -> Result<LocalTime, E> {
                let wrong = || E::invalid_value(serde::de::Unexpected::Float(seconds), &self);
                LocalTime::from_seconds(seconds).ok_or_else(wrong)
            }

            fn visit_i64<E: Error>(self, seconds: i64) -> Result<LocalTime, E> {
                self.visit_f64(seconds as f64)
            }

            fn visit_u64<E: Error>(self, seconds: u64) -> Result<LocalTime, E> {
                self.visit_f64(seconds as f64)
            }
        }
        deserializer.deserialize_any(LocalTimeVisitor)
    }
}

impl JsonSchema for LocalTime {
    fn schema_name() -> Cow<'static, str> {
        "LocalTime".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "string" }, { "type": "number", "minimum": 0 }] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_day_are_read_in_three_forms() {
        for (text, seconds) in [
            ("10:30", 37_800.0),
            ("06:00", 21_600.0),
            ("22:30:15", 81_015.0),
            ("6 h", 21_600.0),
            ("90 min", 5400.0),
        ] {
            assert_eq!(LocalTime::read(text), Some(LocalTime(seconds)), "{text}");
        }
        for text in ["24:00", "10:60", "10:30:60", "-1:00", "10.5", "25 h", "1:2:3:4", "noon", "6 deg"] {
            assert_eq!(LocalTime::read(text), None, "{text}");
        }
        for text in ["10:30", "06:00", "22:30:15"] {
            assert_eq!(LocalTime::read(text).map(|time| time.to_string()).as_deref(), Some(text));
        }
        // Six hours after noon is a quarter of a turn east of the Sun.
        assert!((LocalTime(64_800.0).from_sun() - TAU / 4.0).abs() < 1e-15);
    }
}
