//! Measurement of a loop as linear blocks: sampled sensors, and settled Kalman filters.

use flexsc_control::linear_block::{BlockState, LinearBlock, diagonal};
use flexsc_control::sensor::LinearMeasurement;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::time::Span;
use nalgebra::{DMatrix, DVector};

use crate::linear_loop::LinearAxisEstimator;
use flexsc_scenario::Scenario;

/// Largest latency of a gyro (samples).
const MOST_LATE: f64 = 100.0;

/// Returns the block from the true angle and rate about each axis to the measured ones; the names of its states begin
/// with those of `prefixes`.
///
/// # Errors
/// Sensors that a linear loop does not have: the key, and the reason.
pub fn sensor_block(
    scenario: &Scenario,
    period: Span,
    prefixes: &[&str],
) -> Result<LinearBlock, ConfigError> {
    // Sensors that measure nothing of the motion, such as accelerometers, may follow.
    if scenario.sensor.motion_sensors() > 1 || !scenario.sensor.first().measures_motion() {
        return Err(ConfigError::new("sensor", "is several sensors: a linear loop has one"));
    }
    let wrong = |why: &str| Err(ConfigError::new(scenario.sensor_key(0), why));
    let is_difference = match scenario.sensor.first().linear_measurement() {
        Some(LinearMeasurement::Motion) => false,
        Some(LinearMeasurement::Samples { period: own, is_difference }) if own == period => is_difference,
        Some(LinearMeasurement::Samples { .. }) => {
            return wrong("has another period than the law: a linear loop has one");
        }
        None => {
            return wrong("is not supported in linear loops: use `continuous`, `sampled` or `gyro`");
        }
    };
    let sensor = scenario.sensor.first();
    if sensor.exposure() > Span::ZERO {
        return wrong("has an `exposure`: a linear loop has one with an `[estimator.attitude]`");
    }
    if sensor.rate_latency() > Span::ZERO {
        let late = libm::round(sensor.rate_latency().seconds() / period.seconds());
        if sensor.own_period() != Some(period) || late > MOST_LATE {
            return wrong(
                "has a `latency`, which a linear loop has in periods of the law, at most 100 of them",
            );
        }
        return Ok(late_rates(late as usize, prefixes));
    }
    if !is_difference {
        return Ok(LinearBlock::from_gain(DMatrix::identity(2 * prefixes.len(), 2 * prefixes.len())));
    }
    let back = 1.0 / period.seconds();
    let axis = |prefix: &&str| LinearBlock {
        a: DMatrix::zeros(1, 1),
        b: DMatrix::from_row_slice(1, 2, &[1.0, 0.0]),
        c: DMatrix::from_row_slice(2, 1, &[0.0, -back]),
        d: DMatrix::from_row_slice(2, 2, &[1.0, 0.0, back, 0.0]),
        states: vec![BlockState::new(format!("last_{}", angle_name(prefix)), "rad")],
    };
    Ok(LinearBlock::parallel(prefixes.iter().map(axis).collect()))
}

/// Returns the block of a gyro whose rates come some samples late.
fn late_rates(late: usize, prefixes: &[&str]) -> LinearBlock {
    let axis = |prefix: &&str| {
        let (mut a, mut b) = (DMatrix::zeros(late, late), DMatrix::zeros(late, 2));
        (1..late).for_each(|place| a[(place, place - 1)] = 1.0);
        b[(0, 1)] = 1.0;
        let mut c = DMatrix::zeros(2, late);
        c[(1, late - 1)] = 1.0;
        let state = |age: usize| BlockState::new(format!("{prefix}rate_{}_ago", age + 1), "rad/s");
        let d = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 0.0]);
        LinearBlock { a, b, c, d, states: (0..late).map(state).collect() }
    };
    LinearBlock::parallel(prefixes.iter().map(axis).collect())
}

/// Returns the name of the angle about the axis with this prefix.
pub fn angle_name(prefix: &str) -> &str {
    if prefix.is_empty() { "angle" } else { prefix.trim_end_matches('_') }
}

/// Settled Kalman filters of all axes.
pub struct EstimatorBlock {
    /// Block from measured angles and rates to those that the laws read, whose states are predictions for the sample.
    pub block: LinearBlock,
    /// Response of its states to a torque about each axis, held over a period.
    pub torque: DMatrix<f64>,
}

impl EstimatorBlock {
    /// Creates the block from the filters about each axis.
    pub fn new(filters: &[LinearAxisEstimator], prefixes: &[&str]) -> Self {
        let (mut blocks, mut torques) = (Vec::new(), Vec::new());
        for (filter, prefix) in filters.iter().zip(prefixes) {
            blocks.push(axis_block(filter, prefix));
            let push = DVector::from_column_slice(&filter.steady.push) / filter.inertia;
            torques.push(DMatrix::from_column_slice(push.len(), 1, push.as_slice()));
        }
        let torque = diagonal(&torques.iter().collect::<Vec<_>>());
        Self { block: LinearBlock::parallel(blocks), torque }
    }
}

/// Returns the filter of an axis, from measured angle and rate to those that the law reads.
fn axis_block(filter: &LinearAxisEstimator, prefix: &str) -> LinearBlock {
    let order = filter.steady.push.len();
    let transition = DMatrix::from_fn(order, order, |row, column| filter.steady.transition[row][column]);
    let seen = DMatrix::from_fn(2, order, |row, column| f64::from(u8::from(column % 2 == row)));
    // After a sample, the state is kept x + learnt y.
    let (mut kept, mut learnt) = (DMatrix::identity(order, order), DMatrix::zeros(order, 2));
    for (row, gain) in filter.steady.gains.iter().enumerate() {
        let gain = DVector::from_column_slice(gain);
        learnt -= &gain * (seen.row(row) * &learnt);
        let mut column = learnt.column_mut(row);
        column += &gain;
        kept -= &gain * (seen.row(row) * &kept);
    }
    let read = if filter.rigid { DMatrix::identity(2, order) } else { seen };
    let states = (0..order).map(|place| {
        let (quantity, unit) = if place % 2 == 0 { ("displacement", "rad") } else { ("rate", "rad/s") };
        let name = match place {
            0 => "rigid_angle".to_owned(),
            1 => "rigid_rate".to_owned(),
            place => format!("mode{}_{quantity}", place / 2 - 1),
        };
        BlockState::new(format!("{prefix}expected_{name}"), unit)
    });
    LinearBlock {
        a: &transition * &kept,
        b: &transition * &learnt,
        c: &read * &kept,
        d: &read * &learnt,
        states: states.collect(),
    }
}
