//! Campaigns for Python: their work as whole parts, on threads here or in other processes, and their directories.

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use flexsc_core::answer::CampaignAnswer;
use flexsc_core::campaign::{
    Campaign, CampaignRun, CampaignRuns, ColumnCells, DesignBlock, Directory as Parts, DirectoryError, ERROR,
    MANIFEST, Manifest, RowMaker as Whole, RunRows, SECONDS,
};
use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_core::metrics::Selection;
use flexsc_core::record::{Detail, StopFlag, Trace};
use flexsc_core::statistics::{QUANTILES, Statistics};
use numpy::{IntoPyArray, PyArray2};
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList};

use super::answer::RunAnswer;
use super::aside::aside;
use super::columns::topics_to_dict;
use super::design::Design;
use super::error::{allowed, no_file, scenario_error};
use super::instants::sizes;
use super::parts::known_thread;
use super::run_logs;
use super::table::column;
use super::{Scenario, detail};

/// Name, unit, number of runs, mean, standard deviation, and quantiles with their values.
type Summary = (String, &'static str, usize, f64, f64, Vec<(f64, f64)>);
/// First run, and the one after the last.
type Span = (u64, u64);

/// Largest number of runs that are started to find one with a sample of the motion.
const MOST_STARTED: usize = 16;

fn failed(error: DirectoryError) -> PyErr {
    match error {
        DirectoryError::Io { source, .. } if run_logs::refusal(&source).is_some() => {
            PyValueError::new_err(run_logs::refusal(&source).unwrap_or_default())
        }
        DirectoryError::Io { path, source } => no_file(&path)(source),
        DirectoryError::Busy { .. } => PyOSError::new_err(error.to_string()),
        DirectoryError::Scenario(error) => scenario_error(error),
        DirectoryError::Interrupted => PyKeyboardInterrupt::new_err(()),
        DirectoryError::Other { .. } | DirectoryError::More { .. } => {
            let hint = "hint: give another directory as `out`, or `force=True` to replace what is there";
            PyValueError::new_err(format!("{error}\n\n{hint}"))
        }
        DirectoryError::Wrong { .. } => PyValueError::new_err(error.to_string()),
    }
}

fn summary(statistics: Statistics) -> Summary {
    let Statistics { name, unit, runs, mean, sd, quantiles, .. } = statistics;
    (name, unit, runs, mean, sd, QUANTILES.into_iter().zip(quantiles).collect())
}

/// A column as numpy has it: integers where none is missing, numbers with NaN, words with empty ones, lists of arrays.
fn array(py: Python<'_>, column: ColumnCells) -> PyResult<Bound<'_, PyAny>> {
    match column {
        ColumnCells::Integers(cells) => match cells.iter().copied().collect::<Option<Vec<i64>>>() {
            Some(integers) => Ok(integers.into_pyarray(py).into_any()),
            None => Ok(ColumnCells::Integers(cells).numbers().into_pyarray(py).into_any()),
        },
        ColumnCells::Numbers(cells) => Ok(cells.into_pyarray(py).into_any()),
        ColumnCells::Text(cells) => {
            Ok(PyList::new(py, cells.into_iter().map(Option::unwrap_or_default))?.into_any())
        }
        ColumnCells::Lists(cells) => {
            let lists = cells.into_iter().map(|cell| cell.unwrap_or_default().into_pyarray(py));
            Ok(PyList::new(py, lists)?.into_any())
        }
    }
}

/// Work that makes the rows of a campaign.
#[pyclass(frozen, module = "flexsc._native")]
pub struct Work(pub Arc<Whole>);

impl Work {
    /// The work, if a file can describe it.
    fn on_file(&self) -> PyResult<&Whole> {
        if self.0.campaign.scenario().has_custom_parts() {
            let why = "the scenario has parts written in Python, which are in this process alone and in no file: leave out \
                       `out` and `progress`, and its runs are made on threads here, or on an `executor`";
            return Err(PyValueError::new_err(why));
        }
        Ok(&self.0)
    }
}

/// Rows, their statistics, and the number of each run that did not fail with its topics.
type SampledRows<'py> = (Bound<'py, PyDict>, Vec<Summary>, Vec<(u64, Bound<'py, PyDict>)>);

#[pymethods]
impl Work {
    /// The work of some runs; `part_s` is the work of a part (s), in place of about 4 s, `drawn` whether `[uncertain]` keys
    /// are drawn, and `log` the detail of the log of each run.
    #[staticmethod]
    #[expect(clippy::too_many_arguments, reason = "the arguments of Python's functions")]
    fn create(
        scenario: &Scenario,
        runs: Span,
        design: &Design,
        metrics: Option<Vec<String>>,
        part_s: Option<f64>,
        yes: bool,
        drawn: bool,
        log: &str,
    ) -> PyResult<Self> {
        let wrong = PyValueError::new_err::<String>;
        let selection = metrics.map_or(Ok(Selection::ALL), Selection::from_names).map_err(wrong)?;
        let inner = scenario.inner.clone();
        let inner = if drawn { inner } else { Campaign::undrawn(inner) };
        let campaign = Campaign::from_design(inner, &scenario.origin, design.0.clone());
        let campaign = campaign.map_err(scenario_error)?;
        let count = runs.1.saturating_sub(runs.0);
        let cost = campaign.cost(count, detail(log)?).map_err(|why| wrong(format!("runs {why}")))?;
        allowed(&cost, yes)?;
        if scenario.inner.has_custom_parts() {
            let whole = Whole::in_memory(campaign, runs.0..runs.1, selection).map_err(wrong)?;
            return Ok(Self(Arc::new(whole)));
        }
        let mut manifest = Manifest::new(&campaign, runs.0..runs.1, &selection).map_err(wrong)?;
        if let Some(part_s) = part_s {
            manifest.limit_part_size(part_s);
        }
        Ok(Self(Arc::new(Whole::from_manifest(manifest, MANIFEST.as_ref()).map_err(failed)?)))
    }

    /// The work of points that need not be accepted: each that is not is a row with an error. `[uncertain]` keys keep their
    /// values.
    #[staticmethod]
    fn for_points(scenario: &Scenario, design: &Design, metrics: Vec<String>, yes: bool) -> PyResult<Self> {
        let wrong = PyValueError::new_err::<String>;
        let selection = Selection::from_names(metrics).map_err(wrong)?;
        let (inner, design) = (Campaign::undrawn(scenario.inner.clone()), design.0.clone());
        let campaign = Campaign::from_unchecked_points(inner, &scenario.origin, design);
        let campaign = campaign.map_err(scenario_error)?;
        let count = campaign.design().runs().unwrap_or_default();
        let cost = campaign.cost(count, None).map_err(|why| wrong(format!("points {why}")))?;
        allowed(&cost, yes)?;
        Ok(Self(Arc::new(Whole::in_memory(campaign, 0..count, selection).map_err(wrong)?)))
    }

    /// The work that a manifest describes.
    #[staticmethod]
    fn parse(manifest: &str) -> PyResult<Self> {
        let manifest =
            Manifest::parse(manifest).map_err(|why| PyValueError::new_err(format!("{MANIFEST}: {why}")))?;
        Ok(Self(Arc::new(Whole::from_manifest(manifest, MANIFEST.as_ref()).map_err(failed)?)))
    }

    /// In what the campaign of another manifest differs.
    fn difference(&self, there: &Self) -> Option<String> {
        there.0.manifest.first_difference(&self.0.manifest)
    }

    #[getter]
    fn manifest(&self) -> PyResult<String> {
        self.on_file().map(|work| work.manifest.to_toml())
    }

    #[getter]
    fn hash(&self) -> &str {
        &self.0.manifest.hash
    }

    #[getter]
    fn runs(&self) -> Span {
        (self.0.manifest.from, self.0.manifest.to)
    }

    /// The keys that vary.
    #[getter]
    fn keys(&self) -> Vec<String> {
        self.0.campaign.keys().map(str::to_owned).collect()
    }

    /// Names of the columns.
    #[getter]
    fn names(&self) -> Vec<&str> {
        let names = self.0.fields().iter().map(|field| field.name.as_str());
        // No two campaigns take the same time.
        names.filter(|name| *name != SECONDS).collect()
    }

    /// The keys all of whose values are booleans.
    #[getter]
    fn flags(&self) -> Vec<String> {
        let of_block = |block: &DesignBlock| match block {
            DesignBlock::Values { keys, points } => {
                let is_flag = |place: usize| points.iter().all(|point| point[place].is_bool());
                keys.iter()
                    .enumerate()
                    .filter(|(place, _)| is_flag(*place))
                    .map(|(_, key)| key.clone())
                    .collect()
            }
            _ => Vec::new(),
        };
        self.0.campaign.design().blocks.iter().flat_map(of_block).collect()
    }

    /// The design, whose text can be kept.
    #[getter]
    fn design(&self) -> Design {
        Design(self.0.campaign.design().clone())
    }

    #[getter]
    fn scenario(&self) -> Scenario {
        let inner = self.0.campaign.scenario().clone();
        Scenario { origin: inner.name.clone(), inner }
    }

    /// The scenario of a run, and the number of the run whose noise it has.
    fn run(&self, number: u64) -> PyResult<(Scenario, u64)> {
        let run = self.0.campaign.run(number).map_err(scenario_error)?;
        Ok((Scenario { origin: run.scenario.name.clone(), inner: run.scenario }, run.noise_run))
    }

    /// Returns this campaign with the runs of another manifest of it too.
    fn joined(&self, there: &Self) -> PyResult<Self> {
        let mut manifest = self.on_file()?.manifest.clone();
        manifest.part = there.0.manifest.part;
        manifest.from = manifest.from.min(there.0.manifest.from);
        manifest.to = manifest.to.max(there.0.manifest.to);
        Ok(Self(Arc::new(Whole::from_manifest(manifest, MANIFEST.as_ref()).map_err(failed)?)))
    }

    /// The parts that are missing beside these files.
    fn missing(&self, files: Vec<String>) -> Vec<Span> {
        spans(self.0.manifest.missing(files.iter().map(String::as_str)))
    }

    /// Makes runs: columns by name, and statistics.
    fn make<'py>(
        &self,
        py: Python<'py>,
        runs: Span,
        jobs: usize,
    ) -> PyResult<(Bound<'py, PyDict>, Vec<Summary>)> {
        let work = self.0.clone();
        let (rows, statistics) =
            aside(py, move |stop| made(&work, rows(&work, runs, jobs, stop)?))?.map_err(failed)?;
        Ok((columns_to_dict(py, rows)?, statistics.into_iter().map(summary).collect()))
    }

    /// The number of values in a sample of the motion of a run, by topic; empty if the first runs fail at their start.
    fn sample_sizes(&self, py: Python<'_>) -> PyResult<BTreeMap<String, usize>> {
        let work = self.0.clone();
        aside(py, move |stop| {
            (work.manifest.from..work.manifest.to)
                .take(MOST_STARTED)
                .filter_map(|number| work.campaign.run(number).ok())
                .map(|run| sizes(&run, stop.clone()))
                .find(|sizes| !sizes.is_empty())
                .unwrap_or_default()
        })
    }

    /// Makes runs one by one with their motion at increasing times (s): columns by name, statistics, and for each run that did
    /// not fail its number with its topics, all of them or some.
    fn make_at<'py>(
        &self,
        py: Python<'py>,
        runs: Span,
        jobs: usize,
        times: Vec<f64>,
        topics: Option<Vec<String>>,
    ) -> PyResult<SampledRows<'py>> {
        let (work, traces) = (self.0.clone(), Arc::new(Mutex::new(BTreeMap::new())));
        let kept = Arc::clone(&traces);
        let (rows, statistics) = aside(py, move |stop| {
            let is_own = work.campaign.scenario().has_custom_parts();
            let simulate = move |run: &CampaignRun, stop| {
                let mut samples = Trace::new(Detail::Full);
                let metrics = known_thread(is_own, || {
                    Campaign::simulate_at(run, &Selection::ALL, &times, stop, &mut samples)
                })?;
                let columns: Vec<_> = samples
                    .into_columns()
                    .filter(|(name, _)| topics.as_ref().is_none_or(|topics| topics.contains(name)))
                    .collect();
                kept.lock().unwrap_or_else(PoisonError::into_inner).insert(run.number, columns);
                Ok(metrics)
            };
            made(&work, work.make_rows_singly(runs.0..runs.1, jobs, stop, simulate)?)
        })?
        .map_err(failed)?;
        let traces = std::mem::take(&mut *traces.lock().unwrap_or_else(PoisonError::into_inner));
        let topics = traces.into_iter().map(|(run, columns)| Ok((run, topics_to_dict(py, columns)?)));
        let topics = topics.collect::<PyResult<_>>()?;
        Ok((columns_to_dict(py, rows)?, statistics.into_iter().map(summary).collect(), topics))
    }

    /// Makes runs: metrics as numbers, of shape (runs, metrics), and the first error.
    fn numbers<'py>(
        &self,
        py: Python<'py>,
        runs: Span,
        jobs: usize,
        metrics: Vec<String>,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Option<String>)> {
        let work = self.0.clone();
        let rows = aside(py, move |stop| rows(&work, runs, jobs, stop))?.map_err(failed)?;
        let columns = metrics.iter().map(|name| match rows.column(name) {
            None => Err(PyValueError::new_err(format!("the scenario has no metric {name:?}"))),
            Some(column) if matches!(*column, ColumnCells::Lists(_)) => Err(PyValueError::new_err(format!(
                "the metric {name:?} is a list: name an element, such as \"{name}[0]\""
            ))),
            Some(column) => Ok(column.numbers()),
        });
        let columns = columns.collect::<PyResult<Vec<_>>>()?;
        let row = |row: usize| columns.iter().map(|column| column[row]).collect::<Vec<_>>();
        let numbers: Vec<Vec<f64>> = (0..rows.len()).map(row).collect();
        let error = rows.column(ERROR).and_then(|column| match &*column {
            ColumnCells::Text(errors) => errors.iter().flatten().next().cloned(),
            _ => None,
        });
        Ok((PyArray2::from_vec2(py, &numbers)?, error))
    }

    /// Makes a part: the name of its file, and its bytes.
    fn part<'py>(&self, py: Python<'py>, runs: Span, jobs: usize) -> PyResult<(String, Bound<'py, PyBytes>)> {
        let work = self.0.clone();
        let (name, bytes) = aside(py, move |stop| work.part(runs.0..runs.1, jobs, stop))?.map_err(failed)?;
        Ok((name, PyBytes::new(py, &bytes)))
    }
}

/// Returns rows with their statistics.
fn made(work: &Whole, rows: RunRows) -> Result<(RunRows, Vec<Statistics>), DirectoryError> {
    let columns = |names: &[&str]| -> Result<_, DirectoryError> {
        Ok(names.iter().map(|name| rows.column(name).map(Cow::into_owned)).collect())
    };
    let statistics = work.statistics(rows.len(), columns)?;
    Ok((rows, statistics))
}

/// Returns rows as arrays by the names of their columns.
fn columns_to_dict(py: Python<'_>, rows: RunRows) -> PyResult<Bound<'_, PyDict>> {
    let RunRows { fields, columns } = rows;
    let reported = PyDict::new(py);
    for (field, column) in fields.iter().zip(columns) {
        reported.set_item(&field.name, array(py, column)?)?;
    }
    Ok(reported)
}

/// Simulates runs, on threads that Python knows if parts are written in it.
fn rows(work: &Whole, runs: Span, jobs: usize, stop: StopFlag) -> Result<RunRows, DirectoryError> {
    let is_own = work.campaign.scenario().has_custom_parts();
    let simulate = move |run: &CampaignRun, selection: &Selection, stop| {
        known_thread(is_own, || Campaign::simulate_metrics(run, selection, stop))
    };
    work.make_rows_with(runs.0..runs.1, jobs, stop, simulate)
}

/// The statistics of a campaign's columns.
#[pyfunction]
pub fn campaign_statistics(
    py: Python<'_>,
    work: &Work,
    columns: HashMap<String, Bound<'_, PyAny>>,
    rows: usize,
) -> PyResult<Vec<Summary>> {
    let columns: HashMap<String, ColumnCells> =
        columns.iter().map(|(name, object)| Ok((name.clone(), column(object)?))).collect::<PyResult<_>>()?;
    let work = work.0.clone();
    let reported = aside(py, move |_| {
        let selection_of = |names: &[&str]| -> Result<_, DirectoryError> {
            Ok(names.iter().map(|name| columns.get(*name).cloned()).collect())
        };
        work.statistics(rows, selection_of)
    })?;
    Ok(reported.map_err(failed)?.into_iter().map(summary).collect())
}

/// The names of the columns from which the answer of a campaign is made, besides its varied keys.
#[pyfunction]
pub fn answer_columns() -> Vec<&'static str> {
    CampaignRuns::columns().collect()
}

/// The answer of a campaign's columns.
#[pyfunction]
pub fn campaign_answer(
    py: Python<'_>,
    work: &Work,
    columns: HashMap<String, Bound<'_, PyAny>>,
) -> PyResult<RunAnswer> {
    let columns: HashMap<String, ColumnCells> =
        columns.iter().map(|(name, object)| Ok((name.clone(), column(object)?))).collect::<PyResult<_>>()?;
    let work = work.0.clone();
    let answer = aside(py, move |_| -> Result<_, DirectoryError> {
        let selection_of = |names: &[&str]| -> Result<_, DirectoryError> {
            Ok(names.iter().map(|name| columns.get(*name).cloned()).collect())
        };
        let runs = work.campaign_runs(selection_of)?;
        Ok(CampaignAnswer::new(work.campaign.scenario(), &runs, None, None, ReaderUnits::default()))
    })?
    .map_err(failed)?;
    Ok(RunAnswer::for_campaign(answer))
}

fn spans(ranges: Vec<Range<u64>>) -> Vec<Span> {
    ranges.into_iter().map(|runs| (runs.start, runs.end)).collect()
}

/// The directory of a campaign.
#[pyclass(frozen, module = "flexsc._native")]
pub struct Directory(Arc<Parts>);

#[pymethods]
impl Directory {
    /// Begins a directory, or continues one, which has no other runs unless these are a part; it is locked as long as
    /// this lives.
    #[staticmethod]
    fn create(py: Python<'_>, path: PathBuf, work: &Work, part: bool, force: bool) -> PyResult<Self> {
        let manifest = work.on_file()?.manifest.clone();
        let create = if part { Parts::create } else { Parts::create_whole };
        let made = aside(py, move |_| create(&path, manifest, force))?;
        Ok(Self(Arc::new(made.map_err(failed)?)))
    }

    #[staticmethod]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        Ok(Self(Arc::new(aside(py, move |_| Parts::open(&path))?.map_err(failed)?)))
    }

    #[getter]
    fn work(&self) -> Work {
        Work(Arc::new(self.0.work().clone()))
    }

    /// Makes a part, with the log of each run unless `log` is `none`.
    fn write_part(
        &self,
        py: Python<'_>,
        runs: Span,
        jobs: usize,
        log: &str,
        force: bool,
    ) -> PyResult<PathBuf> {
        let (directory, runs) = (self.0.clone(), runs.0..runs.1);
        let work: Box<dyn FnOnce(StopFlag) -> _ + Send> = match detail(log)? {
            None => Box::new(move |stop| directory.write_part(runs, jobs, stop)),
            Some(detail) => {
                Box::new(move |stop| run_logs::write_part(&directory, runs, jobs, (detail, force), stop))
            }
        };
        aside(py, work)?.map_err(failed)
    }

    /// Writes the table of the statistics.
    fn write_statistics(&self, py: Python<'_>) -> PyResult<()> {
        let directory = self.0.clone();
        let written = aside(py, move |_| {
            flexsc_cli::write_statistics_of(&directory).map_err(|error| error.to_string())
        })?;
        written.map_err(PyOSError::new_err)
    }

    /// The bytes of one file with all rows, of this ending.
    fn table<'py>(&self, py: Python<'py>, ending: String) -> PyResult<Bound<'py, PyBytes>> {
        let directory = self.0.clone();
        let encoded = aside(py, move |_| {
            flexsc_cli::encode_table(&directory, &ending).map_err(|error| error.to_string())
        })?;
        Ok(PyBytes::new(py, &encoded.map_err(PyValueError::new_err)?))
    }

    /// A column of all rows.
    fn column<'py>(&self, py: Python<'py>, name: String) -> PyResult<Option<Bound<'py, PyAny>>> {
        let directory = self.0.clone();
        let column = aside(py, move |_| directory.column(&name))?.map_err(failed)?;
        column.map(|column| array(py, column)).transpose()
    }

    fn statistics(&self, py: Python<'_>) -> PyResult<Vec<Summary>> {
        let directory = self.0.clone();
        let reported = aside(py, move |_| directory.summary())?.map_err(failed)?;
        Ok(reported.statistics.into_iter().map(summary).collect())
    }
}
