//! The zero-order hold: in each period, the mean of the waveform and the feedback at the start.

use flexsc_numerics::quantity::Time;
use flexsc_numerics::time::{Instant, Span};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    Actuator, ActuatorPlacement, ActuatorSpec, AxisActuator, AxisActuatorContext, AxisActuators, AxisTorques,
    Failure,
};
use crate::part::Part;

/// A zero-order hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ZeroOrderHold {
    /// Period of the hold (s): it gives the mean of the planned torque over the period plus the law's torque at its
    /// start.
    pub period: Span,
    /// Time of the first period (s), before which it gives nothing; default: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub phase: Option<Time>,
    /// Intervals in which the actuator fails.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<Failure>,
}

/// Run-time state of the zero-order hold.
#[derive(Clone, Debug)]
pub struct ZeroOrderHoldState {
    period: Span,
    setting: AxisActuatorContext,
    next: Instant,
    feedback: f64,
    held: f64,
}

impl ActuatorSpec for ZeroOrderHold {
    fn start(&self, settings: &[AxisActuatorContext], _: &ActuatorPlacement<'_>) -> Box<dyn Actuator> {
        AxisActuators::start(settings, &self.faults, |setting| ZeroOrderHoldState {
            period: self.period,
            setting: setting.clone(),
            next: super::first(self.phase),
            feedback: 0.0,
            held: 0.0,
        })
    }

    fn period(&self) -> Option<Span> {
        Some(self.period)
    }

    fn phase(&self) -> Option<Time> {
        self.phase
    }

    fn failures(&self) -> &[Failure] {
        &self.faults
    }
}

impl Part for ZeroOrderHoldState {
    fn due(&self) -> Option<Instant> {
        Some(self.next)
    }
}

impl AxisActuator for ZeroOrderHoldState {
    fn command(&mut self, _: Instant, command: f64, _: f64) {
        self.feedback = command;
    }

    fn serve(&mut self, now: Instant, _: f64) {
        if self.next == now {
            self.next = now + self.period;
            let h = self.period.seconds();
            self.held = self.feedback + self.setting.planned_impulse(now, h) / h;
        }
    }

    fn torques(&self) -> AxisTorques {
        AxisTorques { demanded: self.feedback, held: self.held, nominal: self.held, firing: 0.0 }
    }

    fn copy(&self) -> Box<dyn AxisActuator> {
        Box::new(self.clone())
    }
}
