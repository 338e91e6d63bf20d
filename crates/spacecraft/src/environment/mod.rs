//! Environment of a three-axis body: torques that depend on attitude and time.

mod altitude_orbit;
mod arc_length;
mod bright_body;
mod date;
mod deep_space;
mod deferred;
mod density;
mod dipole;
mod direction_motion;
mod drag;
mod eclipses;
mod element_set;
mod ephemeris_orbit;
mod field_model;
mod gravity_gradient;
mod ground_site;
mod igrf_14;
mod kepler;
mod local_time;
mod magnetic_field;
mod moon;
mod oblateness;
mod orbit;
mod orbit_environment;
mod orbit_kind;
mod orbit_path;
mod phase;
mod plate_mount;
mod precession;
mod resonance;
mod row_departure;
mod sampled_orbit;
mod sgp4;
mod shadow;
mod sky_row;
mod solar_disc;
mod solar_pressure;
mod spherical_harmonics;
mod sun;
mod surroundings;
#[cfg(test)]
mod tests;
mod thermal_response;
mod time_jet;
mod two_line_orbit;
mod two_lines;
mod wide_rows;
mod wmm_2025;

use std::f64::consts::TAU;

use flexsc_formats::celestial_frame::CelestialFrame;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Finite;
use flexsc_numerics::time::Span;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use solar_disc::ASTRONOMICAL_UNIT;

pub use altitude_orbit::AltitudeOrbit;
pub use bright_body::BrightBody;
pub use density::DensityModel;
pub use dipole::Dipole;
pub use direction_motion::DirectionMotion;
pub use drag::{Drag, DragPlate};
pub use eclipses::ShadowShape;
pub use element_set::ElementSet;
pub use ephemeris_orbit::EphemerisOrbit;
pub use field_model::FieldModel;
pub use gravity_gradient::GravityGradient;
pub use ground_site::GroundSite;
pub use kepler::{Kepler, OrbitPosition, earth_gravity, earth_radius};
pub use local_time::LocalTime;
pub use magnetic_field::MagneticField;
pub use oblateness::Oblateness;
pub use orbit::to_body;
pub use orbit_environment::{EnvironmentObservation, OrbitEnvironment};
pub use orbit_kind::OrbitKind;
pub use orbit_path::OrbitPath;
pub use plate_mount::{PlateMount, PlateMounts};
pub use precession::to_mean_of_date;
pub use sampled_orbit::SampledOrbit;
pub use solar_pressure::{SolarPlate, SolarPressure};
pub use sun::{Sun, SunPath};
pub use surroundings::SurroundingsState;
pub use two_line_orbit::TwoLineOrbit;

/// Largest number of orbits in a run for which the planet's shadow is computed.
const MOST_ORBITS: f64 = 1e5;

/// The environment of a body with three axes. Its torques add up.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Environment {
    /// Orbit of the body; default: none, or the one given with a torque below.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orbit: Option<OrbitKind>,
    /// The magnetic field of the orbit's planet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub magnetic_field: Option<MagneticField>,
    /// Direction to the Sun in inertial axes, of any length, constant and at 1 au, or `"epoch"`: that from the
    /// Earth at the date, in equatorial axes with x to the equinox, within 0.01 degrees. The orbit's planet casts a
    /// shadow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sun: Option<Sun>,
    /// Shape of the shadow that the orbit's planet casts, whose edges are events; it needs `orbit` and `sun`.
    /// Default: a cone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shadow: Option<ShadowShape>,
    /// Gravity gradient of a circular orbit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity_gradient: Option<GravityGradient>,
    /// Pressure of sunlight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub solar_pressure: Option<SolarPressure>,
    /// A magnetic moment of the body in the field of its planet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dipole: Option<Dipole>,
    /// Drag of the atmosphere on plates: a torque, by which the orbit does not decay.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drag: Option<Drag>,
    /// A torque that is constant in inertial axes (N m).
    #[serde(default)]
    pub torque: [Finite; 3],
}

impl Environment {
    /// Returns an inconsistency between values: a key within the environment, and the reason.
    pub fn fault(&self) -> Option<ConfigError> {
        if let Some(fault) = self.orbit.as_ref().and_then(OrbitKind::fault) {
            return Some(fault.within("orbit"));
        }
        if self.sun.is_some_and(|sun| sun.has_no_direction()) {
            return Some(ConfigError::new("sun", "must not be zero, got [0, 0, 0]"));
        }
        if self.magnetic_field.is_some() && self.orbit.is_none() {
            return Some(ConfigError::new("magnetic_field", "needs an `orbit`, and there is none"));
        }
        if self.shadow.is_some() && (self.orbit.is_none() || self.sun.is_none()) {
            let why = "is that of the orbit's planet: it needs `environment.orbit` and `environment.sun`";
            return Some(ConfigError::new("shadow", why));
        }
        if let Some(fault) = self.shadow_fault() {
            return Some(fault);
        }
        let drag = self.drag.as_ref();
        if let Some(fault) = drag.and_then(|drag| drag.fault(self.orbit.as_ref(), self.sun.is_some())) {
            return Some(fault.within("drag"));
        }
        let pressed = self.solar_pressure.as_ref().and_then(|pressure| pressure.fault(self.sun.is_some()));
        pressed.map(|fault| fault.within("solar_pressure")).or_else(|| self.orbit_fault())
    }

    /// Replaces references to files by their rows, in a run from `epoch_ns` nanoseconds after 1970, if known.
    pub fn inline_files(&mut self, epoch_ns: Option<u64>) {
        if let Some(orbit) = &mut self.orbit {
            orbit.inline(epoch_ns);
        }
        if let Some(field) = &mut self.magnetic_field {
            field.inline();
        }
        if let Some(table) = self.drag.as_mut().and_then(|drag| drag.table.as_mut()) {
            table.inline();
        }
    }

    /// Checks the environment against a run of this duration from `epoch_ns` nanoseconds after 1970, if known; returns a
    /// key within the environment and the reason.
    pub fn run_error(&self, duration: Span, epoch_ns: Option<u64>) -> Option<ConfigError> {
        if self.sun == Some(Sun::Epoch) && epoch_ns.is_none() {
            return Some(ConfigError::new("sun", "follows from the scenario's `epoch`, and there is none"));
        }
        if let Some(fault) =
            self.magnetic_field.as_ref().and_then(|field| field.run_error(duration, epoch_ns))
        {
            return Some(fault.within("magnetic_field"));
        }
        let orbit = self.orbit.as_ref()?;
        if let Some(fault) = orbit.run_fault(duration.seconds(), epoch_ns) {
            return Some(fault.within("orbit"));
        }
        if let Some(drag) = &self.drag
            && let Some(path) = orbit.path(duration.seconds(), epoch_ns)
            && let Some(fault) = drag.run_fault(&path)
        {
            return Some(fault.within("drag"));
        }
        let turns = orbit.kepler().filter(|_| self.sun.is_some())?.mean_motion() * duration.seconds() / TAU;
        let why = || {
            format!("goes around {turns:.1e} times in this run, and shadows are known for {MOST_ORBITS:.0e}")
        };
        (turns > MOST_ORBITS).then(|| ConfigError::new("orbit", why()))
    }

    /// Returns remarks on an environment that is accepted for a run of this duration from `epoch_ns` nanoseconds after 1970, if
    /// known, and probably not meant: a key within the environment, and the reason.
    pub fn remarks(&self, duration: Span, epoch_ns: Option<u64>) -> Vec<ConfigError> {
        let remarks = self.orbit.as_ref().map(|orbit| orbit.remarks(duration.seconds(), epoch_ns));
        remarks.unwrap_or_default().into_iter().map(|remark| remark.within("orbit")).collect()
    }

    /// Returns the inertial axes of a run with a date: those of the mean equator and equinox at its start, to which Sun, field
    /// and sites belong, unless the orbit is in others.
    pub fn frame(&self) -> CelestialFrame {
        self.orbit.as_ref().map_or(CelestialFrame::Mod, OrbitKind::frame)
    }

    /// Returns the key and the reason, if a conical shadow does not fit between the orbit and the Sun.
    fn shadow_fault(&self) -> Option<ConfigError> {
        let orbit = self.orbit.as_ref().and_then(OrbitKind::kepler).filter(|_| self.sun.is_some())?;
        let (farthest, most) = (orbit.farthest(), 0.1 * ASTRONOMICAL_UNIT);
        (self.shadow != Some(ShadowShape::Cylinder) && farthest > most).then(|| {
            let why = format!(
                "must keep the apogee, at {farthest} m, within {most:.3e} m for a conical shadow: write `shadow = \"cylinder\"`, or \
                 leave out `sun`"
            );
            ConfigError::new("orbit.semi_major_axis", why)
        })
    }

    /// Returns the key and the reason, if an orbit is given twice or is missing.
    fn orbit_fault(&self) -> Option<ConfigError> {
        let (gradient, dipole) = (self.gravity_gradient.as_ref(), self.dipole.as_ref());
        if let Some(fault) = gradient.and_then(|gradient| gradient.fault(self.orbit.is_some())) {
            return Some(fault.within("gravity_gradient"));
        }
        let dipole = dipole?;
        if let Some(fault) = dipole.validate(self.orbit.is_some(), self.magnetic_field.is_some()) {
            return Some(fault.within("dipole"));
        }
        let gradient = gradient.filter(|_| dipole.own_field().is_some())?;
        if let (Some(own), Some(other)) = (dipole.orbit_rate, gradient.orbit_rate)
            && own != other
        {
            let why = format!("must be that of `gravity_gradient`, {} rad/s, got {}", other.get(), own.get());
            return Some(ConfigError::new("dipole.orbit_rate", why));
        }
        (dipole.local != gradient.local).then(|| {
            ConfigError::new("dipole.local", "must be that of `gravity_gradient`: there is one orbit")
        })
    }
}
