//! Checks of a body whose actuator acts elsewhere than on the hub: every other torque would act on the hub.

use flexsc_dynamics::axis_model::AxisModel;
use flexsc_formats::document::ConfigError;

use super::ScenarioSpec;

impl ScenarioSpec {
    /// Checks that nothing acts on the hub of a body whose modes have the gains of a load elsewhere.
    pub(super) fn load_inconsistency(&self, body: &AxisModel) -> Option<ConfigError> {
        if body.modes.iter().all(|mode| mode.gain == mode.hub_gain) {
            return None;
        }
        let fault = |key: &str, what: &str| {
            let why = format!(
                "{what} acts on the hub, but the actuator of this body elsewhere (`manoeuvre.load`, or a `hub_gain` of modes)"
            );
            Some(ConfigError::new(key, why))
        };
        if !self.disturbance.is_empty() {
            return fault("disturbance[0]", "is a torque that");
        }
        let (_, wheel) = self.actuator.flywheel()?;
        fault(&wheel, "is a wheel that")
    }
}
