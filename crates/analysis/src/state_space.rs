//! State-space models with names, as control design programs take them: of a scenario's body, and of its open loop.

use flexsc_formats::document::ConfigError;
use nalgebra::DMatrix;

use super::linear_model::{LinearModel, Signal};
use super::open_loop::actuation::common_delay;
use super::open_loop::sampling::SampledSystem;
use super::open_loop::{LoopBreak, OpenLoop, TransferMatrices};
use flexsc_scenario::Scenario;

/// State-space model with the names and units of its states, inputs and outputs.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpaceModel {
    /// Matrices.
    pub matrices: TransferMatrices,
    /// States.
    pub states: Vec<Signal>,
    /// Inputs.
    pub inputs: Vec<Signal>,
    /// Outputs.
    pub outputs: Vec<Signal>,
    /// Sampling period (s); none in continuous time.
    pub period: Option<f64>,
}

impl From<LinearModel> for StateSpaceModel {
    fn from(model: LinearModel) -> Self {
        let LinearModel { a, b, c, states, inputs, outputs } = model;
        let matrix = |rows: &[Vec<f64>], columns: usize| {
            DMatrix::from_fn(rows.len(), columns, |row, column| rows[row][column])
        };
        let matrices = TransferMatrices {
            a: matrix(&a, states.len()),
            b: matrix(&b, inputs.len()),
            c: matrix(&c, states.len()),
            d: DMatrix::zeros(outputs.len(), inputs.len()),
        };
        Self { matrices, states, inputs, outputs, period: None }
    }
}

impl StateSpaceModel {
    /// Returns the body of a scenario in continuous time, with its natural frequencies at a time (s).
    ///
    /// # Errors
    /// A body that is no linear system: its key, and the reason.
    pub fn from_body(scenario: &Scenario, time: f64) -> Result<Self, ConfigError> {
        Ok(LinearModel::from_scenario(scenario, time)?.into())
    }

    /// Returns the body of a scenario at samples `period` (s) apart, whose inputs are held and act late: by a delay (s), or by
    /// that of the actuators.
    ///
    /// # Errors
    /// A body that is no linear system, or actuators with different delays: the key, and the reason.
    pub fn from_sampled_body(
        scenario: &Scenario,
        time: f64,
        period: f64,
        delay: Option<f64>,
    ) -> Result<Self, ConfigError> {
        let Self { matrices, mut states, inputs, outputs, .. } = Self::from_body(scenario, time)?;
        let delay = delay.map_or_else(|| common_delay(scenario), Ok)?;
        let sampled = SampledSystem::new(&matrices.a, &matrices.b, period, delay);
        states.extend(sampled.waiting_inputs(&inputs));
        let c = matrices.c.resize_horizontally(sampled.a.nrows(), 0.0);
        let matrices = TransferMatrices { a: sampled.a, b: sampled.b, c, d: matrices.d };
        Ok(Self { matrices, states, inputs, outputs, period: Some(period) })
    }

    /// Returns the loop of a scenario, cut open, with the delay of its actuators or another (s).
    ///
    /// # Errors
    /// See [`OpenLoop::from_scenario`].
    pub fn from_loop(
        scenario: &Scenario,
        opened: LoopBreak,
        delay: Option<f64>,
    ) -> Result<Self, ConfigError> {
        let cut = match delay {
            None => OpenLoop::from_scenario(scenario, opened)?,
            Some(delay) => OpenLoop::with_delay(scenario, opened, delay)?,
        };
        let channels = cut.channels();
        Ok(Self {
            matrices: cut.transfer,
            states: cut.states,
            inputs: channels.clone(),
            outputs: channels,
            period: Some(cut.period),
        })
    }
}
