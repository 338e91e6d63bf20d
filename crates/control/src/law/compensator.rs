//! A compensator in discrete time as flight code has it, with its state.

use flexsc_flight::compensator::{
    CompensatorQuantity, CompensatorRange, CompensatorSource, advance, read_sources,
};
use flexsc_flight::vector3::Vector3;
use flexsc_numerics::quantity::Positive;
use nalgebra::DMatrix;

use super::compensator_input::CompensatorInput;
use super::discrete_matrices::DiscreteMatrices;
use super::{OutputQuantity, StateSpace};

/// Compensator with its state.
#[derive(Clone, Debug, PartialEq)]
pub struct Compensator {
    /// Rows of the matrices [A B], then of [C D], one after the other.
    pub matrices: Vec<f64>,
    /// Sources of the inputs about three axes; empty for a compensator about one axis.
    pub sources: Vec<CompensatorSource>,
    /// Axis of each output.
    pub axes: Vec<usize>,
    /// Range of the commands.
    pub range: CompensatorRange,
    /// True if it commands accelerations, false if it commands torques.
    pub is_acceleration: bool,
    /// State.
    pub state: Vec<f64>,
    /// Inputs of the last sample.
    pub inputs: Vec<f64>,
    /// Commands of the last sample.
    pub outputs: Vec<f64>,
    /// Buffer for the next state.
    next: Vec<f64>,
}

impl Compensator {
    /// Creates a compensator at rest.
    fn new(
        law: &StateSpace,
        matrices: &DiscreteMatrices,
        sources: Vec<CompensatorSource>,
        axes: Vec<usize>,
    ) -> Self {
        let DiscreteMatrices { a, b, c, d } = matrices;
        let (order, inputs) = (a.nrows(), b.ncols());
        let row = |left: &DMatrix<f64>, right: &DMatrix<f64>, row: usize| -> Vec<f64> {
            left.row(row).iter().chain(right.row(row).iter()).copied().collect()
        };
        let upper = (0..order).map(|state| row(a, b, state));
        let rows: Vec<Vec<f64>> = upper.chain((0..axes.len()).map(|output| row(c, d, output))).collect();
        Self {
            matrices: rows.concat(),
            sources,
            range: CompensatorRange {
                gain: law.gain.get(),
                limit: law.limit.map_or(f64::INFINITY, Positive::get),
            },
            is_acceleration: law.command == OutputQuantity::Acceleration,
            state: vec![0.0; order],
            inputs: vec![0.0; inputs],
            outputs: vec![0.0; axes.len()],
            next: vec![0.0; order],
            axes,
        }
    }

    /// Sets the inputs about one axis: the errors of angle (rad) and rate (rad/s), setpoint minus estimate.
    pub fn set_errors(&mut self, errors: [f64; 2]) {
        self.inputs.iter_mut().zip(errors).for_each(|(input, error)| *input = error);
    }

    /// Reads the inputs about three axes, for errors of angle (rad) and rate (rad/s) and the speeds of wheels (rad/s).
    pub fn read(&mut self, angle: &Vector3, rate: &Vector3, speeds: &[f64]) {
        read_sources(&self.sources, angle, rate, speeds, &mut self.inputs);
    }

    /// Computes the commands for the inputs, and advances the state.
    pub fn advance(&mut self) {
        let Self { matrices, inputs, state, next, range, outputs, .. } = self;
        advance(matrices, inputs, state, next, range, outputs);
    }
}

impl StateSpace {
    /// Returns the compensator at rest as flight code has it: of a law about one axis, or about three axes together.
    pub fn flight_law(&self) -> Compensator {
        // Invalid matrices and names were rejected before.
        let matrices = self.sampled().unwrap_or_else(|_| DiscreteMatrices::zeros(0, 1, 1));
        if !self.is_three_axis() {
            return Compensator::new(self, &matrices, Vec::new(), vec![0]);
        }
        let sources = self.named_inputs().unwrap_or_default().into_iter().map(CompensatorInput::source);
        let axes = self.named_outputs().unwrap_or_default();
        Compensator::new(self, &matrices, sources.collect(), axes)
    }
}

impl CompensatorInput {
    /// Returns the input as flight code has it.
    fn source(self) -> CompensatorSource {
        let (quantity, index) = match self {
            Self::Angle(axis) => (CompensatorQuantity::Angle, axis),
            Self::VectorPart(axis) => (CompensatorQuantity::VectorPart, axis),
            Self::Rate(axis) => (CompensatorQuantity::Rate, axis),
            Self::WheelSpeed(wheel) => (CompensatorQuantity::WheelSpeed, wheel),
        };
        CompensatorSource { quantity, index }
    }
}
