//! Random search with learning: a law's gain is moved to reduce an objective, in the paper the mean envelope
//! (\[Silaev\], steps 1-6).
//!
//! After each window the gain moves by a random part of `step`. The sign of the move is kept while the objective
//! falls and reversed when it rises, except for one rise after `memory` falls. From `earliest_freeze` on, the gain
//! is frozen once the objective has changed by less than `tolerance` in `settled` consecutive windows.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Finite, Positive};
use flexsc_numerics::random::{Seed, Stream};
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::Decision;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Adaptation, AdaptationSpec, Objective};
use crate::law::Tunable;
use crate::part::Part;

/// The constants of the search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RandomSearch {
    /// Tuned parameter of the law, by its key within the law's table: `k_t` of a relay (the default), `k_p` of a PD
    /// law, `bandwidth` of an attitude law, `yaw.pd.k_d` of a law `per_axis`.
    #[serde(default = "k_t", skip_serializing_if = "is_k_t")]
    pub tunes: String,
    /// Quantity that is measured over each window and made smaller; default: `envelope_mean`.
    #[serde(default, skip_serializing_if = "Objective::is_default")]
    pub objective: Objective,
    /// Length of the windows (s); for `envelope_mean`, they are those of the `[estimator.envelope]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window: Option<Span>,
    /// Largest move of the gain in one window, delta `k_t`.
    pub step: Positive,
    /// Smallest and largest gain, which include its value at the start; for `k_t` between 0 and 1.
    pub bounds: [Finite; 2],
    /// A relative change of the objective below this counts as settled, `delta_0`.
    #[serde(default = "five_percent")]
    pub tolerance: Positive,
    /// Consecutive settled windows after which the gain is frozen (the paper's six).
    #[serde(default = "six")]
    pub settled: u32,
    /// Consecutive falls of the objective after which one rise is ignored (the paper's four); 0 for never.
    #[serde(default = "four")]
    pub memory: u32,
    /// The gain is not frozen before this time, `T_min` (s).
    #[serde(default = "ten_thousand_seconds")]
    pub earliest_freeze: Span,
    /// Whether the gain is ever frozen.
    #[serde(default = "yes")]
    pub freeze: bool,
}

impl AdaptationSpec for RandomSearch {
    fn tunes(&self) -> &str {
        &self.tunes
    }

    fn objective(&self) -> Objective {
        self.objective
    }

    fn window(&self) -> Option<Span> {
        self.window
    }

    fn start(&self, value: f64, seed: Seed) -> Box<dyn Adaptation> {
        Box::new(RandomSearchRun::new(RandomSearchState::new(self.clone(), value), seed))
    }

    fn bounds_error(&self, number: &Tunable) -> Option<ConfigError> {
        let [low, high] = self.bounds.map(Finite::get);
        if low >= high {
            let why = format!("must be [low, high] in this order, got [{low}, {high}]");
            return Some(ConfigError::new("bounds", why));
        }
        number.validate_bounds([low, high]).map(|why| ConfigError::new("bounds", why))
    }

    fn start_error(&self, value: f64) -> Option<String> {
        let [low, high] = self.bounds.map(Finite::get);
        let is_inside = (low..=high).contains(&value);
        (!is_inside).then(|| format!("must lie within the adaptation's bounds [{low}, {high}], got {value}"))
    }
}

fn k_t() -> String {
    "k_t".to_owned()
}
fn is_k_t(tunes: &str) -> bool {
    tunes == "k_t"
}
fn five_percent() -> Positive {
    Positive::new(0.05).unwrap_or(Positive::ONE)
}
fn six() -> u32 {
    6
}
fn four() -> u32 {
    4
}
fn ten_thousand_seconds() -> Span {
    Span::from_seconds(10_000.0)
}
fn yes() -> bool {
    true
}

/// Step of the search, as logged.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SearchStep {
    /// Decision of the step.
    pub decision: Decision,
    /// Relative change of the objective since the window before; NaN after the first.
    pub change: f64,
    /// Random fraction r of the largest move, in [-1, 1]; 0 when frozen.
    pub draw: f64,
    /// Gain from now on.
    pub gain: f64,
    /// Number of consecutive settled windows.
    pub settled: u32,
}

/// Run-time state of the search, without its random numbers.
#[derive(Clone, Debug)]
pub struct RandomSearchState {
    constants: RandomSearch,
    gain: f64,
    draw: f64,
    previous: Option<f64>,
    falls: u32,
    settled: u32,
    frozen: bool,
}

impl RandomSearchState {
    /// Creates a search that starts from the law's own gain.
    pub fn new(constants: RandomSearch, gain: f64) -> Self {
        Self { constants, gain, draw: 0.0, previous: None, falls: 0, settled: 0, frozen: false }
    }

    /// Updates the search with the objective over the window that ends at `now`, such as the mean envelope, and a
    /// uniform random number in [0, 1). Returns `None` once the gain is frozen.
    pub fn learn(&mut self, now: Instant, mean: f64, uniform: f64) -> Option<SearchStep> {
        if self.frozen {
            return None;
        }
        let Some(previous) = self.previous.replace(mean) else {
            self.draw = 2.0 * uniform - 1.0;
            return Some(self.advance(Decision::Begin, f64::NAN));
        };
        // The objective may stay at 0.
        let change = if mean == previous { 0.0 } else { ((mean - previous) / mean).abs() };
        self.settled = if change < self.constants.tolerance.get() { self.settled + 1 } else { 0 };
        let may_freeze = now.since(Instant::START) >= self.constants.earliest_freeze;
        if self.constants.freeze && may_freeze && self.settled >= self.constants.settled {
            self.frozen = true;
            self.draw = 0.0;
            return Some(self.advance(Decision::Freeze, change));
        }
        let decision = self.judge(mean < previous);
        let direction = if decision == Decision::Turn { -1.0 } else { 1.0 };
        self.draw = (direction * self.draw).signum() * uniform;
        Some(self.advance(decision, change))
    }

    fn judge(&mut self, fell: bool) -> Decision {
        if fell {
            self.falls += 1;
            return Decision::Keep;
        }
        let memory = self.constants.memory;
        let trusted = memory > 0 && self.falls >= memory;
        self.falls = 0;
        if trusted { Decision::Ignore } else { Decision::Turn }
    }

    fn advance(&mut self, decision: Decision, change: f64) -> SearchStep {
        let [low, high] = self.constants.bounds.map(Finite::get);
        self.gain = (self.gain + self.draw * self.constants.step.get()).clamp(low, high);
        let Self { gain, draw, settled, .. } = *self;
        SearchStep { decision, change, draw, gain, settled }
    }
}

/// Run-time state of the search with its random stream, of which each window draws one number.
#[derive(Clone, Debug)]
pub(super) struct RandomSearchRun {
    search: RandomSearchState,
    draws: Stream,
}

impl RandomSearchRun {
    /// Creates a search for a run.
    pub fn new(search: RandomSearchState, seed: Seed) -> Self {
        Self { search, draws: seed.stream("adaptation") }
    }
}

impl Part for RandomSearchRun {}

impl Adaptation for RandomSearchRun {
    fn learn(&mut self, now: Instant, mean: f64) -> Option<SearchStep> {
        self.search.learn(now, mean, self.draws.uniform())
    }

    fn copy(&self) -> Box<dyn Adaptation> {
        Box::new(self.clone())
    }
}
