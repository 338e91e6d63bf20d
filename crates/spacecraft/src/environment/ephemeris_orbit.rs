//! Orbit by positions at instants, of a file or of a scenario.

use std::sync::Arc;

use flexsc_formats::celestial_frame::CelestialFrame;
use flexsc_formats::document::ConfigError;
use flexsc_formats::ephemeris::EphemerisTable;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::Positive;
use nalgebra::UnitQuaternion;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::deferred::Deferred;
use super::kepler::{earth_gravity, earth_radius};
use super::precession::to_mean_of_date;
use super::row_departure::{Departure, MOST};
use super::sampled_orbit::{MOST_ROWS, SampledOrbit};
use super::wide_rows::{Gap, WideRows};

/// Angle from row to row (rad) above which rows that depart from their neighbours' orbit are too far apart, and not wrong.
const FAR: f64 = 0.4;

/// Difference of velocities (m/s) above which those of the file are not those of its positions.
const UNLIKE: f64 = 1.0;

/// Orbit by positions at instants.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EphemerisOrbit {
    /// Positions, rows \[t, x, y, z\] (s, m) in inertial axes from the planet's centre, or the path of their file.
    pub ephemeris: EphemerisTable,
    /// Axes of the rows: `EME2000`, `GCRF` and `ICRF` are rotated by the precession to the start, which needs a
    /// date, the others are taken as inertial axes; default: those that the file names, else the run's inertial
    /// axes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<CelestialFrame>,
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
    ephemeris: EphemerisTable,
    frame: CelestialFrame,
    planet: [f64; 2],
    epoch_ns: Option<u64>,
    /// Orbit; `None` where it is not known.
    orbit: Option<Arc<SampledOrbit>>,
}

impl EphemerisOrbit {
    /// Creates the orbit from its rows in some axes, with the gravitational parameter (m³/s²) and the radius (m) of the
    /// planet.
    pub(super) fn new(
        ephemeris: EphemerisTable,
        frame: Option<CelestialFrame>,
        gravity: Positive,
        planet_radius: Positive,
    ) -> Self {
        Self { ephemeris, frame, gravity, planet_radius, sampled: Deferred::default() }
    }

    /// Returns the axes of the rows.
    fn row_frame(&self) -> CelestialFrame {
        self.ephemeris.frame().or(self.frame).unwrap_or(CelestialFrame::Mod)
    }

    /// Returns the inertial axes of a run with a date: rows along other mean axes than those of the date are rotated.
    pub(super) fn run_frame(&self) -> CelestialFrame {
        match self.row_frame() {
            own @ (CelestialFrame::Teme | CelestialFrame::Tod) => own,
            _ => CelestialFrame::Mod,
        }
    }

    /// Returns true if the rows are along axes of 2000.
    fn is_rotated(&self) -> bool {
        !matches!(self.row_frame(), CelestialFrame::Mod | CelestialFrame::Teme | CelestialFrame::Tod)
    }

    /// Returns an inconsistency between values, with its key.
    pub(super) fn fault(&self) -> Option<ConfigError> {
        if let (Some(own), Some(given)) = (self.ephemeris.frame(), self.frame)
            && own != given
        {
            let why = format!(
                "must be left out: the file has `REF_FRAME = {}`, got {}",
                own.names().0,
                given.names().0
            );
            return Some(ConfigError::new("frame", why));
        }
        self.ephemeris.fault().map(|why| ConfigError::new("ephemeris", why))
    }

    /// Replaces the reference to a file by its rows in the inertial axes of a run from `epoch_ns` nanoseconds after 1970, if
    /// known.
    pub(super) fn inline(&mut self, epoch_ns: Option<u64>) {
        if let Some(rows) = self.rows(epoch_ns) {
            self.frame = Some(self.run_frame()).filter(|frame| *frame != CelestialFrame::Mod);
            self.ephemeris.inline(rows);
        }
    }

    /// Returns the orbit in a run of this duration (s) from `epoch_ns` nanoseconds after 1970, if known.
    ///
    /// # Errors
    /// The reason for which the rows are no orbit there.
    pub(super) fn run_path(&self, duration: f64, epoch_ns: Option<u64>) -> Result<Arc<SampledOrbit>, String> {
        let apart = |place: String, gap: f64, far: f64| {
            format!(
                "{place}: rows are too far apart: the next row comes {gap} s later, and between them the orbit is known to {:.1} km only, \
                 with velocities or without; export a row a minute for a low orbit",
                far / 1e3
            )
        };
        if let Some(gap) =
            self.least_known(duration, epoch_ns).filter(|gap| gap.distance.is_nan() || gap.distance > MOST)
        {
            return Err(apart(self.ephemeris.place(gap.row), gap.length, gap.distance));
        }
        let orbit = self.path(epoch_ns).ok_or_else(|| {
            let of_dates = self.ephemeris.epoch_ns().is_some();
            let why = if of_dates { "has dates" } else { "is along axes of 2000" };
            format!("{why}: a scenario without a date of its own needs an `epoch`")
        })?;
        let [from, to] = orbit.span();
        if from > 0.0 || to < duration {
            return Err(format!("must have rows from 0 to {duration} s of the run, got {from} to {to} s"));
        }
        let worst = orbit.departure([0.0, duration]);
        if !worst.is_refused() {
            return Ok(orbit);
        }
        let (place, most, far) = (self.place_at(worst.time, epoch_ns), MOST / 1e3, worst.distance / 1e3);
        let own = self.ephemeris.rows(epoch_ns).unwrap_or_default();
        let next = own.partition_point(|row| row[0] <= worst.time).clamp(1, own.len().max(2) - 1);
        let gap = own.get(next).zip(own.get(next - 1)).map_or(0.0, |(after, before)| after[0] - before[0]);
        let distance = own.get(next).map_or(1.0, |[_, x, y, z]| f64::sqrt(x * x + y * y + z * z));
        let angle = gap * f64::sqrt(self.gravity.get() / distance) / distance;
        Err(match worst.gap {
            None if angle > FAR => apart(place, gap, worst.distance),
            None => format!(
                "{place}: must be within {most} km of the polynomial through the four rows before it and the four after it, got {far:.1} km: \
                 is the row wrong, or are the rows too far apart?"
            ),
            Some(gap) => format!(
                "{place}: the next row comes {gap} s later, and between them the orbit is known to {far:.1} km only: rows must be so \
                 near to each other that it is known to {most} km"
            ),
        })
    }

    /// Returns remarks on the orbit in a run of this duration (s) from `epoch_ns` nanoseconds after 1970, if known.
    pub(super) fn remarks(&self, duration: f64, epoch_ns: Option<u64>) -> Vec<ConfigError> {
        let worst = self.path(epoch_ns).map(|orbit| orbit.departure([0.0, duration]));
        let burns = self.ephemeris.burns().first().map(|line| {
            let count = self.ephemeris.burns().len();
            format!(
                "has {count} dates at which the velocity jumps, as at a burn, the first in line {line}: the orbit is smooth there, over \
                 four rows on either side"
            )
        });
        let why = worst.filter(Departure::is_remarkable).map(|worst| {
            let (place, far) = (self.place_at(worst.time, epoch_ns), worst.distance);
            match worst.gap {
                None => format!(
                    "{place}: is {far:.0} m from the polynomial through the four rows before it and the four after it: velocities and \
                     targets follow the rows"
                ),
                Some(gap) => format!(
                    "{place}: the next row comes {gap} s later, and between them the orbit is known to {far:.0} m only"
                ),
            }
        });
        let unlike = self.unlike_velocity(duration, epoch_ns);
        [why, burns, unlike].into_iter().flatten().map(|why| ConfigError::new("ephemeris", why)).collect()
    }

    /// Returns a remark on velocities of the file that are not those of its positions.
    fn unlike_velocity(&self, duration: f64, epoch_ns: Option<u64>) -> Option<String> {
        let (times, _, velocities) = self.states(epoch_ns)?;
        let orbit = self.path(epoch_ns)?;
        let within =
            times.iter().zip(velocities?).enumerate().filter(|(_, (t, _))| (0.0..=duration).contains(*t));
        let off = within.map(|(row, (t, velocity))| (row, (orbit.motion(*t)[1] - velocity).norm()));
        let (row, worst) = off.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, worst)| *worst > UNLIKE)?;
        let place = self.ephemeris.place(row);
        Some(format!(
            "{place}: the velocity differs by {worst:.1} m/s from that of the positions: is it in km/s and in the axes of the positions? \
             Positions count"
        ))
    }

    /// Returns the place of the last row up to a time of the run (s).
    fn place_at(&self, t: f64, epoch_ns: Option<u64>) -> String {
        let rows = self.ephemeris.rows(epoch_ns).unwrap_or_default();
        self.ephemeris.place(rows.partition_point(|row| row[0] <= t + 1e-6).saturating_sub(1))
    }

    /// Returns times since the start of a run (s), positions (m) and, if the file has them, velocities (m/s) in its axes.
    #[expect(clippy::type_complexity, reason = "three columns of one table")]
    fn states(&self, epoch_ns: Option<u64>) -> Option<(Vec<f64>, Vec<Vector>, Option<Vec<Vector>>)> {
        let rows = self.ephemeris.rows(epoch_ns)?;
        let turn = if self.is_rotated() {
            UnitQuaternion::new_normalize(to_mean_of_date(self.row_frame(), epoch_ns?)?)
        } else {
            UnitQuaternion::identity()
        };
        let along =
            |vector: [f64; 3]| if self.is_rotated() { turn * Vector::from(vector) } else { vector.into() };
        let (times, positions) = rows.into_iter().map(|[t, x, y, z]| (t, along([x, y, z]))).unzip();
        let velocities =
            self.ephemeris.velocities().filter(|own| own.iter().any(|velocity| *velocity != [0.0; 3]));
        Some((times, positions, velocities.map(|own| own.iter().map(|velocity| along(*velocity)).collect())))
    }

    /// Returns the gap in a run of this duration (s) in which the orbit is known least, of rows that are far apart and have velocities.
    fn least_known(&self, duration: f64, epoch_ns: Option<u64>) -> Option<Gap> {
        let (times, positions, velocities) = self.states(epoch_ns)?;
        WideRows { times: &times, positions: &positions, velocities: &velocities? }
            .least_known([0.0, duration])
    }

    /// Returns the rows in the inertial axes of a run from `epoch_ns` nanoseconds after 1970: time since the start (s), and
    /// position (m).
    fn rows(&self, epoch_ns: Option<u64>) -> Option<Vec<[f64; 4]>> {
        let (times, positions, velocities) = self.states(epoch_ns)?;
        let wide = velocities.as_ref().map(|velocities| WideRows {
            times: &times,
            positions: &positions,
            velocities,
        });
        let filled = wide.filter(WideRows::is_wide).and_then(|wide| wide.filled(MOST_ROWS));
        let (times, positions) = filled.unwrap_or((times, positions));
        Some(times.iter().zip(&positions).map(|(t, at)| [*t, at.x, at.y, at.z]).collect())
    }

    /// Returns the orbit in a run from `epoch_ns` nanoseconds after 1970; `None` where it is not known.
    pub(super) fn path(&self, epoch_ns: Option<u64>) -> Option<Arc<SampledOrbit>> {
        let planet = [self.gravity.get(), self.planet_radius.get()];
        let compute = || {
            let rows = self.rows(epoch_ns)?;
            let (times, positions) = rows.into_iter().map(|[t, x, y, z]| (t, Vector::new(x, y, z))).unzip();
            Some(Arc::new(SampledOrbit::new(times, positions, planet)))
        };
        let first = self.sampled.get_or(|| RunOrbit {
            ephemeris: self.ephemeris.clone(),
            frame: self.row_frame(),
            planet,
            epoch_ns,
            orbit: compute(),
        });
        let holds = first.ephemeris.shares_rows(&self.ephemeris)
            && first.frame == self.row_frame()
            && first.planet == planet
            && first.epoch_ns == epoch_ns;
        if holds { first.orbit.clone() } else { compute() }
    }
}
