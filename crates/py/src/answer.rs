//! Answer of a run or a campaign, or two side by side: text, and fields as JSON.

use flexsc_core::answer::{
    Answer, CampaignAnswer, CampaignComparison, KeyDifference, RunComparison, ScreenOptions,
};
use flexsc_core::formats::reader_units::ReaderUnits;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::Serialize;
use serde_json::json;

use super::Scenario;
use super::aside::aside;
use super::log::Log;

/// Answer of a run or a campaign, or two answers side by side.
#[pyclass(frozen, module = "flexsc._native")]
pub struct RunAnswer(Contents);

enum Contents {
    /// Answer of a run of this process, and the real time that it took (s), if it is known.
    Made(Box<Answer>, Option<f64>),
    /// Answer of a campaign.
    Campaign(Box<CampaignAnswer>),
    /// Fields and texts of a copy, or of two answers side by side.
    Copied { json: String, screen: String, all: String },
}

fn options(all: bool) -> ScreenOptions {
    ScreenOptions { all, ..ScreenOptions::default() }
}

impl RunAnswer {
    /// Creates the answer of a run that took some real time (s).
    pub fn for_run(answer: Answer, took: Option<f64>) -> Self {
        Self(Contents::Made(Box::new(answer), took))
    }

    /// Creates the answer of a campaign.
    pub fn for_campaign(answer: CampaignAnswer) -> Self {
        Self(Contents::Campaign(Box::new(answer)))
    }

    /// Creates the answer of a comparison from its fields and its text, of which `true` asks for all.
    fn for_comparison(fields: &impl Serialize, screen: impl Fn(bool) -> String) -> Self {
        Self(Contents::Copied { json: json!(fields).to_string(), screen: screen(false), all: screen(true) })
    }

    fn text(&self, is_all: bool) -> String {
        match &self.0 {
            Contents::Made(answer, took) => answer.screen(*took, options(is_all)),
            Contents::Campaign(answer) => answer.screen(None, options(is_all)),
            Contents::Copied { screen, all, .. } => if is_all { all } else { screen }.clone(),
        }
    }
}

#[pymethods]
impl RunAnswer {
    #[new]
    fn new(json: String, screen: String, all: String) -> Self {
        Self(Contents::Copied { json, screen, all })
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
            Contents::Campaign(answer) => json!(answer).to_string(),
            Contents::Copied { json, .. } => json.clone(),
        }
    }

    /// True for a copy, which has fields as JSON, and texts, alone.
    #[getter]
    fn copied(&self) -> bool {
        matches!(self.0, Contents::Copied { .. })
    }
}

/// The scenario of a log, and the answer of its run, which is repeated, or of its rows.
#[pyfunction]
pub fn log_answer(py: Python<'_>, log: &Log) -> PyResult<(Scenario, RunAnswer)> {
    let log = log.0.clone();
    let answer = aside(py, move |_| flexsc_cli::answer_of_log(&log, log.path(), ReaderUnits::default()))?;
    let (inner, answer) = answer.map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok((Scenario { origin: inner.name.clone(), inner }, RunAnswer::for_run(answer, None)))
}

/// Two answers side by side, with the keys in which their scenarios differ.
#[pyfunction]
pub fn compare(
    names: [String; 2],
    scenarios: (PyRef<'_, Scenario>, PyRef<'_, Scenario>),
    answers: (PyRef<'_, RunAnswer>, PyRef<'_, RunAnswer>),
) -> PyResult<RunAnswer> {
    let keys = KeyDifference::between([&scenarios.0.inner, &scenarios.1.inner], ReaderUnits::default());
    match (&answers.0.0, &answers.1.0) {
        (Contents::Made(a, _), Contents::Made(b, _)) => {
            let both = RunComparison { names, keys, answers: [(**a).clone(), (**b).clone()] };
            Ok(RunAnswer::for_comparison(&both, |all| both.screen(options(all))))
        }
        (Contents::Campaign(a), Contents::Campaign(b)) => {
            let both = CampaignComparison { names, keys, answers: [(**a).clone(), (**b).clone()] };
            Ok(RunAnswer::for_comparison(&both, |all| both.screen(options(all))))
        }
        _ => Err(PyValueError::new_err("takes two runs or two campaigns, not one of each")),
    }
}
