//! Checks of parts that need the environment: orbit, magnetic field and Sun.

use std::f64::consts::TAU;

use super::Written;
use crate::document::Fault;
use crate::environment::{Sky, Sun};
use crate::sensor::Sensor;

/// Largest number of orbits in a run for which the planet's shadow is computed.
const MOST_ORBITS: f64 = 1e6;

impl Written {
    /// Checks that the environment is consistent in itself and with the run.
    pub(super) fn environment_fault(&self) -> Option<Fault> {
        let around = self.environment.as_ref()?;
        if let Some(fault) = around.fault() {
            return Some(fault.within("environment"));
        }
        if around.sun == Some(Sun::Epoch) && self.epoch.is_none() {
            return Some(Fault::new(
                "environment.sun",
                "follows from the scenario's `epoch`, and there is none",
            ));
        }
        let turns =
            around.orbit.filter(|_| around.sun.is_some())?.mean_motion() * self.duration.seconds() / TAU;
        let why = || {
            format!("goes around {turns:.1e} times in this run, and shadows are known for {MOST_ORBITS:.0e}")
        };
        (turns > MOST_ORBITS).then(|| Fault::new("environment.orbit", why()))
    }

    /// Returns the orbit environment in inertial axes, independent of the body's attitude.
    pub fn sky(&self) -> Sky {
        let of = |environment| Sky::new(environment, self.duration, self.date_ns());
        self.environment.as_ref().map(of).unwrap_or_default()
    }

    /// Returns the error of a B-dot law without a magnetometer or magnetorquers.
    pub(super) fn b_dot_fault(&self) -> Option<Fault> {
        let why = if !self.sensor.iter().any(Sensor::measures_field) {
            "reads the field of a `[sensor.magnetometer]`, and there is none"
        } else if self.actuator.magnetorquers().is_none() {
            "commands magnetic moments: it needs `[actuator.magnetorquers]`, or wheels that are unloaded by them"
        } else {
            return None;
        };
        Some(Fault::new("", why))
    }

    /// Returns the error of a vector sensor whose field or Sun is missing.
    pub(super) fn vector_fault(&self, sensor: &Sensor) -> Option<Fault> {
        let around = self.environment.as_ref();
        match sensor {
            Sensor::Magnetometer(_) => {
                let why = "measures the field of `[environment.magnetic_field]`, and there is none";
                let dark = around.is_none_or(|around| around.magnetic_field.is_none());
                dark.then(|| Fault::new("", why))
            }
            Sensor::SunSensor(_) => {
                let why = "measures the direction to `environment.sun`, and there is none";
                let dark = around.is_none_or(|around| around.sun.is_none());
                dark.then(|| Fault::new("", why))
            }
            _ => None,
        }
    }
}
