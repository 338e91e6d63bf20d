//! The figures of the command, as SVG and as what they consist of.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::{fs, io};

use flexsc_cli::figures;
use flexsc_core::analysis::mode_influence::ModeInfluences;
use flexsc_core::analysis::one_axis_modes::OneAxisModes;
use flexsc_core::campaign::ColumnCells;
use flexsc_core::record::Detail;
use flexsc_core::spacecraft::body::BodyAxes;
use flexsc_figure::{FigureAxis, Layer, LayerShape, Named, Panel, RGBColor, Renderer, Scale, Strip, Style};
use numpy::PyArray2;
use pyo3::exceptions::{PyFileExistsError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::aside::aside;
use super::campaign::Work;
use super::commands::Commands;
use super::files::write;
use super::log::Log;
use super::parts;
use super::table::column;
use super::{Scenario, detail};

/// Largest number of ticks of a logarithmic axis.
const TICKS: u32 = 8;

/// A figure.
#[pyclass(frozen, module = "flexsc._native")]
pub struct Figure(Arc<flexsc_figure::Figure>);

fn shared(figures: Vec<Named>) -> Vec<(String, Figure)> {
    figures.into_iter().map(|(name, figure)| (name, Figure(Arc::new(figure)))).collect()
}

fn hex(RGBColor(red, green, blue): RGBColor) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

#[pymethods]
impl Figure {
    #[getter]
    fn title(&self) -> &str {
        &self.0.title
    }

    /// Height of each panel's plot in pixels; every figure is 800 wide.
    #[getter]
    fn panel_height(&self) -> u32 {
        self.0.panel_height
    }

    fn svg(&self) -> PyResult<String> {
        self.0.svg().map_err(PyValueError::new_err)
    }

    /// Writes the figure as a file: `svg`, `png` or `pdf` by its ending, of a width (mm) and letters of a size (pt) if given. A
    /// file that is no figure of flexsc stays unless `force` is set.
    fn save(
        &self,
        py: Python<'_>,
        path: PathBuf,
        width: Option<f64>,
        font: Option<f64>,
        force: bool,
    ) -> PyResult<()> {
        let style = Style::new(width, font).map_err(PyValueError::new_err)?;
        let figure = Arc::clone(&self.0);
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        // What cannot be read stays as well: it may be another file.
        let is_free = match fs::read(&path) {
            Ok(bytes) => flexsc_figure::is_figure(&bytes),
            Err(error) => error.kind() == io::ErrorKind::NotFound,
        };
        if !is_free && !force {
            let why = format!(
                "{} is there and is no figure of flexsc: give force=True to replace it",
                path.display()
            );
            return Err(PyFileExistsError::new_err(why));
        }
        let bytes = aside(py, move |_| {
            let drawn = figure.laid_out(&style)?;
            match ending.as_deref() {
                Some("svg") => Ok(style.sized(&drawn).into_bytes()),
                Some("png") => Renderer::default().png(&drawn, &style),
                Some("pdf") => Renderer::default().pdf(&style.sized(&drawn)),
                _ => Err("path must end in .svg, .png or .pdf".to_owned()),
            }
        })?;
        write(path, &bytes.map_err(PyValueError::new_err)?)
    }

    /// The panels, from top to bottom.
    fn panels<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        self.0
            .panels
            .iter()
            .zip(&self.0.upward())
            .map(|(layered_panel, y)| panel(py, layered_panel, y))
            .collect()
    }
}

fn panel<'py>(py: Python<'py>, panel: &Panel, y: &FigureAxis) -> PyResult<Bound<'py, PyDict>> {
    let reported = PyDict::new(py);
    reported.set_item("x", axis(py, &panel.x)?)?;
    reported.set_item("y", axis(py, y)?)?;
    let layers =
        panel.layers.iter().map(|drawn_layer| layer(py, drawn_layer)).collect::<PyResult<Vec<_>>>()?;
    reported.set_item("layers", layers)?;
    let bar = panel.bar.as_ref().map(|bar| {
        (bar.name.as_str(), bar.colours.iter().copied().map(hex).collect::<Vec<_>>(), bar.edges.clone())
    });
    reported.set_item("bar", bar)?;
    let spans = |strip: &Strip| -> Vec<(f64, f64, String, String)> {
        strip.spans.iter().map(|span| (span.from, span.to, span.name.clone(), hex(span.colour))).collect()
    };
    let strips: Vec<_> = panel.strips.iter().map(|strip| (strip.name.as_str(), spans(strip))).collect();
    reported.set_item("strips", strips)?;
    let notes = panel.notes.iter().map(|note| (note.text.as_str(), note.at.0, note.at.1, hex(note.colour)));
    reported.set_item("notes", notes.collect::<Vec<_>>())?;
    reported.set_item("remark", &panel.remark)?;
    reported.set_item("plain", panel.is_plain)?;
    Ok(reported)
}

fn axis<'py>(py: Python<'py>, axis: &FigureAxis) -> PyResult<Bound<'py, PyDict>> {
    let reported = PyDict::new(py);
    reported.set_item("label", axis.label())?;
    reported.set_item("unit", axis.unit)?;
    reported.set_item("low", axis.range.start)?;
    reported.set_item("high", axis.range.end)?;
    reported.set_item("factor", axis.factor())?;
    reported.set_item("logarithmic", axis.scale == Scale::Logarithmic)?;
    let ticks = axis.ticks(TICKS);
    let texts: Vec<(f64, String)> = ticks.at.iter().map(|value| (*value, ticks.text(*value))).collect();
    reported.set_item("ticks", texts)?;
    Ok(reported)
}

fn layer<'py>(py: Python<'py>, layer: &Layer) -> PyResult<Bound<'py, PyDict>> {
    let (shape, size) = match layer.shape {
        LayerShape::Line(width) => ("line", width),
        LayerShape::Dashes => ("dashes", 1.0),
        LayerShape::Area(opacity) => ("area", opacity),
        LayerShape::Disc => ("disc", 1.0),
        LayerShape::Dot => ("dot", 1.0),
        LayerShape::Ring => ("ring", 1.0),
        LayerShape::Triangle => ("triangle", 1.0),
        LayerShape::Square => ("square", 1.0),
        LayerShape::Diamond => ("diamond", 1.0),
        LayerShape::Cross => ("cross", 1.0),
        LayerShape::Stroke => ("stroke", 1.0),
    };
    let reported = PyDict::new(py);
    reported.set_item("name", &layer.name)?;
    reported.set_item("colour", hex(layer.colour))?;
    reported.set_item("shape", shape)?;
    reported.set_item("size", size)?;
    let points: Vec<Vec<f64>> = [|p: &(f64, f64)| p.0, |p: &(f64, f64)| p.1]
        .map(|coordinate| layer.points.iter().map(coordinate).collect())
        .into();
    reported.set_item("points", PyArray2::from_vec2(py, &points)?)?;
    Ok(reported)
}

/// The name that a log's errors give it.
fn place(log: &Log) -> PathBuf {
    log.0.metadata().get("scenario").map_or("log", String::as_str).into()
}

/// A log of a run in memory, with its events, or with its rows if `detail` is `full`.
#[pyfunction]
pub fn log_of(
    py: Python<'_>,
    scenario: &Scenario,
    run: u64,
    log: &str,
    stepped: Option<&Commands>,
) -> PyResult<Log> {
    let detail = detail(log)?.unwrap_or_default().min(Detail::Full);
    let (run, is_own) = (scenario.run(run), scenario.inner.has_custom_parts());
    let Commands { commands, until } = Commands::from_stepped(stepped);
    let log =
        aside(py, move |_| parts::known_thread(is_own, || figures::log_of(&run, &commands, until, detail)))?;
    Ok(Log(Arc::new(log.map_err(PyValueError::new_err)?)))
}

/// The names of the figures that a log has. The scenario, if given, is that of the run, with its parts in Python.
#[pyfunction]
pub fn log_figures(py: Python<'_>, log: &Log, scenario: Option<&Scenario>) -> PyResult<Vec<String>> {
    let (path, log) = (place(log), log.0.clone());
    let known = scenario.map(|scenario| scenario.inner.clone());
    aside(py, move |_| figures::names(&log, &path, known.as_ref()))?.map_err(PyValueError::new_err)
}

/// The figure of a log by its name. The scenario, if given, is that of the run, with its parts in Python.
#[pyfunction]
pub fn log_figure(py: Python<'_>, log: &Log, name: String, scenario: Option<&Scenario>) -> PyResult<Figure> {
    let (path, log) = (place(log), log.0.clone());
    let known = scenario.map(|scenario| scenario.inner.clone());
    let is_own = known.as_ref().is_some_and(|known| known.has_custom_parts());
    let figure = aside(py, move |_| {
        parts::known_thread(is_own, || figures::log_figure(&log, &path, &name, known.as_ref()))
    })?;
    Ok(Figure(Arc::new(figure.map_err(PyValueError::new_err)?)))
}

/// The figures of several runs, each with its name, over each other; of two with their difference.
#[pyfunction]
pub fn overlaid_figure(subject: &str, runs: Vec<(String, PyRef<'_, Figure>)>) -> PyResult<Figure> {
    let runs: Vec<_> = runs.into_iter().map(|(name, figure)| (name, Arc::clone(&figure.0))).collect();
    let why = "the figures of these runs have other axes, and cannot be drawn over each other";
    figures::overlaid(subject, &runs)
        .map(|figure| Figure(Arc::new(figure)))
        .ok_or_else(|| PyValueError::new_err(why))
}

/// The figures of a campaign's columns: of a kind, or the natural ones.
#[pyfunction]
pub fn campaign_figures(
    py: Python<'_>,
    work: &Work,
    columns: HashMap<String, Bound<'_, PyAny>>,
    kind: Option<String>,
    metrics: Vec<String>,
) -> PyResult<Vec<(String, Figure)>> {
    let columns: HashMap<String, ColumnCells> =
        columns.iter().map(|(name, object)| Ok((name.clone(), column(object)?))).collect::<PyResult<_>>()?;
    let work = work.0.clone();
    let drawn = aside(py, move |_| {
        figures::column_figure(&work, &|name| columns.get(name).cloned(), kind.as_deref(), &metrics)
    })?;
    Ok(shared(drawn.map_err(PyValueError::new_err)?))
}

/// The figures of the campaigns in a directory.
#[pyfunction]
pub fn directory_figures(
    py: Python<'_>,
    path: PathBuf,
    kind: Option<String>,
    metrics: Vec<String>,
) -> PyResult<Vec<(String, Figure)>> {
    let drawn = aside(py, move |_| figures::directory_figures(Path::new(&path), kind.as_deref(), &metrics))?;
    Ok(shared(drawn.map_err(PyValueError::new_err)?))
}

/// The modes of a scenario; none of a rigid body.
#[pyfunction]
pub fn modes_figure(scenario: &Scenario) -> Option<Figure> {
    let size = |values: &[f64]| values.iter().map(|value| value.abs()).collect::<Vec<_>>();
    let figure = match scenario.inner.model.axes() {
        BodyAxes::One(body) => {
            let modal = OneAxisModes::from_body(body);
            figures::modes(&modal.frequencies_rad_s, &size(&modal.gains), ("modal gain", ""))
        }
        BodyAxes::Three(body) => {
            let influences = ModeInfluences::from_scenario(&scenario.inner, body);
            let most =
                |mode: usize| influences.influences.iter().map(|axis| axis[mode].abs()).fold(0.0, f64::max);
            let most: Vec<f64> = (0..influences.frequencies_rad_s.len()).map(most).collect();
            figures::modes(&influences.frequencies_rad_s, &most, ("influence", ""))
        }
    };
    figure.map(|figure| Figure(Arc::new(figure)))
}
