//! `flexsc._native`: arguments translated, the engine called once, errors mapped.

#![expect(
    clippy::needless_pass_by_value,
    reason = "Python's arguments come, and errors are mapped, as values"
)]

mod analysis;
mod answer;
mod arrow;
mod aside;
mod campaign;
mod columns;
mod commands;
mod copies;
mod design;
mod error;
mod figures;
mod files;
mod handover;
mod instants;
mod linear;
mod log;
mod matrix_file;
mod mcap_log;
mod parts;
mod run_logs;
mod stepping;
mod table;

use std::ffi::OsString;
use std::fmt;
use std::path::PathBuf;

use flexsc_core::analysis::body_poles::WhirlPoles;
use flexsc_core::analysis::mode_influence::ModeInfluences;
use flexsc_core::analysis::one_axis_modes::OneAxisModes;
use flexsc_core::answer::RunObserver;
use flexsc_core::campaign::{Campaign, CampaignRun};
use flexsc_core::formats::document::ConfigError;
use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_core::metrics::Selection;
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{Detail, Trace};
use flexsc_core::requirement_verdict::validate_metrics;
use flexsc_core::spacecraft::body::BodyAxes;
use flexsc_core::{Document, ScenarioError};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::json;

use answer::RunAnswer;
use aside::aside;
use commands::Commands;
use error::{allowed, scenario_error, simulation_error};

#[pymodule]
mod _native {
    #[pymodule_export]
    use super::analysis::{analysis, persistence, plan_torque};
    #[pymodule_export]
    use super::answer::{RunAnswer, compare, log_answer};
    #[pymodule_export]
    use super::arrow::{arrow_schema, arrow_stream};
    #[pymodule_export]
    use super::campaign::{Directory, Work, answer_columns, campaign_answer, campaign_statistics};
    #[pymodule_export]
    use super::commands::Commands;
    #[pymodule_export]
    use super::copies::Simulators;
    #[pymodule_export]
    use super::design::Design;
    #[pymodule_export]
    use super::error::{LogError, ScenarioError, SimulationError};
    #[pymodule_export]
    use super::figures::{
        Figure, campaign_figures, directory_figures, log_figure, log_figures, log_of, modes_figure,
        overlaid_figure,
    };
    #[pymodule_export]
    use super::files::{table_ending, write};
    #[pymodule_export]
    use super::handover::{ExportOptions, export_fmu, export_log, export_run};
    #[pymodule_export]
    use super::instants::{MotionSampler, sample_sizes};
    #[pymodule_export]
    use super::linear::{common_margins, linearise, sampled};
    #[pymodule_export]
    use super::log::{Log, log_run};
    #[pymodule_export]
    use super::matrix_file::matrix_market;
    #[pymodule_export]
    use super::mcap_log::to_mcap;
    #[pymodule_export]
    use super::parts::{
        Aim, Authority, Demanded, Draws, Effort, Event, Hold, Instant, Known, Load, Reading, Setting, Sky,
        Stream, Taken, ThreeAxisEvent, ThreeAxisHold, Truth, beside_parts, parts_of, text_beside_parts,
        with_parts,
    };
    #[pymodule_export]
    use super::stepping::Simulator;
    #[pymodule_export]
    use super::{Scenario, examples, main, simulate};
    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}

/// A valid scenario, and what errors call it.
#[pyclass(frozen, eq, module = "flexsc._native")]
#[derive(Clone)]
struct Scenario {
    inner: flexsc_core::Scenario,
    origin: String,
}

impl PartialEq for Scenario {
    fn eq(&self, other: &Self) -> bool {
        self.inner == other.inner
    }
}

impl Scenario {
    fn new(origin: &str, inner: Result<flexsc_core::Scenario, ScenarioError>) -> PyResult<Self> {
        let checked = inner.and_then(|inner| {
            let at = |fault: ConfigError| Document::from_table(origin, inner.to_table()).at_key(&fault);
            validate_metrics(&inner).map_err(at)?;
            Ok(inner)
        });
        Ok(Self { inner: checked.map_err(scenario_error)?, origin: origin.to_owned() })
    }

    fn read(document: &Document) -> PyResult<Self> {
        Self::new(document.origin(), flexsc_core::Scenario::from_document(document))
    }

    /// The error of a key.
    fn key_error(&self, fault: ConfigError) -> PyErr {
        let ConfigError { key, why, .. } = fault;
        scenario_error(ScenarioError::Key { origin: self.inner.name.clone(), key, why })
    }

    /// The error that a reason is, with the name of the scenario.
    fn error(&self, why: &impl fmt::Display) -> PyErr {
        PyValueError::new_err(format!("{}: {why}", self.inner.name))
    }

    /// The scenario as it is, as this run.
    fn run(&self, number: u64) -> CampaignRun {
        CampaignRun::new(self.inner.clone(), number)
    }
}

#[pymethods]
impl Scenario {
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let read = aside(py, move |_| {
            let document = Document::load(&path)?;
            let inner = flexsc_core::Scenario::from_document(&document)?;
            validate_metrics(&inner).map_err(|fault| document.at_key(&fault))?;
            Ok(Self { inner, origin: document.origin().to_owned() })
        })?;
        read.map_err(scenario_error)
    }

    #[staticmethod]
    fn parse(text: &str, name: &str) -> PyResult<Self> {
        let scenario = Self::new(name, flexsc_core::Scenario::parse(name, text))?;
        if text.parse().is_ok_and(|written: toml::Table| written.contains_key("name")) {
            return Ok(scenario);
        }
        // The engine would take a part of the name only, as if it were that of a file.
        scenario.with_keys(vec![("name".to_owned(), toml::Value::from(name).to_string())])
    }

    /// Reads generated TOML, into which no error needs to point.
    #[staticmethod]
    fn from_values(text: &str, name: &str) -> PyResult<Self> {
        let document = Document::parse(name, text.to_owned()).map_err(scenario_error)?;
        Self::read(&Document::from_table(name, document.table().clone()))
    }

    fn with_keys(&self, keys: Vec<(String, String)>) -> PyResult<Self> {
        let mut document = Document::from_table(&self.origin, self.inner.table_without_custom_parts());
        for (key, value) in keys {
            document.set_text(&key, &value).map_err(scenario_error)?;
        }
        Self::new(&self.origin, flexsc_core::Scenario::from_document_reusing(&document, &self.inner))
    }

    /// Returns true if a scenario of these kinds has a key, also one that has its default.
    fn has_key(&self, key: &str) -> bool {
        self.inner.has_key(key)
    }

    fn in_mode(&self, name: &str) -> PyResult<Self> {
        Self::new(&self.origin, self.inner.in_mode(name))
    }

    fn draw(&self, run: u64) -> PyResult<Self> {
        let campaign = Campaign::new(self.inner.clone(), &self.origin, []).map_err(scenario_error)?;
        Self::new(&self.origin, campaign.run(run).map(|run| run.scenario))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.inner.name
    }

    #[getter]
    fn seed(&self) -> u64 {
        self.inner.seed
    }

    #[getter]
    fn duration(&self) -> f64 {
        self.inner.duration.seconds()
    }

    #[getter]
    fn mode_count(&self) -> usize {
        self.inner.mode_count()
    }

    #[getter]
    fn spatial(&self) -> bool {
        self.inner.axis_count() == 3
    }

    /// The remarks on values that are accepted and probably not meant, each with its key.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        let own = (!self.inner.own_disturbances.is_empty()).then(|| {
            let why = "acts in runs alone: margins, noise, linear models and the linear part of budgets leave out one that is written in Python or compiled";
            ConfigError::new("disturbance", why)
        });
        self.inner.remarks().iter().chain(&own).map(ToString::to_string).collect()
    }

    fn modes_json(&self) -> String {
        match self.inner.model.axes() {
            BodyAxes::One(body) => json!(OneAxisModes::from_body(body)).to_string(),
            BodyAxes::Three(body) => json!(ModeInfluences::from_scenario(&self.inner, body)).to_string(),
        }
    }

    /// Returns the frequency (rad/s) and damping ratio of each pole with the wheels that points of the structure carry at a speed.
    fn whirl_poles(&self, speed: Option<f64>) -> PyResult<Vec<(f64, f64)>> {
        let found = WhirlPoles::from_scenario(&self.inner, speed).map_err(|fault| self.key_error(fault))?;
        let poles = found.map_or_else(Vec::new, |found| found.poles);
        Ok(poles.into_iter().map(|pole| (pole.frequency_rad_s, pole.damping)).collect())
    }

    fn to_toml(&self) -> String {
        self.inner.to_toml()
    }

    fn to_json(&self) -> String {
        json!(self.inner.to_table()).to_string()
    }
}

/// Returns the detail of a log of this name; `None` for `none`.
fn detail(log: &str) -> PyResult<Option<Detail>> {
    match log {
        "none" => Ok(None),
        "events" => Ok(Some(Detail::Events)),
        "full" => Ok(Some(Detail::Full)),
        "scene" => Ok(Some(Detail::Scene)),
        _ => {
            let why = format!("log must be 'events', 'full', 'scene' or 'none', got {log:?}");
            Err(PyValueError::new_err(why))
        }
    }
}

/// Metrics, topics, answer and, at chosen times, the topics there.
type SimulatedRun<'py> = (Bound<'py, PyDict>, Bound<'py, PyDict>, RunAnswer, Option<Bound<'py, PyDict>>);

#[pyfunction]
fn simulate<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    run: u64,
    log: &str,
    yes: bool,
    stepped: Option<&Commands>,
    at: Option<Vec<f64>>,
) -> PyResult<SimulatedRun<'py>> {
    allowed(&scenario.inner.cost(detail(log)?, true), yes)?;
    let (run, mut trace) = (scenario.run(run), detail(log)?.map(Trace::new));
    let Commands { commands, until } = Commands::from_stepped(stepped);
    let is_own = scenario.inner.has_custom_parts();
    let (mut observer, began) = (RunObserver::new(&scenario.inner), std::time::Instant::now());
    let (metrics, trace, observed, samples) = aside(py, move |stop| {
        let record = (&mut observer, (&mut trace, stop));
        let mut samples = at.as_ref().map(|_| Trace::new(Detail::Full));
        let metrics = parts::known_thread(is_own, || match (&at, &mut samples) {
            (Some(at), Some(samples)) => Campaign::simulate_at(&run, &Selection::ALL, at, record, samples),
            _ => commands.simulate(&run, until, record),
        });
        (metrics, trace, Some(observer.finish()).filter(|_| until == Instant::END), samples)
    })?;
    let metrics = metrics.map_err(|error| simulation_error(scenario.name(), error))?;
    let topics = columns::topics_to_dict(py, trace.into_iter().flat_map(Trace::into_columns))?;
    let samples = samples.map(|trace| columns::topics_to_dict(py, trace.into_columns())).transpose()?;
    let answer = flexsc_core::answer::Answer::new(
        &scenario.inner,
        &metrics,
        observed.as_ref(),
        ReaderUnits::Engineering,
    );
    Ok((
        columns::metrics_to_dict(py, &metrics)?,
        topics,
        RunAnswer::for_run(answer, Some(began.elapsed().as_secs_f64())),
        samples,
    ))
}

/// Names and texts of the shipped scenarios.
#[pyfunction]
fn examples() -> Vec<(&'static str, &'static str)> {
    flexsc_cli::EXAMPLES.to_vec()
}

#[pyfunction]
fn main(py: Python<'_>, args: Vec<OsString>) -> u8 {
    py.detach(|| flexsc_cli::main(args))
}
