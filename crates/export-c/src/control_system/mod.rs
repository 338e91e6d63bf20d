//! Control system of a scenario: its plain laws about each axis, and what distributes their commands.

mod actuation;
mod attitude_unit;
mod b_dot;
mod channel;
mod excluded_parts;
mod kalman_unit;
mod laws_of_axes;
mod mode_inputs;
mod mode_laws;
mod mode_system;
mod rate_unit;
mod relays;
mod sampled_laws;
mod step_layout;
mod stored_momentum;

use std::fmt;

use flexsc_core::Scenario;
use flexsc_core::control::law::LawKind;
use flexsc_flight::ticks::Ticks;
use flexsc_flight_precision::Precision;

pub use actuation::{Actuation, UnloadingDevice};
pub use attitude_unit::{AttitudeUnit, Corrector, counter};
pub use b_dot::{BDotLaws, BDotSystem, FieldUnit};
pub use channel::{CallLayout, Channel, NumberKind, WordReader};
pub use excluded_parts::ExcludedPart;
pub use kalman_unit::{AxisFilter, KalmanUnit};
pub use laws_of_axes::LawsOfAxes;
pub use mode_inputs::{ModeInputs, ReadingFormula};
pub use mode_laws::{LawsOfMode, ModeLaws};
pub use mode_system::ModeSystem;
pub use rate_unit::RateUnit;
pub use relays::Relays;
pub use sampled_laws::SampledLaws;
pub use stored_momentum::StoredMomentum;

/// Reason for which a scenario's control system cannot be exported.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotExportable {
    /// Key that prevents the export.
    pub key: String,
    /// Reason.
    pub reason: String,
}

impl fmt::Display for NotExportable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` {}", self.key, self.reason)
    }
}

impl std::error::Error for NotExportable {}

impl NotExportable {
    /// Creates the error of a key and its reason.
    pub fn new(key: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { key: key.into(), reason: reason.into() }
    }
}

/// Control system of a scenario at the start of a run.
#[derive(Clone, Debug)]
pub enum ControlSystem {
    /// Relays, which decide at events.
    Relays(Relays),
    /// Laws that decide at their period.
    Sampled(Box<SampledLaws>),
    /// B-dot laws, which read the change of the magnetic field.
    BDot(BDotSystem),
    /// Laws of modes of operation under a supervisor, or stages of a law.
    Modes(Box<ModeSystem>),
}

impl ControlSystem {
    /// Returns the control system of a scenario.
    ///
    /// # Errors
    /// A [`NotExportable`] with the key of a part that has no plain code.
    pub fn new(scenario: &Scenario) -> Result<Self, NotExportable> {
        let axes = scenario.study.axes.len();
        let laws: Vec<&LawKind> = (0..axes).map(|axis| scenario.law.about(axis)).collect();
        if scenario.adaptation.is_some() {
            let reason = "tunes the law in a run: leave it out, and write the value that it reaches";
            return Err(NotExportable::new("adaptation", reason));
        }
        if !scenario.mode.is_empty() || matches!(scenario.law, LawKind::Stages(_)) {
            return Ok(Self::Modes(Box::new(ModeSystem::new(scenario)?)));
        }
        match laws.first() {
            Some(LawKind::Relay(_)) => Ok(Self::Relays(Relays::new(&laws)?)),
            Some(LawKind::BDot(_)) => Ok(Self::BDot(BDotSystem::new(scenario, &laws)?)),
            _ => Ok(Self::Sampled(Box::new(SampledLaws::new(scenario, &laws)?))),
        }
    }

    /// Sets the start to a time, where the function that sets the state has one.
    pub fn start_at(&mut self, now: Ticks) {
        if let Self::Modes(modes) = self {
            modes.start_at(now);
        }
    }

    /// Returns the functions of the control system.
    pub fn calls(&self) -> Vec<CallLayout> {
        match self {
            Self::Relays(relays) => relays.calls(),
            Self::Sampled(laws) => laws.calls(),
            Self::BDot(_) => vec![FieldUnit::layout(), BDotLaws::layout()],
            Self::Modes(modes) => modes.calls(),
        }
    }

    /// Calls the function with this index, and returns the words of its outputs.
    pub fn call(&mut self, call: usize, now: Ticks, inputs: &[u64]) -> Vec<u64> {
        match self {
            Self::Relays(relays) => relays.call(call, now, inputs),
            Self::Sampled(laws) => laws.call(call, now, inputs),
            Self::BDot(system) => system.call(call, now, inputs),
            Self::Modes(modes) => modes.call(call, now, inputs),
        }
    }

    /// Returns laws that decide at their period without their estimator, the on-times of jets and the unloading of wheels: they
    /// read estimates.
    #[must_use]
    pub fn on_estimates(mut self) -> Self {
        if let Self::Sampled(laws) = &mut self {
            laws.read_estimates();
        }
        self
    }

    /// Returns the attitude filter, if the laws read one.
    pub fn estimator(&self) -> Option<&AttitudeUnit> {
        match self {
            Self::Relays(_) | Self::BDot(_) => None,
            Self::Sampled(laws) => laws.estimator.as_ref(),
            Self::Modes(modes) => modes.estimator.as_ref(),
        }
    }

    /// Returns the precision in which it computes.
    pub fn precision(&self) -> Precision {
        match self {
            Self::Relays(_) => Precision::Double,
            Self::Sampled(laws) => laws.precision(),
            Self::BDot(system) => system.laws.precision(),
            Self::Modes(modes) => modes.precision(),
        }
    }

    /// Returns the time from one call to the next (s): the period of the laws, or 0.1 s for relays.
    pub fn period(&self) -> f64 {
        match self {
            Self::Relays(_) => 0.1,
            Self::Sampled(laws) => laws.period,
            Self::BDot(system) => system.laws.period,
            Self::Modes(modes) => modes.period(),
        }
    }
}

/// Returns laws about each axis of one kind.
///
/// # Errors
/// A [`NotExportable`] if an axis has a law of another kind.
fn all_of_kind<T>(laws: &[&LawKind], each: impl Fn(&LawKind) -> Option<T>) -> Result<Vec<T>, NotExportable> {
    laws.iter()
        .map(|law| {
            each(law).ok_or_else(|| {
                let reason =
                    format!("is another kind than `{}` about roll: export axes of one kind", laws[0].kind());
                NotExportable::new(format!("law.per_axis.{}", law.kind()), reason)
            })
        })
        .collect()
}
