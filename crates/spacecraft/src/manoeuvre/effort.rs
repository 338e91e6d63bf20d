//! Effort of a manoeuvre: peak, root mean square, and integral of the square.

use flexsc_dynamics::axis_model::{AxisModel, CommandedQuantity};
use flexsc_numerics::quadrature::integral;

use super::Plan;
use super::modal_response::{ModalResponse, torque};
use super::peak_search::PeakValue;
use super::plan::fastest;

/// Effort of a command or a torque, in its unit.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct PlanEffort {
    /// Largest absolute value, with its time.
    pub peak: PeakValue,
    /// Root mean square over the manoeuvre.
    pub rms: f64,
    /// Integral of the square over the manoeuvre.
    pub square: f64,
    /// Value just after the start.
    pub initial: f64,
}

impl PlanEffort {
    /// Computes the effort of the command.
    pub fn from_command(plan: &Plan) -> Self {
        let command = &plan.waveform;
        let panel = 4.0 / command.fastest().max(1e-9);
        let value = |middle, t| command.value_on_piece(middle, t);
        Self::new(plan, plan.peak(), panel, value)
    }

    /// Computes the effort of the torque on the hub (N m).
    pub fn from_torque(plan: &Plan, body: &AxisModel) -> Self {
        match body.drive {
            CommandedQuantity::Torque => Self::from_command(plan),
            CommandedQuantity::Motion => {
                let history = ModalResponse::new(body, &plan.waveform, 1.0);
                let panel = (4.0 / fastest(body, &plan.waveform)).max(plan.time / 2e3);
                Self::new(plan, plan.peak_torque(body), panel, |middle, t| torque(body, &history, middle, t))
            }
        }
    }

    fn new(plan: &Plan, peak: PeakValue, panel: f64, value: impl Fn(f64, f64) -> f64) -> Self {
        let breaks = plan.waveform.breaks();
        let square = integral(&breaks, panel, |middle, t| value(middle, t) * value(middle, t));
        let initial = breaks.get(1).map_or(0.0, |second| value(0.5 * second, 0.0));
        Self { peak, rms: f64::sqrt(square / plan.time), square, initial }
    }
}
