//! Answer of a run or a campaign: its text, and its fields as JSON.

use flexsc_core::answer::{Answer, ScreenOptions};
use pyo3::prelude::*;
use serde_json::json;

/// Answer of a run or a campaign.
#[pyclass(frozen, module = "flexsc._native")]
pub struct RunAnswer(Contents);

enum Contents {
    /// Answer of a run of this process, and the real time that it took (s).
    Made(Box<Answer>, f64),
    /// Fields and texts of a copy.
    Copied { json: String, screen: String, all: String },
}

impl RunAnswer {
    /// Creates the answer of a run that took some real time (s).
    pub fn made(answer: Answer, took: f64) -> Self {
        Self(Contents::Made(Box::new(answer), took))
    }

    /// Creates an answer from its fields as JSON, its first screen, and everything that is known.
    pub fn copied(json: String, screen: String, all: String) -> Self {
        Self(Contents::Copied { json, screen, all })
    }

    fn text(&self, is_all: bool) -> String {
        match &self.0 {
            Contents::Made(answer, took) => {
                answer.screen(Some(*took), ScreenOptions { all: is_all, ..ScreenOptions::default() })
            }
            Contents::Copied { screen, all, .. } => if is_all { all } else { screen }.clone(),
        }
    }
}

#[pymethods]
impl RunAnswer {
    #[new]
    fn new(json: String, screen: String, all: String) -> Self {
        Self::copied(json, screen, all)
    }

    fn __getnewargs__(&self) -> (String, String, String) {
        (self.json(), self.text(false), self.text(true))
    }

    /// Returns the first screen, or everything that is known.
    fn screen(&self, all: bool) -> String {
        self.text(all)
    }

    /// Returns the fields as JSON.
    fn json(&self) -> String {
        match &self.0 {
            Contents::Made(answer, _) => json!(answer).to_string(),
            Contents::Copied { json, .. } => json.clone(),
        }
    }
}
