//! The orbit of a scenario: Kepler elements, two-line elements, or an ephemeris.

use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

use flexsc_formats::document::ConfigError;
use flexsc_formats::ephemeris::EphemerisTable;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

use super::deferred::Deferred;
use super::kepler::{earth_gravity, earth_radius};
use super::orbit_path::OrbitPath;
use super::sampled_orbit::{MOST_ROWS, ROWS, SampledOrbit};
use super::sgp4::Sgp4;
use super::{Kepler, Oblateness, two_lines};

/// Angle at the perigee (rad) between two rows that are computed from two-line elements: one minute in a low orbit.
const STEP: f64 = 0.065;

/// The orbit of a scenario.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum OrbitKind {
    /// Kepler elements.
    Kepler(Kepler),
    /// Two-line elements.
    TwoLines(TwoLineOrbit),
    /// Positions at instants.
    Ephemeris(EphemerisOrbit),
}

/// Orbit by two-line elements, in the axes of the true equator and the mean equinox, which differ from the inertial axes by
/// the nutation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TwoLineOrbit {
    /// Both lines, of 69 characters.
    pub tle: [String; 2],
    /// Gravitational parameter of the planet (m³/s²); default: the Earth's.
    #[serde(default = "earth_gravity")]
    pub gravity: Positive,
    /// Radius of the planet (m), for its shadow; default: the Earth's equatorial radius.
    #[serde(default = "earth_radius")]
    pub planet_radius: Positive,
    /// Orbit of the first run that was asked for.
    #[serde(skip)]
    #[schemars(skip)]
    sampled: Deferred<RunOrbit>,
}

/// Orbit by positions at instants.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EphemerisOrbit {
    /// Positions, or the path of their file.
    pub ephemeris: EphemerisTable,
    /// Gravitational parameter of the planet (m³/s²); default: the Earth's.
    #[serde(default = "earth_gravity")]
    pub gravity: Positive,
    /// Radius of the planet (m), for its shadow; default: the Earth's equatorial radius.
    #[serde(default = "earth_radius")]
    pub planet_radius: Positive,
    /// Orbit of the first run that was asked for.
    #[serde(skip)]
    #[schemars(skip)]
    sampled: Deferred<RunOrbit>,
}

/// Orbit of a run, with everything that it follows from.
#[derive(Clone, Debug, PartialEq)]
struct RunOrbit {
    tle: Option<[String; 2]>,
    ephemeris: EphemerisTable,
    planet: [f64; 2],
    epoch_ns: Option<u64>,
    duration: f64,
    /// Orbit; `None` where it is not known.
    orbit: Option<Arc<SampledOrbit>>,
}

/// Keys of all kinds of orbit.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OrbitKeys {
    semi_major_axis: Option<Positive>,
    eccentricity: Option<NonNegative>,
    inclination: Option<Finite>,
    node: Option<Finite>,
    perigee: Option<Finite>,
    anomaly: Option<Finite>,
    gravity: Option<Positive>,
    planet_radius: Option<Positive>,
    j2: Option<Oblateness>,
    tle: Option<[String; 2]>,
    ephemeris: Option<EphemerisTable>,
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
        let two_lines = generator.subschema_for::<TwoLineOrbit>();
        let ephemeris = generator.subschema_for::<EphemerisOrbit>();
        json_schema!({ "anyOf": [kepler, two_lines, ephemeris] })
    }
}

impl TryFrom<OrbitKeys> for OrbitKind {
    type Error = String;

    fn try_from(keys: OrbitKeys) -> Result<Self, String> {
        let gravity = keys.gravity.unwrap_or_else(earth_gravity);
        let planet_radius = keys.planet_radius.unwrap_or_else(earth_radius);
        let elements = [
            ("semi_major_axis", keys.semi_major_axis.is_some()),
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
        match (keys.semi_major_axis, keys.tle, keys.ephemeris, given) {
            (_, Some(_), Some(_), _) => twice("ephemeris", "tle"),
            (_, Some(_), None, Some(other)) => twice("tle", other),
            (_, None, Some(_), Some(other)) => twice("ephemeris", other),
            (_, Some(tle), None, None) => {
                Ok(Self::TwoLines(TwoLineOrbit { tle, gravity, planet_radius, sampled: Deferred::default() }))
            }
            (_, None, Some(ephemeris), None) => Ok(Self::Ephemeris(EphemerisOrbit {
                ephemeris,
                gravity,
                planet_radius,
                sampled: Deferred::default(),
            })),
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
            (None, None, None, _) => {
                Err("must have a `semi_major_axis`, for Kepler elements, a `tle` or an `ephemeris`"
                    .to_owned())
            }
        }
    }
}

impl OrbitKind {
    /// Reads the file of an ephemeris relative to `directory`, or takes the rows of `other` if that has read the same
    /// file; returns an inconsistency, a key within the orbit and the reason.
    pub fn read(&mut self, directory: &Path, other: Option<&Self>) -> Option<ConfigError> {
        let Self::Ephemeris(orbit) = self else { return None };
        let other = match other {
            Some(Self::Ephemeris(other)) => Some(&other.ephemeris),
            _ => None,
        };
        orbit.ephemeris.locate(directory);
        orbit.ephemeris.read(other).err().map(|why| ConfigError::new("ephemeris", why))
    }

    /// Replaces the reference to a file by its rows, in a run from `epoch_ns` nanoseconds after 1970, if known.
    pub fn inline(&mut self, epoch_ns: Option<u64>) {
        if let Self::Ephemeris(orbit) = self {
            orbit.ephemeris.inline(epoch_ns);
        }
    }

    /// Returns the date (ns after 1970, UTC) of a run that has none of its own: the epoch of two-line elements, or the
    /// first row of an ephemeris with dates.
    pub fn epoch_ns(&self) -> Option<u64> {
        match self {
            Self::Kepler(_) => None,
            Self::TwoLines(orbit) => two_lines::parse(&orbit.tle).ok().map(|elements| elements.epoch_ns),
            Self::Ephemeris(orbit) => orbit.ephemeris.epoch_ns(),
        }
    }

    /// Returns an inconsistency between values: a key within the orbit, and the reason.
    pub(super) fn fault(&self) -> Option<ConfigError> {
        match self {
            Self::Kepler(orbit) => orbit.fault(),
            Self::TwoLines(orbit) => two_lines::parse(&orbit.tle).err(),
            Self::Ephemeris(orbit) => orbit.ephemeris.fault().map(|why| ConfigError::new("ephemeris", why)),
        }
    }

    /// Checks that the orbit is known over a run of this duration (s) from `epoch_ns` nanoseconds after 1970, if known;
    /// returns the key and the reason.
    pub(super) fn run_fault(&self, duration: f64, epoch_ns: Option<u64>) -> Option<ConfigError> {
        let (key, radius) = match self {
            Self::Kepler(_) => return None,
            Self::TwoLines(orbit) => {
                if let Some(rows) = orbit.rows(duration).filter(|rows| *rows > MOST_ROWS as f64) {
                    let why = format!(
                        "would need {rows:.0} rows in this run, and at most {MOST_ROWS} are computed"
                    );
                    return Some(ConfigError::new("tle", why));
                }
                ("tle", orbit.planet_radius.get())
            }
            Self::Ephemeris(orbit) => ("ephemeris", orbit.planet_radius.get()),
        };
        let Some(path) = self.path(duration, epoch_ns) else {
            let why = match self {
                Self::TwoLines(_) => {
                    "does not hold in this run: the theory SGP4 has no position, as after a decay"
                }
                _ => "has dates: a scenario with another `epoch` than these needs one",
            };
            return Some(ConfigError::new(key, why));
        };
        let OrbitPath::Sampled(orbit) = path else { return None };
        let [from, to] = orbit.span();
        if from > 0.0 || to < duration {
            let why = format!("must have rows from 0 to {duration} s of the run, got {from} to {to} s");
            return Some(ConfigError::new(key, why));
        }
        let nearest = orbit.nearest_row().min(orbit.nearest());
        (nearest.is_nan() || nearest <= radius).then(|| {
            let why = format!("must stay above the planet's radius of {radius} m, got {nearest:.0} m");
            ConfigError::new(key, why)
        })
    }

    /// Returns the orbit in a run of this duration (s) from `epoch_ns` nanoseconds after 1970, if known.
    pub fn path(&self, duration: f64, epoch_ns: Option<u64>) -> Option<OrbitPath> {
        match self {
            Self::Kepler(orbit) => Some(OrbitPath::Kepler(*orbit)),
            Self::TwoLines(orbit) => orbit.path(duration, epoch_ns?).map(OrbitPath::Sampled),
            Self::Ephemeris(orbit) => orbit.path(epoch_ns).map(OrbitPath::Sampled),
        }
    }

    /// Returns the Kepler elements, if the orbit has them.
    pub fn kepler(&self) -> Option<&Kepler> {
        if let Self::Kepler(orbit) = self { Some(orbit) } else { None }
    }
}

impl TwoLineOrbit {
    /// Returns the interval between two rows (s).
    fn step(elements: &two_lines::MeanElements) -> f64 {
        let e = elements.eccentricity;
        // The true anomaly moves by n (1 + e)²/(1 - e²)^1.5 at the perigee.
        let flat = (1.0 - e) * (1.0 + e);
        let rate = elements.motion / 60.0 * (1.0 + e) * (1.0 + e) / (flat * f64::sqrt(flat));
        STEP / rate
    }

    /// Returns the number of rows of a run of this duration (s).
    fn rows(&self, duration: f64) -> Option<f64> {
        let elements = two_lines::parse(&self.tle).ok()?;
        Some(duration / Self::step(&elements) + ROWS as f64)
    }

    fn path(&self, duration: f64, epoch_ns: u64) -> Option<Arc<SampledOrbit>> {
        let planet = [self.gravity.get(), self.planet_radius.get()];
        let compute = || self.sample(duration, epoch_ns).map(Arc::new);
        let first = self.sampled.get_or(|| RunOrbit {
            tle: Some(self.tle.clone()),
            ephemeris: EphemerisTable::default(),
            planet,
            epoch_ns: Some(epoch_ns),
            duration,
            orbit: compute(),
        });
        // Copies of a scenario share the orbit; they may have other keys.
        let holds = first.tle.as_ref() == Some(&self.tle)
            && first.planet == planet
            && first.epoch_ns == Some(epoch_ns)
            && first.duration.to_bits() == duration.to_bits();
        if holds { first.orbit.clone() } else { compute() }
    }

    /// Returns rows of SGP4 over a run, and some beyond each end.
    fn sample(&self, duration: f64, epoch_ns: u64) -> Option<SampledOrbit> {
        let elements = two_lines::parse(&self.tle).ok()?;
        let (mut orbit, step) = (Sgp4::new(&elements), Self::step(&elements));
        // The difference of two counts is exact where it matters.
        let since = (i128::from(epoch_ns) - i128::from(elements.epoch_ns)) as f64 / 1e9;
        let beyond = (ROWS / 2) as f64;
        let count = libm::ceil(duration / step) + 2.0 * beyond;
        if count > MOST_ROWS as f64 {
            return None;
        }
        let times: Vec<f64> = (0..=count as usize).map(|row| (row as f64 - beyond) * step).collect();
        let positions: Option<Vec<Vector>> =
            times.iter().map(|t| Some(orbit.at((since + t) / 60.0)?[0])).collect();
        Some(SampledOrbit::new(times, positions?, [self.gravity.get(), self.planet_radius.get()]))
    }
}

impl EphemerisOrbit {
    fn path(&self, epoch_ns: Option<u64>) -> Option<Arc<SampledOrbit>> {
        let planet = [self.gravity.get(), self.planet_radius.get()];
        let compute = || {
            let rows = self.ephemeris.rows(epoch_ns)?;
            let (times, positions) = rows.into_iter().map(|[t, x, y, z]| (t, Vector::new(x, y, z))).unzip();
            Some(Arc::new(SampledOrbit::new(times, positions, planet)))
        };
        let first = self.sampled.get_or(|| RunOrbit {
            tle: None,
            ephemeris: self.ephemeris.clone(),
            planet,
            epoch_ns,
            duration: 0.0,
            orbit: compute(),
        });
        let holds = first.ephemeris.shares_rows(&self.ephemeris)
            && first.planet == planet
            && first.epoch_ns == epoch_ns;
        if holds { first.orbit.clone() } else { compute() }
    }
}
