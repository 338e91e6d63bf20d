//! Unloading of wheels: above a momentum limit, jets or magnetorquers exert a torque that the wheels counteract, which
//! reduces their momentum.
//!
//! With the momentum h of the wheels and the field B the moment of magnetorquers is k h x B/B²: its torque is -k times
//! the part of h perpendicular to B (\[Wertz78\]). The part along the field remains until the field rotates along the
//! orbit: over an orbit h decreases at the mean rate k (1 - <b b'>), with b the field's direction.

use flexsc_flight::momentum_unloading::MomentumUnloading;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::flight_types::{from_vector3, to_vector3};
use flexsc_numerics::quantity::{NonNegative, Positive, Time};
use flexsc_numerics::time::{Instant, Span};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    Actuator, ActuatorEvent, ActuatorKind, Demand, Jets, Magnetorquers, PulsedActuator, UnloadingCycle,
};

/// How an actuator of a list unloads the wheels of the list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Unloads")]
pub struct UnloadingTask {
    /// Total momentum of the wheels above which unloading begins (N m s).
    pub above: Positive,
    /// Total momentum below which unloading ends (N m s).
    pub below: NonNegative,
    /// For jets: the largest mean torque about each axis over a cycle (N m), which the wheels counteract.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque: Option<Positive>,
    /// For magnetorquers: the fraction of the momentum perpendicular to the field that they remove per second (1/s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gain: Option<Positive>,
    /// For magnetorquers: the period of their commands (s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<Span>,
    /// For magnetorquers: time of their first command (s); default: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub phase: Option<Time>,
}

/// Unloading of the wheels by jets or by magnetorquers, within the wheels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Unloading")]
pub struct WheelUnloading {
    /// Total momentum of the wheels above which unloading begins (N m s).
    pub above: Positive,
    /// Total momentum below which unloading ends (N m s).
    pub below: NonNegative,
    /// Largest mean torque of the jets about each axis over a cycle (N m), which the wheels counteract.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque: Option<Positive>,
    /// Jets for unloading, with their own period and without a delay.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub jets: Option<Jets>,
    /// Magnetorquers for unloading.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub magnetorquers: Option<Magnetorquers>,
    /// For magnetorquers: the fraction of the momentum perpendicular to the field that they remove per second (1/s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gain: Option<Positive>,
    /// For magnetorquers: the period of their commands (s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<Span>,
}

impl WheelUnloading {
    /// Returns the settings of the unloading.
    pub(super) fn method(&self) -> UnloadingTask {
        let Self { above, below, torque, gain, period, .. } = *self;
        UnloadingTask { above, below, torque, gain, period, phase: None }
    }

    /// Returns the actuator that unloads the wheels.
    pub(super) fn device(&self) -> ActuatorKind {
        let jets = self.jets.clone().map(ActuatorKind::Jets);
        jets.or_else(|| self.magnetorquers.clone().map(ActuatorKind::Magnetorquers)).unwrap_or_default()
    }

    /// Checks the choice of the unloading actuator; returns a key within the unloading and the reason.
    pub fn validate(&self) -> Option<ConfigError> {
        let error_at = |key: &str, why: &str| Some(ConfigError::new(key, why));
        match (&self.jets, &self.magnetorquers) {
            (None, None) => error_at("jets", "must be given, or `magnetorquers`"),
            (Some(_), Some(_)) => error_at(
                "magnetorquers",
                "must be left out with `jets`: only one of the two can unload the wheels",
            ),
            _ => None,
        }
    }
}

impl UnloadingTask {
    /// Returns the period (s) and the phase of the cycles of the actuator.
    pub fn cycle(&self, kind: &ActuatorKind) -> (Option<Span>, Option<Time>) {
        match kind {
            ActuatorKind::Jets(jets) => (jets.period, jets.phase),
            _ => (self.period, self.phase),
        }
    }

    /// Returns the law of the actuator, as flight code has it.
    pub fn flight_law(&self, kind: &ActuatorKind) -> MomentumUnloading {
        MomentumUnloading {
            above: self.above.get(),
            below: self.below.get(),
            is_magnetic: self.gain.is_some(),
            gain: self.gain.map_or(0.0, Positive::get),
            period: self.cycle(kind).0.unwrap_or(Span::TICK).seconds(),
            most: self.torque.map_or(f64::INFINITY, Positive::get),
            is_active: false,
        }
    }

    /// Checks the settings against the actuator; returns a key and the reason, and true if the key is within the
    /// actuator.
    pub fn fault(&self, kind: &ActuatorKind) -> Option<(ConfigError, bool)> {
        let (above, below) = (self.above.get(), self.below.get());
        let error_at = |key: &str, why: String| Some((ConfigError::new(key, why), false));
        if below >= above {
            return error_at("below", format!("must be less than `above`, {above} N m s, got {below}"));
        }
        let torquer_keys = [
            ("gain", self.gain.is_some(), true),
            ("period", self.period.is_some(), true),
            ("phase", self.phase.is_some(), false),
        ];
        match kind {
            ActuatorKind::Jets(jets) => {
                if let Some((key, ..)) = torquer_keys.into_iter().find(|(_, is_given, _)| *is_given) {
                    return error_at(key, "applies only to `magnetorquers`: leave it out".to_owned());
                }
                if self.torque.is_none() {
                    return error_at("torque", "must be given with `jets`".to_owned());
                }
                validate_jets(jets).map(|fault| (fault, true))
            }
            ActuatorKind::Magnetorquers(_) => {
                if self.torque.is_some() {
                    return error_at("torque", "applies only to `jets`: leave it out".to_owned());
                }
                let (key, ..) = torquer_keys.into_iter().find(|(_, is_given, must)| *must && !is_given)?;
                error_at(key, "must be given with `magnetorquers`".to_owned())
            }
            other => {
                let why =
                    "is for `jets` or `magnetorquers`, which can unload `wheels` or `control_moment_gyros`";
                Some((ConfigError::new("", format!("{why}, got `{}`", other.kind())), false))
            }
        }
    }
}

/// Checks jets that unload wheels; returns a key of the jets and the reason.
fn validate_jets(jets: &Jets) -> Option<ConfigError> {
    let error_at = |key: &str, why: String| Some(ConfigError::new(key, why));
    let Some(period) = jets.period.map(Span::seconds) else {
        return error_at("period", "must be given: the law's cycles are those of the wheels".to_owned());
    };
    if jets.delay > 0 {
        return error_at("delay", format!("must be 0 for jets that unload wheels, got {}", jets.delay));
    }
    for (key, value) in [("minimum_on", jets.minimum_on.get()), ("quantum", jets.quantum.get())] {
        if value > period {
            return error_at(key, format!("must be at most the period of {period} s, got {value}"));
        }
    }
    None
}

/// Run-time state of an actuator that unloads wheels.
#[derive(Clone, Debug)]
pub(super) struct UnloaderState {
    pub actuator: Box<dyn Actuator>,
    law: MomentumUnloading,
    period: Span,
    /// Start of the next cycle.
    next: Instant,
    /// Last cycle.
    pub cycle: UnloadingCycle,
}

impl UnloaderState {
    /// Creates the unloader before its first cycle.
    pub fn new(unloads: &UnloadingTask, kind: &ActuatorKind, actuator: Box<dyn Actuator>) -> Self {
        let (period, phase) = unloads.cycle(kind);
        Self {
            actuator,
            law: unloads.flight_law(kind),
            period: period.unwrap_or(Span::TICK),
            next: super::first(phase),
            cycle: UnloadingCycle::default(),
        }
    }

    /// Returns the next time at which the actuator's output changes.
    pub fn due(&self) -> Option<Instant> {
        self.actuator.due().into_iter().chain([self.next]).min()
    }

    /// Returns true if laws command magnetic moments, so that the magnetorquers do not unload.
    pub fn is_commanded(&self, demands: &[Demand]) -> bool {
        self.law.is_magnetic && demands.iter().any(|demand| matches!(demand, Demand::Moment(_)))
    }

    /// Executes the demands of laws that command the magnetorquers.
    pub fn execute(&mut self, now: Instant, demands: &[Demand], rigid: [f64; 3]) {
        self.actuator.command(now, demands, rigid);
        (self.law.is_active, self.cycle.counter) = (false, Vector::zeros());
    }

    /// Begins a cycle if one is due: if the wheels' momentum `stored` (N m s) is too large, commands a torque that
    /// reduces it. Returns the torque that the wheels must counteract from now on (N m), if it changes.
    pub fn serve(
        &mut self,
        now: Instant,
        rigid: [f64; 3],
        stored: Vector,
        demands: &[Demand],
    ) -> Option<Vector> {
        let begins = self.next == now;
        let is_commanded = self.is_commanded(demands);
        if begins {
            self.next = now + self.period;
            if !is_commanded {
                let demanded = from_vector3(&self.law.torque(&to_vector3(&stored)));
                self.actuator.command(now, &demanded.data.0[0].map(Demand::Torque), [0.0; 3]);
            }
        }
        self.actuator.update(now, ActuatorEvent::Due(rigid));
        if !begins || is_commanded {
            return None;
        }
        let counter = if self.law.is_magnetic {
            Vector::from_fn(|axis, _| self.actuator.effort(axis).held)
        } else {
            let jets = self.actuator.capabilities().pulses;
            jets.map_or_else(Vector::zeros, PulsedActuator::cycle_impulse) / self.period.seconds()
        };
        let before = std::mem::replace(&mut self.cycle, UnloadingCycle { at: Some(now), counter });
        // The mean torque of jets is 0 most of the time; that of magnetorquers changes with the field each time.
        (before.counter != counter || self.law.is_magnetic).then_some(counter)
    }
}
