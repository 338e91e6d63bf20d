//! Adaptation loops: they improve a parameter of the law, and never call it.

mod objective;
mod random_search;

use std::any::Any;
use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::own::{Halt, Own};
use crate::random::Seed;
use crate::time::{Instant, Span};

pub use crate::record::Decision;
pub use objective::Objective;
pub use random_search::{RandomSearch, SearchState, SearchStep};

/// The kinds of adaptation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Adaptation {
    /// Random search with learning, based on an objective over consecutive windows.
    RandomSearch(RandomSearch),
    /// An adaptation from another crate; a scenario file cannot name it.
    Own(Own<dyn Adapt>),
}

/// What an adaptation from outside tells of itself before a run.
pub trait Adapt: Send + Sync {
    /// The key of the number of the law that it tunes.
    fn tunes(&self) -> &str;

    /// What it measures over each window.
    fn objective(&self) -> Objective {
        Objective::default()
    }

    /// Length of the windows; none of the envelope's mean, whose windows are those of its monitor.
    fn window(&self) -> Option<Span> {
        None
    }

    /// The adaptation at work, of a number that begins with this value.
    fn start(&self, value: f64, seed: Seed) -> Box<dyn Learn>;

    /// What it is, for the program that brought it.
    fn any(&self) -> Option<&dyn Any> {
        None
    }
}

/// An adaptation at work.
pub trait Learn: fmt::Debug + Send + Sync {
    /// Learns the objective over the window that ends now; tells nothing once it has ended.
    fn learn(&mut self, now: Instant, measured: f64) -> Option<SearchStep>;

    /// Why it cannot go on, of one from outside that cannot: the run ends there.
    fn halted(&self) -> Option<Halt> {
        None
    }

    /// A copy in the same state.
    fn copy(&self) -> Box<dyn Learn>;
}

impl Clone for Box<dyn Learn> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

impl Adaptation {
    /// The key of the number of the law that it tunes.
    pub fn tunes(&self) -> &str {
        match self {
            Self::RandomSearch(search) => &search.tunes,
            Self::Own(own) => own.tunes(),
        }
    }

    /// What it measures over each window.
    pub fn objective(&self) -> Objective {
        match self {
            Self::RandomSearch(search) => search.objective,
            Self::Own(own) => own.objective(),
        }
    }

    /// Length of the windows, unless they are those of the envelope.
    pub fn window(&self) -> Option<Span> {
        match self {
            Self::RandomSearch(search) => search.window,
            Self::Own(own) => own.window(),
        }
    }

    /// The kind, as a scenario names it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::RandomSearch(_) => "random_search",
            Self::Own(_) => "own",
        }
    }

    /// The adaptation at work, of a number that begins with this value.
    pub fn start(&self, value: f64, seed: Seed) -> Box<dyn Learn> {
        match self {
            Self::RandomSearch(constants) => {
                Box::new(random_search::Drawing::new(SearchState::new(constants.clone(), value), seed))
            }
            Self::Own(own) => own.start(value, seed),
        }
    }
}
