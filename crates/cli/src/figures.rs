//! The figures of `flexsc plot` as data, for drawing by other programs.

use std::path::Path;

use clap::ValueEnum;
use flexsc_core::Scenario;
use flexsc_core::campaign::{CampaignRun, ColumnCells, CommandLog, RowMaker};
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{Detail, Log};
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Named, Panel, colour};

use crate::memory_log;
use crate::plot::{self, FigureKind};

pub use crate::plot::overlaid;

/// Returns the log, in memory and of this detail, of a run under these commands up to an instant.
///
/// # Errors
/// A failed run.
pub fn log_of(
    run: &CampaignRun,
    commanded: &CommandLog,
    until: Instant,
    detail: Detail,
) -> Result<Log, String> {
    memory_log::log_run(run, commanded, until, Path::new(&run.scenario.name), detail)
        .map_err(|failure| failure.to_string())
}

/// Returns the names of the figures that a log has. The scenario of the run is `known` where the parts of a program are at
/// hand.
///
/// # Errors
/// An invalid log.
pub fn names(log: &Log, path: &Path, known: Option<&Scenario>) -> Result<Vec<String>, String> {
    let drawable = plot::drawable_kinds(log, path, known).map_err(|failure| failure.to_string())?;
    Ok(drawable.into_iter().map(FigureKind::name).collect())
}

/// Returns a figure of a log by its name. The scenario of the run is `known` where the parts of a program are at hand.
///
/// # Errors
/// A figure that the log does not have, or a run that cannot be repeated.
pub fn log_figure(log: &Log, path: &Path, name: &str, known: Option<&Scenario>) -> Result<Figure, String> {
    plot::figure_of(log, path, name, known).map_err(|failure| failure.to_string())
}

/// Returns a figure of a log by its name, from one instant (s) to another; `None` for the end that the figure chooses.
///
/// # Errors
/// As [`log_figure`], or times beyond the run.
pub fn log_figure_between(
    log: &Log,
    path: &Path,
    name: &str,
    times: [Option<f64>; 2],
) -> Result<Figure, String> {
    plot::figure_between(log, path, name, None, times).map_err(|failure| failure.to_string())
}

/// Returns named figures of a campaign from its columns: of the given kind, else the default ones; of the given
/// metrics, else of the main ones that vary.
///
/// # Errors
/// A figure or a metric that the campaign does not have.
pub fn column_figure(
    work: &RowMaker,
    column: &dyn Fn(&str) -> Option<ColumnCells>,
    kind: Option<&str>,
    metrics: &[String],
) -> Result<Vec<Named>, String> {
    let kind = kind.map(|kind| FigureKind::from_str(kind, false)).transpose()?;
    plot::column_figures(work, column, kind, metrics).map_err(|failure| failure.to_string())
}

/// Returns named figures of the campaigns in a directory, as [`column_figure`] does, and a `fan` of their logs.
///
/// # Errors
/// A directory without a campaign, or a figure or a metric that they do not have.
pub fn directory_figures(path: &Path, kind: Option<&str>, metrics: &[String]) -> Result<Vec<Named>, String> {
    let kinds: Vec<FigureKind> =
        kind.map(|kind| FigureKind::from_str(kind, false)).transpose()?.into_iter().collect();
    plot::directory_figures(path, &kinds, metrics).map_err(|failure| failure.to_string())
}

/// Returns a figure of a scenario's natural frequencies and influences, as an overview; `None` without modes.
pub fn modes(frequencies: &[f64], weights: &[f64], (name, unit): (&str, &'static str)) -> Option<Figure> {
    if frequencies.is_empty() {
        return None;
    }
    let x = FigureAxis::decades("natural frequency", "rad/s", frequencies.iter().copied()).in_hertz();
    let y = FigureAxis::from_zero(name, unit, weights.iter().copied());
    let points: Vec<_> = frequencies.iter().copied().zip(weights.iter().copied()).collect();
    let stems = points.iter().flat_map(|(w, height)| [(*w, 0.0), (*w, *height), (f64::NAN, f64::NAN)]);
    let layers = vec![
        Layer::new("", colour::GREY, LayerShape::Line(1.0), stems.collect()),
        Layer::new("", colour::BLUE, LayerShape::Disc, points),
    ];
    let title = format!("{} elastic modes", frequencies.len());
    Some(Figure { title, panels: vec![Panel::new(x, y, layers)], panel_height: 160 })
}
