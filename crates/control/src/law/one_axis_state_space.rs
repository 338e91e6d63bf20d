//! Run-time state of a compensator about one axis.

use flexsc_numerics::time::{Instant, Span};
use nalgebra::DMatrix;

use super::discrete_matrices::DiscreteMatrices;
use super::output_quantity::OutputQuantity;
use super::{Command, ControlOutput, DecisionCause, Guards, Law, LawState, Phase, ReferenceNeeds, Setpoint};
use crate::part::Part;
use crate::state_estimate::StateEstimate;

/// Run-time state of the compensator about an axis.
#[derive(Clone, Debug)]
pub struct OneAxisStateSpace {
    /// Matrices of the compensator at the period.
    pub matrices: DiscreteMatrices,
    /// State x, a column.
    pub state: DMatrix<f64>,
    /// Period of the samples.
    pub period: Span,
    /// Quantity of the output.
    pub command: OutputQuantity,
    /// Factor on the output.
    pub gain: f64,
    /// Last tuned value of the factor; NaN before.
    pub tuned: f64,
    /// Largest command.
    pub limit: f64,
    /// True if the law follows a manoeuvre.
    pub track: bool,
    /// True once the law acts.
    pub active: bool,
}

impl Part for OneAxisStateSpace {}

impl Law for OneAxisStateSpace {
    fn decide(
        &mut self,
        now: Instant,
        _: DecisionCause,
        goal: &Setpoint,
        state_estimate: &StateEstimate,
    ) -> ControlOutput {
        self.active = now >= goal.from;
        if !self.active {
            return ControlOutput { until: Some(goal.from), ..ControlOutput::NONE };
        }
        let (angle, rate) = goal.at(now);
        let DiscreteMatrices { a, b, c, d } = &self.matrices;
        let errors = [angle - state_estimate.angle, rate - state_estimate.rate];
        let error = DMatrix::from_column_slice(b.ncols(), 1, &errors[..b.ncols()]);
        let mut output = (d * &error)[(0, 0)];
        if !self.state.is_empty() {
            output += (c * &self.state)[(0, 0)];
            self.state = a * &self.state + b * &error;
        }
        output *= self.gain;
        let command = match self.command {
            OutputQuantity::Torque => Command::Torque(output.clamp(-self.limit, self.limit)),
            OutputQuantity::Acceleration => {
                Command::Acceleration(output.clamp(-self.limit, self.limit) + goal.acceleration)
            }
        };
        ControlOutput { command, until: Some(now + self.period), guards: Guards::NONE }
    }

    fn state(&self) -> LawState<'_> {
        LawState::with_tuned(if self.active { Phase::Feedback } else { Phase::Open }, self.tuned)
    }

    fn reference_needs(&self) -> ReferenceNeeds {
        // Accelerations have a reference to follow.
        let tracks_manoeuvre = self.track || self.command == OutputQuantity::Acceleration;
        ReferenceNeeds { tracks_manoeuvre, ..ReferenceNeeds::default() }
    }

    fn copy(&self) -> Box<dyn Law> {
        Box::new(self.clone())
    }

    fn tune(&mut self, key: &str, value: f64) {
        if key == "gain" {
            (self.gain, self.tuned) = (value, value);
        }
    }
}
