//! The ideal actuator: the command at every instant, and the exact waveform of a manoeuvre.

use std::sync::Arc;

use flexsc_dynamics::flow::ActiveWaveform;
use flexsc_dynamics::waveform::Waveform;
use flexsc_numerics::time::Instant;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    Actuator, ActuatorPlacement, ActuatorSpec, AxisActuator, AxisActuatorContext, AxisActuators,
    AxisProperties, AxisResponse, AxisTorques, AxisWaves, Failure, LinearDrive,
};
use crate::offers::{ActuatorOffers, ActuatorPlace, Offers};
use crate::part::Part;
use crate::requirement::Requirements;

/// The ideal actuator.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ideal {
    /// Intervals in which the actuator fails.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<Failure>,
}

impl ActuatorSpec for Ideal {
    fn start(&self, settings: &[AxisActuatorContext], _: &ActuatorPlacement<'_>) -> Box<dyn Actuator> {
        AxisActuators::start(settings, &self.faults, IdealState::new)
    }

    fn offers(&self) -> ActuatorOffers {
        ActuatorOffers { follows_waveform: true, has_single_precision: true, ..ActuatorOffers::default() }
    }

    fn requires(&self, _: &ActuatorPlace<'_>, offers: &Offers, needs: &mut Requirements) {
        let Some(matrix) = &offers.body.damping_matrix else { return };
        needs.require_elsewhere(
            !offers.body.has_manoeuvre,
            matrix,
            "needs torques that are constant for a while: execute the `[manoeuvre]` by an `[actuator.hold]` or \
             thrusters",
        );
    }

    fn failures(&self) -> &[Failure] {
        &self.faults
    }

    fn linear_drive(&self) -> Option<LinearDrive<'_>> {
        Some(LinearDrive { gain: 1.0, back_emf: 0.0, opposes_body_rate: true, delay: 0.0, wheel: None })
    }
}

/// Run-time state of the ideal actuator.
#[derive(Clone, Debug)]
pub struct IdealState {
    torque: f64,
    waveform: Option<Arc<Waveform>>,
}

impl IdealState {
    /// Creates the actuator before its first command.
    pub fn new(setting: &AxisActuatorContext) -> Self {
        let share = |waveform: &Arc<Waveform>| match setting.share {
            1.0 => Arc::clone(waveform),
            share => Arc::new(waveform.shifted(0.0, share)),
        };
        Self { torque: 0.0, waveform: setting.waveform.as_ref().map(share) }
    }
}

impl Part for IdealState {}

impl AxisActuator for IdealState {
    fn command(&mut self, _: Instant, command: f64, _: f64) {
        self.torque = command;
    }

    fn torques(&self) -> AxisTorques {
        let torque = self.torque;
        AxisTorques { demanded: torque, held: torque, nominal: torque, firing: 0.0 }
    }

    fn response(&self, now: Instant, _: [f64; 2]) -> AxisResponse {
        let planned = self.waveform.as_ref().map_or(0.0, |waveform| waveform.at(now.seconds()));
        AxisResponse { applied: planned + self.torque, rotor: None }
    }

    fn properties(&self) -> AxisProperties {
        AxisProperties { executes_waveform: self.waveform.is_some(), ..AxisProperties::default() }
    }

    fn waves(&self, now: Instant) -> AxisWaves<'_> {
        let waveform = self.waveform.as_ref().filter(|waveform| now.seconds() < waveform.end());
        let active = |waveform| ActiveWaveform::new(Arc::clone(waveform), now.seconds());
        AxisWaves { waveform: waveform.map(active), sines: &[] }
    }

    fn copy(&self) -> Box<dyn AxisActuator> {
        Box::new(self.clone())
    }
}
