//! A compensator given by its matrices, x' = A x + B e, u = C x + D e, at samples, as design programs export it.
//!
//! e is the setpoint minus the estimate, of the angle and, with a second column of B and D, of the rate: a PD law is D
//! = \[\[k_p, k_d\]\]. With named inputs and outputs it is one compensator about three axes together.

use std::sync::Arc;

use flexsc_formats::count::counted;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::AXES;
use flexsc_numerics::quantity::{Finite, Positive};
use flexsc_numerics::time::Span;
use flexsc_record::CustomTopic;
use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::compensator_input::CompensatorInput;
use super::discrete_matrices::{DiscreteMatrices, matrix};
use super::one_axis_state_space::OneAxisStateSpace;
use super::output_quantity::OutputQuantity;
use super::three_axis_state_space::{ThreeAxisStateSpace, states_topic};
use super::{
    Authority, ErrorBand, EstimateNeeds, Law, LawKind, LawSpec, ThreeAxisLaw, TorqueConditions, Tunable,
};
use crate::offers::{LawOffers, LawPlace, Offers};
use crate::requirement::Requirements;

/// Largest number of states.
const MOST: usize = 64;

/// The compensator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StateSpace {
    /// Period of its samples (s).
    pub period: Span,
    /// Matrix A, row by row, for at most 64 states; default: there are no states.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub a: Vec<Vec<Finite>>,
    /// Matrix B: one row per state; one column for each input, or for the angle error (rad) and optionally a second for the rate error (rad/s).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub b: Vec<Vec<Finite>>,
    /// Matrix C: one row, or one for each output.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub c: Vec<Vec<Finite>>,
    /// Matrix D: one row, or one for each output; default: it is zero.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub d: Vec<Vec<Finite>>,
    /// Names of the inputs of one law about three axes together; default: a law about each axis.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub inputs: Vec<String>,
    /// Axes of the outputs of one law about three axes together; default: roll, pitch and yaw.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outputs: Vec<String>,
    /// Whether the matrices are in discrete or continuous time.
    #[serde(default)]
    pub of: TimeDomain,
    /// Quantity that it commands.
    #[serde(default)]
    pub command: OutputQuantity,
    /// Factor on the output, which an adaptation may tune; default: 1.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub gain: Positive,
    /// Largest command, in its unit; no limit by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<Positive>,
    /// Whether the law tracks a manoeuvre while it lasts, as with accelerations it always does; otherwise it takes
    /// over at the end of the manoeuvre.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub track: bool,
    /// Number of states in the log, if there are more than those of the law: of several modes, the largest.
    #[serde(skip)]
    logged: usize,
}

fn one() -> Positive {
    Positive::ONE
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn is_one(gain: &Positive) -> bool {
    *gain == Positive::ONE
}

/// Whether the matrices are in discrete or continuous time.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Of")]
pub enum TimeDomain {
    /// Discrete time, with samples `period` apart.
    #[default]
    Samples,
    /// Continuous time, discretised with the error held over a period.
    Held,
    /// Continuous time, discretised by Tustin's rule.
    Tustin,
}

/// Returns the index of the first name that occurs earlier, as an error.
fn first_repetition(names: &[String]) -> Option<ConfigError> {
    let index = (1..names.len()).find(|index| names[..*index].contains(&names[*index]))?;
    Some(ConfigError::new(format!("[{index}]"), format!("is given twice: `{}`", names[index])))
}

impl StateSpace {
    /// Gives the laws about three axes among those of modes one topic for their states.
    pub(super) fn share_topic<'a>(laws: impl Iterator<Item = &'a mut LawKind>) {
        let compensator = |law: &'a mut LawKind| match law {
            LawKind::StateSpace(law) if law.is_three_axis() => Some(law),
            _ => None,
        };
        let mut laws: Vec<&mut Self> = laws.filter_map(compensator).collect();
        let most = laws.iter().map(|law| law.a.len()).max().unwrap_or(0);
        for law in &mut laws {
            law.logged = most;
        }
    }

    /// Returns the topics of the rows that the law reports beyond those of the engine.
    pub fn topics(&self) -> Vec<Arc<CustomTopic>> {
        let topic = self.is_three_axis().then(|| states_topic(self.a.len().max(self.logged)));
        topic.flatten().into_iter().collect()
    }

    /// Returns true if the law acts about three axes together.
    pub(super) fn is_three_axis(&self) -> bool {
        !(self.inputs.is_empty() && self.outputs.is_empty())
    }

    /// Returns the inputs of a law about three axes together.
    pub(super) fn named_inputs(&self) -> Result<Vec<CompensatorInput>, ConfigError> {
        if self.inputs.is_empty() {
            let why = format!("must name the columns of B and D, each {}", CompensatorInput::ACCEPTED);
            return Err(ConfigError::new("inputs", why));
        }
        let input = |(index, name): (usize, &String)| {
            CompensatorInput::from_name(name).ok_or_else(|| {
                let why = format!("must be {}, got `{name}`", CompensatorInput::ACCEPTED);
                ConfigError::new(format!("inputs[{index}]"), why)
            })
        };
        let inputs = self.inputs.iter().enumerate().map(input).collect::<Result<Vec<_>, _>>()?;
        match first_repetition(&self.inputs) {
            Some(fault) => Err(fault.within("inputs")),
            None => Ok(inputs),
        }
    }

    /// Returns the axes of the outputs of a law about three axes together.
    pub(super) fn named_outputs(&self) -> Result<Vec<usize>, ConfigError> {
        if self.outputs.is_empty() {
            return Ok(vec![0, 1, 2]);
        }
        let output = |(index, name): (usize, &String)| {
            AXES.iter().position(|axis| axis == name).ok_or_else(|| {
                let why = format!("must be `roll`, `pitch` or `yaw`, got `{name}`");
                ConfigError::new(format!("outputs[{index}]"), why)
            })
        };
        let outputs = self.outputs.iter().enumerate().map(output).collect::<Result<Vec<_>, _>>()?;
        match first_repetition(&self.outputs) {
            Some(fault) => Err(fault.within("outputs")),
            None => Ok(outputs),
        }
    }

    /// Returns the number of columns of B and D of a law about each axis.
    fn one_axis_inputs(&self) -> Result<usize, ConfigError> {
        let Some(inputs) = self.d.first().or(self.b.first()).map(Vec::len) else {
            return Err(ConfigError::new("d", "must be given if there are no states"));
        };
        if (1..=2).contains(&inputs) {
            return Ok(inputs);
        }
        let key = if self.d.is_empty() { "b[0]" } else { "d[0]" };
        let why = format!(
            "must have a column for the angle, or two for angle and rate, got {inputs}: a law about three axes together \
             names its `inputs`"
        );
        Err(ConfigError::new(key, why))
    }

    /// Returns C or D, which has a row for each output or is left out.
    fn output_rows(
        &self,
        key: &str,
        rows: &[Vec<Finite>],
        outputs: usize,
        columns: usize,
    ) -> Result<DMatrix<f64>, ConfigError> {
        let count = rows.len();
        if count == 0 {
            return Ok(DMatrix::zeros(outputs, columns));
        }
        if count == outputs {
            return matrix(key, rows, columns);
        }
        let why = if self.is_three_axis() {
            format!("must have a row for each of {}, got {count}", counted(outputs, "output"))
        } else {
            format!("must be one row, got {count}: a law about three axes together names its `inputs`")
        };
        Err(ConfigError::new(key, why))
    }

    /// Returns the matrices in discrete time.
    pub(super) fn sampled(&self) -> Result<DiscreteMatrices, ConfigError> {
        let wrong = |key: &str, why: String| Err(ConfigError::new(key, why));
        let order = self.a.len();
        if order > MOST {
            return wrong("a", format!("must have at most {MOST} states, got {order}"));
        }
        let (inputs, outputs) = if self.is_three_axis() {
            (self.named_inputs()?.len(), self.named_outputs()?.len())
        } else {
            (self.one_axis_inputs()?, 1)
        };
        if order == 0 && self.d.is_empty() {
            return wrong("d", "must be given if there are no states".to_owned());
        }
        let (a, b) = (matrix("a", &self.a, order)?, matrix("b", &self.b, inputs)?);
        if b.nrows() != order {
            return wrong(
                "b",
                format!("must have a row for each of {}, got {}", counted(order, "state"), b.nrows()),
            );
        }
        if order > 0 && self.c.is_empty() {
            return wrong("c", format!("must be a row of {order}: without it the states have no effect"));
        }
        let c = self.output_rows("c", &self.c, outputs, order)?;
        let d = self.output_rows("d", &self.d, outputs, inputs)?;
        let continuous = DiscreteMatrices { a, b, c, d };
        let h = self.period.seconds();
        match self.of {
            TimeDomain::Samples => Ok(continuous),
            TimeDomain::Held => Ok(continuous.held(h)),
            TimeDomain::Tustin => match continuous.tustin(h) {
                Some(sampled) => Ok(sampled),
                None => wrong(
                    "a",
                    format!("has an eigenvalue at 2/period = {} 1/s, where Tustin's rule has none", 2.0 / h),
                ),
            },
        }
    }

    /// Returns the size of the first command at an angle error (rad), with the compensator's states at 0; of a law about
    /// three axes together, that of its largest output.
    fn first_command(&self, angle: f64) -> f64 {
        let direct = if self.is_three_axis() {
            let inputs = self.named_inputs().unwrap_or_default();
            let entries = self.d.iter().flat_map(|row| row.iter().zip(&inputs));
            entries
                .filter(|(_, input)| input.is_attitude())
                .fold(0.0, |most, (entry, _)| f64::max(most, entry.get().abs()))
        } else {
            self.d.first().and_then(|row| row.first()).map_or(0.0, |entry| entry.get())
        };
        let limit = self.limit.map_or(f64::INFINITY, Positive::get);
        (self.gain.get() * direct * angle).abs().min(limit)
    }
}

impl LawSpec for StateSpace {
    fn expected_torque(&self, conditions: &TorqueConditions) -> f64 {
        let unit = match self.command {
            OutputQuantity::Torque => conditions.torque_per_command,
            OutputQuantity::Acceleration => conditions.inertia,
        };
        let first = unit * self.first_command(conditions.angle);
        // About three axes a slew along a profile commands its acceleration.
        let slew = conditions.profile_acceleration.filter(|_| self.is_three_axis());
        slew.map_or(first, |acceleration| conditions.inertia * acceleration)
    }

    fn start(&self, _: &Authority) -> Box<dyn Law> {
        Box::new(OneAxisStateSpace {
            compensator: self.flight_law(),
            period: self.period,
            tuned: f64::NAN,
            track: self.track,
            active: false,
        })
    }

    fn start_three_axis(&self, _: &[Authority]) -> Option<Box<dyn ThreeAxisLaw>> {
        let compensator = self.is_three_axis().then(|| self.flight_law())?;
        Some(Box::new(ThreeAxisStateSpace {
            topic: states_topic(compensator.state.len().max(self.logged)),
            compensator,
            period: self.period,
            tuned: f64::NAN,
        }))
    }

    fn offers(&self) -> LawOffers {
        LawOffers {
            is_three_axis: self.is_three_axis(),
            ..LawOffers::new(Some(self.period), EstimateNeeds::Motion)
        }
    }

    fn validate(&self) -> Option<ConfigError> {
        match self.sampled() {
            Err(fault) => Some(fault),
            Ok(sampled) => {
                let all = [&sampled.a, &sampled.b, &sampled.c, &sampled.d];
                let finite = all.iter().all(|matrix| matrix.iter().all(|entry| entry.is_finite()));
                (!finite).then(|| ConfigError::new("a", "overflows within a period"))
            }
        }
    }

    fn requires(&self, place: &LawPlace, offers: &Offers, needs: &mut Requirements) {
        if !self.is_three_axis() {
            return;
        }
        let key = if self.inputs.is_empty() { "outputs" } else { "inputs" };
        offers.require_three_axes(needs, key, ": leave them out");
        needs.require(
            !place.is_per_axis,
            key,
            "make one law about three axes together: use `[law.state_space]`, or leave them out",
        );
        let wheels: usize = offers.actuators.iter().map(|member| member.offers.wheels).sum();
        for (index, input) in self.named_inputs().unwrap_or_default().into_iter().enumerate() {
            if let CompensatorInput::WheelSpeed(wheel) = input {
                needs.require_with(wheel < wheels, &format!("inputs[{index}]"), || {
                    let found = match wheels {
                        0 => "there is no `[actuator.wheels]`".to_owned(),
                        _ => format!("the last of {wheels} wheels is `wheel{}`", wheels - 1),
                    };
                    format!("is the speed of a wheel that is not there: {found}")
                });
            }
        }
    }

    /// Returns the usual 5 % of a step.
    fn expected_band(&self) -> ErrorBand {
        ErrorBand::Fraction(0.05)
    }

    fn tunable(&self) -> Vec<Tunable> {
        vec![Tunable::positive("gain", self.gain)]
    }
}
