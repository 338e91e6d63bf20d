//! A compensator given by its matrices, x' = A x + B e, u = C x + D e, at samples, as design programs export it.
//!
//! e is the setpoint minus the estimate, of the angle and, with a second column of B and D, of the rate: a PD law is D
//! = \[\[k_p, k_d\]\]. Matrices in continuous time are discretised exactly, with the error held over a period, or by
//! Tustin's rule (\[FranklinPowell98\]).

use flexsc_formats::count::counted;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::exponential::exponential;
use flexsc_numerics::quantity::{Finite, Positive};
use flexsc_numerics::time::{Instant, Span};
use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    Authority, Command, ControlOutput, DecisionCause, ErrorBand, EstimateNeeds, Guards, Law, LawSpec,
    LawState, Phase, ReferenceNeeds, Setpoint, TorqueConditions, Tunable,
};
use crate::offers::LawOffers;
use crate::part::Part;
use crate::state_estimate::StateEstimate;

/// Largest number of states.
const MOST: usize = 64;

/// The compensator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StateSpace {
    /// Period of its samples (s).
    pub period: Span,
    /// Matrix A, row by row; default: there are no states.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub a: Vec<Vec<Finite>>,
    /// Matrix B: one row per state; one column for the angle error (rad) and optionally a second for the rate error (rad/s).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub b: Vec<Vec<Finite>>,
    /// Matrix C: one row.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub c: Vec<Vec<Finite>>,
    /// Matrix D: one row; default: it is zero.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub d: Vec<Vec<Finite>>,
    /// Whether the matrices are in discrete or continuous time.
    #[serde(default)]
    pub of: TimeDomain,
    /// Quantity that it commands.
    #[serde(default)]
    pub command: OutputQuantity,
    /// Factor on the output.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub gain: Positive,
    /// Largest command, in its unit; no limit by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<Positive>,
    /// Whether the law tracks a manoeuvre while it lasts; otherwise it takes over at the end of the manoeuvre.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub track: bool,
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

/// Quantity that the output commands.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Commands")]
pub enum OutputQuantity {
    /// A torque (N m; for a wheel, units of its command).
    #[default]
    Torque,
    /// An angular acceleration (rad/s²): that of the reference is added, and the sum is multiplied by the whole inertia.
    Acceleration,
}

/// Matrices in discrete time.
#[derive(Clone, Debug, PartialEq)]
struct DiscreteMatrices {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    c: DMatrix<f64>,
    d: DMatrix<f64>,
}

/// Returns a matrix with `columns` columns, or the key of the first row with another length.
fn matrix(key: &str, rows: &[Vec<Finite>], columns: usize) -> Result<DMatrix<f64>, ConfigError> {
    match rows.iter().position(|row| row.len() != columns) {
        Some(row) => Err(ConfigError::new(
            format!("{key}[{row}]"),
            format!(
                "must have {columns} column{}, got {}",
                if columns == 1 { "" } else { "s" },
                rows[row].len()
            ),
        )),
        None => Ok(DMatrix::from_fn(rows.len(), columns, |row, column| rows[row][column].get())),
    }
}

impl StateSpace {
    /// Returns the matrices in discrete time.
    fn sampled(&self) -> Result<DiscreteMatrices, ConfigError> {
        let wrong = |key: &str, why: String| Err(ConfigError::new(key, why));
        let order = self.a.len();
        if order > MOST {
            return wrong("a", format!("must have at most {MOST} states, got {order}"));
        }
        let Some(inputs) = self.d.first().or(self.b.first()).map(Vec::len) else {
            return wrong("d", "must be given if there are no states".to_owned());
        };
        if !(1..=2).contains(&inputs) {
            let key = if self.d.is_empty() { "b[0]" } else { "d[0]" };
            return wrong(
                key,
                format!("must have a column for the angle, or two for angle and rate, got {inputs}"),
            );
        }
        let (a, b) = (matrix("a", &self.a, order)?, matrix("b", &self.b, inputs)?);
        if b.nrows() != order {
            return wrong(
                "b",
                format!("must have a row for each of {}, got {}", counted(order, "state"), b.nrows()),
            );
        }
        let row = |key: &str, rows: &[Vec<Finite>], columns: usize| match rows.len() {
            0 => Ok(DMatrix::zeros(1, columns)),
            1 => matrix(key, rows, columns),
            many => Err(ConfigError::new(key, format!("must be one row, got {many}"))),
        };
        if order > 0 && self.c.is_empty() {
            return wrong("c", format!("must be a row of {order}: without it the states have no effect"));
        }
        let (c, d) = (row("c", &self.c, order)?, row("d", &self.d, inputs)?);
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

    /// Checks the settings against each other; returns a key within the law and the reason.
    pub fn inconsistency(&self) -> Option<ConfigError> {
        match self.sampled() {
            Err(fault) => Some(fault),
            Ok(sampled) => {
                let all = [&sampled.a, &sampled.b, &sampled.c, &sampled.d];
                let finite = all.iter().all(|matrix| matrix.iter().all(|entry| entry.is_finite()));
                (!finite).then(|| ConfigError::new("a", "overflows within a period"))
            }
        }
    }

    /// Returns the size of the first command at an angle error (rad), with the compensator's states at 0.
    fn first_command(&self, angle: f64) -> f64 {
        let direct = self.d.first().and_then(|row| row.first()).map_or(0.0, |entry| entry.get());
        let limit = self.limit.map_or(f64::INFINITY, Positive::get);
        (self.gain.get() * direct * angle).abs().min(limit)
    }
}

impl DiscreteMatrices {
    /// Discretises the matrices for samples `h` (s) apart, with the input held between them.
    fn held(self, h: f64) -> Self {
        let (order, inputs) = (self.a.nrows(), self.b.ncols());
        let mut whole = DMatrix::zeros(order + inputs, order + inputs);
        whole.view_mut((0, 0), (order, order)).copy_from(&(&self.a * h));
        whole.view_mut((0, order), (order, inputs)).copy_from(&(&self.b * h));
        let whole = exponential(&whole);
        let (a, b) = (whole.view((0, 0), (order, order)), whole.view((0, order), (order, inputs)));
        Self { a: a.into_owned(), b: b.into_owned(), ..self }
    }

    /// Discretises the matrices by s = 2/h (z - 1)/(z + 1), if possible: with L = (1 - A h/2)^-1, states (L (1 + A h/2)
    /// x), inputs L B h, outputs C L, and D + C L B h/2.
    fn tustin(self, h: f64) -> Option<Self> {
        let one = DMatrix::identity(self.a.nrows(), self.a.nrows());
        let half = &self.a * (0.5 * h);
        let inverse = if self.a.is_empty() { one.clone() } else { (&one - &half).try_inverse()? };
        let (a, c) = (&inverse * (one + half), &self.c * &inverse);
        let b = inverse * &self.b * h;
        let d = &self.d + &c * &self.b * (0.5 * h);
        Some(Self { a, b, c, d })
    }
}

impl LawSpec for StateSpace {
    fn expected_torque(&self, conditions: &TorqueConditions) -> f64 {
        let unit = match self.command {
            OutputQuantity::Torque => conditions.torque_per_command,
            OutputQuantity::Acceleration => conditions.inertia,
        };
        unit * self.first_command(conditions.angle)
    }

    fn start(&self, _: &Authority) -> Box<dyn Law> {
        // Invalid matrices were rejected before.
        let none = || DiscreteMatrices {
            a: DMatrix::zeros(0, 0),
            b: DMatrix::zeros(0, 1),
            c: DMatrix::zeros(1, 0),
            d: DMatrix::zeros(1, 1),
        };
        let matrices = self.sampled().unwrap_or_else(|_| none());
        Box::new(StateSpaceState {
            state: DMatrix::zeros(matrices.a.nrows(), 1),
            period: self.period,
            command: self.command,
            gain: self.gain.get(),
            tuned: f64::NAN,
            limit: self.limit.map_or(f64::INFINITY, Positive::get),
            track: self.track,
            active: false,
            matrices,
        })
    }

    fn offers(&self) -> LawOffers {
        LawOffers::new(Some(self.period), EstimateNeeds::Motion)
    }

    /// Returns the usual 5 % of a step.
    fn expected_band(&self) -> ErrorBand {
        ErrorBand::Fraction(0.05)
    }

    fn tunable(&self) -> Vec<Tunable> {
        vec![Tunable::positive("gain", self.gain)]
    }
}

/// Run-time state of the compensator about an axis.
#[derive(Clone, Debug)]
struct StateSpaceState {
    matrices: DiscreteMatrices,
    /// State x, a column.
    state: DMatrix<f64>,
    period: Span,
    command: OutputQuantity,
    /// Factor on the output, and its last tuned value.
    gain: f64,
    tuned: f64,
    limit: f64,
    track: bool,
    active: bool,
}

impl Part for StateSpaceState {}

impl Law for StateSpaceState {
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
        let DiscreteMatrices { a, b, c, d } = &self.matrices;
        let errors = [angle - state_estimate.angle, rate - state_estimate.rate];
        let error = DMatrix::from_column_slice(b.ncols(), 1, &errors[..b.ncols()]);
        let mut output = (d * &error)[(0, 0)];
        if !self.state.is_empty() {
            output += (c * &self.state)[(0, 0)];
            self.state = a * &self.state + b * &error;
        }
        output *= self.gain;
        let command = match self.command {
            OutputQuantity::Torque => Command::Torque(output.clamp(-self.limit, self.limit)),
            OutputQuantity::Acceleration => {
                Command::Acceleration(output.clamp(-self.limit, self.limit) + goal.acceleration)
            }
        };
        ControlOutput { command, until: Some(now + self.period), guards: Guards::NONE }
    }

    fn state(&self) -> LawState<'_> {
        LawState::with_tuned(if self.active { Phase::Feedback } else { Phase::Open }, self.tuned)
    }

    fn reference_needs(&self) -> ReferenceNeeds {
        // Accelerations have a reference to follow.
        let tracks_manoeuvre = self.track || self.command == OutputQuantity::Acceleration;
        ReferenceNeeds { tracks_manoeuvre, ..ReferenceNeeds::default() }
    }

    fn copy(&self) -> Box<dyn Law> {
        Box::new(self.clone())
    }

    fn tune(&mut self, key: &str, value: f64) {
        if key == "gain" {
            (self.gain, self.tuned) = (value, value);
        }
    }
}
