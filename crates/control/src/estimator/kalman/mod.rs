//! Kalman filters of the body's motion: linear, extended and unscented (\[BarShalom01\]).
//!
//! The measured angle, and with a gyro the rate, determines the rigid motion and every mode. The extended and the
//! unscented filter estimate ratios of the natural frequencies, which drift as integrated random walks.

mod filter;
mod frequency_bounds;
mod measurement_filter;
mod model;
mod sigma;
mod steady_state;

use flexsc_dynamics::axis_model::AxisModel;
use flexsc_dynamics::flow::CoupledMatrices;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{NonNegative, Positive};
use flexsc_numerics::random::Stream;
use flexsc_spacecraft::body::Mode;
use nalgebra::DVector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::EstimateOutputs;

pub use filter::{FilterLanes, FilterParameters, Innovation, KalmanFilter, Prediction};
pub use measurement_filter::{FilterKeys, MeasurementFilter};
pub use model::FilterModel;
pub use steady_state::SteadyStateFilter;

/// A linear Kalman filter: natural frequencies are known and constant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Kalman {
    /// Modes of the filter's model; default: the body's own at the start of each run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub modes: Option<Vec<Mode>>,
    /// Spectral density of the white noise in the reduced moment ((rad/s²)² s).
    #[serde(default = "moment_noise")]
    pub moment_noise: NonNegative,
    /// Standard deviation of the measured angle (rad), required where the sensor has none, such as a gyro; default:
    /// that of the sensor, with the square of its `resolution` over 12 added to the variance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle_noise: Option<Positive>,
    /// Standard deviations of the estimate at the start.
    #[serde(default)]
    pub initial: FilterInitialDeviations,
    /// Initial state estimate of the filter.
    #[serde(default)]
    pub prior: Prior,
    /// Criterion for the dominant mode.
    #[serde(default)]
    pub dominant: Ranking,
    /// Interval over which the metrics assess the filter (s); default: the whole run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub assess: Option<[NonNegative; 2]>,
    /// Estimates that the law reads: `modes` for the dominant mode only, with angle and rate as measured; `hub` for angle and
    /// rate of the hub, elastic part included; `rigid` for the rigid angle and rate. By default, `modes` for a law that reads
    /// the dominant mode, else `hub`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub feeds: Option<EstimateOutputs>,
    /// Whether the filter runs for assessment only: the law does not read it.
    #[serde(default, skip_serializing_if = "is_false")]
    pub watch_only: bool,
}

/// An extended or an unscented Kalman filter: natural frequencies drift.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrequencyTracking {
    /// Modes of the filter's model; default: the body's own at the start of each run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub modes: Option<Vec<Mode>>,
    /// Spectral density of the white noise in the reduced moment ((rad/s²)² s).
    #[serde(default = "moment_noise")]
    pub moment_noise: NonNegative,
    /// Standard deviation of the measured angle (rad), required where the sensor has none, such as a gyro; default:
    /// that of the sensor, with the square of its `resolution` over 12 added to the variance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle_noise: Option<Positive>,
    /// Standard deviations of the estimate at the start.
    #[serde(default)]
    pub initial: FilterInitialDeviations,
    /// Initial state estimate of the filter.
    #[serde(default)]
    pub prior: Prior,
    /// Criterion for the dominant mode.
    #[serde(default)]
    pub dominant: Ranking,
    /// Interval over which the metrics assess the filter (s); default: the whole run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub assess: Option<[NonNegative; 2]>,
    /// Estimates that the law reads: `modes` for the dominant mode only, with angle and rate as measured; `hub` for angle and
    /// rate of the hub, elastic part included; `rigid` for the rigid angle and rate. By default, `modes` for a law that reads
    /// the dominant mode, else `hub`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub feeds: Option<EstimateOutputs>,
    /// Whether the filter runs for assessment only: the law does not read it.
    #[serde(default, skip_serializing_if = "is_false")]
    pub watch_only: bool,
    /// Which frequencies drift together.
    #[serde(default)]
    pub ratios: Ratios,
    /// Initial estimate of the frequency ratio: unless `prior` is `true`, the estimate is drawn around it.
    #[serde(default = "one")]
    pub ratio: Positive,
    /// Standard deviation of the initial ratio.
    #[serde(default = "ratio_sd")]
    pub ratio_sd: NonNegative,
    /// Standard deviation of the ratio's initial rate, which is estimated as 0 (1/s).
    #[serde(default = "ratio_rate_sd")]
    pub ratio_rate_sd: NonNegative,
    /// Spectral density of the white noise in a ratio (1/s).
    #[serde(default = "ratio_noise")]
    pub ratio_noise: NonNegative,
    /// Spectral density of the white noise in the rate of a ratio (1/s³).
    #[serde(default = "ratio_noise")]
    pub ratio_rate_noise: NonNegative,
    /// Bounds `[low, high]` of a ratio; a filter that reaches them has lost lock.
    #[serde(default = "bounds")]
    pub bounds: [Positive; 2],
    /// Number of prediction steps per period, 1 to 100; with a gyro of 1e-6 rad/s use 8.
    #[serde(default = "substeps")]
    pub substeps: Substeps,
    /// Amplitude of the dominant mode, in standard deviations of the angle, below which the ratios are not updated.
    #[serde(default = "gate")]
    pub gate: NonNegative,
}

/// Settings of an extended Kalman filter.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ExtendedKalman(pub FrequencyTracking);

/// Settings of an unscented Kalman filter.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct UnscentedKalman(pub FrequencyTracking);

impl MeasurementFilter for ExtendedKalman {
    fn filter(&self, setting: &FilterContext<'_>, draws: &mut Stream) -> KalmanFilter {
        self.0.filter(setting, Prediction::Extended, draws)
    }

    fn keys(&self) -> FilterKeys<'_> {
        self.0.keys()
    }

    fn validate(&self) -> Option<ConfigError> {
        self.0.validate()
    }
}

impl MeasurementFilter for UnscentedKalman {
    /// Number of passes through the sigma points, relative to the other filters.
    const PASSES: f64 = 4.0;

    fn filter(&self, setting: &FilterContext<'_>, draws: &mut Stream) -> KalmanFilter {
        self.0.filter(setting, Prediction::Unscented, draws)
    }

    fn keys(&self) -> FilterKeys<'_> {
        self.0.keys()
    }

    fn validate(&self) -> Option<ConfigError> {
        self.0.validate()
    }
}

/// Standard deviations of a filter's estimate at the start.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(rename = "Initial")]
pub struct FilterInitialDeviations {
    /// Standard deviation of the rigid angle (rad).
    pub angle: NonNegative,
    /// Standard deviation of the rigid rate (rad/s).
    pub rate: NonNegative,
    /// Standard deviation of the displacement of the mode with the largest k/w² (rad); a tenth of it for the other modes.
    pub displacement: NonNegative,
    /// Standard deviation of the rate of that mode (rad/s); a tenth of it for the other modes.
    pub mode_rate: NonNegative,
}

/// Initial state estimate of a filter.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Prior {
    /// Drawn at random about the true state with the standard deviations of `initial` and, about `ratio`, with `ratio_sd`.
    #[default]
    Drawn,
    /// The true state: errors start at 0, and say little about the filter.
    True,
}

/// Criterion for the dominant mode.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Ranking {
    /// The largest excitability k/w².
    #[default]
    Excitability,
    /// The largest estimated amplitude, if it exceeds the others by more than their standard deviations.
    Amplitude,
}

/// Which frequencies drift together.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Ratios {
    /// All frequencies have one ratio.
    #[default]
    Common,
    /// Each mode has its own ratio.
    Each,
}

impl Ratios {
    /// Returns the number of frequency ratios of `modes` modes.
    pub fn count(self, modes: usize) -> usize {
        if self == Self::Common { 1 } else { modes }
    }
}

/// Data of a scenario that a filter is built from.
#[derive(Clone, Debug)]
pub struct FilterContext<'a> {
    /// Single-axis model of the body.
    pub body: &'a AxisModel,
    /// Back-EMF of the wheel per unit of inertia (1/s); true if it opposes the total rate, not the rigid one.
    pub back_emf: (f64, bool),
    /// Period of the samples (s).
    pub period: f64,
    /// Standard deviation of the sensor's angle (rad).
    pub angle_noise: f64,
    /// Standard deviation of the gyro's rate, if there is one (rad/s).
    pub rate_noise: Option<f64>,
}

impl MeasurementFilter for Kalman {
    fn keys(&self) -> FilterKeys<'_> {
        FilterKeys {
            modes: self.modes.as_deref(),
            angle_noise: self.angle_noise,
            assess: self.assess,
            feeds: self.feeds,
            watch_only: self.watch_only,
            ratios: None,
        }
    }

    fn filter(&self, setting: &FilterContext<'_>, draws: &mut Stream) -> KalmanFilter {
        let body = filter_body(setting.body, self.modes.as_deref());
        let ones = vec![1.0; body.modes.len()];
        let (transition, input) = CoupledMatrices::new(&body, setting.back_emf.0, setting.back_emf.1, &ones)
            .discrete(setting.period);
        let model = FilterModel::new(&body.modes, 0, setting.back_emf, 1, [1.0; 2]);
        let (mean, spread) = start(setting.body, &model, self.initial, &[], self.prior, draws);
        KalmanFilter::new(FilterParameters {
            model,
            prediction: Prediction::Linear(transition, input),
            period: setting.period,
            mean,
            spread,
            moment_noise: self.moment_noise.get(),
            ratio_noise: [0.0; 2],
            angle_noise: self.angle_noise.map_or(setting.angle_noise, Positive::get),
            rate_noise: setting.rate_noise,
            bounds: [1.0; 2],
            gate: 0.0,
            ranking: self.dominant,
        })
    }
}

impl FrequencyTracking {
    fn keys(&self) -> FilterKeys<'_> {
        FilterKeys {
            modes: self.modes.as_deref(),
            angle_noise: self.angle_noise,
            assess: self.assess,
            feeds: self.feeds,
            watch_only: self.watch_only,
            ratios: Some(self.ratios),
        }
    }

    /// Creates the filter for a setting, extended or unscented by `prediction`; `draws` supplies a drawn prior.
    pub fn filter(
        &self,
        setting: &FilterContext<'_>,
        prediction: Prediction,
        draws: &mut Stream,
    ) -> KalmanFilter {
        let body = filter_body(setting.body, self.modes.as_deref());
        let bounds = self.bounds.map(Positive::get);
        let ratios = self.ratios.count(body.modes.len());
        let model = FilterModel::new(&body.modes, ratios, setting.back_emf, self.substeps.get(), bounds);
        let ratio = [self.ratio.get(), self.ratio_sd.get(), self.ratio_rate_sd.get()];
        let (mean, spread) =
            start(setting.body, &model, self.initial, &vec![ratio; ratios], self.prior, draws);
        let angle_noise = self.angle_noise.map_or(setting.angle_noise, Positive::get);
        let mut filter = FilterParameters {
            model,
            prediction,
            period: setting.period,
            mean,
            spread,
            moment_noise: self.moment_noise.get(),
            ratio_noise: [self.ratio_noise.get(), self.ratio_rate_noise.get()],
            angle_noise,
            rate_noise: setting.rate_noise,
            bounds,
            gate: self.gate.get() * angle_noise,
            ranking: self.dominant,
        };
        for index in 0..ratios {
            let index = filter.model.motion_states() + 2 * index;
            filter.mean[index] = filter.mean[index].clamp(bounds[0], bounds[1]);
        }
        KalmanFilter::new(filter)
    }
}

/// Returns the body with the modes of the filter's model.
fn filter_body(body: &AxisModel, modes: Option<&[Mode]>) -> AxisModel {
    let mut filter_body = body.clone();
    if let Some(modes) = modes {
        filter_body.modes = modes.iter().map(Into::into).collect();
    }
    filter_body
}

/// Returns mean and standard deviations at the start; each of `ratios` has its mean, its deviation, and that of its
/// rate.
fn start(
    body: &AxisModel,
    model: &FilterModel,
    initial: FilterInitialDeviations,
    ratios: &[[f64; 3]],
    prior: Prior,
    draws: &mut Stream,
) -> (DVector<f64>, DVector<f64>) {
    let frequencies: Vec<f64> = body.modes.iter().map(|mode| mode.frequency.get()).collect();
    let motion = body.initial_state().to_vector(&frequencies);
    let excitability = |mode: usize| body.modes[mode].excitability().abs();
    let largest = (0..body.modes.len()).map(excitability).fold(0.0, f64::max);
    let mut mean: Vec<f64> = motion.iter().copied().collect();
    let mut spread = vec![initial.angle.get(), initial.rate.get()];
    for mode in 0..body.modes.len() {
        let part = if excitability(mode) == largest { 1.0 } else { 0.1 };
        spread.extend([part * initial.displacement.get(), part * initial.mode_rate.get()]);
    }
    for [ratio, sd, rate_sd] in ratios {
        mean.extend([*ratio, 0.0]);
        spread.extend([*sd, *rate_sd]);
    }
    if prior == Prior::Drawn {
        // The rate of a ratio is unknown: its mean stays 0.
        for (index, (mean, sd)) in mean.iter_mut().zip(&spread).enumerate() {
            if index < model.motion_states() || (index - model.motion_states()).is_multiple_of(2) {
                *mean += sd * draws.normal();
            }
        }
    }
    (DVector::from_vec(mean), DVector::from_vec(spread))
}

impl Default for FrequencyTracking {
    fn default() -> Self {
        Self {
            modes: None,
            moment_noise: moment_noise(),
            angle_noise: None,
            initial: FilterInitialDeviations::default(),
            prior: Prior::default(),
            dominant: Ranking::default(),
            assess: None,
            feeds: None,
            watch_only: false,
            ratios: Ratios::default(),
            ratio: Positive::ONE,
            ratio_sd: ratio_sd(),
            ratio_rate_sd: ratio_rate_sd(),
            ratio_noise: ratio_noise(),
            ratio_rate_noise: ratio_noise(),
            bounds: bounds(),
            substeps: substeps(),
            gate: gate(),
        }
    }
}

impl Default for FilterInitialDeviations {
    fn default() -> Self {
        let known = |sd| NonNegative::new(sd).unwrap_or_default();
        Self { angle: known(1e-4), rate: known(1e-4), displacement: known(2e-3), mode_rate: known(6e-4) }
    }
}

/// Number of prediction steps per period.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct Substeps(#[schemars(range(min = 1, max = 100))] u32);

impl Substeps {
    /// Creates the number if it is 1 to 100.
    pub fn new(value: u32) -> Option<Self> {
        (1..=100).contains(&value).then_some(Self(value))
    }

    /// Returns the number.
    pub const fn get(self) -> u32 {
        self.0
    }
}

impl<'de> Deserialize<'de> for Substeps {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = u32::deserialize(deserializer)?;
        Self::new(value)
            .ok_or_else(|| serde::de::Error::custom(format!("must be 1 to 100 steps, got {value}")))
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn is_false(value: &bool) -> bool {
    !value
}

fn moment_noise() -> NonNegative {
    NonNegative::new(1e-13).unwrap_or_default()
}

fn one() -> Positive {
    Positive::ONE
}

fn ratio_sd() -> NonNegative {
    NonNegative::new(0.03).unwrap_or_default()
}

fn ratio_rate_sd() -> NonNegative {
    NonNegative::new(0.003).unwrap_or_default()
}

fn ratio_noise() -> NonNegative {
    NonNegative::new(1e-8).unwrap_or_default()
}

fn bounds() -> [Positive; 2] {
    [0.1, 3.0].map(|bound| Positive::new(bound).unwrap_or(Positive::ONE))
}

fn substeps() -> Substeps {
    Substeps(2)
}

fn gate() -> NonNegative {
    NonNegative::new(3.0).unwrap_or_default()
}
