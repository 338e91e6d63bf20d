//! Checks of the precision of the flight computer: which parts of a control system compute in single precision.

use flexsc_control::actuator::ActuatorKind;
use flexsc_control::estimator::EstimatorKind;
use flexsc_control::law::LawKind;
use flexsc_formats::document::ConfigError;

use super::ScenarioSpec;

/// Key of the precision.
const KEY: &str = "flight_precision";

impl ScenarioSpec {
    pub(super) fn validate_flight_precision(&self, errors: &mut Vec<ConfigError>) {
        if self.flight_precision.is_double() {
            return;
        }
        let mut refuse = |part: &str, accepted: &str| {
            let why = format!("must be `double` with `{part}`: {accepted} can compute in single precision");
            errors.push(ConfigError::new(KEY, why));
        };
        for axis in 0..self.axis_count() {
            let mut laws = self.law.laws_about(axis).into_iter();
            let other = laws.find(|placed| {
                !matches!(placed.law, LawKind::Attitude(_) | LawKind::BDot(_) | LawKind::Open(_))
            });
            if let Some(placed) = other {
                refuse(&placed.key, "the laws `attitude`, `b_dot` and `open`");
                break;
            }
        }
        match &self.estimator {
            None => {}
            Some(EstimatorKind::Attitude(filter)) if filter.elastic.is_none() => {}
            Some(EstimatorKind::Attitude(_)) => {
                refuse("estimator.attitude.elastic", "an attitude filter without modes");
            }
            Some(other) => refuse(&format!("estimator.{}", other.kind()), "`[estimator.attitude]`"),
        }
        if let Some(adaptation) = &self.adaptation {
            refuse(&format!("adaptation.{}", adaptation.kind()), "a law that is not tuned in the run");
        }
        let acts = |kind: &ActuatorKind| {
            matches!(kind, ActuatorKind::Ideal(_) | ActuatorKind::Wheels(_) | ActuatorKind::Magnetorquers(_))
        };
        if let Some(member) = self.actuator.members().iter().find(|member| !acts(&member.kind)) {
            refuse(&member.key, "the actuators `ideal`, `wheels` and `magnetorquers`");
        }
    }
}
