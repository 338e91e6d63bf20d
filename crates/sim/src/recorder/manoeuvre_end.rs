//! State at the end of the manoeuvre: distance from the goal and residual vibration.

use flexsc_control::law::Setpoint;
use flexsc_control::sensor::Truth;
use flexsc_dynamics::AxisState;
use flexsc_dynamics::axis_model::{AxisModel, CommandedQuantity};
use flexsc_numerics::time::Instant;
use flexsc_record::{self, Residual};

use flexsc_scenario::Scenario;

/// Pending end of a manoeuvre.
#[derive(Clone, Debug)]
pub struct ManoeuvreEnd {
    /// Instant of the end.
    pub at: Instant,
    goal: Setpoint,
    body: AxisModel,
}

impl ManoeuvreEnd {
    /// Creates the end of a scenario's manoeuvre; `None` without one.
    pub fn new(scenario: &Scenario, goal: &Setpoint) -> Option<Self> {
        let body = scenario.model.one_axis().filter(|_| scenario.plan.is_some())?.clone();
        Some(Self { at: goal.from, goal: *goal, body })
    }

    /// Returns the row of the record for a body in this state.
    pub fn row(&self, truth: &Truth, state: &AxisState) -> flexsc_record::Arrival {
        let modes = || self.body.modes.iter().zip(&state.modes);
        let amplitudes: Vec<f64> = modes().map(|(mode, phase)| mode.amplitude(*phase)).collect();
        let visible = if self.body.drive == CommandedQuantity::Torque { 1.0 } else { 0.0 };
        let outputs = self.body.outputs.iter().map(|output| {
            let parts = output.modes.iter().zip(&amplitudes);
            Residual {
                amplitude: parts.map(|(weight, amplitude)| weight.get().abs() * amplitude).sum(),
                unit: output.unit.clone(),
            }
        });
        flexsc_record::Arrival {
            angle_error_rad: truth.sensor_angles()[0] - self.goal.angle,
            rate_error_rad_s: truth.rate[0] - self.goal.rate,
            angle_residual_rad: visible * amplitudes.iter().sum::<f64>(),
            elastic_energy_j: modes().map(|(mode, phase)| mode.energy(*phase, self.body.inertia.get())).sum(),
            outputs: outputs.collect(),
        }
    }
}
