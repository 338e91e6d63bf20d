//! Orbit by two-line elements: rows of SGP4, between which it is interpolated.

use std::sync::Arc;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::Positive;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::date::DAY;
use super::deferred::Deferred;
use super::element_set::ElementSet;
use super::kepler::{earth_gravity, earth_radius};
use super::sampled_orbit::{MOST_ROWS, ROWS, STEP, SampledOrbit};
use super::sgp4::Sgp4;
use super::two_lines::MeanElements;

/// Time from the epoch of the elements (days) beyond which a run is remarked.
const FRESH: f64 = 14.0;

/// Orbit by two-line elements, in the axes of the true equator and the mean equinox, which differ from the mean equator and
/// equinox by the nutation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TwoLineOrbit {
    /// Mean elements about the Earth, from 0.05 to 18 revolutions a day: both lines of a two-line element set, three with
    /// a name, one text of them, or the path of a file of them or of an OMM (keywords, XML, JSON). SGP4 gives the position, from a
    /// period of 225 min on SDP4 with Sun, Moon and resonances. The run starts at the `epoch`, else at that of the elements (`check`
    /// remarks more than 14 days between them), in axes of the true equator and mean equinox, without nutation, up to 18 arc
    /// seconds. Jumps of SDP4 of more than 2 km are refused.
    pub tle: ElementSet,
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
    tle: ElementSet,
    planet: [f64; 2],
    epoch_ns: u64,
    duration: f64,
    /// Orbit; `None` where the theory has no position.
    orbit: Option<Arc<SampledOrbit>>,
}

impl TwoLineOrbit {
    /// Creates the orbit from its elements, with the gravitational parameter (m³/s²) and the radius (m) of the planet.
    pub(super) fn new(tle: ElementSet, gravity: Positive, planet_radius: Positive) -> Self {
        Self { tle, gravity, planet_radius, sampled: Deferred::default() }
    }

    /// Returns the epoch of the elements (ns after 1970, UTC).
    pub(super) fn epoch_ns(&self) -> Option<u64> {
        self.tle.elements().ok().map(|elements| elements.epoch_ns)
    }

    /// Returns the fault of the elements, with its key.
    pub(super) fn fault(&self) -> Option<ConfigError> {
        self.tle.elements().err()
    }

    /// Returns the orbit in a run of this duration (s) from `epoch_ns` nanoseconds after 1970.
    ///
    /// # Errors
    /// The reason for which the theory has no continuous orbit there.
    pub(super) fn run_path(&self, duration: f64, epoch_ns: u64) -> Result<Arc<SampledOrbit>, String> {
        if let Some(rows) = self.rows(duration).filter(|rows| *rows > MOST_ROWS as f64) {
            return Err(format!(
                "would need {rows:.0} rows in this run, and at most {MOST_ROWS} are computed"
            ));
        }
        let orbit = self.path(duration, epoch_ns).ok_or_else(|| {
            "does not hold in this run: the theory SGP4 has no position, as after a decay".to_owned()
        })?;
        let jump = orbit.departure([0.0, duration]);
        if jump.is_refused() {
            return Err(format!(
                "jumps by {:.1} km near {:.0} s of the run: SGP4 itself does so in deep space where the perturbed inclination passes \
                 0.2 rad (11.46 deg), and no motion goes with it; end the run before, or take elements of another epoch",
                2e-3 * jump.distance,
                jump.time
            ));
        }
        Ok(orbit)
    }

    /// Returns remarks on the orbit in a run of this duration (s) from `epoch_ns` nanoseconds after 1970.
    pub(super) fn remarks(&self, duration: f64, epoch_ns: Option<u64>) -> Vec<ConfigError> {
        let (Some(start), Some(own)) = (epoch_ns, self.epoch_ns()) else { return Vec::new() };
        let since = (i128::from(start) - i128::from(own)) as f64 / 1e9;
        let (before, after) = (-since / DAY, (since + duration) / DAY);
        let (days, place) = if before > after { (before, "before") } else { (after, "after") };
        let age = (days > FRESH).then(|| {
            format!(
                "is used up to {days:.0} days {place} its epoch, and SGP4 errs by kilometres more each day in a low orbit: take elements \
                 from within {FRESH} days of the run"
            )
        });
        let jump = self.path(duration, start).map(|orbit| orbit.departure([0.0, duration]));
        let jump = jump.filter(super::row_departure::Departure::is_remarkable).map(|jump| {
            format!(
                "jumps by about {:.0} m near {:.0} s of the run, as SGP4 itself does: velocity and targets are wrong for some rows about it",
                2.0 * jump.distance,
                jump.time
            )
        });
        age.into_iter().chain(jump).map(|why| ConfigError::new("tle", why)).collect()
    }

    /// Returns the interval between two rows (s).
    fn step(elements: &MeanElements) -> f64 {
        let e = elements.eccentricity;
        // The true anomaly moves by n (1 + e)²/(1 - e²)^1.5 at the perigee.
        let flat = (1.0 - e) * (1.0 + e);
        let rate = elements.motion / 60.0 * (1.0 + e) * (1.0 + e) / (flat * f64::sqrt(flat));
        STEP / rate
    }

    /// Returns the number of rows of a run of this duration (s).
    fn rows(&self, duration: f64) -> Option<f64> {
        let elements = self.tle.elements().ok()?;
        Some(duration / Self::step(&elements) + ROWS as f64)
    }

    /// Returns the orbit in a run of this duration (s) from `epoch_ns` nanoseconds after 1970; `None` where the theory has no
    /// position.
    pub(super) fn path(&self, duration: f64, epoch_ns: u64) -> Option<Arc<SampledOrbit>> {
        let planet = [self.gravity.get(), self.planet_radius.get()];
        let compute = || self.sample(duration, epoch_ns).map(Arc::new);
        let first = self.sampled.get_or(|| RunOrbit {
            tle: self.tle.clone(),
            planet,
            epoch_ns,
            duration,
            orbit: compute(),
        });
        // Copies of a scenario share the orbit; they may have other keys.
        let holds = first.tle == self.tle
            && first.planet == planet
            && first.epoch_ns == epoch_ns
            && first.duration.to_bits() == duration.to_bits();
        if holds { first.orbit.clone() } else { compute() }
    }

    /// Returns rows of SGP4 over a run, and some beyond each end.
    fn sample(&self, duration: f64, epoch_ns: u64) -> Option<SampledOrbit> {
        let elements = self.tle.elements().ok()?;
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
