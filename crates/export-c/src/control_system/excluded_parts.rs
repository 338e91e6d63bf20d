//! Parts of a scenario's control loop that are not in its exported code, and what the caller does in their place.

use flexsc_core::Scenario;
use flexsc_core::control::actuator::ActuatorKind;
use flexsc_core::control::law::LawKind;

use super::ControlSystem;
use super::actuation::{Actuation, Executing, are_magnetorquers};

/// Part of the loop that is not in the code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExcludedPart {
    /// Key of the part in the scenario.
    pub key: String,
    /// Task of the caller in its place.
    pub duty: String,
    /// True for guidance and ephemerides, whose results are inputs of the code.
    pub is_supplied: bool,
}

impl ControlSystem {
    /// Returns the actuators that the code commands.
    fn actuation(&self) -> Option<&Actuation> {
        match self {
            Self::Relays(_) | Self::BDot(_) => None,
            Self::Sampled(laws) => Some(&laws.actuation),
            Self::Modes(modes) => Some(&modes.actuation),
        }
    }

    /// Returns true if an estimator is part of the code, or if its laws read none.
    fn has_estimator(&self) -> bool {
        match self {
            Self::Relays(_) => false,
            Self::BDot(_) => true,
            Self::Sampled(laws) => {
                laws.estimator.is_some() || laws.filter.is_some() || laws.rate_filter.is_some()
            }
            Self::Modes(modes) => modes.estimator.is_some(),
        }
    }

    /// Returns the parts of the scenario's control loop that are not in the code: those of the loop first, then those whose results
    /// are inputs.
    pub fn excluded_parts(&self, scenario: &Scenario) -> Vec<ExcludedPart> {
        let mut parts = Vec::new();
        let mut add = |key: String, duty: &str, is_supplied: bool| {
            parts.push(ExcludedPart { key, duty: duty.to_owned(), is_supplied });
        };
        if let Some(estimator) = &scenario.estimator
            && !estimator.offers().is_assessed_only
            && !self.has_estimator()
        {
            add(format!("estimator.{}", estimator.kind()), "supply its estimates as inputs", false);
        }
        self.actuators_left_out(scenario, &mut |key, duty| add(key, duty, false));
        let references = self.estimator().map_or(&[][..], |unit| &unit.correctors);
        for corrector in references.iter().filter(|corrector| corrector.is_of_vector()) {
            let duty =
                "supply the reference of its vector at each exposure, in inertial axes, from an ephemeris";
            add(scenario.sensor_key(corrector.sensor), duty, true);
        }
        if !scenario.target.is_empty() || scenario.mode.iter().any(|mode| mode.target.is_some()) {
            let duty = "supply the target attitude, and angle, rate and acceleration of a slew's reference";
            add("target".to_owned(), duty, true);
        }
        if scenario.manoeuvre.is_some() {
            let duty = "supply the reference motion and the waveform of the manoeuvre";
            add("manoeuvre".to_owned(), duty, false);
        }
        parts
    }

    /// Adds the actuators that are not in the code.
    fn actuators_left_out(&self, scenario: &Scenario, add: &mut dyn FnMut(String, &str)) {
        let actuation = self.actuation();
        let has_wheels = actuation.is_some_and(|own| own.wheels.is_some());
        let members = scenario.actuator.members();
        let executing = Executing::all(scenario, &members);
        let mut with_torquers = executing.iter().filter(|own| own.has(are_magnetorquers));
        let has_moments = with_torquers.all(|own| matches!(own.law, LawKind::BDot(_)));
        for member in &members {
            let key = member.key.clone();
            if !member.executes() {
                let is_included = match self {
                    // B-dot laws alone command the magnetorquers, which do not unload.
                    Self::BDot(_) => are_magnetorquers(&member.kind),
                    _ => actuation.is_some_and(|own| own.unloading.is_some()),
                };
                if !is_included {
                    add(member.unloading_key(), "unload the momentum of the wheels");
                }
                continue;
            }
            match &*member.kind {
                ActuatorKind::Wheels(wheels) => {
                    if !has_wheels {
                        add(key.clone(), "distribute the torque to the wheels, within their limits");
                    }
                    let extras = [
                        ("speed_bias", wheels.speed_bias.is_some(), "hold the speeds of the wheels"),
                        (
                            "compensation",
                            wheels.compensation.is_some(),
                            "compensate the friction of the wheels",
                        ),
                    ];
                    for (name, _, duty) in extras.into_iter().filter(|(_, exists, _)| *exists) {
                        add(format!("{key}.{name}"), duty);
                    }
                }
                ActuatorKind::ControlMomentGyros(_) => add(key, "steer the gimbals that give the torque"),
                ActuatorKind::Jets(_) if actuation.is_none_or(|own| own.jets.is_none()) => {
                    add(key, "give the commands by on-times of the jets");
                }
                ActuatorKind::Thrusters(_) => add(key, "give the torque by the thrusters"),
                ActuatorKind::Magnetorquers(_) if !has_moments => {
                    add(key, "give the torque by magnetic moments");
                }
                _ => {}
            }
        }
    }
}
