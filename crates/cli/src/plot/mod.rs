//! `flexsc plot`: the figures of a log, as SVG and PNG.

mod angle;
mod drive;
mod envelope;
mod gain;
mod modes;
mod outputs;
mod phase_plane;
mod spatial;
mod story;
mod torque;

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use flexsc_core::record::Log;

use crate::failure::Failure;
use crate::figure::{Axis, Figure, Format, Layer, Shape, colour, round_to_nice, save};
use spatial::Cycles;
use story::{Motion, Story};

#[derive(clap::Args)]
pub struct Args {
    /// Log file
    log: PathBuf,
    /// Directory for the figures, made if it is not there [default: that of the log]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Figures to draw [default: all that the log has]
    #[arg(long, value_enum, value_delimiter = ',', value_name = "FIGURES")]
    what: Vec<What>,
    /// Form of the figures
    #[arg(long, value_enum, default_value = "both")]
    format: Format,
}

/// A figure.
#[derive(Copy, Clone, PartialEq, ValueEnum)]
enum What {
    /// Rate against angle, with the law's switching lines
    PhasePlane,
    /// Torque: of a law that switches at the end of the run, else over all of it
    Torque,
    /// Angle of the hub with its goal, and the distance between them
    Angle,
    /// Each observed coordinate
    Outputs,
    /// Envelope of the elastic modes with its window means, and the elastic angle at the end of the run
    Envelope,
    /// What the adaptation decided, and the gain
    Gain,
    /// Each elastic mode: under a law that switches at the end of the run, else over all of it
    Modes,
    /// Of a spatial body: angles beyond the target
    Pointing,
    /// Of a spatial body: rates, rigid and at the gyro
    Rates,
    /// Of a spatial body: energy of the elastic modes, and propellant
    Energy,
    /// Of a spatial body: for how long the jets fire
    Jets,
}

pub fn run(args: &Args) -> Result<(), Failure> {
    let log = Log::open(&args.log)?;
    let story = Story::read(&log, &args.log)?;
    let there: Vec<_> = What::value_variants().iter().copied().filter(|what| what.is_in(&story)).collect();
    if let Some(missing) = args.what.iter().find(|what| !there.contains(what)) {
        let names: Vec<_> = there.iter().map(|what| what.name()).collect();
        return Err(Failure::Arguments(format!(
            "{}: there is no figure `{}` of this log\n\nhint: it has {}",
            args.log.display(),
            missing.name(),
            names.join(", ")
        )));
    }
    let chosen = if args.what.is_empty() { &there } else { &args.what };
    let cycles = if story.scenario.spatial.is_some() {
        Cycles::read(&story, &log, &args.log)?
    } else {
        Cycles::default()
    };
    let moving = [What::PhasePlane, What::Envelope, What::Modes].iter().any(|what| chosen.contains(what));
    let motion = if story.scenario.spatial.is_some() {
        Motion::default()
    } else if !story.switches() {
        story.motion(&log, &args.log, 0.0, 0.0)?
    } else if moving {
        let late = phase_plane::late(&story).min(swings(&story).start);
        story.motion(&log, &args.log, phase_plane::early(&story), late)?
    } else {
        Motion::default()
    };

    let beside = args.log.parent().unwrap_or(Path::new(""));
    let directory = args.out.as_deref().unwrap_or(beside);
    let name = args.log.file_stem().unwrap_or_default().to_string_lossy();
    let file = |what: &What| format!("{name}-{}", what.name());
    save(directory, args.format, chosen, file, |what| what.figure(&story, &motion, &cycles))
}

impl What {
    /// Whether a log has what the figure shows.
    fn is_in(self, story: &Story) -> bool {
        let spatial = story.scenario.spatial.is_some();
        match self {
            Self::PhasePlane => story.switches(),
            Self::Torque => !spatial,
            Self::Angle => !story.switches() && !spatial,
            Self::Outputs => !story.scenario.model.outputs.is_empty() && !story.switches(),
            Self::Envelope => {
                story.scenario.estimator.as_ref().is_some_and(|estimator| estimator.envelope().is_some())
            }
            Self::Gain => !story.steps.is_empty(),
            Self::Modes => !story.scenario.model.modes.is_empty(),
            Self::Pointing | Self::Rates | Self::Energy | Self::Jets => spatial,
        }
    }

    fn figure(self, story: &Story, motion: &Motion, cycles: &Cycles) -> Figure {
        match self {
            Self::PhasePlane => phase_plane::figure(story, motion),
            Self::Torque if story.switches() => torque::figure(story),
            Self::Torque => drive::figure(story, motion),
            Self::Angle => angle::figure(story, motion),
            Self::Outputs => outputs::figure(story, motion),
            Self::Envelope => envelope::figure(story, motion),
            Self::Gain => gain::figure(story),
            Self::Modes => modes::figure(story, motion),
            Self::Pointing => spatial::pointing(story, cycles),
            Self::Rates => spatial::rates(story, cycles),
            Self::Energy => spatial::energy(story, cycles),
            Self::Jets => spatial::jets(story, cycles),
        }
    }

    fn name(self) -> String {
        self.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
    }
}

/// The title of a figure: what it shows, of which run.
fn title(story: &Story, what: &str) -> String {
    let scenario = &story.scenario;
    if !story.switches() {
        let run = if story.run == 0 { String::new() } else { format!(" (run {})", story.run) };
        return format!("{}: {what}{run}", scenario.name);
    }
    let (first, seed) = (story.start.1, scenario.seed);
    let last = story.steps.last().map_or(first, |step| step.gain);
    let moved = if last == first { String::new() } else { format!(" → {}", short(last)) };
    let run = if story.run == 0 { String::new() } else { format!(", run {}", story.run) };
    format!("{}: {what} (k_t = {}{moved}, seed {seed}{run})", scenario.name, short(first))
}

/// A gain with at most four decimals.
fn short(gain: f64) -> String {
    format!("{gain:.4}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The unit of what drives the body.
fn unit_of_torque(story: &Story) -> &'static str {
    if story.scenario.model.commanded_inertia() == 1.0 { "rad/s²" } else { "N m" }
}

/// A line where the manoeuvre ends, if there is one.
fn arrival(story: &Story, y: &Axis) -> Option<Layer> {
    let plan = story.scenario.plan.as_ref()?;
    let ends = vec![(plan.time, y.range.start), (plan.time, y.range.end)];
    Some(Layer::new("", colour::GREY, Shape::Dashes, ends))
}

/// What figures of the modes show: the whole run, or of a law that switches about seven periods of the slowest mode at
/// its end.
fn swings(story: &Story) -> std::ops::Range<f64> {
    if !story.switches() {
        return 0.0..story.end;
    }
    let frequencies = story.scenario.model.modes.iter().map(|mode| mode.frequency.get());
    let slowest = frequencies.fold(f64::INFINITY, f64::min);
    let span = if slowest.is_finite() { round_to_nice(7.0 * TAU / slowest) } else { 100.0 };
    (story.end - span).max(0.0)..story.end
}

/// The axis of time.
fn time(range: std::ops::Range<f64>) -> Axis {
    Axis::exact("time", "s", range)
}
