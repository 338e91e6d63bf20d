//! Loop of a scenario, cut open at one point: body, sensors, estimators and laws as one linear system at samples.
//!
//! Everything is sampled exactly: torques are held over a period and act late by the delay of the actuators, filters and
//! estimators keep their periods. Limits, quantisation and noise are left out. The loop transfer has the sign of
//! negative feedback: the closed loop has the state matrix a - b (1 + d)^-1 c.

pub(crate) mod actuation;
pub(crate) mod attitude_rows;
pub(crate) mod block_matrices;
mod measurement;
pub(crate) mod multi_rate;
pub(crate) mod repeated_instants;
pub mod sampling;
mod transfer;
pub(crate) mod uniform_rate;

use flexsc_control::actuator::CommandResponse;
use flexsc_control::law::LinearLaw;
use flexsc_control::linear_block::LinearBlock;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::AXES;
use flexsc_numerics::inverse::inverse;
use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::Serialize;

pub use transfer::TransferMatrices;

use super::linear_loop::LinearLoop;
use super::linear_model::{LinearModel, Signal};
use super::noise::mirror_states::MirrorStates;
use super::state_space::StateSpaceModel;
use flexsc_scenario::Scenario;

/// Point at which a loop is cut open.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LoopBreak {
    /// Commands of the law.
    #[default]
    Command,
    /// Torques of the actuator.
    Torque,
    /// Measured angles and rates.
    Measurement,
}

impl LoopBreak {
    /// All points.
    pub const ALL: [Self; 3] = [Self::Command, Self::Torque, Self::Measurement];

    /// Returns the point of this name, if there is one.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|point| point.name() == name)
    }

    /// Returns the name of the point.
    pub fn name(self) -> &'static str {
        match self {
            Self::Command => "command",
            Self::Torque => "torque",
            Self::Measurement => "measurement",
        }
    }
}

/// Loop that is cut open, with the sign of negative feedback.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenLoop {
    /// Transfer of the signals at the break, with feedthrough only for several samples of the law in a period.
    pub transfer: TransferMatrices,
    /// States.
    pub states: Vec<Signal>,
    /// Signals at the break, of one sample of the law: inputs and outputs in this order, sample after sample.
    pub signals: Vec<Signal>,
    /// Point at which the loop is cut open.
    pub opened: LoopBreak,
    /// Period after which the loop repeats (s).
    pub period: f64,
    /// Samples of the law in a period.
    pub samples: usize,
}

/// Body in continuous time, and the parts that close its loop.
#[derive(Clone)]
pub(crate) struct LoopParts<'a> {
    pub scenario: &'a Scenario,
    pub body: BodyMatrices,
    pub actuators: CommandResponse,
    pub parts: LinearLoop,
    pub law: AxisLaws,
    pub opened: LoopBreak,
    /// Fine mirrors among the states of the body; empty where none are.
    pub mirrors: Vec<MirrorStates>,
}

/// Linear model of the body, as matrices.
#[derive(Clone)]
pub(crate) struct BodyMatrices {
    pub a: DMatrix<f64>,
    pub b: DMatrix<f64>,
    /// Rows of the measured angle and rate about each axis, in this order.
    pub c: DMatrix<f64>,
    pub states: Vec<Signal>,
    pub inputs: Vec<Signal>,
    /// Measured angle and rate about each axis.
    pub outputs: Vec<Signal>,
    /// Model that the matrices are from.
    pub model: LinearModel,
}

/// Laws about all axes.
#[derive(Clone)]
pub(crate) struct AxisLaws {
    /// Block from angles and rates, axis by axis, to commands.
    pub block: LinearBlock,
    /// Period of the samples.
    pub period: flexsc_numerics::time::Span,
}

impl OpenLoop {
    /// Returns the loop of a scenario, cut open, with natural frequencies as they are at the start.
    ///
    /// # Errors
    /// A part that is not linear, or a combination that a linear loop does not have: its key, and the reason.
    pub fn from_scenario(scenario: &Scenario, opened: LoopBreak) -> Result<Self, ConfigError> {
        Self::from_parts(&LoopParts::from_scenario(scenario, opened)?)
    }

    /// Returns the loop of a scenario, cut open, whose actuators have another delay (s).
    ///
    /// # Errors
    /// See [`OpenLoop::from_scenario`].
    pub fn with_delay(scenario: &Scenario, opened: LoopBreak, delay: f64) -> Result<Self, ConfigError> {
        Self::from_parts(&LoopParts::with_delay(scenario, opened, Some(delay))?)
    }

    /// Returns the inputs of the transfer, which are also its outputs: of several samples in a period, each signal has the
    /// number of its sample.
    pub fn channels(&self) -> Vec<Signal> {
        if self.samples == 1 {
            return self.signals.clone();
        }
        let numbered = |signal: &Signal, sample| Signal {
            name: format!("{}_{sample}", signal.name),
            unit: signal.unit.clone(),
        };
        (0..self.samples).flat_map(|k| self.signals.iter().map(move |signal| numbered(signal, k))).collect()
    }

    /// Returns the loop of these parts.
    ///
    /// # Errors
    /// See [`OpenLoop::from_scenario`].
    pub(crate) fn from_parts(parts: &LoopParts<'_>) -> Result<Self, ConfigError> {
        let has_filter = parts.parts.attitude.is_some();
        if has_filter { multi_rate::lifted_loop(parts) } else { uniform_rate::sampled_loop(parts) }
    }
}

impl<'a> LoopParts<'a> {
    /// Returns the parts of a scenario's loop, with natural frequencies as they are at the start.
    ///
    /// # Errors
    /// See [`OpenLoop::from_scenario`].
    pub(crate) fn from_scenario(scenario: &'a Scenario, opened: LoopBreak) -> Result<Self, ConfigError> {
        Self::with_delay(scenario, opened, None)
    }

    /// Returns the parts of a scenario's loop whose actuators have another delay (s), if one is given.
    fn with_delay(
        scenario: &'a Scenario,
        opened: LoopBreak,
        delay: Option<f64>,
    ) -> Result<Self, ConfigError> {
        if let Some(fault) = scenario.mode_choice_fault().or_else(|| scenario.stage_choice_fault()) {
            return Err(fault);
        }
        let model = LinearModel::from_scenario(scenario, 0.0)?;
        let axes = model.inputs.len();
        let mut body = BodyMatrices::new(model)?;
        let actuators = actuation::combined_response(scenario, axes, delay)?;
        let parts = LinearLoop::from_scenario(scenario)?;
        body.add_exposures(parts.attitude.as_ref().and_then(attitude_rows::exposure_rates));
        let law = AxisLaws::new(scenario, &body)?;
        Ok(Self { scenario, body, actuators, parts, law, opened, mirrors: Vec::new() })
    }

    /// Returns the parts of the same loop with the wheels that points of the structure carry at a speed (rad/s); `None` if there are
    /// none.
    ///
    /// # Errors
    /// See [`OpenLoop::from_scenario`].
    pub(crate) fn at_wheel_speed(&self, speed: f64) -> Result<Option<Self>, ConfigError> {
        if self.scenario.study.carried_rotors.is_empty() {
            return Ok(None);
        }
        let body = BodyMatrices::new(LinearModel::at_wheel_speed(self.scenario, speed)?)?;
        let law = AxisLaws::new(self.scenario, &body)?;
        Ok(Some(Self { body, law, ..self.clone() }))
    }

    /// Returns the parts of the same loop, cut open at a point.
    pub(crate) fn opened_at(self, opened: LoopBreak) -> Self {
        Self { opened, ..self }
    }
}

impl BodyMatrices {
    /// Selects the measured angles and rates of a model.
    fn new(model: LinearModel) -> Result<Self, ConfigError> {
        let names: Vec<String> = match model.inputs.len() {
            1 => vec!["angle".to_owned(), "rate".to_owned()],
            _ => AXES.iter().flat_map(|axis| [(*axis).to_owned(), format!("{axis}_rate")]).collect(),
        };
        let place = |name: &String| model.outputs.iter().position(|output| output.name == *name);
        let Some(places) = names.iter().map(place).collect::<Option<Vec<_>>>() else {
            return Err(ConfigError::new("body", "has no measured angles and rates"));
        };
        let StateSpaceModel { matrices, states, inputs, outputs, .. } = model.clone().into();
        Ok(Self {
            a: matrices.a,
            b: matrices.b,
            c: matrices.c.select_rows(&places),
            outputs: places.iter().map(|place| outputs[*place].clone()).collect(),
            states,
            inputs,
            model,
        })
    }

    /// Adds states without effect, up to a number of states.
    pub fn resize(&mut self, size: usize) {
        self.a.resize_mut(size, size, 0.0);
        self.b.resize_vertically_mut(size, 0.0);
        self.c.resize_horizontally_mut(size, 0.0);
    }

    /// Adds the integrals of angles over exposures, whose rates are rows over the states.
    fn add_exposures(&mut self, rates: Option<DMatrix<f64>>) {
        let Some(rates) = rates else { return };
        let first = self.a.nrows();
        self.resize(first + rates.nrows());
        self.a.view_mut((first, 0), rates.shape()).copy_from(&rates);
        let state = |axis: &&str| Signal { name: format!("exposed_{axis}"), unit: "rad s".to_owned() };
        self.states.extend(AXES.iter().map(state));
    }

    /// Returns the inertia that the rigid rates have under the torques.
    fn inertia(&self) -> Result<DMatrix<f64>, ConfigError> {
        let axes = self.inputs.len();
        let first = if axes == 1 { 1 } else { 3 };
        let rates = self.b.rows(first, axes).into_owned();
        inverse(rates).ok_or_else(|| ConfigError::new("body", "has no finite inertia"))
    }
}

impl AxisLaws {
    fn new(scenario: &Scenario, body: &BodyMatrices) -> Result<Self, ConfigError> {
        let axes = body.inputs.len();
        let laws = linear_laws(scenario, axes)?;
        let Some(first) = laws.first() else { return Err(ConfigError::new("law", "must be given")) };
        let (period, is_acceleration, own_inertia) = (first.period, first.is_acceleration, first.inertia);
        if laws.iter().any(|law| law.period != period) {
            let why = "has laws of the axes with different periods: a linear loop has one";
            return Err(ConfigError::new("law", why));
        }
        if laws.iter().any(|law| law.is_acceleration != is_acceleration) {
            let why =
                "has laws of the axes that command torques and accelerations: a linear loop has one kind";
            return Err(ConfigError::new("law", why));
        }
        let mut block = LinearBlock::parallel(laws.into_iter().map(|law| law.block).collect());
        if is_acceleration {
            let inertia = match own_inertia {
                Some(own) => DMatrix::from_fn(3, 3, |row, column| own[(row, column)]),
                None => body.inertia()?,
            };
            (block.c, block.d) = (&inertia * block.c, &inertia * block.d);
            if axes == 3 {
                // Accelerations become torques J a + w x (J w + h), and J times this block is the cross product with h.
                let gyroscopic = body.inertia()? * body.a.view((3, 3), (3, 3));
                for axis in 0..3 {
                    let mut column = block.d.column_mut(2 * axis + 1);
                    column -= gyroscopic.column(axis);
                }
            }
        }
        Ok(Self { block, period })
    }
}

/// Returns the law about three axes together, or those about each axis.
fn linear_laws(scenario: &Scenario, axes: usize) -> Result<Vec<LinearLaw>, ConfigError> {
    let together = scenario.law.linear_about_three_axes();
    if let Some(law) = together.map_err(|fault| fault.within(&scenario.law.key_about(0)))? {
        return Ok(vec![law]);
    }
    let about = |axis: usize| {
        let law = scenario.law.linear_about(axis, &axis_prefix(axes, axis));
        law.map_err(|fault| fault.within(&scenario.law.key_about(axis)))
    };
    (0..axes).map(about).collect()
}

/// Returns the prefix of the names of states about an axis.
fn axis_prefix(axes: usize, axis: usize) -> String {
    if axes == 1 { String::new() } else { format!("{}_", AXES[axis]) }
}

/// Returns the states of a block as signals.
fn block_states(block: &LinearBlock) -> impl Iterator<Item = Signal> + '_ {
    block.states.iter().map(|state| Signal { name: state.name.clone(), unit: state.unit.to_owned() })
}

impl LoopParts<'_> {
    /// Returns the signals at the break.
    pub(crate) fn signals(&self) -> Vec<Signal> {
        let inputs = &self.body.inputs;
        match self.opened {
            LoopBreak::Measurement => self.body.outputs.clone(),
            LoopBreak::Torque => inputs.clone(),
            LoopBreak::Command => {
                let gain = self.actuators.gain;
                let unit = |unit: &str| match gain {
                    1.0 => unit.to_owned(),
                    1e-4..1e5 => format!("{unit}/{gain}"),
                    _ => format!("{unit}/{gain:e}"),
                };
                let command = |input: &Signal| Signal {
                    name: input.name.replace("torque", "command"),
                    unit: unit(&input.unit),
                };
                inputs.iter().map(command).collect()
            }
        }
    }
}
