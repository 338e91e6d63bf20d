//! Environment of a scenario: its checks, and its state in inertial axes.

use std::path::Path;

use flexsc_formats::document::ConfigError;
use flexsc_spacecraft::environment::OrbitEnvironment;

use super::{Scenario, ScenarioSpec, epoch};

impl ScenarioSpec {
    /// Reads the files of the environment, relative to `directory`, or takes their contents from `parent` if that has read
    /// them. A scenario without an `epoch` has that of its orbit, if the orbit has dates.
    pub(super) fn read_environment(
        &mut self,
        parent: Option<&Scenario>,
        directory: &Path,
    ) -> Option<ConfigError> {
        let around = self.environment.as_mut()?;
        let before = parent.and_then(|parent| parent.environment.as_ref());
        let mut is_sampled = false;
        if let Some(orbit) = &mut around.orbit {
            is_sampled = orbit.kepler().is_none();
            if let Some(fault) = orbit.read(directory, before.and_then(|before| before.orbit.as_ref())) {
                return Some(fault.within("environment.orbit"));
            }
            if self.epoch.is_none() {
                self.epoch = orbit.epoch_ns().and_then(epoch::date);
            }
        }
        let field = around.magnetic_field.as_mut();
        let other = before.and_then(|before| before.magnetic_field.as_ref());
        if let Some(fault) = field.and_then(|field| field.read(directory, other)) {
            return Some(fault.within("environment.magnetic_field"));
        }
        if let Some(fault) = around.drag.as_mut().and_then(|drag| drag.read(directory)) {
            return Some(fault.within("environment.drag"));
        }
        // Orbits that are interpolated must be known before anything follows from them.
        if is_sampled { self.environment_error() } else { None }
    }

    /// Checks that the environment is consistent in itself and with the run.
    pub(super) fn validate_environment(&self, errors: &mut Vec<ConfigError>) {
        errors.extend(self.environment_error());
    }

    fn environment_error(&self) -> Option<ConfigError> {
        let around = self.environment.as_ref()?;
        let error = around.fault().or_else(|| around.run_error(self.duration, self.date_ns()))?;
        Some(error.within("environment"))
    }

    /// Returns remarks on an environment that is accepted and probably not meant.
    pub(super) fn environment_remarks(&self) -> Vec<ConfigError> {
        let around = self.environment.as_ref();
        let remarks = around.map(|around| around.remarks(self.duration, self.date_ns())).unwrap_or_default();
        remarks.into_iter().map(|remark| remark.within("environment")).collect()
    }

    /// Returns the orbit environment in inertial axes, independent of the body's attitude.
    pub fn orbit_environment(&self) -> OrbitEnvironment {
        let of = |environment| OrbitEnvironment::new(environment, self.duration, self.date_ns());
        self.environment.as_ref().map(of).unwrap_or_default()
    }
}
