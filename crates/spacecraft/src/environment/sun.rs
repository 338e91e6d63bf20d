//! The Sun: a fixed direction, or direction and distance as seen from the Earth at a date.

use std::borrow::Cow;
use std::fmt;

use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::Finite;
use flexsc_numerics::time_arcs::SplitTime;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::date::{DAY, J2000};
use super::direction_motion::DirectionMotion;

/// Word of the scenario for the Sun at the date.
const EPOCH: &str = "epoch";

/// Rate of the Sun's mean anomaly (1e-7 degrees a day).
const ANOMALY: f64 = 9_856_003.0;

/// Rate of the Sun's mean anomaly (degrees a day).
const ANOMALY_RATE: f64 = 1e-7 * ANOMALY;

/// Direction from the body to the Sun.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Sun {
    /// Fixed direction in inertial axes, of any length.
    Towards([Finite; 3]),
    /// Direction as seen from the Earth at the date, in axes of the Earth's equator, x to the equinox.
    Epoch,
}

impl Sun {
    /// Returns true if the direction is the zero vector.
    pub fn has_no_direction(&self) -> bool {
        matches!(self, Self::Towards(direction) if direction.iter().all(|part| part.get() == 0.0))
    }
}

/// Path of the Sun during a run, in inertial axes.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum SunPath {
    /// Fixed direction, a unit vector, at a distance of 1 au.
    Fixed(Vector),
    /// Sun as seen from the Earth, in a run that starts at this time (s) after J2000.
    Dated(f64),
}

/// Light of the Sun at an instant.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct Sunlight {
    /// Direction to the Sun, a unit vector.
    pub direction: Vector,
    /// Pressure relative to that at 1 au.
    pub pressure: f64,
}

impl SunPath {
    /// Upper bound of the rate of the direction (rad/s): 1.0193 degrees a day, at the perihelion.
    const FASTEST: f64 = 2.06e-7;

    /// Least distance of the Sun (au).
    const NEAREST: f64 = 0.983_29;

    /// Creates the path for a scenario that begins `epoch_ns` nanoseconds after 1970, UTC.
    pub(super) fn new(sun: &Sun, epoch_ns: u64) -> Self {
        match sun {
            Sun::Towards(direction) => Self::Fixed(vector(direction).normalize()),
            Sun::Epoch => Self::Dated(epoch_ns as f64 / 1e9 - J2000),
        }
    }

    /// Returns the direction at a time since the start (s).
    pub fn direction(&self, t: f64) -> Vector {
        match self {
            Self::Fixed(direction) => *direction,
            Self::Dated(_) => self.motion(t).direction,
        }
    }

    /// Returns the direction with its derivatives at a time since the start (s).
    pub fn motion(&self, t: f64) -> DirectionMotion {
        match self {
            Self::Fixed(direction) => DirectionMotion::fixed(*direction),
            Self::Dated(start) => almanac(days_since_j2000(*start, t.into())),
        }
    }

    /// Returns true if the direction changes.
    pub fn moves(&self) -> bool {
        matches!(self, Self::Dated(_))
    }

    /// Returns an upper bound of the rate of the direction (rad/s).
    pub fn fastest(&self) -> f64 {
        if self.moves() { Self::FASTEST } else { 0.0 }
    }

    /// Returns the distance of the Sun at a time since the start (s) in au, and its rate (1/s).
    pub(super) fn distance(&self, t: f64) -> [f64; 2] {
        let Self::Dated(start) = self else { return [1.0, 0.0] };
        distance(days_since_j2000(*start, t.into()))
    }

    /// Returns the light of the Sun at a time since the start.
    pub(super) fn light(&self, t: SplitTime) -> Sunlight {
        match self {
            Self::Fixed(direction) => Sunlight { direction: *direction, pressure: 1.0 },
            Self::Dated(start) => {
                let days = days_since_j2000(*start, t);
                let [distance, _] = distance(days);
                Sunlight { direction: almanac(days).direction, pressure: 1.0 / (distance * distance) }
            }
        }
    }

    /// Returns an upper bound of the pressure of sunlight relative to that at 1 au.
    pub(super) fn most_pressure(&self) -> f64 {
        if self.moves() { 1.0 / (Self::NEAREST * Self::NEAREST) } else { 1.0 }
    }
}

/// Returns the whole days from J2000 to a time since a start that is this long (s) after J2000, and the rest of a day.
fn days_since_j2000(start: f64, t: SplitTime) -> [f64; 2] {
    let whole = libm::floor((start + t.middle) / DAY);
    [whole, ((start - whole * DAY) + t.middle + t.offset) / DAY]
}

/// Returns an angle (degrees, less whole turns) from its value at J2000, its rate (1e-7 degrees a day) and whole days with a
/// rest. Products of whole numbers and their remainders are exact.
fn angle(at_j2000: f64, rate: f64, [whole, rest]: [f64; 2]) -> f64 {
    at_j2000 + (libm::remainder(rate * whole, 360e7) + rate * rest) / 1e7
}

/// Returns the mean anomaly of the Sun (rad) at `days` after J2000.
fn anomaly(days: [f64; 2]) -> f64 {
    angle(357.528, ANOMALY, days).to_radians()
}

/// Returns the distance of the Sun in au at `days` after J2000, and its rate (1/s).
fn distance(days: [f64; 2]) -> [f64; 2] {
    let anomaly = anomaly(days);
    let [(sin, cos), (sin_twice, cos_twice)] = [libm::sincos(anomaly), libm::sincos(2.0 * anomaly)];
    let distance = 1.000_14 - 0.016_71 * cos - 0.000_14 * cos_twice;
    [distance, (0.016_71 * sin + 0.000_28 * sin_twice) * ANOMALY_RATE.to_radians() / DAY]
}

/// Returns the direction to the Sun at `days` after J2000, within 0.01 degrees from 1950 to 2050: the low-precision
/// formulas of \[AstronomicalAlmanac\].
fn almanac(days: [f64; 2]) -> DirectionMotion {
    let anomaly = anomaly(days);
    let [(sin, cos), (sin_twice, cos_twice)] = [libm::sincos(anomaly), libm::sincos(2.0 * anomaly)];
    let longitude = angle(280.460, 9_856_474.0, days) + 1.915 * sin + 0.020 * sin_twice;
    // Rate and acceleration of the longitude, from degrees a day and days. The obliquity's rate of 8e-14 rad/s is
    // negligible.
    let mean = ANOMALY_RATE.to_radians();
    let rate = (0.985_647_4 + mean * (1.915 * cos + 0.040 * cos_twice)).to_radians() / DAY;
    let acceleration = (-mean * mean * (1.915 * sin + 0.080 * sin_twice)).to_radians() / (DAY * DAY);
    let (sin, cos) = libm::sincos(longitude.to_radians());
    let (up, along) = libm::sincos((23.439 - 4e-7 * (days[0] + days[1])).to_radians());
    let direction = Vector::new(cos, along * sin, up * sin);
    let ahead = Vector::new(-sin, along * cos, up * cos);
    DirectionMotion {
        direction,
        rate: ahead * rate,
        acceleration: ahead * acceleration - direction * (rate * rate),
    }
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

    /// Returns the path of a run that starts at `seconds` after 1970.
    fn path(seconds: u64) -> SunPath {
        SunPath::new(&Sun::Epoch, seconds * 1_000_000_000)
    }

    #[test]
    fn the_sun_is_where_almanacs_have_it() {
        // Seconds since 1970, right ascension and declination (degrees): the apparent Sun of Meeus, Astronomical
        // Algorithms, example 25.a (1992-10-13), the equinox of 2026-03-20 14:46 UTC, the solstice of 2024-06-20 20:51
        // UTC.
        for (seconds, ascension, declination) in
            [(718_934_400, 198.380_83, -7.785_07), (1_774_017_960, 0.0, 0.0), (1_718_916_660, 90.0, 23.436)]
        {
            let sun = path(seconds).direction(0.0);
            let found = libm::atan2(sun.y, sun.x).to_degrees().rem_euclid(360.0);
            let apart = libm::remainder(found - ascension, 360.0);
            assert!(apart.abs() < 0.02, "{seconds}: {found}");
            assert!((libm::asin(sun.z).to_degrees() - declination).abs() < 0.012, "{seconds}: {}", sun.z);
        }
    }

    #[test]
    fn the_sun_moves_as_erfa_has_it() {
        // Seconds since 1970, direction in the mean equator and equinox of date, and distance (au), of ERFA (epv00 with
        // annual aberration and bp06), within 2e-4 and, of the pressure, 1e-4. All runs start on 2026-01-01.
        let start = 1_767_225_600;
        for (seconds, direction, distance) in [
            (1_774_017_960, [1.0, -0.000_027_82, -0.000_010_36], 0.995_917_60), // 2026-03-20T14:46:00Z
            (1_782_030_240, [0.000_043_69, 0.917_506_35, 0.397_721_12], 1.016_193_85), // 2026-06-21T08:24:00Z
            (1_795_478_400, [-0.473_983_03, -0.807_897_06, -0.350_203_41], 0.987_402_72), // 2026-11-24T00:00:00Z
            (1_798_977_600, [0.222_669_71, -0.894_470_84, -0.387_737_17], 0.983_333_79), // 2027-01-03T12:00:00Z
            (1_914_517_800, [-0.935_860_18, 0.323_305_25, 0.140_140_80], 1.009_199_08), // 2030-09-01T18:30:00Z
        ] {
            let (path, t) = (path(start), (seconds - start) as f64);
            let off = (path.direction(t) - Vector::from(direction)).norm();
            assert!(off < 2e-4, "{seconds}: {off:e}");
            let pressure = path.light(t.into()).pressure * distance * distance;
            assert!(
                (pressure - 1.0).abs() < 1e-4 && path.light(t.into()).pressure <= path.most_pressure(),
                "{pressure}"
            );
        }
        assert_eq!(SunPath::Fixed(Vector::x()).light(1e7.into()).pressure, 1.0);
    }

    #[test]
    fn its_rates_are_derivatives_and_within_the_bound() {
        let path = path(1_767_225_600);
        // Differences over an hour: the third derivative is below 1e-20 1/s³.
        let h = 3600.0;
        for day in 0..400 {
            let t = 86_400.0 * f64::from(day);
            let [before, now, after] = [t - h, t, t + h].map(|t| path.motion(t));
            let rate = (after.direction - before.direction) / (2.0 * h);
            assert!((rate - now.rate).norm() < 2e-13, "{day} {:e}", (rate - now.rate).norm());
            let acceleration = (after.rate - before.rate) / (2.0 * h);
            assert!((acceleration - now.acceleration).norm() < 1e-19, "{day}");
            let [[nearer, _], [_, climb], [farther, _]] = [t - h, t, t + h].map(|t| path.distance(t));
            assert!(((farther - nearer) / (2.0 * h) - climb).abs() < 1e-15, "{day} {climb:e}");
            assert!(now.rate.norm() <= path.fastest() && now.rate.norm() > 1.92e-7, "{day}");
            // The bound of the shadow's second derivative relies on this one.
            assert!(now.acceleration.norm() <= 1.1 * path.fastest() * path.fastest(), "{day}");
        }
    }
}
