//! Run-time state of a compensator about one axis.

use flexsc_numerics::time::{Instant, Span};

use super::compensator::Compensator;
use super::{Command, ControlOutput, DecisionCause, Guards, Law, LawState, Phase, ReferenceNeeds, Setpoint};
use crate::part::Part;
use crate::state_estimate::StateEstimate;

/// Run-time state of the compensator about an axis.
#[derive(Clone, Debug)]
pub struct OneAxisStateSpace {
    /// Compensator with its state.
    pub compensator: Compensator,
    /// Period of the samples.
    pub period: Span,
    /// Last tuned value of the factor on the output; NaN before.
    pub tuned: f64,
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
        self.compensator.set_errors([angle - state_estimate.angle, rate - state_estimate.rate]);
        self.compensator.advance();
        let output = self.compensator.outputs[0];
        let command = if self.compensator.is_acceleration {
            Command::Acceleration(output + goal.acceleration)
        } else {
            Command::Torque(output)
        };
        ControlOutput { command, until: Some(now + self.period), guards: Guards::NONE }
    }

    fn state(&self) -> LawState<'_> {
        LawState::with_tuned(if self.active { Phase::Feedback } else { Phase::Open }, self.tuned)
    }

    fn reference_needs(&self) -> ReferenceNeeds {
        // Accelerations have a reference to follow.
        let tracks_manoeuvre = self.track || self.compensator.is_acceleration;
        ReferenceNeeds { tracks_manoeuvre, ..ReferenceNeeds::default() }
    }

    fn copy(&self) -> Box<dyn Law> {
        Box::new(self.clone())
    }

    fn tune(&mut self, key: &str, value: f64) {
        if key == "gain" {
            (self.compensator.range.gain, self.tuned) = (value, value);
        }
    }
}
