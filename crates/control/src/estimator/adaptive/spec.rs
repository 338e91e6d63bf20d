//! Settings of the adaptive observers in a scenario, one observer for each axis.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Finite, NonNegative};
use flexsc_numerics::random::Seed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Gradient, ObserverSet, Recurrence, Tracker};
use crate::estimator::pass_through::PassThrough;
use crate::estimator::requirements::require_modes;
use crate::estimator::sample_cost::ADAPTIVE_S;
use crate::estimator::{Estimator, EstimatorContext, EstimatorSpec};
use crate::offers::{EstimatorOffers, Offers};
use crate::requirement::Requirements;

/// Tolerance of rounded shares of the demand.
const ROUNDING: f64 = 1e-9;

/// Relative frequency difference below which modes cannot be distinguished.
const MERGE: f64 = 0.08;

/// Estimates the rigid rates and, for each axis of the gyro, its dominant elastic modes with their parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Adaptive {
    /// Form of the observers; default: `gradient`.
    pub form: ObserverForm,
    /// The modes to track about each axis, on three axes, such as `roll = [{ frequency = 1.7, influence = [0, 0,
    /// 3], bounds = [1.0, 2.4] }]`; an axis that is left out tracks none. Default: the dominant modes of the body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trackers: Option<GivenModes>,
    /// Number of modes that each axis tracks; default: 2, or 1 in the form `recurrence`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub count: Option<u32>,
    /// Relative frequency difference below which modes of the body are tracked as one: the influences add up, the
    /// frequency is their mean weighted by these.
    pub merge: NonNegative,
    /// Whether an axis accounts for the jets of the other axes; default: true in the form `gradient`, else false.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cross_axis: Option<bool>,
    /// Relative error of the frequencies at the start; a frequency stays within its bounds.
    pub frequency_error: Finite,
    /// Relative error of the influences at the start.
    pub influence_error: Finite,
    /// Whether frequencies and influences are identified.
    pub adapt: bool,
}

/// The forms of an observer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Form")]
pub enum ObserverForm {
    /// Recursive gradient with exact pulses.
    Gradient(Gradient),
    /// The recurrence of \[Timakov14\], for one mode about each axis.
    Recurrence(Recurrence),
}

/// Modes to track about each axis. The influence has one element per group of jets (roll, pitch, yaw), or a single one for
/// the axis' own group if `cross_axis` is false.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Given")]
pub struct GivenModes {
    /// About x.
    #[serde(default)]
    pub roll: Vec<Tracker>,
    /// About y.
    #[serde(default)]
    pub pitch: Vec<Tracker>,
    /// About z.
    #[serde(default)]
    pub yaw: Vec<Tracker>,
}

impl GivenModes {
    /// Returns the modes of each axis.
    pub fn axes(&self) -> [&[Tracker]; 3] {
        [&self.roll, &self.pitch, &self.yaw]
    }
}

impl Default for ObserverForm {
    fn default() -> Self {
        Self::Gradient(Gradient::default())
    }
}

impl Default for Adaptive {
    fn default() -> Self {
        Self {
            form: ObserverForm::default(),
            trackers: None,
            count: None,
            merge: NonNegative::new(MERGE).unwrap_or_default(),
            cross_axis: None,
            frequency_error: Finite::default(),
            influence_error: Finite::default(),
            adapt: true,
        }
    }
}

impl EstimatorSpec for Adaptive {
    fn start(&self, known: &EstimatorContext<'_>, _: Seed) -> Box<dyn Estimator> {
        known
            .adaptive
            .map_or_else(|| Box::new(PassThrough) as _, |design| Box::new(ObserverSet::new(design)) as _)
    }

    fn offers(&self) -> EstimatorOffers {
        EstimatorOffers {
            dominant_mode: true,
            elastic_rates: true,
            estimates_rates_only: true,
            ..EstimatorOffers::default()
        }
    }

    fn validate(&self) -> Option<ConfigError> {
        let error_at = |key: &str, why: String| Some(ConfigError::new(key, why));
        for (key, error) in
            [("frequency_error", self.frequency_error), ("influence_error", self.influence_error)]
        {
            if error.get() <= -1.0 {
                return error_at(key, format!("must be above -1, got {}", error.get()));
            }
        }
        if self.count() == 0 {
            return error_at("count", "must be 1 or more, got 0".to_owned());
        }
        if self.recurs() && self.count() > 1 {
            let why = format!("must be 1 in the form `recurrence`, got {}", self.count());
            return error_at("count", why);
        }
        if self.recurs() && self.uses_cross_axis() {
            return error_at("cross_axis", "must be false in the form `recurrence`, got true".to_owned());
        }
        None
    }

    fn requires(&self, offers: &Offers, needs: &mut Requirements) {
        needs.require(
            !offers.has_actuator(|actuator| actuator.programs_pulses),
            "",
            "predicts by the pulses of groups: it needs jets with `allocation = \"groups\"`",
        );
        let is_part = |share: &f64| *share > 0.0 && *share < 1.0 - ROUNDING;
        let mut jets = offers.actuators.iter().filter(|member| member.offers.has_jets);
        needs.require(
            !jets.any(|member| member.shares.iter().any(is_part)),
            "",
            "predicts what one actuator about each axis does: it needs jets with all of the demand about theirs",
        );
        require_modes(self, offers, needs);
    }

    fn sample_seconds(&self, _: usize, modes: f64) -> f64 {
        modes * ADAPTIVE_S
    }
}

impl Adaptive {
    /// Returns true for the form `recurrence`.
    fn recurs(&self) -> bool {
        matches!(self.form, ObserverForm::Recurrence(_))
    }

    /// Returns the number of modes that each axis tracks.
    pub fn count(&self) -> usize {
        self.count.map_or(if self.recurs() { 1 } else { 2 }, |count| count as usize)
    }

    /// Returns true if the jets of other axes are inputs of an axis.
    pub fn uses_cross_axis(&self) -> bool {
        self.cross_axis.unwrap_or(!self.recurs())
    }

    /// Returns the form of the observers, with zero adaptation gains if `adapt` is false.
    pub fn effective_form(&self) -> ObserverForm {
        let mut form = self.form.clone();
        if !self.adapt {
            match &mut form {
                ObserverForm::Gradient(gradient) => gradient.rate = NonNegative::default(),
                ObserverForm::Recurrence(recurrence) => {
                    recurrence.frequency_gain = NonNegative::default();
                    recurrence.influence_gain = NonNegative::default();
                }
            }
        }
        form
    }
}
