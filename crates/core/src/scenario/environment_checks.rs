//! Environment of a scenario: its checks, and its state in inertial axes.

use flexsc_formats::document::ConfigError;
use flexsc_spacecraft::environment::OrbitEnvironment;

use super::ScenarioSpec;

impl ScenarioSpec {
    /// Checks that the environment is consistent in itself and with the run.
    pub(super) fn validate_environment(&self) -> Option<ConfigError> {
        let around = self.environment.as_ref()?;
        let fault = around.fault().or_else(|| around.run_error(self.duration, self.date_ns()))?;
        Some(fault.within("environment"))
    }

    /// Returns the orbit environment in inertial axes, independent of the body's attitude.
    pub fn orbit_environment(&self) -> OrbitEnvironment {
        let of = |environment| OrbitEnvironment::new(environment, self.duration, self.date_ns());
        self.environment.as_ref().map(of).unwrap_or_default()
    }
}
