//! Export of runs and scenarios in the formats of other programs.

use std::fs;
use std::path::{Path, PathBuf};

use flexsc_core::record::{self, Detail, LogBytes, RunEnd, atomic_file};
use flexsc_core::scenario::date_from_text;
use flexsc_cosim::{CoSimulationError, FmiVersion, FmuContent, FmuPart, Platform, fmu_bytes};
use flexsc_handover::{HandoverError, HandoverFormat, HandoverOptions, hand_over, hand_over_run};
use flexsc_view::scene::Scene;
use flexsc_view::with_layout;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::aside::aside;
use crate::commands::Commands;
use crate::log::Log;
use crate::{Scenario, error, parts};

/// Format and options of an export.
#[derive(Clone)]
#[pyclass(frozen, module = "flexsc._native")]
pub struct ExportOptions {
    format: HandoverFormat,
    options: HandoverOptions,
}

#[pymethods]
impl ExportOptions {
    #[new]
    #[pyo3(signature = (format, epoch, frame, center, object_id, speed, modes))]
    fn new(
        format: &str,
        epoch: Option<&str>,
        frame: Option<String>,
        center: Option<String>,
        object_id: Option<String>,
        speed: Option<f64>,
        modes: bool,
    ) -> PyResult<Self> {
        let wrong = |why: String| PyValueError::new_err(why);
        let names = HandoverFormat::ALL.map(|(name, _)| format!("'{name}'")).join(", ");
        let format = HandoverFormat::from_name(format)
            .ok_or_else(|| wrong(format!("format must be one of {names}, got '{format}'")))?;
        let date = |text: &str| {
            let accepted = "a date and time from 1970 to 2500, such as '2026-03-20T14:46:00Z'";
            date_from_text(text).ok_or_else(|| wrong(format!("epoch must be {accepted}, got '{text}'")))
        };
        if let Some(speed) = speed.filter(|speed| !(1e-6..=1e9).contains(speed)) {
            return Err(wrong(format!("speed must be from 1e-6 to 1e9, got {speed}")));
        }
        let epoch_ns = epoch.map(date).transpose()?;
        let options = HandoverOptions { epoch_ns, frame, center, object_id, speed, mode_shapes: modes };
        Ok(Self { format, options })
    }
}

/// Exports the run of a log; returns the size of the file in bytes.
#[pyfunction]
pub fn export_log(py: Python<'_>, log: &Log, options: &ExportOptions, path: PathBuf) -> PyResult<u64> {
    let (log, ExportOptions { format, options }) = (log.0.clone(), options.clone());
    let bytes = aside(py, move |_| hand_over(&log, format, &options))?.map_err(handover_error)?;
    write(&path, &bytes)
}

/// Exports a run, which is simulated again with its scene; returns the size of the file in bytes.
#[pyfunction]
pub fn export_run(
    py: Python<'_>,
    scenario: &Scenario,
    run: u64,
    options: &ExportOptions,
    path: PathBuf,
    stepped: Option<&Commands>,
) -> PyResult<u64> {
    let (run, is_own) = (scenario.run(run), scenario.inner.has_custom_parts());
    let Commands { commands, until } = Commands::from_stepped(stepped);
    let ExportOptions { format, options } = options.clone();
    let place = PathBuf::from(scenario.name());
    let exported = aside(py, move |stop| {
        let provenance = with_layout(commands.provenance(&run), &run.scenario, Detail::Scene);
        let mut log = LogBytes::new(&provenance, Detail::Scene)?;
        let scene = Scene::new(&run.scenario);
        let metrics =
            parts::known_thread(is_own, || commands.simulate(&run, until, ((&mut log, scene), stop)))?;
        let bytes = log.finish(&metrics, RunEnd::at(until, run.scenario.duration))?;
        let log = record::Log::read(&place, bytes).map_err(HandoverError::from);
        Ok(log.and_then(|log| hand_over_run(&log, &run.scenario, format, &options)))
    })?;
    let bytes = exported.map_err(|error| error::unwritten(&path, scenario.name(), error))?;
    write(&path, &bytes.map_err(handover_error)?)
}

/// Exports a scenario as an FMU with this library; returns the size of the file in bytes.
#[pyfunction]
pub fn export_fmu(
    py: Python<'_>,
    scenario: &Scenario,
    path: PathBuf,
    fmi: u8,
    part: &str,
    library: PathBuf,
) -> PyResult<u64> {
    let wrong = |why: String| PyValueError::new_err(why);
    let version = match fmi {
        2 => FmiVersion::V2,
        3 => FmiVersion::V3,
        _ => return Err(wrong(format!("fmi must be 2 or 3, got {fmi}"))),
    };
    let fmu_error = |failure: CoSimulationError| match failure {
        CoSimulationError::Scenario(error) => error::scenario_error(error),
        other => wrong(other.to_string()),
    };
    let content = FmuPart::from_name(part).and_then(|part| FmuContent::new(&scenario.inner, part));
    let content = content.map_err(fmu_error)?;
    let unread = |error| wrong(format!("cannot read the library of FMUs, {}: {error}", library.display()));
    let library = fs::read(&library).map_err(unread)?;
    let bytes = aside(py, move |_| fmu_bytes(&content, &[(Platform::host()?, library)], version))?
        .map_err(fmu_error)?;
    write(&path, &bytes)
}

fn write(path: &Path, bytes: &[u8]) -> PyResult<u64> {
    atomic_file::write(path, bytes).map_err(error::no_file(path))?;
    Ok(bytes.len() as u64)
}

/// The exception of a hand-over.
fn handover_error(error: HandoverError) -> PyErr {
    match error {
        HandoverError::Log(error) => error::log_error(error),
        // The option of the command is a keyword here.
        other => PyValueError::new_err(
            other.to_string().replace("`--epoch ", "`epoch=").replace("--epoch", "epoch"),
        ),
    }
}
