//! Choices of a control system that are constant at its export, by which the translated code is pruned.

use flexsc_flight::attitude_observation::ObservationKind;
use flexsc_flight::error_measure::ErrorMeasure;

use crate::control_system::{Actuation, ControlSystem, LawsOfAxes};
use crate::translate::ConstantChoices;

/// Values of each choice in a control system.
#[derive(Default)]
struct Choices {
    has_rate_limit: Vec<bool>,
    has_integral: Vec<bool>,
    measures: Vec<ErrorMeasure>,
    observations: Vec<ObservationKind>,
    has_gain: Vec<bool>,
    is_least_largest: Vec<bool>,
    is_magnetic: Vec<bool>,
}

/// Returns the choices that are constant in a control system.
pub fn constant_choices(system: &ControlSystem) -> ConstantChoices {
    let mut all = Choices::default();
    all.add(system);
    let mut constant = ConstantChoices::default();
    constant.flag(("AttitudeFeedback", "has_rate_limit"), all.has_rate_limit);
    constant.flag(("AttitudeFeedback", "has_integral"), all.has_integral);
    constant.flag(("AttitudeObservation", "has_gain"), all.has_gain);
    constant.flag(("allocate", "is_least_largest"), all.is_least_largest);
    constant.flag(("MomentumUnloading", "is_magnetic"), all.is_magnetic);
    constant.variant("ErrorMeasure", all.measures);
    constant.variant("ObservationKind", all.observations);
    constant
}

impl Choices {
    fn add(&mut self, system: &ControlSystem) {
        if let Some(unit) = system.estimator() {
            let observations = || unit.correctors.iter().map(|corrector| &corrector.observation);
            self.observations.extend(observations().map(|own| own.kind));
            self.has_gain.extend(observations().map(|own| own.has_gain));
        }
        match system {
            ControlSystem::Relays(_) | ControlSystem::BDot(_) => {}
            ControlSystem::Modes(modes) => {
                self.add_actuation(&modes.actuation);
                let laws = modes.modes.iter().filter_map(|mode| mode.start.on_estimates());
                laws.for_each(|laws| self.add_laws(&laws.laws));
            }
            ControlSystem::Sampled(laws) => {
                self.add_actuation(&laws.actuation);
                self.add_laws(&laws.laws);
            }
        }
    }

    fn add_laws(&mut self, laws: &LawsOfAxes) {
        match laws {
            LawsOfAxes::Pd(laws) => self.measures.extend(laws.iter().map(|(law, _)| law.measure)),
            LawsOfAxes::Attitude(laws) => {
                for (law, _) in laws {
                    self.measures.push(law.measure);
                    self.has_rate_limit.push(law.has_rate_limit);
                    self.has_integral.push(law.has_integral);
                }
            }
            LawsOfAxes::PhasePlane(..) | LawsOfAxes::StateSpace(_) => {}
        }
    }

    fn add_actuation(&mut self, actuation: &Actuation) {
        self.is_least_largest.extend(actuation.wheels.as_ref().map(|own| own.is_least_largest));
        self.is_magnetic.extend(actuation.unloading.as_ref().map(|own| own.law.is_magnetic));
    }
}
