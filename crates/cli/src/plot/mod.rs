//! `flexsc plot`: the figures of a log or of a campaign, as SVG and PNG.

mod accelerations;
mod angle;
mod assessed_mean;
mod attitude_filter;
mod campaign;
mod columns;
mod consistency;
mod cycle_data;
mod dead_zone;
mod deflection;
mod drives;
mod empty_panels;
mod envelope;
mod estimate;
mod extra_loop;
mod figure_kind;
mod figure_name;
mod figure_spec;
mod fine_mirror;
mod flywheel;
mod frequency;
mod gain;
mod gimbals;
mod hinges;
mod identified_frequencies;
mod interpolation;
mod judged_run;
mod line_of_sight;
mod magnetorquers;
mod manoeuvre_torque;
mod modes;
mod motion;
mod orbit;
mod outputs;
mod overlay;
mod phase_plane;
mod pointing;
mod repeated_run;
mod requirement;
mod requirement_lines;
mod run_events;
mod running_mean;
mod stale_check;
mod strips;
mod three_axis;
mod time_range;
mod title;
mod topic;
mod torque;
mod torques;
mod wheels;

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use flexsc_core::Scenario;
use flexsc_core::record::{Log, Orbit, Wheels};
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Named, colour, round_to_nice};

use crate::error::CliError;
use crate::figure_files::{FigureFormat, FigureLook, FigureTarget};
use crate::quantity::in_unit;
pub use campaign::{column_figures, directory_figures};
use cycle_data::{CycleData, RowSource};
pub use figure_kind::FigureKind;
pub use figure_name::FigureName;
use figure_name::FigureNameParser;
use figure_spec::{FigureSpec, MotionPart, RunData};
use judged_run::JudgedRun;
use motion::MotionData;
pub use overlay::overlaid;
pub use run_events::RunEvents;
pub use title::readable;
use title::title;

#[derive(clap::Args)]
pub struct PlotArgs {
    /// Log file, or directory of a campaign
    #[arg(value_name = "LOG|DIR")]
    path: PathBuf,
    /// More logs, overlaid on the first with one colour per log
    #[arg(value_name = "LOG")]
    others: Vec<PathBuf>,
    /// Directory for the figures, created if missing, or one FILE.svg, .png or .pdf for all of them; of a campaign also FILE.html, a
    /// page that explores it [default: beside the log or in the campaign's directory]
    #[arg(short, long, value_name = "DIR|FILE")]
    out: Option<PathBuf>,
    /// Figures to draw [default: all of a log; the usual ones of a campaign]
    #[arg(long, value_parser = FigureNameParser, value_delimiter = ',', value_name = "FIGURES")]
    what: Vec<FigureName>,
    /// Format of the figures [default: svg and png, or by the extension of FILE]
    #[arg(long, value_enum)]
    format: Option<FigureFormat>,
    /// Replace a FILE of other content, and files in DIR that are no figures of flexsc
    #[arg(long, requires = "out")]
    force: bool,
    #[command(flatten)]
    look: FigureLook,
    /// Start of the time range to show (s) [default: chosen by the figure]
    #[arg(long, value_name = "TIME", value_parser = in_unit("s"))]
    from: Option<f64>,
    /// End of the time range to show (s) [default: the end of the run]
    #[arg(long, value_name = "TIME", value_parser = in_unit("s"))]
    to: Option<f64>,
    /// Draw the pointing error about each axis, not its norm
    #[arg(long)]
    axes: bool,
    /// Campaigns: metrics to plot and to list the worst runs of [default: the main ones that vary]
    #[arg(long, value_delimiter = ',', value_name = "METRICS")]
    metric: Vec<String>,
    /// Campaigns: number of worst runs to list per metric [default: 3]
    #[arg(long, value_name = "N")]
    worst: Option<usize>,
    /// Print one JSON object per file and per worst run to stdout
    #[arg(long)]
    json: bool,
}

impl PlotArgs {
    /// Returns the figures of a log over the requested time.
    fn figures_of(&self, path: &Path, asked: &[FigureName]) -> Result<Vec<(String, Figure)>, CliError> {
        let log = Log::open(path)?;
        if !self.json {
            stale_check::warn_if_stale(&log, path);
        }
        let part = ShownPart { from: self.from, to: self.to, is_by_axis: self.axes };
        drawn_over(&log, path, asked, part, RunSource { known: None, is_noted: !self.json })
    }

    /// Returns the figures that all logs have in common, the lines of all logs in each.
    fn together(&self) -> Result<Vec<(String, Figure)>, CliError> {
        let paths: Vec<&Path> =
            std::iter::once(&self.path).chain(&self.others).map(PathBuf::as_path).collect();
        let all =
            paths.iter().map(|path| self.figures_of(path, &self.what)).collect::<Result<Vec<_>, _>>()?;
        in_common(&paths, all)
    }
}

/// Returns the figures that two logs have in common, the lines of both in each.
pub fn overlaid_logs(logs: [(&Path, &Log); 2]) -> Result<Vec<Named>, CliError> {
    let drawn =
        |(path, log): (&Path, &Log)| drawn_over(log, path, &[], ShownPart::default(), RunSource::default());
    let all = logs.into_iter().map(drawn).collect::<Result<Vec<_>, _>>()?;
    in_common(&logs.map(|(path, _)| path), all)
}

/// Returns the figures that all runs have, by their names, the lines of all runs in each.
fn in_common(paths: &[&Path], runs: Vec<Vec<(String, Figure)>>) -> Result<Vec<(String, Figure)>, CliError> {
    let names: Vec<String> = paths
        .iter()
        .map(|path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned())
        .collect();
    // Logs of the same name in several directories are distinguished by their paths.
    let name = |run: usize| {
        let is_unique = names.iter().filter(|name| **name == names[run]).count() == 1;
        if is_unique { names[run].clone() } else { paths[run].display().to_string() }
    };
    let mut figures = Vec::new();
    let mut runs = runs;
    let kinds: Vec<String> = runs[0].iter().map(|(kind, _)| kind.clone()).collect();
    for kind in kinds {
        let mut same_kind = Vec::new();
        for (run, figures) in runs.iter_mut().enumerate() {
            if let Some(place) = figures.iter().position(|(other, _)| *other == kind) {
                same_kind.push((name(run), figures.swap_remove(place).1));
            }
        }
        if same_kind.len() == paths.len() {
            let title = kind.replace('-', " ");
            figures.extend(overlaid(&title, &same_kind).map(|figure| (kind, figure)));
        }
    }
    if figures.is_empty() {
        let why = "these logs have no figure with the same axes, which could show them together";
        return Err(CliError::Arguments(format!("{why}\n\nhint: draw them one by one")));
    }
    Ok(figures)
}

/// Interval of time that figures show (s), by default that which each figure chooses, and whether the pointing error is shown
/// about each axis.
#[derive(Copy, Clone, Default)]
struct ShownPart {
    from: Option<f64>,
    to: Option<f64>,
    is_by_axis: bool,
}

/// Source of a run that is repeated.
#[derive(Copy, Clone, Default)]
struct RunSource<'a> {
    /// Scenario with the parts of a program, if they are at hand.
    known: Option<&'a Scenario>,
    /// True if a repetition is noted on the terminal.
    is_noted: bool,
}

/// Returns the figure of a log in memory by its name; errors refer to the log as `path`. The scenario of the run is `known`
/// where the parts of a program are at hand.
///
/// # Errors
/// A figure that the log does not have, or a run that cannot be repeated.
pub fn figure_of(log: &Log, path: &Path, name: &str, known: Option<&Scenario>) -> Result<Figure, CliError> {
    figure_between(log, path, name, known, [None; 2])
}

/// Returns the figure of a log in memory by its name, from one instant (s) to another, as [`figure_of`] does.
///
/// # Errors
/// As [`figure_of`], or times beyond the run.
pub fn figure_between(
    log: &Log,
    path: &Path,
    name: &str,
    known: Option<&Scenario>,
    [from, to]: [Option<f64>; 2],
) -> Result<Figure, CliError> {
    let Ok(kind) = FigureName::parse(name) else {
        let there: Vec<String> =
            drawable_kinds(log, path, known)?.into_iter().map(FigureKind::name).collect();
        let why = format!("there is no figure '{name}' for it; it has {}", there.join(", "));
        return Err(CliError::Arguments(why));
    };
    let source = RunSource { known, is_noted: false };
    let part = ShownPart { from, to, is_by_axis: false };
    let drawn = drawn_over(log, path, &[kind], part, source)?.into_iter().next();
    let nothing = || CliError::Draw { path: path.to_owned(), why: format!("figure {name}: nothing to draw") };
    drawn.map(|(_, figure)| figure).ok_or_else(nothing)
}

/// Returns the figures that are drawn of a log if none is named.
pub fn drawable_kinds(log: &Log, path: &Path, known: Option<&Scenario>) -> Result<Vec<FigureKind>, CliError> {
    Ok(FigureKind::usual_in(&RunEvents::read(log, path, known)?))
}

pub fn run(args: &PlotArgs) -> Result<(), CliError> {
    if args.path.is_dir() {
        let log_options = [
            ("more than one path", !args.others.is_empty()),
            ("--from", args.from.is_some()),
            ("--to", args.to.is_some()),
            ("--axes", args.axes),
        ];
        if let Some((is_given, _)) = log_options.into_iter().find(|(_, is_given)| *is_given) {
            let path = args.path.display();
            return Err(CliError::Arguments(format!("{is_given}: only for logs, and {path} is a directory")));
        }
        return campaign::run(args);
    }
    let campaign_options = [("metric", !args.metric.is_empty()), ("worst", args.worst.is_some())];
    if let Some((option, _)) = campaign_options.into_iter().find(|(_, is_given)| *is_given) {
        let path = args.path.display();
        return Err(CliError::Arguments(format!("--{option}: {path} is not the directory of a campaign")));
    }
    let directory = args.path.parent().unwrap_or(Path::new(""));
    let logs: Vec<&Path> = std::iter::once(&args.path).chain(&args.others).map(PathBuf::as_path).collect();
    let target = FigureTarget::new(args.out.as_deref().unwrap_or(directory), args.format, &logs, args.force)?;
    let name = args.path.file_stem().unwrap_or_default().to_string_lossy();
    let figures =
        if args.others.is_empty() { args.figures_of(&args.path, &args.what)? } else { args.together()? };
    let named = figures.into_iter().map(|(kind, figure)| (format!("{name}-{kind}"), figure));
    target.save(&args.look.finished(named.collect())?, args.look.style()?, args.json)
}

/// Returns figures of a log over an interval of time, if given: the named ones, or all that it has.
fn drawn_over(
    log: &Log,
    path: &Path,
    asked: &[FigureName],
    ShownPart { from, to, is_by_axis }: ShownPart,
    source: RunSource<'_>,
) -> Result<Vec<(String, Figure)>, CliError> {
    let (kinds, topics) = FigureName::split(asked);
    let of_topic = |topic: &str| Ok((topic.replace('/', "topic-"), topic::figure(log, path, topic)?));
    let figures = topics.into_iter().map(of_topic).collect::<Result<Vec<_>, CliError>>()?;
    if kinds.is_empty() && !figures.is_empty() {
        let end = figures.iter().flat_map(|(_, figure)| &figure.panels).map(|panel| panel.x.range.end);
        let shown = time_range::resolve(from, to, end.fold(0.0, f64::max))?;
        let crop = |figure| shown.iter().fold(figure, time_range::crop);
        return Ok(figures.into_iter().map(|(name, figure)| (name, crop(figure))).collect());
    }
    let mut story = RunEvents::read(log, path, source.known)?;
    story.is_noted = source.is_noted;
    story.is_by_axis = is_by_axis;
    story.shown = time_range::resolve(from, to, story.end)?;
    for name in asked {
        if let FigureName::Requirement(name) = name {
            story.requirements.push(requirement::index_of(&story, name)?);
        }
    }
    let is_of_all =
        |name: &FigureName| matches!(name, FigureName::Kind(kind) if kind.name() == requirement::SPEC.name);
    if asked.iter().any(is_of_all) {
        story.requirements.clear();
    }
    let usual = FigureKind::usual_in(&story);
    let wanted = if kinds.is_empty() { &usual } else { &kinds };
    let chosen = figure_kind::select(wanted, &FigureKind::all_in(&story)).map_err(|(missing, there)| {
        let path = path.display();
        CliError::Arguments(format!(
            "{path}: there is no figure `{missing}` for this log\n\nhint: it has {there}"
        ))
    })?;
    let chosen: Vec<&FigureSpec> = chosen.into_iter().filter_map(FigureKind::log_spec).collect();
    let is_three_axis = story.scenario.axis_count() == 3;
    let part = chosen.iter().map(|spec| spec.motion).max().unwrap_or(MotionPart::Nothing);
    let mut rows: Vec<RowSource> = chosen.iter().flat_map(|spec| spec.rows).copied().collect();
    // Every figure has strips of eclipses and of wheels at limits; a run that is repeated has them anyway.
    for source in [RowSource::new::<Orbit>(), RowSource::new::<Wheels>()] {
        let has_rows = log.topics().iter().any(|topic| topic == source.topic);
        if has_rows && !rows.is_empty() && rows.iter().all(|other| other.topic != source.topic) {
            rows.push(source);
        }
    }
    let cycles = if is_three_axis && !rows.is_empty() {
        CycleData::read(&story, log, path, &rows)?
    } else {
        CycleData::default()
    };
    let motion = if is_three_axis || part == MotionPart::Nothing {
        MotionData::default()
    } else if part == MotionPart::All || !story.switches() {
        story.motion(log, path, 0.0, 0.0)?
    } else if part == MotionPart::Ends {
        let late = phase_plane::late(&story).min(swings(&story).start).min(torque::shown(&story).start);
        let late = story.shown.as_ref().map_or(late, |shown| shown.start.min(late));
        story.motion(log, path, phase_plane::early(&story), late)?
    } else {
        MotionData::default()
    };
    let is_judged = chosen.iter().any(|spec| spec.name == requirement::SPEC.name);
    let judged = if is_judged { JudgedRun::read(&story, log, path)? } else { JudgedRun::default() };
    let run = RunData { story: &story, motion: &motion, cycles: &cycles, judged: &judged };
    let drawn = chosen.into_iter().filter_map(|spec| {
        let figure = empty_panels::without_empty((spec.draw)(&run))?;
        let figure = story.shown.iter().fold(figure, time_range::crop);
        Some((spec.name.to_owned(), strips::add(figure, &run)))
    });
    let crop = |figure| story.shown.iter().fold(figure, time_range::crop);
    let topics = figures.into_iter().map(|(name, figure)| (name, crop(figure)));
    let all: Vec<(String, Figure)> = drawn.chain(topics).collect();
    if all.is_empty() {
        let why = "there is nothing to draw: all values are zero".to_owned();
        return Err(CliError::Draw { path: path.to_owned(), why });
    }
    Ok(all)
}

/// Returns the unit of the torque: of an acceleration for a body without inertia.
fn unit_of_torque(story: &RunEvents) -> &'static str {
    story.scenario.model.commanded_quantity().1
}

/// Returns a line at the end of the manoeuvre, if there is one.
fn arrival(story: &RunEvents, y: &FigureAxis) -> Option<Layer> {
    let plan = story.scenario.plan.as_ref()?;
    let ends = vec![(plan.time, y.range.start), (plan.time, y.range.end)];
    Some(Layer::new("end of the manoeuvre", colour::GREY, LayerShape::Dashes, ends))
}

/// Returns the interval of figures of the modes: the whole run, or for a switching law about seven periods of the
/// slowest mode at the end of the run.
fn swings(story: &RunEvents) -> std::ops::Range<f64> {
    if let Some(shown) = &story.shown {
        return shown.clone();
    }
    if !story.switches() {
        return 0.0..story.end;
    }
    let frequencies = story.scenario.model.frequencies();
    let slowest = frequencies.fold(f64::INFINITY, f64::min);
    let span = if slowest.is_finite() { round_to_nice(7.0 * TAU / slowest) } else { 100.0 };
    (story.end - span).max(0.0)..story.end
}

/// Returns the axis of time.
fn time(range: std::ops::Range<f64>) -> FigureAxis {
    FigureAxis::exact("time", "s", range)
}
