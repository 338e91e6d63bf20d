//! Checks of the environment: orbit and Sun.

use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;
use flexsc_spacecraft::environment::{OrbitEnvironment, Sun};

use super::ScenarioSpec;

/// Largest number of orbits in a run for which the planet's shadow is computed.
const MOST_ORBITS: f64 = 1e6;

impl ScenarioSpec {
    /// Checks that the environment is consistent in itself and with the run.
    pub(super) fn validate_environment(&self) -> Option<ConfigError> {
        let around = self.environment.as_ref()?;
        if let Some(fault) = around.fault() {
            return Some(fault.within("environment"));
        }
        if around.sun == Some(Sun::Epoch) && self.epoch.is_none() {
            return Some(ConfigError::new(
                "environment.sun",
                "follows from the scenario's `epoch`, and there is none",
            ));
        }
        let turns =
            around.orbit.filter(|_| around.sun.is_some())?.mean_motion() * self.duration.seconds() / TAU;
        let why = || {
            format!("goes around {turns:.1e} times in this run, and shadows are known for {MOST_ORBITS:.0e}")
        };
        (turns > MOST_ORBITS).then(|| ConfigError::new("environment.orbit", why()))
    }

    /// Returns the orbit environment in inertial axes, independent of the body's attitude.
    pub fn orbit_environment(&self) -> OrbitEnvironment {
        let of = |environment| OrbitEnvironment::new(environment, self.duration, self.date_ns());
        self.environment.as_ref().map(of).unwrap_or_default()
    }
}
