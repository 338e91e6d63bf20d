//! A compensator with inputs and outputs about three axes together, x' = A x + B e, u = C x + D e, at samples.

use std::fmt;
use std::sync::Arc;

use flexsc_numerics::attitude::{AXES, Vector, rotation};
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{CustomField, CustomTopic, Report};
use nalgebra::DMatrix;

use super::discrete_matrices::DiscreteMatrices;
use super::{
    Command, DecisionCause, LawState, OutputQuantity, Phase, ThreeAxisInput, ThreeAxisLaw, ThreeAxisOutput,
};
use crate::part::{Occasion, Part, ReportContext};

/// Input of a compensator about three axes.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum CompensatorInput {
    /// Component of the rotation vector from the estimated attitude to the target (rad): `roll`.
    Angle(usize),
    /// Component of the vector part of the quaternion of that rotation: `quaternion_x`.
    VectorPart(usize),
    /// Error of the rate about an axis (rad/s): `roll_rate`.
    Rate(usize),
    /// Speed of a reaction wheel (rad/s): `wheel0_speed`.
    WheelSpeed(usize),
}

impl CompensatorInput {
    /// Names that an input may have, for errors.
    pub const ACCEPTED: &str = "`roll`, `pitch`, `yaw`, `quaternion_x`, `quaternion_y`, `quaternion_z`, `roll_rate`, \
                                `pitch_rate`, `yaw_rate`, or `wheel0_speed` and so on";

    /// Returns the input of this name, if there is one.
    pub fn from_name(name: &str) -> Option<Self> {
        let axis = |name: &str| AXES.iter().position(|axis| *axis == name);
        if let Some(axis) = axis(name) {
            return Some(Self::Angle(axis));
        }
        if let Some(component) = name.strip_prefix("quaternion_") {
            return ["x", "y", "z"].iter().position(|own| *own == component).map(Self::VectorPart);
        }
        if let Some(axis) = name.strip_suffix("_rate").and_then(axis) {
            return Some(Self::Rate(axis));
        }
        let wheel = name.strip_prefix("wheel")?.strip_suffix("_speed")?.parse().ok()?;
        // One name for one wheel: no `wheel01_speed`.
        Some(Self::WheelSpeed(wheel)).filter(|input| input.to_string() == name)
    }

    /// Returns true for a component of the attitude error.
    pub fn is_attitude(self) -> bool {
        matches!(self, Self::Angle(_) | Self::VectorPart(_))
    }
}

impl fmt::Display for CompensatorInput {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Angle(axis) => out.write_str(AXES[*axis]),
            Self::VectorPart(component) => write!(out, "quaternion_{}", ["x", "y", "z"][*component]),
            Self::Rate(axis) => write!(out, "{}_rate", AXES[*axis]),
            Self::WheelSpeed(wheel) => write!(out, "wheel{wheel}_speed"),
        }
    }
}

/// Returns the topic of the states of a compensator about three axes; `None` without states.
pub fn states_topic(order: usize) -> Option<Arc<CustomTopic>> {
    let field = |index: usize| CustomField::new(format!("x{index}"), "", "State of the law.");
    let doc = "States of the law `state_space` about three axes, after its last sample.";
    CustomTopic::new("/law_states", doc, (0..order).map(field).collect()).ok()
}

/// Run-time state of a compensator about three axes.
#[derive(Clone, Debug)]
pub struct ThreeAxisStateSpace {
    /// Matrices, of which the columns of B and D belong to `inputs`.
    pub matrices: DiscreteMatrices,
    /// State x, a column.
    pub state: DMatrix<f64>,
    /// Inputs, in the order of the columns of B and D.
    pub inputs: Vec<CompensatorInput>,
    /// Axis of each row of C and D.
    pub outputs: Vec<usize>,
    /// Period of the samples.
    pub period: Span,
    /// Quantity that the outputs command.
    pub command: OutputQuantity,
    /// Factor on the outputs.
    pub gain: f64,
    /// Last tuned value of the factor; NaN before.
    pub tuned: f64,
    /// Largest command.
    pub limit: f64,
    /// Topic of the states, if there are any.
    pub topic: Option<Arc<CustomTopic>>,
}

impl ThreeAxisStateSpace {
    /// Returns the inputs as a column.
    fn column(&self, now: Instant, input: &ThreeAxisInput<'_>) -> DMatrix<f64> {
        let errors = input.errors(now);
        let turn = rotation(&Vector::from(errors.map(|[angle, _]| angle))).vector().into_owned();
        let reads_wheels = self.inputs.iter().any(|input| matches!(input, CompensatorInput::WheelSpeed(_)));
        let speeds = if reads_wheels { (input.wheel_speeds)() } else { Vec::new() };
        DMatrix::from_fn(self.inputs.len(), 1, |row, _| match self.inputs[row] {
            CompensatorInput::Angle(axis) => errors[axis][0],
            CompensatorInput::VectorPart(axis) => turn[axis],
            CompensatorInput::Rate(axis) => errors[axis][1],
            CompensatorInput::WheelSpeed(wheel) => speeds.get(wheel).copied().unwrap_or(0.0),
        })
    }
}

impl Part for ThreeAxisStateSpace {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        let row = self.topic.as_ref().filter(|_| at.occasion == Occasion::Period);
        // The topic may have the states of a larger law of another mode.
        let states = self.state.iter().copied().chain(std::iter::repeat(f64::NAN));
        let row = row.and_then(|topic| topic.row(states.take(topic.fields().len())).ok());
        if let Some(row) = row {
            report.add(row);
        }
    }
}

impl ThreeAxisLaw for ThreeAxisStateSpace {
    fn decide(&mut self, now: Instant, _: DecisionCause, input: &ThreeAxisInput<'_>) -> ThreeAxisOutput {
        let error = self.column(now, input);
        let DiscreteMatrices { a, b, c, d } = &self.matrices;
        let output = c * &self.state + d * &error;
        self.state = a * &self.state + b * &error;
        let mut values = [0.0; 3];
        for (row, axis) in self.outputs.iter().enumerate() {
            values[*axis] = (self.gain * output[(row, 0)]).clamp(-self.limit, self.limit);
        }
        let commands = [0, 1, 2].map(|axis| match self.command {
            OutputQuantity::Torque => Command::Torque(values[axis]),
            OutputQuantity::Acceleration => {
                Command::Acceleration(values[axis] + input.setpoints[axis].acceleration)
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
            (self.gain, self.tuned) = (value, value);
        }
    }
}
