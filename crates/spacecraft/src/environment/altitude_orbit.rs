//! An orbit as a mission states it: its altitude and, of a Sun-synchronous one, the local time of its ascending node.

use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::date::{DAY, J2000};
use super::kepler::{earth_gravity, earth_radius};
use super::local_time::LocalTime;
use super::{Kepler, Oblateness};

/// Rate of the mean Sun among the stars (rad/s): a turn in a tropical year of 365.2422 days.
const MEAN_SUN_RATE: f64 = TAU / (365.2422 * DAY);
/// Mean longitude of the Sun at J2000, and its rate (degrees, degrees a day), from the mean equinox of date.
const MEAN_LONGITUDE: [f64; 2] = [280.460, 0.985_647_4];

/// An orbit by its altitude. Inertial axes are those of the planet's equator: z along its axis of rotation.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AltitudeOrbit {
    /// Altitude above the planet's radius at the equator (m); of an ellipse, the semi-major axis less the radius.
    pub altitude: Positive,
    /// Mean local time of the ascending node: `"10:30"`, `"6 h"`, or seconds since midnight; with the inclination left out, the
    /// orbit is Sun-synchronous. It needs the scenario's `epoch`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ltan: Option<LocalTime>,
    /// Eccentricity.
    #[serde(default)]
    pub eccentricity: NonNegative,
    /// Inclination to the equator (rad); default: with `ltan`, that of a Sun-synchronous orbit, else 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inclination: Option<Finite>,
    /// Angle from the inertial x to the ascending node (rad), in place of `ltan`; default: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub node: Option<Finite>,
    /// Angle from the node to the perigee (rad).
    #[serde(default)]
    pub perigee: Finite,
    /// Mean anomaly at the start (rad); for a circular orbit, the angle from the perigee.
    #[serde(default)]
    pub anomaly: Finite,
    /// Gravitational parameter of the planet (m³/s²); default: the Earth's.
    #[serde(default = "earth_gravity")]
    pub gravity: Positive,
    /// Radius of the planet (m), for its shadow; default: the Earth's equatorial radius.
    #[serde(default = "earth_radius")]
    pub planet_radius: Positive,
    /// Coefficient J2 of the planet's oblateness, as of Kepler elements; default: with `ltan` that of the Earth, else a sphere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub j2: Option<Oblateness>,
}

impl AltitudeOrbit {
    /// Returns the Kepler elements of a run that starts `epoch_ns` nanoseconds after 1970, UTC; the node is 0 where the local
    /// time of the node needs a date and there is none.
    pub fn kepler(&self, epoch_ns: Option<u64>) -> Kepler {
        let semi_major_axis = self.planet_radius.get() + self.altitude.get();
        let default = if self.ltan.is_some() { Oblateness::EARTH } else { Oblateness::default() };
        let mut orbit = Kepler {
            semi_major_axis: Positive::new(semi_major_axis).unwrap_or(Positive::ONE),
            eccentricity: self.eccentricity,
            inclination: self.inclination.unwrap_or_default(),
            node: self.node.unwrap_or_default(),
            perigee: self.perigee,
            anomaly: self.anomaly,
            gravity: self.gravity,
            planet_radius: self.planet_radius,
            j2: self.j2.unwrap_or(default),
        };
        let Some(ltan) = self.ltan else { return orbit };
        if self.inclination.is_none() {
            orbit.inclination = Finite::new(sun_synchronous_inclination(&orbit)).unwrap_or_default();
        }
        let from_equinox = epoch_ns.map_or(0.0, |epoch_ns| mean_longitude(epoch_ns) + ltan.from_sun());
        orbit.node = Finite::new(from_equinox.rem_euclid(TAU)).unwrap_or_default();
        orbit
    }

    /// Returns an inconsistency between values: a key within the orbit, and the reason.
    pub(super) fn fault(&self) -> Option<ConfigError> {
        let (orbit, radius) = (self.kepler(None), self.planet_radius.get());
        if let Some(fault) = orbit.fault().filter(|fault| fault.key != "semi_major_axis") {
            return Some(fault);
        }
        if orbit.nearest() <= radius {
            let why = format!(
                "must keep the perigee above the planet, and an eccentricity of {} takes it {:.0} m below the surface",
                self.eccentricity.get(),
                radius - orbit.nearest()
            );
            return Some(ConfigError::new("altitude", why));
        }
        if self.ltan.is_none() || self.inclination.is_some() {
            return None;
        }
        let cosine = sun_synchronous_cosine(&self.kepler(None));
        if cosine.is_nan() || cosine.abs() > 1.0 {
            let why = "has no Sun-synchronous orbit at this altitude: the node does not follow the Sun at any inclination; \
                       give the `inclination`";
            return Some(ConfigError::new("ltan", why));
        }
        None
    }

    /// Returns the key and the reason, if the local time of the node needs a date and there is none.
    pub(super) fn date_fault(&self, epoch_ns: Option<u64>) -> Option<ConfigError> {
        (self.ltan.is_some() && epoch_ns.is_none()).then(|| {
            let why = "needs the date at which the run starts: the scenario's `epoch`, and there is none";
            ConfigError::new("ltan", why)
        })
    }
}

/// Returns the cosine of the inclination at which the node of an orbit follows the mean Sun; NaN or infinite about a sphere.
fn sun_synchronous_cosine(orbit: &Kepler) -> f64 {
    let equatorial = Kepler { inclination: Finite::default(), ..*orbit };
    MEAN_SUN_RATE / equatorial.secular_rates().node
}

fn sun_synchronous_inclination(orbit: &Kepler) -> f64 {
    libm::acos(sun_synchronous_cosine(orbit))
}

/// Returns the mean longitude of the Sun (rad), which is the right ascension of the mean Sun.
fn mean_longitude(epoch_ns: u64) -> f64 {
    let days = (epoch_ns as f64 / 1e9 - J2000) / DAY;
    (MEAN_LONGITUDE[0] + MEAN_LONGITUDE[1] * days).to_radians()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn orbit(text: &str) -> AltitudeOrbit {
        flexsc_formats::document::from_text(text).expect(text)
    }

    #[test]
    fn a_sun_synchronous_orbit_follows_the_mean_sun() {
        // Computed apart, from cos i = -(2/3) (2 pi/365.2422 d)/(J2 n) (a/Re)^2 with a = 6 903 137 m and the constants above.
        let orbit = orbit("altitude = 525e3\nltan = \"10:30\"\n");
        let start = orbit.kepler(Some(1_773_878_400_000_000_000));
        assert!(
            (start.inclination.get().to_degrees() - 97.496_942_073_066_22).abs() < 1e-9,
            "{}",
            start.inclination.get()
        );
        // 2026-03-19 00:00 UTC: 9573.5 days after J2000; the node is 22.5 degrees west of the mean Sun.
        let node = (280.460 + 0.985_647_4 * 9573.5 - 22.5_f64).rem_euclid(360.0);
        assert!((start.node.get().to_degrees() - node).abs() < 1e-9);
        // In a year, the node turns once.
        let year = start.secular_rates().node * 365.2422 * DAY;
        assert!((year - TAU).abs() < 1e-9, "{year}");
    }

    #[test]
    fn what_has_no_sun_synchronous_orbit_is_refused() {
        let fault = |text: &str| orbit(text).fault().map(|fault| fault.key);
        assert_eq!(fault("altitude = 525e3\nltan = \"6 h\"\n"), None);
        assert_eq!(fault("altitude = 525e3\nltan = \"6 h\"\nj2 = 0\n"), Some("ltan".into()));
        assert_eq!(fault("altitude = 2e7\nltan = \"6 h\"\n"), Some("ltan".into()));
        assert_eq!(fault("altitude = 2e7\nltan = \"6 h\"\ninclination = 1\n"), None);
        assert_eq!(fault("altitude = 525e3\neccentricity = 0.5\n"), Some("altitude".into()));
        let without = orbit("altitude = 525e3\nltan = \"6 h\"\n");
        assert!(without.date_fault(None).is_some() && without.date_fault(Some(0)).is_none());
    }
}
