//! Adaptation loops: they tune a parameter of the law to reduce an objective.

mod objective;
mod random_search;

use std::any::Any;

use flexsc_numerics::random::Seed;
use flexsc_numerics::time::{Instant, Span};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::custom::Custom;
use crate::part::Part;

pub use flexsc_record::Decision;
pub use objective::Objective;
pub use random_search::{RandomSearch, RandomSearchState, SearchStep};

/// The kinds of adaptation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Adaptation")]
pub enum AdaptationKind {
    /// Random search with learning, based on an objective over consecutive windows.
    RandomSearch(RandomSearch),
    /// An adaptation from another crate; a scenario file cannot name it.
    Own(Custom<dyn AdaptationSpec>),
}

/// Settings of an adaptation that another crate provides.
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

    /// Returns the run-time state of the adaptation, for a parameter that starts at `value`.
    fn start(&self, value: f64, seed: Seed) -> Box<dyn Adaptation>;

    /// Returns the concrete type behind the trait, so that the providing program can downcast it; `None` by default.
    fn any(&self) -> Option<&dyn Any> {
        None
    }
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
    /// Returns the key of the law's parameter that is tuned.
    pub fn tunes(&self) -> &str {
        match self {
            Self::RandomSearch(search) => &search.tunes,
            Self::Own(own) => own.tunes(),
        }
    }

    /// Returns the objective that is evaluated over each window.
    pub fn objective(&self) -> Objective {
        match self {
            Self::RandomSearch(search) => search.objective,
            Self::Own(own) => own.objective(),
        }
    }

    /// Returns the length of the windows, unless they are those of the envelope.
    pub fn window(&self) -> Option<Span> {
        match self {
            Self::RandomSearch(search) => search.window,
            Self::Own(own) => own.window(),
        }
    }

    /// Returns the name of the kind, as in a scenario.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::RandomSearch(_) => "random_search",
            Self::Own(_) => "own",
        }
    }

    /// Returns the run-time state of the adaptation, for a parameter that starts at `value`.
    pub fn start(&self, value: f64, seed: Seed) -> Box<dyn Adaptation> {
        match self {
            Self::RandomSearch(constants) => Box::new(random_search::RandomSearchRun::new(
                RandomSearchState::new(constants.clone(), value),
                seed,
            )),
            Self::Own(own) => own.start(value, seed),
        }
    }
}
