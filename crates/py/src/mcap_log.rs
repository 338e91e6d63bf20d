//! Log files of runs, with the layout and the scene for viewers.

use std::path::PathBuf;

use flexsc_core::record::{LogFile, RunEnd};
use flexsc_view::scene::Scene;
use flexsc_view::with_layout;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::aside::aside;
use crate::commands::Commands;
use crate::{Scenario, detail, error, parts};

/// Writes the log of a run as an MCAP file; returns its size in bytes.
#[pyfunction]
pub fn to_mcap(
    py: Python<'_>,
    scenario: &Scenario,
    run: u64,
    log: &str,
    path: PathBuf,
    stepped: Option<&Commands>,
) -> PyResult<u64> {
    let none = || PyValueError::new_err("log must be 'events', 'full' or 'scene' for a file");
    let (run, detail) = (scenario.run(run), detail(log)?.ok_or_else(none)?);
    let Commands { commands, until } = Commands::from_stepped(stepped);
    let (place, is_own) = (path.clone(), scenario.inner.has_custom_parts());
    let written = aside(py, move |stop| {
        let provenance = with_layout(commands.provenance(&run), &run.scenario, detail);
        let mut file = LogFile::create(&place, &provenance, detail)?;
        let scene = Scene::for_detail(&run.scenario, detail);
        let metrics =
            parts::known_thread(is_own, || commands.simulate(&run, until, ((&mut file, scene), stop)))?;
        Ok(file.finish(&metrics, RunEnd::at(until, run.scenario.duration))?)
    })?;
    written.map_err(|error| error::unwritten(&path, scenario.name(), error))
}
