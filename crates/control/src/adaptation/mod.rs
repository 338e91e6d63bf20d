//! Adaptation loops: they tune a parameter of the law to reduce an objective.

mod adaptation_facts;
mod objective;
mod random_search;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::{Instant, Span};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::kinds::kinds;
use crate::law::Tunable;
use crate::offers::Offers;
use crate::part::Part;

pub use adaptation_facts::AdaptationFacts;
pub use flexsc_record::Decision;
pub use objective::Objective;
pub use random_search::{RandomSearch, RandomSearchState, SearchStep};

kinds! {
    /// The kinds of adaptation.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[schemars(rename = "Adaptation")]
    pub enum AdaptationKind: dyn AdaptationSpec {
        /// Random search with learning, based on an objective over consecutive windows.
        "random_search" RandomSearch(RandomSearch),
    }
    own "An adaptation from another crate; a scenario file cannot name it."
}

/// Settings of an adaptation.
pub trait AdaptationSpec: Send + Sync {
    /// Returns the key of the law's parameter that is tuned.
    fn tunes(&self) -> &str;

    /// Returns the objective that is evaluated over each window.
    fn objective(&self) -> Objective {
        Objective::default()
    }

    /// Returns the length of the windows; `None` for the mean envelope, whose windows are those of its monitor.
    fn window(&self) -> Option<Span> {
        None
    }

    /// Checks the bounds against the parameter that is tuned; returns a key within the adaptation and the reason.
    fn bounds_error(&self, _number: &Tunable) -> Option<ConfigError> {
        None
    }

    /// Returns the reason why the initial value of the parameter is outside the bounds, if it is.
    fn start_error(&self, _value: f64) -> Option<String> {
        None
    }

    /// Returns the run-time state of the adaptation, for a parameter that starts at `value`.
    fn start(&self, value: f64, seed: Seed) -> Box<dyn Adaptation>;
}

/// Run-time state of an adaptation.
pub trait Adaptation: Part {
    /// Updates the adaptation with the objective over the window that ends at `now`. Returns its step; `None` once it
    /// has ended.
    fn learn(&mut self, now: Instant, measured: f64) -> Option<SearchStep>;

    /// Returns a copy in the same state.
    fn copy(&self) -> Box<dyn Adaptation>;
}

impl Clone for Box<dyn Adaptation> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

impl AdaptationKind {
    /// Checks that the objective can be measured; returns a key within the adaptation and the reason.
    pub fn objective_error(&self, offers: &Offers) -> Option<ConfigError> {
        let (objective, window) = (self.objective(), self.window());
        let at = |key: &str, why: String| Some(ConfigError::new(key, why));
        if objective == Objective::EnvelopeMean {
            if offers.estimator.is_none_or(|estimator| !estimator.is_envelope) {
                let why = "needs the window means of an `[estimator.envelope]`, and there is none: give it one, or another \
                           `objective`";
                return at("", why.to_owned());
            }
            let why =
                "follows from the `[estimator.envelope]`: leave it out for the objective `envelope_mean`";
            return window.and_then(|_| at("window", why.to_owned()));
        }
        let word = objective.key();
        if window.is_none_or(|window| window == Span::ZERO) {
            return at("window", format!("must be given for the objective `{word}`"));
        }
        objective.obstacle(offers).and_then(|why| at("objective", format!("`{word}` {why}")))
    }
}
