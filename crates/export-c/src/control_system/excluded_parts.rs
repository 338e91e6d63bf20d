//! Parts of a scenario's control loop that are not in its exported code, and what the caller does in their place.

use flexsc_core::Scenario;
use flexsc_core::control::actuator::ActuatorKind;

use super::ControlSystem;

/// Part of the loop that is not in the code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExcludedPart {
    /// Key of the part in the scenario.
    pub key: String,
    /// Task of the caller in its place.
    pub duty: String,
}

/// Contents of the code, as far as they differ between control systems.
#[derive(Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a part that is there or not")]
struct Included {
    has_estimator: bool,
    has_wheels: bool,
    has_jets: bool,
    has_moments: bool,
}

impl Included {
    fn new(system: &ControlSystem) -> Self {
        match system {
            ControlSystem::Relays(_) => Self::default(),
            ControlSystem::BDot(_) => Self { has_estimator: true, has_moments: true, ..Self::default() },
            ControlSystem::Sampled(laws) => Self {
                has_estimator: laws.estimator.is_some()
                    || laws.filter.is_some()
                    || laws.rate_filter.is_some(),
                has_wheels: laws.wheels.is_some(),
                has_jets: laws.jets.is_some(),
                has_moments: false,
            },
            ControlSystem::Modes(modes) => {
                let laws = || modes.modes.iter().filter_map(|mode| mode.start.as_ref());
                Self {
                    has_estimator: modes.estimator.is_some(),
                    has_wheels: laws().all(|laws| laws.wheels.is_some()),
                    has_jets: false,
                    has_moments: false,
                }
            }
        }
    }
}

impl ControlSystem {
    /// Returns the parts of the scenario's control loop that are not in the code.
    pub fn excluded_parts(&self, scenario: &Scenario) -> Vec<ExcludedPart> {
        let included = Included::new(self);
        let mut parts = Vec::new();
        let mut add = |key: String, duty: &str| parts.push(ExcludedPart { key, duty: duty.to_owned() });
        if let Some(estimator) = &scenario.estimator {
            let is_read = !estimator.offers().is_assessed_only;
            if is_read && !included.has_estimator {
                add(format!("estimator.{}", estimator.kind()), "supply its estimates as inputs");
            }
        }
        for member in scenario.actuator.members() {
            let key = member.key.clone();
            match &*member.kind {
                ActuatorKind::Wheels(wheels) => {
                    if !included.has_wheels {
                        add(key.clone(), "distribute the torque to the wheels, within their limits");
                    }
                    let extras = [
                        ("speed_bias", wheels.speed_bias.is_some(), "hold the speeds of the wheels"),
                        (
                            "compensation",
                            wheels.compensation.is_some(),
                            "compensate the friction of the wheels",
                        ),
                        ("unloading", wheels.unloading.is_some(), "unload the momentum of the wheels"),
                    ];
                    for (name, _, duty) in extras.into_iter().filter(|(_, exists, _)| *exists) {
                        add(format!("{key}.{name}"), duty);
                    }
                }
                ActuatorKind::ControlMomentGyros(_) => add(key, "steer the gimbals that give the torque"),
                ActuatorKind::Jets(_) if !included.has_jets => {
                    add(key, "give the commands by on-times of the jets");
                }
                ActuatorKind::Thrusters(_) => add(key, "give the torque by the thrusters"),
                ActuatorKind::Magnetorquers(_) if !included.has_moments => {
                    add(key, "give the torque by magnetic moments");
                }
                _ => {}
            }
        }
        let references = self.estimator().map_or(&[][..], |unit| &unit.correctors);
        for corrector in references.iter().filter(|corrector| corrector.is_of_vector()) {
            let key = scenario.sensor_key(corrector.sensor);
            add(
                key,
                "supply the reference of its vector at each exposure, in inertial axes, from an ephemeris",
            );
        }
        if !scenario.target.is_empty() || scenario.mode.iter().any(|mode| mode.target.is_some()) {
            add(
                "target".to_owned(),
                "supply the target attitude, and angle, rate and acceleration of a slew's reference",
            );
        }
        if scenario.manoeuvre.is_some() {
            add("manoeuvre".to_owned(), "supply the reference motion and the waveform of the manoeuvre");
        }
        parts
    }
}
