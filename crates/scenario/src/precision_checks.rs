//! Checks of the precision of the flight computer.

use flexsc_formats::document::ConfigError;

use super::ScenarioSpec;

impl ScenarioSpec {
    /// Adds the errors of parts that compute in double precision only.
    pub(super) fn validate_flight_precision(&self, errors: &mut Vec<ConfigError>) {
        if self.flight_precision.is_double() {
            return;
        }
        let laws = (0..self.axis_count()).flat_map(|axis| self.law.laws_about(axis));
        let mut others: Vec<String> = laws
            .filter(|placed| !placed.law.offers().has_single_precision)
            .map(|placed| placed.key)
            .collect();
        let estimator = self.estimator.iter().filter(|kind| !kind.offers().has_single_precision);
        others.extend(estimator.map(|kind| format!("estimator.{}", kind.kind())));
        others.extend(self.adaptation.iter().map(|kind| format!("adaptation.{}", kind.kind())));
        let members = self.actuator.members();
        let actuators = members.iter().filter(|member| !member.kind.offers().has_single_precision);
        others.extend(actuators.map(|member| member.key.clone()));
        if let Some(part) = others.first() {
            let why = format!("must be `double`, because `{part}` computes in double precision only");
            errors.push(ConfigError::new("flight_precision", why));
        }
    }
}
