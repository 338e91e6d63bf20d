//! Facts about an adaptation of another crate that a log keeps: in figures of the log they are in place of the adaptation,
//! which is not started.

use flexsc_numerics::random::Seed;
use flexsc_numerics::time::{Instant, Span};
use serde::{Deserialize, Serialize};

use super::{Adaptation, AdaptationSpec, Objective, SearchStep};
use crate::part::Part;

/// Facts about a custom adaptation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AdaptationFacts {
    /// Key of the tuned parameter.
    tunes: String,
    /// Key of the objective.
    objective: String,
    /// Length of the windows (s), unless they are those of the envelope.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    window_s: Option<f64>,
}

impl AdaptationFacts {
    /// Collects the facts about an adaptation.
    pub fn from_adaptation(adaptation: &dyn AdaptationSpec) -> Self {
        Self {
            tunes: adaptation.tunes().to_owned(),
            objective: adaptation.objective().key().to_owned(),
            window_s: adaptation.window().map(Span::seconds),
        }
    }
}

impl AdaptationSpec for AdaptationFacts {
    fn tunes(&self) -> &str {
        &self.tunes
    }

    fn objective(&self) -> Objective {
        Objective::from_key(&self.objective).unwrap_or_default()
    }

    fn window(&self) -> Option<Span> {
        self.window_s.filter(|window| window.is_finite() && *window > 0.0).map(Span::from_seconds)
    }

    fn start(&self, _: f64, _: Seed) -> Box<dyn Adaptation> {
        Box::new(Ended)
    }
}

/// Adaptation that has ended.
#[derive(Debug)]
struct Ended;

impl Part for Ended {}

impl Adaptation for Ended {
    fn learn(&mut self, _: Instant, _: f64) -> Option<SearchStep> {
        None
    }

    fn copy(&self) -> Box<dyn Adaptation> {
        Box::new(Self)
    }
}
