//! Test vectors: the calls of the control system in a run of the engine, with the outputs of the plain laws, compared with the
//! engine's own.

mod b_dot;
mod kalman;
mod mode_calls;
mod rate;
mod samples;
mod unloading;

use std::fmt;

use flexsc_core::control::flight_quantity::FlightQuantity;
use flexsc_core::control::law::{Command, DecisionCause};
use flexsc_core::control::sensor::Orientation;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::{ControlCall, ControlDecision, Scenario, Simulation, SimulationError};
use flexsc_flight::b_dot::limited_moment;
use flexsc_flight::ticks::Ticks;

use crate::control_system::{Channel, ControlSystem, NotExportable};

/// First word of a file of vectors: `flexscV1` as bytes.
pub const MAGIC: u64 = u64::from_le_bytes(*b"flexscV1");

/// Longest piece of a run between two looks at its calls (s).
const PIECE: f64 = 100.0;

/// Call of a function of the control system, with the outputs that it must have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CallVector {
    /// Index of the function.
    pub call: usize,
    /// Time of the call.
    pub now: Ticks,
    /// Words of the inputs.
    pub inputs: Vec<u64>,
    /// Words of the outputs.
    pub outputs: Vec<u64>,
}

/// Reason for which there are no vectors.
#[derive(Debug)]
pub enum VectorError {
    /// The control system has no plain code.
    NotExportable(NotExportable),
    /// The run failed.
    Simulation(SimulationError),
    /// The plain laws did not give the engine's command.
    Different {
        /// Number of the call.
        call: usize,
        /// Quantity.
        quantity: String,
        /// Value of the engine.
        engine: f64,
        /// Value of the plain laws.
        plain: f64,
    },
}

impl fmt::Display for VectorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotExportable(error) => error.fmt(f),
            Self::Simulation(error) => error.fmt(f),
            Self::Different { call, quantity, engine, plain } => {
                write!(
                    f,
                    "call {call}: {quantity} is {engine:e} in the engine and {plain:e} in the exported laws"
                )
            }
        }
    }
}

impl std::error::Error for VectorError {}

impl From<NotExportable> for VectorError {
    fn from(error: NotExportable) -> Self {
        Self::NotExportable(error)
    }
}

impl From<SimulationError> for VectorError {
    fn from(error: SimulationError) -> Self {
        Self::Simulation(error)
    }
}

/// Returns the calls of run number 0 of a scenario, at most `most` of them.
///
/// # Errors
/// A [`VectorError`] if the control system has no plain code, if the run fails, or if the plain laws give another command.
pub fn record(scenario: &Scenario, most: usize) -> Result<Vec<CallVector>, VectorError> {
    let mut system = ControlSystem::new(scenario)?;
    let mut simulation = Simulation::new(scenario, 0);
    simulation.trace_control();
    let mut vectors = Vec::new();
    let mut until = Instant::START;
    let step = Span::from_seconds(scenario.duration.seconds().min(PIECE));
    while vectors.len() < most && !simulation.is_finished() {
        until += step;
        simulation.run_until(until, &mut ())?;
        for call in simulation.take_control_trace() {
            if vectors.len() == most {
                break;
            }
            match call {
                ControlCall::Decision(decision) => replay(&mut system, &decision, &mut vectors)?,
                ControlCall::Mode(trial) => mode_calls::replay_trial(&mut system, &trial, &mut vectors)?,
                ControlCall::Sample(sample) => {
                    samples::replay(&mut system, scenario, &sample, &mut vectors);
                }
                ControlCall::Unloading(cycle) => unloading::replay(&mut system, &cycle, &mut vectors)?,
            }
        }
    }
    Ok(vectors)
}

/// Calls the plain laws with what the engine's laws read in a decision, and adds the calls.
fn replay(
    system: &mut ControlSystem,
    decision: &ControlDecision,
    vectors: &mut Vec<CallVector>,
) -> Result<(), VectorError> {
    let now = decision.now.ticks();
    if let ControlSystem::Modes(_) = system {
        return mode_calls::replay_decision(system, decision, vectors);
    }
    if let ControlSystem::Relays(_) = system {
        for axis in &decision.axes {
            let event = match axis.cause {
                DecisionCause::Start => 0,
                DecisionCause::Guard(0) => 1,
                DecisionCause::Guard(_) => 2,
                DecisionCause::Timeout => 3,
            };
            let inputs = vec![axis.axis as u64, event, axis.estimate.angle.to_bits()];
            let outputs = system.call(0, now, &inputs);
            let Command::Torque(torque) = axis.output.command else { continue };
            compare(vectors.len(), "the torque", torque, f64::from_bits(outputs[0]))?;
            let engine: Vec<u64> = axis.output.guards.iter().map(|guard| guard.level.to_bits()).collect();
            for (guard, level) in engine.iter().enumerate() {
                compare(
                    vectors.len(),
                    "a guard",
                    f64::from_bits(*level),
                    f64::from_bits(outputs[7 + guard]),
                )?;
            }
            vectors.push(CallVector { call: 0, now, inputs, outputs });
        }
        return Ok(());
    }
    if let ControlSystem::BDot(_) = system {
        return b_dot::step(system, decision, vectors);
    }
    // Before its setpoint begins a law about one axis gives nothing.
    let is_together = matches!(&*system, ControlSystem::Sampled(laws) if laws.is_together());
    if !is_together && decision.axes.iter().any(|axis| decision.now < axis.goal.from) {
        return Ok(());
    }
    kalman::shift(system, now, decision.shift, vectors);
    let ControlSystem::Sampled(laws) = &*system else { return Ok(()) };
    let layout = laws.layout();
    let inputs = step_inputs(&layout.inputs, decision);
    let outputs = call(system, "step", now, inputs, vectors);
    let number = vectors.len() - 1;
    compare_commands(number, decision, &outputs, [f64::INFINITY; 3])?;
    compare_actuators(number, decision, |name| {
        let place = layout.outputs.iter().take_while(|channel| channel.name != name);
        outputs.get(place.map(|channel| channel.count).sum::<usize>()..).unwrap_or_default()
    })
}

/// Calls a function, adds the call, and returns the words of its outputs.
fn call(
    system: &mut ControlSystem,
    name: &str,
    now: Ticks,
    inputs: Vec<u64>,
    vectors: &mut Vec<CallVector>,
) -> Vec<u64> {
    let call = system.calls().iter().position(|call| call.name == name).unwrap_or(0);
    let outputs = system.call(call, now, &inputs);
    vectors.push(CallVector { call, now, inputs, outputs: outputs.clone() });
    outputs
}

/// Fails if the torques of wheels or the on-times of jets in a decision, which `output` returns by their names, differ from the
/// engine's.
fn compare_actuators<'a>(
    number: usize,
    decision: &ControlDecision,
    output: impl Fn(&str) -> &'a [u64],
) -> Result<(), VectorError> {
    compare_numbers(number, "the torque of a wheel", &decision.wheel_torques, output("wheel_torque"))?;
    compare_numbers(
        number,
        "the on-time",
        decision.on_times.as_ref().map_or(&[], |own| &own[..]),
        output("on_time"),
    )
}

/// Fails if numbers differ from those of the engine, as far as both have them.
fn compare_numbers(number: usize, quantity: &str, engine: &[f64], plain: &[u64]) -> Result<(), VectorError> {
    for (engine, plain) in engine.iter().zip(plain) {
        // A zero may have another sign: that of a sum or a command of nothing.
        let plain = f64::from_bits(*plain);
        if *engine != 0.0 || plain != 0.0 {
            compare(number, quantity, *engine, plain)?;
        }
    }
    Ok(())
}

/// Fails if the laws' outputs in a decision differ from the engine's commands; moments are limited (A m²).
fn compare_commands(
    number: usize,
    decision: &ControlDecision,
    outputs: &[u64],
    limits: [f64; 3],
) -> Result<(), VectorError> {
    for axis in &decision.axes {
        let found = f64::from_bits(outputs[axis.axis]);
        match axis.output.command {
            Command::Torque(value) => compare(number, "the torque", value, found)?,
            Command::Change(value) => compare(number, "the change of the rate", value, found)?,
            Command::Acceleration(value) => {
                compare(number, "the acceleration", value, found)?;
                let axes = decision.axes.len();
                let torque = f64::from_bits(outputs[axes + axis.axis]);
                compare(number, "the torque", decision.demanded_torque[axis.axis], torque)?;
            }
            Command::Moment(moment) => {
                let limited = limited_moment(moment, limits[axis.axis]);
                compare(number, "the magnetic moment", limited, found)?;
            }
        }
    }
    Ok(())
}

/// Returns the words of the inputs of a step.
fn step_inputs(channels: &[Channel], decision: &ControlDecision) -> Vec<u64> {
    let axes = &decision.axes;
    let references: Vec<_> = axes.iter().map(|axis| axis.goal.flight_reference(decision.now)).collect();
    let mut words = Vec::new();
    for channel in channels {
        let Some(quantity) = channel.quantity else {
            words.extend(std::iter::repeat_n(0.0, channel.count));
            continue;
        };
        match quantity {
            FlightQuantity::TargetAttitude => {
                if let Orientation::Attitude(q) = decision.origin {
                    words.extend([q.w, q.i, q.j, q.k]);
                }
            }
            FlightQuantity::Angle => words.extend(axes.iter().map(|axis| axis.estimate.angle)),
            FlightQuantity::Rate => words.extend(axes.iter().map(|axis| axis.estimate.rate)),
            FlightQuantity::Displacement => {
                words.extend(axes.iter().map(|axis| axis.estimate.dominant.displacement));
            }
            FlightQuantity::DisplacementRate => {
                words.extend(axes.iter().map(|axis| axis.estimate.dominant.rate));
            }
            FlightQuantity::Frequency => {
                words.extend(axes.iter().map(|axis| axis.estimate.dominant.frequency));
            }
            FlightQuantity::QueuedRate => words.extend(axes.iter().map(|axis| axis.estimate.queued_rate)),
            FlightQuantity::ReferenceAngle => {
                words.extend(references.iter().map(|reference| reference.angle));
            }
            FlightQuantity::ReferenceRate => words.extend(references.iter().map(|reference| reference.rate)),
            FlightQuantity::ReferenceAcceleration => {
                words.extend(references.iter().map(|reference| reference.acceleration));
            }
            FlightQuantity::WheelSpeed => {
                let known = &decision.rotors.wheel_speeds;
                words.extend((0..channel.count).map(|wheel| known.get(wheel).copied().unwrap_or(0.0)));
            }
            FlightQuantity::StoredMomentum => words.extend(decision.rotors.stored_momentum),
            FlightQuantity::ElasticRate
            | FlightQuantity::ElasticFrequency
            | FlightQuantity::ElasticInfluence => {
                let modes = channel.count / axes.len();
                for axis in axes {
                    words.extend((0..modes).map(|mode| {
                        let mode = axis.estimate.elastic.get(mode).copied().unwrap_or_default();
                        match quantity {
                            FlightQuantity::ElasticRate => mode.rate,
                            FlightQuantity::ElasticFrequency => mode.frequency,
                            _ => mode.influence,
                        }
                    }));
                }
            }
            // Truth values are words 0 and 1.
            FlightQuantity::ElasticTrust => words
                .extend(axes.iter().map(|axis| f64::from_bits(u64::from(axis.estimate.elastic_is_trusted)))),
            FlightQuantity::Field | FlightQuantity::FieldRate | FlightQuantity::Torque => {
                words.extend(std::iter::repeat_n(0.0, channel.count));
            }
        }
    }
    words.into_iter().map(f64::to_bits).collect()
}

/// Fails if two values differ in a bit; all NaN are one value.
fn compare(call: usize, quantity: &str, engine: f64, plain: f64) -> Result<(), VectorError> {
    if engine.to_bits() == plain.to_bits() || (engine.is_nan() && plain.is_nan()) {
        return Ok(());
    }
    Err(VectorError::Different { call, quantity: quantity.to_owned(), engine, plain })
}

/// Returns vectors as the bytes of a file: words of 64 bits, little endian; for each call its index, whole seconds,
/// femtoseconds, inputs and outputs.
pub fn to_bytes(vectors: &[CallVector]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut word = |word: u64| bytes.extend_from_slice(&word.to_le_bytes());
    word(MAGIC);
    word(vectors.len() as u64);
    for vector in vectors {
        word(vector.call as u64);
        word(vector.now.whole as u64);
        word(vector.now.part as u64);
        vector.inputs.iter().chain(&vector.outputs).for_each(|input| word(*input));
    }
    bytes
}
