//! Checks of an adaptation: the parameter that it tunes, and its objective.

use flexsc_control::actuator::ActuatorKind;
use flexsc_control::adaptation::{AdaptationKind, Objective};
use flexsc_control::law::{LawKind, Tunable};
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Finite;

use super::Scenario;

impl Scenario {
    pub(super) fn validate_adaptation(&self) -> Option<ConfigError> {
        let adaptation = self.adaptation.as_ref()?;
        let tunable = self.law.tunable();
        let at = |key: &str, why: String| {
            Some(ConfigError::new(format!("adaptation.{}{key}", adaptation.kind()), why))
        };
        let Some(number) = tunable.iter().find(|number| number.key == adaptation.tunes()) else {
            let tunes = if tunable.is_empty() { "" } else { ".tunes" };
            return at(tunes, self.untunable(adaptation.tunes(), &tunable));
        };
        if let Some((key, why)) = self.objective_fault(adaptation) {
            return at(key, why);
        }
        let AdaptationKind::RandomSearch(search) = adaptation else { return None };
        let [low, high] = search.bounds.map(Finite::get);
        if low >= high {
            return at(".bounds", format!("must be [low, high] in this order, got [{low}, {high}]"));
        }
        if let Some(why) = number.validate_bounds([low, high]) {
            return at(".bounds", why);
        }
        let value = number.value;
        if !(low..=high).contains(&value) {
            let why = format!("must lie within the adaptation's bounds [{low}, {high}], got {value}");
            let place = if let LawKind::Stages(_) = self.law { "" } else { "." };
            return Some(ConfigError::new(format!("law.{}{place}{}", self.law.kind(), search.tunes), why));
        }
        None
    }

    /// Returns the reason why the law has no parameter `tunes`.
    fn untunable(&self, tunes: &str, tunable: &[Tunable]) -> String {
        let known: Vec<_> = tunable.iter().map(|number| format!("`{}`", number.key)).collect();
        match (known.is_empty(), tunes) {
            (true, "k_t") => "adapts the gain k_t of a law `relay`, and there is none".to_owned(),
            (true, _) => format!("tunes a number of the law, and the law `{}` has none", self.law.kind()),
            (false, tunes) => {
                let (kind, known) = (self.law.kind(), known.join(" or "));
                format!("must name a number of the law `{kind}`, {known}, got `{tunes}`")
            }
        }
    }

    /// Returns the reason why the objective of an adaptation cannot be measured, with the key within the adaptation.
    fn objective_fault(&self, adaptation: &AdaptationKind) -> Option<(&'static str, String)> {
        let objective = adaptation.objective();
        if objective == Objective::EnvelopeMean {
            if self.estimator.as_ref().is_none_or(|estimator| estimator.envelope().is_none()) {
                let why = "needs the window means of an `[estimator.envelope]`, and there is none: give it one, or another \
                           `objective`";
                return Some(("", why.to_owned()));
            }
            let why =
                "follows from the `[estimator.envelope]`: leave it out for the objective `envelope_mean`";
            return adaptation.window().map(|_| (".window", why.to_owned()));
        }
        let word = objective.key();
        if adaptation.window().is_none_or(|window| window == flexsc_numerics::time::Span::ZERO) {
            return Some((".window", format!("must be given for the objective `{word}`")));
        }
        let why = match objective {
            Objective::ElasticRms if self.mode_count() == 0 || self.model.chain().is_some() => {
                "needs elastic modes, and the body has none"
            }
            Objective::WheelPowerMean if !self.spins() => {
                "needs wheels whose speed is known: an `[actuator.wheels]`, or a wheel with a `rotor`"
            }
            Objective::Firings
                if !self.actuator.has_kind(|kind| matches!(kind, ActuatorKind::Thrusters(_)))
                    && self.actuator.jets().is_none() =>
            {
                "counts pulses of thrusters or jets, and there are none"
            }
            Objective::Firings if self.actuator.jets().is_none() && self.actuator.len() > 1 => {
                "counts the pulses of thrusters in the torque on the body, which is theirs alone if there are no other actuators"
            }
            Objective::Switchings if !(0..self.axis_count()).any(|axis| self.has_states(axis)) => {
                "counts the switchings of a law `relay` or `phase_plane`, and there is none"
            }
            Objective::TorqueMean
                if self.actuator.has_kind(|kind| matches!(kind, ActuatorKind::Magnetorquers(_))) =>
            {
                "is not known for magnetorquers, whose torque changes with the field"
            }
            Objective::TorqueMean if self.actuator.control_moment_gyros().is_some() => {
                "is not known for control moment gyros, whose torque changes with the gimbal angles between commands"
            }
            _ => return None,
        };
        Some((".objective", format!("`{word}` {why}")))
    }

    /// Returns true if there are wheels with known speed.
    fn spins(&self) -> bool {
        self.actuator.has_kind(|kind| match kind {
            ActuatorKind::Wheels(_) => true,
            ActuatorKind::Wheel(wheel) => wheel.rotor.is_some(),
            _ => false,
        })
    }

    /// Returns true if the law about an axis has states between which it switches.
    fn has_states(&self, axis: usize) -> bool {
        let law = self.law.about(axis);
        law.is_switching() || matches!(law, LawKind::PhasePlane(_) | LawKind::Own(_))
    }
}
