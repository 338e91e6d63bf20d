//! The orbit of a scenario: Kepler elements, an altitude, two-line elements, or an ephemeris.

use std::borrow::Cow;
use std::path::Path;

use flexsc_formats::celestial_frame::CelestialFrame;
use flexsc_formats::document::ConfigError;
use flexsc_formats::ephemeris::EphemerisTable;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

use super::altitude_orbit::AltitudeOrbit;
use super::element_set::ElementSet;
use super::ephemeris_orbit::EphemerisOrbit;
use super::kepler::{earth_gravity, earth_radius};
use super::local_time::LocalTime;
use super::orbit_path::OrbitPath;
use super::two_line_orbit::TwoLineOrbit;
use super::{Kepler, Oblateness};

/// The orbit of a scenario.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum OrbitKind {
    /// Kepler elements.
    Kepler(Kepler),
    /// Altitude and, of a Sun-synchronous orbit, local time of the node.
    Altitude(AltitudeOrbit),
    /// Two-line elements.
    TwoLines(TwoLineOrbit),
    /// Positions at instants.
    Ephemeris(EphemerisOrbit),
}

/// Keys of all kinds of orbit.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OrbitKeys {
    semi_major_axis: Option<Positive>,
    altitude: Option<Positive>,
    ltan: Option<LocalTime>,
    eccentricity: Option<NonNegative>,
    inclination: Option<Finite>,
    node: Option<Finite>,
    perigee: Option<Finite>,
    anomaly: Option<Finite>,
    gravity: Option<Positive>,
    planet_radius: Option<Positive>,
    j2: Option<Oblateness>,
    tle: Option<ElementSet>,
    ephemeris: Option<EphemerisTable>,
    frame: Option<CelestialFrame>,
}

impl<'de> Deserialize<'de> for OrbitKind {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        OrbitKeys::deserialize(deserializer)?.try_into().map_err(D::Error::custom)
    }
}

impl JsonSchema for OrbitKind {
    fn schema_name() -> Cow<'static, str> {
        "OrbitKind".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let kepler = generator.subschema_for::<Kepler>();
        let altitude = generator.subschema_for::<AltitudeOrbit>();
        let two_lines = generator.subschema_for::<TwoLineOrbit>();
        let ephemeris = generator.subschema_for::<EphemerisOrbit>();
        json_schema!({ "anyOf": [kepler, altitude, two_lines, ephemeris] })
    }
}

impl TryFrom<OrbitKeys> for OrbitKind {
    type Error = String;

    fn try_from(keys: OrbitKeys) -> Result<Self, String> {
        let gravity = keys.gravity.unwrap_or_else(earth_gravity);
        let planet_radius = keys.planet_radius.unwrap_or_else(earth_radius);
        let elements = [
            ("semi_major_axis", keys.semi_major_axis.is_some()),
            ("altitude", keys.altitude.is_some()),
            ("ltan", keys.ltan.is_some()),
            ("eccentricity", keys.eccentricity.is_some()),
            ("inclination", keys.inclination.is_some()),
            ("node", keys.node.is_some()),
            ("perigee", keys.perigee.is_some()),
            ("anomaly", keys.anomaly.is_some()),
            ("j2", keys.j2.is_some()),
        ];
        let given = elements.into_iter().find(|(_, is_given)| *is_given).map(|(key, _)| key);
        let twice = |kind: &str, other: &str| {
            Err(format!(
                "has `{other}` and `{kind}`: an orbit is given by Kepler elements, a `tle` or an `ephemeris`"
            ))
        };
        if keys.frame.is_some() && keys.ephemeris.is_none() {
            return Err("has a `frame`, which names the axes of an `ephemeris`".to_owned());
        }
        match (keys.semi_major_axis, keys.tle, keys.ephemeris, given) {
            (_, Some(_), Some(_), _) => twice("ephemeris", "tle"),
            (_, Some(_), None, Some(other)) => twice("tle", other),
            (_, None, Some(_), Some(other)) => twice("ephemeris", other),
            (_, Some(tle), None, None) => Ok(Self::TwoLines(TwoLineOrbit::new(tle, gravity, planet_radius))),
            (_, None, Some(ephemeris), None) => {
                Ok(Self::Ephemeris(EphemerisOrbit::new(ephemeris, keys.frame, gravity, planet_radius)))
            }
            (Some(_), None, None, _) if keys.altitude.is_some() => {
                Err("has `semi_major_axis` and `altitude`: one follows from the other".to_owned())
            }
            (Some(_), None, None, _) if keys.ltan.is_some() => {
                Err("has `semi_major_axis` and `ltan`: a local time of the node goes with an `altitude`".to_owned())
            }
            (None, None, None, _) if keys.ltan.is_some() && keys.node.is_some() => {
                Err("has `node` and `ltan`: one follows from the other".to_owned())
            }
            (Some(semi_major_axis), None, None, _) => Ok(Self::Kepler(Kepler {
                semi_major_axis,
                eccentricity: keys.eccentricity.unwrap_or_default(),
                inclination: keys.inclination.unwrap_or_default(),
                node: keys.node.unwrap_or_default(),
                perigee: keys.perigee.unwrap_or_default(),
                anomaly: keys.anomaly.unwrap_or_default(),
                gravity,
                planet_radius,
                j2: keys.j2.unwrap_or_default(),
            })),
            (None, None, None, _) if keys.altitude.is_some() => Ok(Self::Altitude(AltitudeOrbit {
                altitude: keys.altitude.unwrap_or(Positive::ONE),
                ltan: keys.ltan,
                eccentricity: keys.eccentricity.unwrap_or_default(),
                inclination: keys.inclination,
                node: keys.node,
                perigee: keys.perigee.unwrap_or_default(),
                anomaly: keys.anomaly.unwrap_or_default(),
                gravity,
                planet_radius,
                j2: keys.j2,
            })),
            (None, None, None, _) => {
                Err("must have a `semi_major_axis` or an `altitude`, for Kepler elements, a `tle` or an `ephemeris`"
                    .to_owned())
            }
        }
    }
}

impl OrbitKind {
    /// Reads the file of elements or of an ephemeris relative to `directory`, or takes the rows of `other` if that has read the same
    /// file; returns an inconsistency of the orbit in itself, a key within the orbit and the reason.
    pub fn read(&mut self, directory: &Path, other: Option<&Self>) -> Option<ConfigError> {
        if let Self::TwoLines(orbit) = self {
            orbit.tle.locate(directory);
            if let Err(why) = orbit.tle.read() {
                return Some(ConfigError::new("tle", why));
            }
        }
        let Self::Ephemeris(orbit) = self else { return self.fault() };
        let other = match other {
            Some(Self::Ephemeris(other)) => Some(&other.ephemeris),
            _ => None,
        };
        orbit.ephemeris.locate(directory);
        orbit.ephemeris.read(other).err().map(|why| ConfigError::new("ephemeris", why))
    }

    /// Replaces the reference to a file by its rows, in a run from `epoch_ns` nanoseconds after 1970, if known.
    pub fn inline(&mut self, epoch_ns: Option<u64>) {
        match self {
            Self::Ephemeris(orbit) => orbit.inline(epoch_ns),
            Self::TwoLines(orbit) => orbit.tle.inline(),
            Self::Kepler(_) | Self::Altitude(_) => {}
        }
    }

    /// Returns the date (ns after 1970, UTC) of a run that has none of its own: the epoch of two-line elements, or the
    /// first row of an ephemeris with dates.
    pub fn epoch_ns(&self) -> Option<u64> {
        match self {
            Self::Kepler(_) | Self::Altitude(_) => None,
            Self::TwoLines(orbit) => orbit.epoch_ns(),
            Self::Ephemeris(orbit) => orbit.ephemeris.epoch_ns(),
        }
    }

    /// Returns an inconsistency between values: a key within the orbit, and the reason.
    pub(super) fn fault(&self) -> Option<ConfigError> {
        match self {
            Self::Kepler(orbit) => orbit.fault(),
            Self::Altitude(orbit) => orbit.fault(),
            Self::TwoLines(orbit) => orbit.fault(),
            Self::Ephemeris(orbit) => orbit.fault(),
        }
    }

    /// Checks that the orbit is known over a run of this duration (s) from `epoch_ns` nanoseconds after 1970, if known;
    /// returns the key and the reason.
    pub(super) fn run_fault(&self, duration: f64, epoch_ns: Option<u64>) -> Option<ConfigError> {
        let (key, radius, checked) = match self {
            Self::Kepler(_) => return None,
            Self::Altitude(orbit) => return orbit.date_fault(epoch_ns),
            Self::TwoLines(orbit) => {
                ("tle", orbit.planet_radius, orbit.run_path(duration, epoch_ns.unwrap_or_default()))
            }
            Self::Ephemeris(orbit) => ("ephemeris", orbit.planet_radius, orbit.run_path(duration, epoch_ns)),
        };
        let orbit = match checked {
            Ok(orbit) => orbit,
            Err(why) => return Some(ConfigError::new(key, why)),
        };
        let (nearest, radius) = (orbit.nearest_row().min(orbit.nearest()), radius.get());
        (nearest.is_nan() || nearest <= radius).then(|| {
            let why = format!("must stay above the planet's radius of {radius} m, got {nearest:.0} m");
            ConfigError::new(key, why)
        })
    }

    /// Returns remarks on an orbit that is accepted for a run of this duration (s) from `epoch_ns` nanoseconds after 1970, if
    /// known, and probably not meant: a key within the orbit, and the reason.
    pub fn remarks(&self, duration: f64, epoch_ns: Option<u64>) -> Vec<ConfigError> {
        match self {
            Self::Kepler(_) | Self::Altitude(_) => Vec::new(),
            Self::TwoLines(orbit) => orbit.remarks(duration, epoch_ns),
            Self::Ephemeris(orbit) => orbit.remarks(duration, epoch_ns),
        }
    }

    /// Returns the inertial axes of a run with a date: those of the mean equator and equinox at its start, unless the orbit is
    /// in others.
    pub fn frame(&self) -> CelestialFrame {
        match self {
            Self::Kepler(_) | Self::Altitude(_) => CelestialFrame::Mod,
            Self::TwoLines(_) => CelestialFrame::Teme,
            Self::Ephemeris(orbit) => orbit.run_frame(),
        }
    }

    /// Returns the orbit in a run of this duration (s) from `epoch_ns` nanoseconds after 1970, if known.
    pub fn path(&self, duration: f64, epoch_ns: Option<u64>) -> Option<OrbitPath> {
        match self {
            Self::Kepler(orbit) => Some(OrbitPath::Kepler(*orbit)),
            Self::Altitude(orbit) => Some(OrbitPath::Kepler(orbit.kepler(epoch_ns))),
            Self::TwoLines(orbit) => orbit.path(duration, epoch_ns?).map(OrbitPath::Sampled),
            Self::Ephemeris(orbit) => orbit.path(epoch_ns).map(OrbitPath::Sampled),
        }
    }

    /// Returns the Kepler elements, if the orbit has them; of one with a local time of its node, without the node.
    pub fn kepler(&self) -> Option<Kepler> {
        match self {
            Self::Kepler(orbit) => Some(*orbit),
            Self::Altitude(orbit) => Some(orbit.kepler(None)),
            Self::TwoLines(_) | Self::Ephemeris(_) => None,
        }
    }
}
