//! `flexsc plot`: the figures of a log, as SVG and PNG.

mod angle;
mod consistency;
mod drive;
mod envelope;
mod estimate;
mod extra;
mod frequency;
mod gain;
mod lock;
mod modes;
mod motion;
mod outputs;
mod phase_plane;
mod spatial;
mod story;
mod torque;
mod wheel;

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use flexsc_core::estimator::Estimator;
use flexsc_core::law::Law;
use flexsc_core::record::Log;

use crate::failure::Failure;
use crate::figure::{Axis, Figure, Format, Layer, Shape, colour, round_to_nice, save};
use motion::Motion;
use spatial::Cycles;
use story::Story;

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
    /// Angle of the hub with its goal, the distance between them, and when it has settled
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
    /// Of a spatial body: natural frequencies as adaptive observers estimate them, and as they are
    Tracking,
    /// Of a spatial body: elastic rates that active damping acts on, its thresholds, and its pulses
    Damping,
    /// Speed and momentum of the flywheel, with its limits
    Wheel,
    /// Frequency of the dominant mode as a filter estimates it, and what it really is
    Frequency,
    /// Displacement of the dominant mode as a filter estimates it, and what it really is
    Estimate,
    /// Whether a filter knows how large its errors are: NIS and NEES with their 95 % bands
    Consistency,
    /// Gain of the extra loop, and the frequency that it follows
    Extra,
}

/// The figure of a log that is in memory, by its name; `path` is what errors call the log.
pub fn figure_of(log: &Log, path: &Path, name: &str) -> Result<Figure, Failure> {
    let what = What::from_str(name, false).map_err(Failure::Arguments)?;
    let story = Story::read(log, path)?;
    if !what.is_in(&story) {
        return Err(Failure::Arguments(format!(
            "{}: there is no figure `{name}` of this log",
            path.display()
        )));
    }
    let spatial = story.scenario.spatial.is_some();
    let cycles = if spatial { Cycles::read(&story, log, path)? } else { Cycles::default() };
    let motion = if spatial { Motion::default() } else { Motion::read(log)? };
    Ok(what.figure(&story, &motion, &cycles))
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
    let any = |of: &[What]| of.iter().any(|what| chosen.contains(what));
    let moving = any(&[What::PhasePlane, What::Envelope, What::Modes]);
    let all = any(&[What::Wheel, What::Frequency, What::Estimate, What::Consistency, What::Extra]);
    let is_spatial = story.scenario.spatial.is_some();
    let cycles = if is_spatial { Cycles::read(&story, &log, &args.log)? } else { Cycles::default() };
    let motion = if is_spatial {
        Motion::default()
    } else if all || !story.switches() {
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
            Self::Tracking => matches!(story.scenario.estimator, Some(Estimator::Adaptive(_))),
            Self::Damping => {
                matches!(&story.scenario.law, Law::PhasePlane(law) if law.damping.is_some())
            }
            Self::Wheel => wheel::rotor(story).is_some(),
            Self::Frequency | Self::Estimate | Self::Consistency => {
                story.scenario.estimator.as_ref().is_some_and(Estimator::filters)
            }
            Self::Extra => extra::of(story).is_some(),
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
            Self::Tracking => spatial::tracking(story, cycles),
            Self::Damping => spatial::damping(story, cycles),
            Self::Wheel => wheel::figure(story, motion),
            Self::Frequency => frequency::figure(story, motion),
            Self::Estimate => estimate::figure(story, motion),
            Self::Consistency => consistency::figure(story, motion),
            Self::Extra => extra::figure(story, motion),
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
