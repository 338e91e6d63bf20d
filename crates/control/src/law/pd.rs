//! The sampled PD law, u = -k_p (y - y_goal) - k_d (y' - y'_goal), held between its samples.
//!
//! y is the measured angle, or with an extra loop y = x + gain x_d, where x_d is the estimated displacement of the
//! dominant mode (\[Wheel11, Sukhanov\], equations (5), (7) and (8)).

use flexsc_flight::gain_schedule::{SchedulePoint, scheduled_gain};
use flexsc_flight::pd::{ErrorDerivative, PdLaw};
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive};
use flexsc_numerics::time::{Instant, Span};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    AttitudeErrorMeasure, Authority, Command, ControlOutput, DecisionCause, ErrorBand, EstimateNeeds, Guards,
    Law, LawSpec, LawState, Phase, ReferenceNeeds, Setpoint, TorqueConditions, Tunable,
};
use crate::offers::{LawOffers, LawPlace, Offers};
use crate::part::Part;
use crate::requirement::Requirements;
use crate::state_estimate::StateEstimate;

/// The PD law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pd {
    /// Proportional gain (N m/rad; for a wheel, units of its command per rad).
    pub k_p: NonNegative,
    /// Derivative gain (N m s/rad; without the second where the difference is raw).
    pub k_d: NonNegative,
    /// Period of its samples (s).
    pub period: Span,
    /// How the derivative is taken.
    #[serde(default)]
    pub differentiation: Differentiation,
    /// How a rotation is converted into an error, on a body with three axes; default: `quaternion`.
    #[serde(default, skip_serializing_if = "AttitudeErrorMeasure::is_default")]
    pub error: AttitudeErrorMeasure,
    /// Extra loop on the dominant mode.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extra: Option<Extra>,
    /// Largest torque (N m; for a wheel, in units of its command); no limit by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<Positive>,
    /// Whether the law tracks a manoeuvre while it lasts; otherwise it waits and takes over at the end of the
    /// manoeuvre.
    #[serde(default, skip_serializing_if = "is_false")]
    pub track: bool,
}

/// How the derivative is taken.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Differentiation {
    /// The measured rate.
    #[default]
    Exact,
    /// The difference of two samples divided by their period.
    Difference,
    /// The difference of two samples: the derivative gain then has the unit of the proportional one.
    Raw,
}

/// The extra loop on the dominant mode; its gain is k_d of the papers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Extra {
    /// A constant gain.
    Gain(Finite),
    /// A gain scheduled by the estimated frequency: linear interpolation between points, constant before the first and after
    /// the last.
    Schedule(Vec<ScheduledGain>),
}

/// A point of a schedule.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScheduledGain {
    /// Frequency of the dominant mode (rad/s).
    pub frequency: Positive,
    /// Gain at that frequency.
    pub gain: Finite,
}

impl Pd {
    /// Returns the gain of the extra loop at a frequency of the dominant mode (rad/s); 0 without that loop.
    pub fn extra_gain(&self, frequency: f64) -> f64 {
        self.extra.as_ref().map_or(0.0, |extra| extra.gain(frequency))
    }
}

impl Extra {
    /// Checks that the points of a schedule are in order; returns a key within the schedule and the reason.
    fn validate(&self) -> Option<ConfigError> {
        let Self::Schedule(points) = self else { return None };
        if points.is_empty() {
            return Some(ConfigError::new("", "must have at least one point"));
        }
        let index = points.windows(2).position(|pair| pair[0].frequency >= pair[1].frequency)? + 1;
        let why = format!("must be above the one before, got {}", points[index].frequency.get());
        Some(ConfigError::new(format!("[{index}].frequency"), why))
    }

    /// Returns the gain at a frequency of the dominant mode (rad/s).
    pub fn gain(&self, frequency: f64) -> f64 {
        match self {
            Self::Gain(gain) => gain.get(),
            Self::Schedule(points) => {
                let points: Vec<SchedulePoint> = points.iter().map(ScheduledGain::flight).collect();
                scheduled_gain(&points, frequency)
            }
        }
    }
}

impl ScheduledGain {
    /// Returns the point as flight code has it.
    pub fn flight(&self) -> SchedulePoint {
        SchedulePoint { frequency: self.frequency.get(), gain: self.gain.get() }
    }
}

impl Pd {
    /// Returns the law at the start, as flight code has it.
    pub fn flight_law(&self) -> PdLaw {
        PdLaw {
            k_p: self.k_p.get(),
            k_d: self.k_d.get(),
            limit: self.limit.map_or(f64::INFINITY, Positive::get),
            period: self.period.seconds(),
            measure: self.error.flight(),
            derivative: match self.differentiation {
                Differentiation::Exact => ErrorDerivative::Measured,
                Differentiation::Difference => ErrorDerivative::Difference,
                Differentiation::Raw => ErrorDerivative::Raw,
            },
            has_last: false,
            last: 0.0,
        }
    }

    /// Returns the points of the gain of the extra loop: one for a constant gain, none without that loop.
    pub fn schedule(&self) -> Vec<SchedulePoint> {
        match &self.extra {
            None => Vec::new(),
            Some(Extra::Gain(gain)) => vec![SchedulePoint { frequency: 0.0, gain: gain.get() }],
            Some(Extra::Schedule(points)) => points.iter().map(ScheduledGain::flight).collect(),
        }
    }
}

impl LawSpec for Pd {
    fn start(&self, _: &Authority) -> Box<dyn Law> {
        Box::new(PdRun {
            law: self.flight_law(),
            schedule: self.schedule(),
            period: self.period,
            tracks_manoeuvre: self.track,
            active: false,
            tuned: f64::NAN,
        })
    }

    fn offers(&self) -> LawOffers {
        let reads_mode = self.extra.is_some();
        let needs = if reads_mode { EstimateNeeds::DominantMode } else { EstimateNeeds::Motion };
        LawOffers::new(Some(self.period), needs)
    }

    /// Returns the usual 5 % of a step.
    fn expected_band(&self) -> ErrorBand {
        ErrorBand::Fraction(0.05)
    }

    fn expected_torque(&self, conditions: &TorqueConditions) -> f64 {
        let limit = self.limit.filter(|_| conditions.detailed).map_or(f64::INFINITY, Positive::get);
        conditions.torque_per_command * limit.min(self.k_p.get() * conditions.angle)
    }

    fn validate(&self) -> Option<ConfigError> {
        Some(self.extra.as_ref()?.validate()?.within("extra.schedule"))
    }

    fn requires(&self, _: &LawPlace, offers: &Offers, needs: &mut Requirements) {
        super::requirements::require_measure(self.error, offers, needs);
    }

    fn tunable(&self) -> Vec<Tunable> {
        let mut numbers =
            vec![Tunable::not_negative("k_p", self.k_p), Tunable::not_negative("k_d", self.k_d)];
        if let Some(Extra::Gain(gain)) = self.extra {
            numbers.push(Tunable::unbounded("extra.gain", gain.get()));
        }
        numbers.extend(self.limit.map(|limit| Tunable::positive("limit", limit)));
        numbers
    }
}

/// PD law in a run.
#[derive(Clone, Debug)]
struct PdRun {
    law: PdLaw,
    /// Gain of the extra loop over the frequency of the dominant mode.
    schedule: Vec<SchedulePoint>,
    period: Span,
    tracks_manoeuvre: bool,
    active: bool,
    /// Value of the parameter tuned last.
    tuned: f64,
}

impl Part for PdRun {}

impl Law for PdRun {
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
        let (motion, reference) = (state_estimate.flight_motion(), goal.flight_reference(now));
        let torque = self.law.step(&motion, &reference, &self.schedule);
        let until = Some(now + self.period);
        ControlOutput { command: Command::Torque(torque), until, guards: Guards::NONE }
    }

    fn state(&self) -> LawState<'_> {
        LawState::with_tuned(if self.active { Phase::Feedback } else { Phase::Open }, self.tuned)
    }

    fn reference_needs(&self) -> ReferenceNeeds {
        ReferenceNeeds { tracks_manoeuvre: self.tracks_manoeuvre, ..ReferenceNeeds::default() }
    }

    fn copy(&self) -> Box<dyn Law> {
        Box::new(self.clone())
    }

    fn tune(&mut self, key: &str, value: f64) {
        match key {
            "k_p" => self.law.k_p = value,
            "k_d" => self.law.k_d = value,
            "limit" => self.law.limit = value,
            "extra.gain" => self.schedule.iter_mut().for_each(|point| point.gain = value),
            _ => return,
        }
        self.tuned = value;
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn is_false(value: &bool) -> bool {
    !value
}
