//! Environment that does not depend on the attitude: position on the orbit, magnetic field, Sun, and the planet's
//! shadow.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::{Instant, Span};

use super::date::greenwich;
use super::magnetic_field::PlanetField;
use super::{Environment, Kepler, OrbitPosition, SunPath};

/// Orbit, magnetic field and Sun of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OrbitEnvironment {
    orbit: Option<Kepler>,
    field: Option<PlanetField>,
    sun: Option<SunPath>,
    /// Intervals in which the planet hides the Sun.
    shadows: Vec<[Instant; 2]>,
    /// Angle from the inertial x to the meridian of Greenwich at the start (rad): 0 without a date.
    greenwich: f64,
    /// Duration of the run (s).
    duration: f64,
}

/// Observable environment at an instant, in inertial axes.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct EnvironmentObservation {
    /// Magnetic field (T), if there is one.
    pub field: Option<Vector>,
    /// Direction to the Sun; `None` in shadow.
    pub sun: Option<Vector>,
}

impl OrbitEnvironment {
    /// Creates the sky of an environment for a run of this duration from `epoch_ns` nanoseconds after 1970, if known.
    pub fn new(environment: &Environment, duration: Span, epoch_ns: Option<u64>) -> Self {
        let sun = environment.sun.map(|sun| SunPath::new(&sun, epoch_ns.unwrap_or(0)));
        let shadows = match (&environment.orbit, &sun) {
            (Some(orbit), Some(sun)) => orbit.shadows(sun, duration.seconds()),
            _ => Vec::new(),
        };
        let instant = |seconds: f64| Instant::START + Span::from_seconds(seconds);
        Self {
            orbit: environment.orbit,
            field: environment.magnetic_field.map(|field| PlanetField::new(&field, epoch_ns)),
            sun,
            shadows: shadows.into_iter().map(|shadow| shadow.map(instant)).collect(),
            greenwich: epoch_ns.map_or(0.0, greenwich),
            duration: duration.seconds(),
        }
    }

    /// Returns the position at `t` seconds after the start, if the body is on an orbit.
    pub fn position(&self, t: f64) -> Option<OrbitPosition> {
        self.orbit.as_ref().map(|orbit| orbit.at(t))
    }

    /// Returns position (m), velocity, acceleration and its rate of change in inertial axes at `t` seconds after the
    /// start, if the body is on an orbit.
    pub fn orbit_motion(&self, t: f64) -> Option<[Vector; 4]> {
        let place = self.position(t)?;
        let (position, velocity) = (place.position, place.velocity);
        let climb = 3.0 * position.dot(&velocity) / position.norm_squared();
        let jerk = (position * climb - velocity) * place.tide;
        Some([position, velocity, position * -place.tide, jerk])
    }

    /// Returns the angle from the inertial x to the meridian of Greenwich at the start (rad): 0 without a date.
    pub fn greenwich(&self) -> f64 {
        self.greenwich
    }

    /// Returns the environment with another angle of Greenwich at the start (rad).
    #[must_use]
    pub fn with_greenwich(self, greenwich: f64) -> Self {
        Self { greenwich, ..self }
    }

    /// Returns the duration of the run (s).
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Returns the orbit.
    pub fn orbit(&self) -> Option<&Kepler> {
        self.orbit.as_ref()
    }

    /// Returns the path of the Sun, in the light or not.
    pub fn sun(&self) -> Option<&SunPath> {
        self.sun.as_ref()
    }

    /// Returns the instants at which the shadow begins and ends.
    pub fn shadow_edges(&self) -> impl Iterator<Item = Instant> {
        self.shadows.iter().flatten().copied()
    }

    /// Returns true if the planet does not hide the Sun at a time since the start (s).
    pub fn is_lit(&self, t: f64) -> bool {
        let past = self.shadows.partition_point(|[from, _]| from.seconds() <= t);
        past.checked_sub(1).is_none_or(|last| t >= self.shadows[last][1].seconds())
    }

    /// Returns the magnetic field at a position, in inertial axes (T), at a time since the start (s).
    pub(super) fn field(&self, place: &OrbitPosition, t: f64) -> Option<Vector> {
        self.field.as_ref().map(|field| field.at(&place.position, t))
    }

    /// Returns an upper bound of the field on the orbit (T).
    pub fn field_bound(&self) -> f64 {
        let on = self.orbit.as_ref().zip(self.field.as_ref());
        on.map_or(0.0, |(orbit, field)| field.bound(orbit.nearest()))
    }

    /// Returns true if there is a magnetic field.
    pub fn is_magnetic(&self) -> bool {
        self.field.is_some()
    }

    /// Returns the highest degree of the spherical harmonics of the magnetic field, 1 of a dipole; 0 without a field.
    pub fn field_degree(&self) -> usize {
        self.field.as_ref().map_or(0, PlanetField::degree)
    }

    /// Returns the environment with the degrees of the magnetic field up to `degree`.
    #[must_use]
    pub fn with_field_degree(&self, degree: usize) -> Self {
        Self { field: self.field.as_ref().map(|field| field.truncated(degree)), ..self.clone() }
    }

    /// Returns the rotation rate of the planet whose magnetic field turns with it (rad/s); 0 without a field.
    pub(super) fn field_rotation(&self) -> f64 {
        self.field.as_ref().map_or(0.0, |field| field.rotation.abs())
    }

    /// Returns the magnetic field at the body in inertial axes (T) at a time since the start (s).
    pub fn field_at(&self, t: f64) -> Option<Vector> {
        self.field.as_ref().and_then(|field| Some(field.at(&self.position(t)?.position, t)))
    }

    /// Returns the observable environment at a time since the start (s).
    pub fn observation(&self, t: f64) -> EnvironmentObservation {
        let sun = self.sun.as_ref().filter(|_| self.is_lit(t));
        EnvironmentObservation { field: self.field_at(t), sun: sun.map(|sun| sun.direction(t)) }
    }
}
