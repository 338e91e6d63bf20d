//! A compensator with inputs and outputs about three axes together, x' = A x + B e, u = C x + D e, at samples.

use std::sync::Arc;

use flexsc_flight::compensator::{CompensatorQuantity, CompensatorSource};
use flexsc_flight::vector3::Vector3;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{CustomField, CustomTopic, Report};

use super::compensator::Compensator;
use super::{Command, DecisionCause, LawState, Phase, ThreeAxisInput, ThreeAxisLaw, ThreeAxisOutput};
use crate::part::{Occasion, Part, ReportContext};

/// Returns the topic of the states of a compensator about three axes; `None` without states.
pub fn states_topic(order: usize) -> Option<Arc<CustomTopic>> {
    let field = |index: usize| CustomField::new(format!("x{index}"), "", "State of the law.");
    let doc = "States of the law `state_space` about three axes, after its last sample.";
    CustomTopic::new("/law_states", doc, (0..order).map(field).collect()).ok()
}

/// Run-time state of a compensator about three axes.
#[derive(Clone, Debug)]
pub struct ThreeAxisStateSpace {
    /// Compensator with its state.
    pub compensator: Compensator,
    /// Period of the samples.
    pub period: Span,
    /// Last tuned value of the factor on the outputs; NaN before.
    pub tuned: f64,
    /// Topic of the states, if there are any.
    pub topic: Option<Arc<CustomTopic>>,
}

impl Part for ThreeAxisStateSpace {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        let row = self.topic.as_ref().filter(|_| at.occasion == Occasion::Period);
        // The topic may have the states of a larger law of another mode.
        let states = self.compensator.state.iter().copied().chain(std::iter::repeat(f64::NAN));
        let row = row.and_then(|topic| topic.row(states.take(topic.fields().len())).ok());
        if let Some(row) = row {
            report.add(row);
        }
    }
}

impl ThreeAxisLaw for ThreeAxisStateSpace {
    fn decide(&mut self, now: Instant, _: DecisionCause, input: &ThreeAxisInput<'_>) -> ThreeAxisOutput {
        let errors = input.errors(now);
        let [angle, rate] =
            [0, 1].map(|part| Vector3 { x: errors[0][part], y: errors[1][part], z: errors[2][part] });
        let reads_speeds = |source: &CompensatorSource| source.quantity == CompensatorQuantity::WheelSpeed;
        let reads_wheels = self.compensator.sources.iter().any(reads_speeds);
        let speeds = if reads_wheels { (input.wheel_speeds)() } else { Vec::new() };
        self.compensator.read(&angle, &rate, &speeds);
        self.compensator.advance();
        let mut values = [0.0; 3];
        for (output, axis) in self.compensator.outputs.iter().zip(&self.compensator.axes) {
            values[*axis] = *output;
        }
        let commands = [0, 1, 2].map(|axis| {
            if self.compensator.is_acceleration {
                Command::Acceleration(values[axis] + input.setpoints[axis].acceleration)
            } else {
                Command::Torque(values[axis])
            }
        });
        ThreeAxisOutput { commands, until: Some(now + self.period) }
    }

    fn state(&self) -> LawState<'_> {
        LawState::with_tuned(Phase::Feedback, self.tuned)
    }

    fn copy(&self) -> Box<dyn ThreeAxisLaw> {
        Box::new(self.clone())
    }

    fn tune(&mut self, key: &str, value: f64) {
        if key == "gain" {
            (self.compensator.range.gain, self.tuned) = (value, value);
        }
    }
}
