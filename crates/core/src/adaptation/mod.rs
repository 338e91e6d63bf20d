//! Adaptation loops: they improve a parameter of the law, and never call it.

mod random_search;

use std::any::Any;
use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::own::{Halt, Own};
use crate::random::Seed;
use crate::time::Instant;

pub use random_search::{Decision, RandomSearch, Search, Step};

/// The kinds of adaptation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Adaptation {
    /// Random search with learning, based on the window means of the envelope.
    RandomSearch(RandomSearch),
    /// An adaptation from another crate; a scenario file cannot name it.
    Own(Own<dyn Adapt>),
}

/// What an adaptation from outside tells of itself before a run.
pub trait Adapt: Send + Sync {
    /// The key of the number of the law that it tunes.
    fn tunes(&self) -> &str;

    /// The adaptation at work, of a number that begins with this value.
    fn start(&self, value: f64, seed: Seed) -> Box<dyn Learn>;

    /// What it is, for the program that brought it.
    fn any(&self) -> Option<&dyn Any> {
        None
    }
}

/// An adaptation at work.
pub trait Learn: fmt::Debug + Send + Sync {
    /// Learns the mean envelope (rad) of the window that ends now; nothing of one that has ended.
    fn learn(&mut self, now: Instant, mean: f64) -> Option<Step>;

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

    /// The adaptation at work, of a number that begins with this value.
    pub fn start(&self, value: f64, seed: Seed) -> Box<dyn Learn> {
        match self {
            Self::RandomSearch(constants) => {
                Box::new(random_search::Drawing::new(Search::new(constants.clone(), value), seed))
            }
            Self::Own(own) => own.start(value, seed),
        }
    }
}
