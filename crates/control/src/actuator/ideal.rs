//! The ideal actuator: the command at every instant, and the exact waveform of a manoeuvre.

use std::sync::Arc;

use flexsc_dynamics::waveform::Waveform;
use flexsc_numerics::time::Instant;
use flexsc_spacecraft::flow::ActiveWaveform;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{AxisActuator, AxisActuatorContext, Failure};

/// The ideal actuator.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ideal {
    /// Intervals in which it fails.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<Failure>,
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

impl AxisActuator for IdealState {
    fn command(&mut self, _: Instant, command: f64, _: f64) {
        self.torque = command;
    }

    fn torque(&self) -> f64 {
        self.torque
    }

    fn demanded_torque(&self) -> f64 {
        self.torque
    }

    fn executes_waveform(&self) -> bool {
        self.waveform.is_some()
    }

    fn waveform(&self, now: Instant) -> Option<ActiveWaveform> {
        let waveform = self.waveform.as_ref().filter(|waveform| now.seconds() < waveform.end())?;
        Some(ActiveWaveform::new(Arc::clone(waveform), now.seconds()))
    }

    fn applied(&self, now: Instant, _: [f64; 2]) -> f64 {
        self.waveform.as_ref().map_or(0.0, |waveform| waveform.at(now.seconds())) + self.torque
    }

    fn copy(&self) -> Box<dyn AxisActuator> {
        Box::new(self.clone())
    }
}
