//! Open loop whose sensor, estimators and laws have one period.

use flexsc_control::linear_block::LinearBlock;
use flexsc_formats::document::ConfigError;
use nalgebra::DMatrix;

use super::block_matrices::{blocks, stacked};
use super::measurement::{EstimatorBlock, sensor_block};
use super::sampling::{Lateness, SampledSystem};
use super::{LoopBreak, LoopParts, OpenLoop, TransferMatrices, axis_prefix, block_states};

/// Mean of each torque over the coming period, by the states of the sampled body and by its inputs.
struct ActingTorque {
    by_state: DMatrix<f64>,
    by_input: DMatrix<f64>,
}

impl ActingTorque {
    /// Returns the mean torques of a body of this order, whose states of earlier inputs follow.
    fn new(plant: &SampledSystem, order: usize, period: f64, delay: f64) -> Self {
        let count = plant.b.ncols();
        let mut by_state = DMatrix::zeros(count, plant.a.nrows());
        let mut by_input = DMatrix::zeros(count, count);
        for (age, share) in Lateness::new(period, delay).shares(period) {
            for axis in 0..count {
                if age == 0 {
                    by_input[(axis, axis)] += share;
                } else if share > 0.0 {
                    by_state[(axis, order + count * (age - 1) + axis)] += share;
                }
            }
        }
        Self { by_state, by_input }
    }
}

/// Part of the loop from the measured angles and rates to the commands.
pub struct Controller {
    /// Block from the measured angles and rates to the commands.
    pub block: LinearBlock,
    /// Response of its states to the mean torque about each axis over a period.
    pub torque: DMatrix<f64>,
}

impl Controller {
    /// Returns the controller of a loop.
    ///
    /// # Errors
    /// Sensors that a linear loop does not have: the key, and the reason.
    pub fn new(parts: &LoopParts<'_>) -> Result<Self, ConfigError> {
        let axes = parts.body.inputs.len();
        let prefixes: Vec<String> = (0..axes).map(|axis| axis_prefix(axes, axis)).collect();
        let prefixes: Vec<&str> = prefixes.iter().map(String::as_str).collect();
        let mut block = sensor_block(parts.scenario, parts.law.period, &prefixes)?;
        let mut torque = DMatrix::zeros(block.a.nrows(), axes);
        if let Some(estimators) = &parts.parts.estimators {
            let estimators = EstimatorBlock::new(estimators, &prefixes);
            block = block.then(estimators.block);
            torque = stacked(&[&torque, &estimators.torque]);
        }
        block = block.then(parts.law.block.clone());
        let torque = torque.resize_vertically(block.a.nrows(), 0.0);
        Ok(Self { block, torque })
    }
}

/// Returns the loop, cut open.
pub fn sampled_loop(parts: &LoopParts<'_>) -> Result<OpenLoop, ConfigError> {
    let Controller { block, torque } = Controller::new(parts)?;
    let (period, delay) = (parts.law.period.seconds(), parts.actuators.delay);
    let body = &parts.body;
    let plant = SampledSystem::new(&body.a, &body.b, period, delay);
    let order = body.a.nrows();
    let seen = body.c.clone().resize_horizontally(plant.a.nrows(), 0.0);
    let ActingTorque { by_state, by_input } = ActingTorque::new(&plant, order, period, delay);
    let scale = if parts.opened == LoopBreak::Torque { 1.0 } else { parts.actuators.gain };
    let (forced, by_input) = (&plant.b * scale, by_input * scale);
    let known = &torque * by_state;
    let direct = &torque * by_input;
    let (inside, outside) = (plant.a.nrows(), block.a.nrows());
    let (a, b, c) = if parts.opened == LoopBreak::Measurement {
        (
            blocks([[&plant.a, &(&forced * &block.c)], [&known, &(&block.a + &direct * &block.c)]]),
            stacked(&[&(&forced * &block.d), &(&block.b + &direct * &block.d)]),
            seen.resize_horizontally(inside + outside, 0.0),
        )
    } else {
        let out = if parts.opened == LoopBreak::Torque { parts.actuators.gain } else { 1.0 };
        (
            blocks([[&plant.a, &DMatrix::zeros(inside, outside)], [&(&block.b * &seen + known), &block.a]]),
            stacked(&[&forced, &direct]),
            blocks([[&(&block.d * &seen), &block.c]]) * out,
        )
    };
    let waiting = plant.waiting_inputs(&body.inputs);
    let states = body.states.iter().cloned().chain(waiting).chain(block_states(&block)).collect();
    let signals = parts.signals();
    let d = DMatrix::zeros(c.nrows(), b.ncols());
    Ok(OpenLoop {
        transfer: TransferMatrices { a, b, c: -c, d },
        states,
        signals,
        opened: parts.opened,
        period,
        samples: 1,
    })
}
