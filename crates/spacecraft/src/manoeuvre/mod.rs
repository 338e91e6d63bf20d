//! Manoeuvres: rotations planned ahead, whose command leaves the elastic modes at rest.

mod adjoint;
mod alternatives;
mod attitude_table;
mod bang_bang;
mod command;
mod effort;
mod minimum_energy;
mod minimum_peak;
mod modal_response;
mod peak_search;
mod plan;
mod planned_slew;
mod planner;
mod polynomial;
mod rate_decay;
mod report;
mod residual;
mod series;
mod shaper;
mod slew;
mod suppression;
mod task;
mod timing;

use std::borrow::Cow;

use flexsc_dynamics::axis_model::AxisModel;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Finite, Positive};
use flexsc_numerics::time::Span;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use alternatives::{
    Alternative, AlternativeOutcome, CommandCost, ComparisonBasis, alternatives, compare,
};
pub use attitude_table::{AttitudeRow, AttitudeTable};
pub use command::{BangBang, ManoeuvreCommand, MinimumPeak, PolynomialCommand};
pub use effort::PlanEffort;
pub use peak_search::PeakValue;
pub use plan::{CommandSample, Plan};
pub use planned_slew::PlannedSlew;
pub use rate_decay::RateDecay;
pub use report::{PlanReport, RestTimes};
pub use residual::FinalResidual;
pub use series::SeriesCoefficients;
pub use shaper::{ExtraInsensitive, ShapedModes, Shaper, ShaperImpulse, convolve};
pub use slew::{AttitudeMotion, Slew, SlewProfile};
pub use suppression::{SuppressedMode, Suppression};
pub use task::RestToRestTask;

use crate::body::{Load, Planar};
use planner::ManoeuvrePlanner;

/// A manoeuvre. The modes of the body are at rest at its start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Manoeuvre {
    /// Angle by which the rigid body turns (rad).
    pub angle: Finite,
    /// Duration of the manoeuvre (s); default: the shortest that the peak torque allows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<Span>,
    /// Largest torque (N m); together with `time`, a limit that the plan must respect.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_torque: Option<Positive>,
    /// Rate before the manoeuvre (rad/s), equal to the body's rate at the start.
    #[serde(default)]
    pub start_rate: Finite,
    /// Rate after the manoeuvre (rad/s).
    #[serde(default)]
    pub end_rate: Finite,
    /// Command that turns the body.
    pub command: ManoeuvreCommand,
    /// Shaper with which the command is convolved; it uses part of the duration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shaper: Option<Shaper>,
    /// Distribution of the torque over the body, in any unit, as only the ratios matter: `{ hub, sections }` of panels, `{ rigid,
    /// modes }` of a planar body, coordinates of matrices by name or in order; default: a torque on the hub. The actuator acts
    /// there during the whole run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load: Option<Load>,
    /// Body for which the manoeuvre is planned; default: the body itself. A campaign that draws keys of the body plans for the
    /// body as written in the scenario: the plan does not depend on the drawn values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub model: Option<Planar>,
}

impl Manoeuvre {
    /// Returns the body for which the manoeuvre is planned: `model` if given, else `body`.
    pub fn planned_for<'a>(&self, body: &'a AxisModel) -> Cow<'a, AxisModel> {
        self.model.as_ref().map_or(Cow::Borrowed(body), |model| Cow::Owned(model.into()))
    }

    /// Plans the manoeuvre for a body.
    pub fn plan(&self, body: &AxisModel) -> Result<Plan, ConfigError> {
        if let Some(index) = body.modes.iter().position(|mode| mode.damping.get() >= 1.0) {
            let damping = body.modes[index].damping.get();
            let why = format!("needs modes that oscillate, and the damping of mode {index} is {damping}");
            return Err(ConfigError::new("command", why));
        }
        let planner = ManoeuvrePlanner::new(self, body)?;
        match (self.time.map(Span::seconds), self.peak_torque.map(Positive::get)) {
            (None, None) => Err(ConfigError::new("", "needs a `time`, a `peak_torque` or both")),
            (None, Some(limit)) => timing::shortest_plan(&planner, limit),
            (Some(time), None) => planner.plan(time),
            (Some(time), Some(limit)) => {
                let plan = planner.plan(time)?;
                let peak = plan.peak_torque(body).value;
                // The limit may be the peak itself as printed, so it is met within rounding.
                if peak <= limit * (1.0 + 1e-9) {
                    return Ok(plan);
                }
                let shortest = match timing::shortest_plan(&planner, limit) {
                    Ok(longer) => format!("with {limit} N m it takes {:.6} s", longer.time),
                    Err(_) => format!("with {limit} N m no time is enough"),
                };
                let why =
                    format!("must be at least {peak:.6} N m for a time of {time} s, got {limit}; {shortest}");
                Err(ConfigError::new("peak_torque", why))
            }
        }
    }
}
