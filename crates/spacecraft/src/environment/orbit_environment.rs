//! Environment that does not depend on the attitude: position on the orbit, magnetic field, Sun, and the planet's
//! shadow.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::{Instant, Span};
use flexsc_numerics::time_arcs::TimeArcs;

use super::arc_length::LONGEST;
use super::date::greenwich;
use super::deferred::Deferred;
use super::eclipses::{self, Eclipses};
use super::magnetic_field::PlanetField;
use super::sky_row::{self, SkyRow};
use super::{DensityModel, Environment, OrbitPath, OrbitPosition, ShadowShape, SunPath, moon};

/// Orbit, magnetic field and Sun of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OrbitEnvironment {
    orbit: Option<OrbitPath>,
    field: Option<PlanetField>,
    sun: Option<SunPath>,
    /// Shape of the planet's shadow.
    shadow: ShadowShape,
    /// Eclipses of the run.
    eclipses: Deferred<Eclipses>,
    /// Angle from the inertial x to the meridian of Greenwich at the start (rad): 0 without a date.
    greenwich: f64,
    /// Time (s) from J2000 to the start; `None` without a date.
    date: Option<f64>,
    /// Duration of the run (s).
    duration: f64,
    /// True if the density of the atmosphere follows from the height above the Earth's ellipsoid.
    has_height: bool,
    /// Length of the arcs on an orbit by Kepler elements (s).
    arc_length: Deferred<f64>,
    arcs: TimeArcs<{ sky_row::COLUMNS }>,
}

/// Observable environment at an instant, in inertial axes.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct EnvironmentObservation {
    /// Magnetic field (T), if there is one.
    pub field: Option<Vector>,
    /// Direction to the Sun; `None` with less than half of its disc in view.
    pub sun: Option<Vector>,
    /// Direction to the planet's centre, if the body is on an orbit.
    pub nadir: Option<Vector>,
    /// Position from the planet's centre (m), if the body is on an orbit.
    pub position: Option<Vector>,
    /// Velocity (m/s), if the body is on an orbit.
    pub velocity: Option<Vector>,
}

impl OrbitEnvironment {
    /// Creates the sky of an environment for a run of this duration from `epoch_ns` nanoseconds after 1970, if known.
    pub fn new(environment: &Environment, duration: Span, epoch_ns: Option<u64>) -> Self {
        let orbit = environment.orbit.as_ref();
        Self {
            orbit: orbit.and_then(|orbit| orbit.path(duration.seconds(), epoch_ns)),
            field: environment.magnetic_field.as_ref().map(|field| PlanetField::new(field, epoch_ns)),
            sun: environment.sun.map(|sun| SunPath::new(&sun, epoch_ns.unwrap_or(0))),
            shadow: environment.shadow.unwrap_or_default(),
            eclipses: Deferred::default(),
            greenwich: epoch_ns.map_or(0.0, greenwich),
            date: epoch_ns.map(moon::since_j2000),
            duration: duration.seconds(),
            has_height: environment.drag.as_ref().is_some_and(|drag| drag.model != DensityModel::Exponential),
            arc_length: Deferred::default(),
            arcs: TimeArcs::default(),
        }
    }

    /// Returns the position at `t` seconds after the start, if the body is on an orbit.
    pub fn position(&self, t: f64) -> Option<OrbitPosition> {
        self.orbit.as_ref().map(|orbit| orbit.at(t))
    }

    /// Returns position (m), velocity, acceleration and its rate of change in inertial axes at `t` seconds after the
    /// start, if the body is on an orbit.
    pub fn orbit_motion(&self, t: f64) -> Option<[Vector; 4]> {
        Some(self.orbit.as_ref()?.motion(t))
    }

    /// Returns the orbit's normal with its first two derivatives in inertial axes at `t` seconds after the start, if the
    /// body is on an orbit; the length is any.
    pub fn orbit_normal(&self, t: f64) -> Option<[Vector; 3]> {
        self.orbit.as_ref().map(|orbit| orbit.normal_motion(t))
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
    pub fn orbit(&self) -> Option<&OrbitPath> {
        self.orbit.as_ref()
    }

    /// Returns the path of the Sun, in the light or not.
    pub fn sun(&self) -> Option<&SunPath> {
        self.sun.as_ref()
    }

    /// Returns the position of the Moon (m) from the Earth's centre at a time since the start (s); `None` without a date.
    pub fn moon(&self, t: f64) -> Option<Vector> {
        self.date.map(|date| moon::position(date + t))
    }

    /// Returns the radius of the planet (m), if the body is on an orbit.
    pub fn planet_radius(&self) -> Option<f64> {
        self.orbit.as_ref().map(OrbitPath::planet_radius)
    }

    /// Returns the eclipses of the run; `None` without an orbit or a Sun.
    fn eclipses(&self) -> Option<&Eclipses> {
        let (orbit, sun) = (self.orbit.as_ref()?, self.sun.as_ref()?);
        Some(self.eclipses.get_or(|| Eclipses::new(self.shadow, orbit, sun, self.duration)))
    }

    /// Returns the instants at which the part of the Sun's disc in view is not smooth: the edges of penumbra and umbra, or
    /// of the cylinder.
    pub fn shadow_edges(&self) -> impl Iterator<Item = Instant> {
        self.eclipses().into_iter().flat_map(|eclipses| eclipses.edges.iter().copied())
    }

    /// Returns the part of the Sun's disc that the planet leaves in view at a time since the start (s), from 0 to 1.
    pub fn part_in_view(&self, t: f64) -> f64 {
        match (self.shadow, &self.orbit, &self.sun) {
            (ShadowShape::Cone, Some(orbit), Some(sun)) => eclipses::part_in_view(orbit, sun, t),
            _ if self.eclipses().is_some_and(|eclipses| eclipses.is_within(t)) => 0.0,
            _ => 1.0,
        }
    }

    /// Returns the part of the Sun's disc in view, from 0 to 1, at a time since the start (s) with its row.
    pub(super) fn part_in_row(&self, row: &SkyRow, t: f64) -> f64 {
        match (self.shadow, &self.orbit, &self.sun) {
            (ShadowShape::Cone, Some(orbit), Some(_)) => {
                eclipses::part_at(&row.position(), orbit.planet_radius(), &row.light())
            }
            _ => self.part_in_view(t),
        }
    }

    /// Returns start and end (s) of the arc about a time since the start (s) on which position, magnetic field and Sun are
    /// polynomials, before it is halved for an error that is too large: on an orbit by rows, from one row to the next.
    pub fn span(&self, t: f64) -> [f64; 2] {
        let length = match &self.orbit {
            None => LONGEST,
            Some(OrbitPath::Kepler(orbit)) => {
                *self.arc_length.get_or(|| orbit.arc_length(self.field.as_ref()))
            }
            Some(OrbitPath::Sampled(orbit)) => return orbit.span(t),
        };
        let index = libm::floor(t / length);
        [index * length, (index + 1.0) * length]
    }

    /// Returns position, magnetic field and Sun at a time since the start (s), from the arc about it.
    pub(super) fn row(&self, t: f64) -> SkyRow {
        let (orbit, field, sun) = (self.orbit.as_ref(), self.field.as_ref(), self.sun.as_ref());
        let has_rows = matches!(orbit, Some(OrbitPath::Sampled(_)));
        SkyRow(self.arcs.read(
            t,
            || self.span(t),
            |t| SkyRow::new(orbit, field, sun, self.has_height, t).0,
            |arc, tail| SkyRow::is_resolved(arc, tail, has_rows),
            |arc| arc.at(t),
        ))
    }

    /// Returns the rate (rad/s) with which the part of the Sun's disc in view varies at a time since the start (s).
    pub fn light_rate(&self, t: f64) -> f64 {
        self.eclipses().map_or(0.0, |eclipses| eclipses.rate(t))
    }

    /// Returns true if at least half of the Sun's disc is in view at a time since the start (s).
    pub fn is_lit(&self, t: f64) -> bool {
        self.part_in_view(t) >= 0.5
    }

    /// Returns the times of the run (s) with less than half of the Sun's disc in view.
    pub fn eclipses_seen(&self) -> Vec<[f64; 2]> {
        let dark = |[from, to]: [Instant; 2]| {
            let [from, to] = [from, to].map(|edge| edge.seconds().clamp(0.0, self.duration));
            let middle = 0.5 * (from + to);
            if self.is_lit(middle) {
                return None;
            }
            // The last lit instant on each side of the middle, unless the run begins or ends in the dark.
            let [enters, leaves] =
                [from, to].map(|end| if self.is_lit(end) { self.dusk(end, middle) } else { end });
            Some([enters, leaves])
        };
        self.eclipses().map_or_else(Vec::new, |eclipses| {
            eclipses
                .outer
                .iter()
                .filter(|[from, _]| from.seconds() < self.duration)
                .filter_map(|own| dark(*own))
                .collect()
        })
    }

    /// Returns the time (s) between a lit and a dark one at which half of the Sun's disc is in view, to a microsecond.
    fn dusk(&self, mut lit: f64, mut dark: f64) -> f64 {
        while (dark - lit).abs() > 1e-6 {
            let middle = 0.5 * (lit + dark);
            if self.is_lit(middle) { lit = middle } else { dark = middle }
        }
        dark
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
        let field = self.field.as_ref().map(|field| field.truncated(degree));
        Self { field, arc_length: Deferred::default(), arcs: TimeArcs::default(), ..self.clone() }
    }

    /// Returns the magnetic field in the planet's axes.
    #[cfg(test)]
    pub(super) fn field(&self) -> Option<&PlanetField> {
        self.field.as_ref()
    }

    /// Returns the rotation rate of the planet whose magnetic field turns with it (rad/s); 0 without a field.
    pub(super) fn field_rotation(&self) -> f64 {
        self.field.as_ref().map_or(0.0, |field| field.rotation.abs())
    }

    /// Returns the magnetic field at the body in inertial axes (T) at a time since the start (s).
    pub fn field_at(&self, t: f64) -> Option<Vector> {
        (self.orbit.is_some() && self.is_magnetic()).then(|| self.row(t).field())
    }

    /// Returns the magnetic field at the body in inertial axes (T) with its first two derivatives at a time since the start
    /// (s).
    pub fn field_motion(&self, t: f64) -> Option<[Vector; 3]> {
        let (orbit, field) = (self.orbit.as_ref()?, self.field.as_ref()?);
        let [position, velocity, acceleration, _] = orbit.motion(t);
        Some(field.motion([position, velocity, acceleration], t))
    }

    /// Returns an upper bound of the rate of the field at the body (T/s); 0 without a field.
    pub fn field_rate_bound(&self) -> f64 {
        let on = self.orbit.as_ref().zip(self.field.as_ref());
        on.map_or(0.0, |(orbit, field)| {
            field.rate_bound([orbit.nearest(), orbit.farthest()], orbit.largest_speed())
        })
    }

    /// Returns the observable environment at a time since the start (s).
    pub fn observation(&self, t: f64) -> EnvironmentObservation {
        if self.orbit.is_none() && self.sun.is_none() {
            return EnvironmentObservation::default();
        }
        let row = self.row(t);
        let sun = self.sun.as_ref().filter(|_| self.part_in_row(&row, t) >= 0.5);
        EnvironmentObservation {
            field: self.field.as_ref().map(|_| row.field()),
            sun: sun.map(|_| row.light().direction),
            nadir: self.orbit.as_ref().map(|_| -row.position().normalize()),
            position: self.orbit.as_ref().map(|_| row.position()),
            velocity: self.orbit.as_ref().map(|_| row.velocity()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shadows of a long run take seconds: a scenario is read without them.
    #[test]
    fn shadows_are_searched_where_they_are_needed() {
        let around: Environment =
            flexsc_formats::document::from_text("orbit = { semi_major_axis = 7e6 }\nsun = \"epoch\"")
                .unwrap();
        let sky = OrbitEnvironment::new(&around, Span::from_seconds(1e5), Some(1_795_478_400_000_000_000));
        let copy = sky.clone();
        assert!(sky.observation(5.0).nadir.is_some() && !sky.eclipses.is_known());
        assert!(sky.shadow_edges().count() > 60);
        assert!(copy == sky && copy.eclipses.is_known());
    }
}
