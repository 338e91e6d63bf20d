//! Data of a run for its figures: the events of its log, and its motion, which is recomputed from the scenario in the
//! log if the log does not have it.

use std::path::Path;

use flexsc_core::Scenario;
use flexsc_core::campaign::CommandLog;
use flexsc_core::record::{Column, Columns, Log};

use super::columns::{labels, rows, topics};
use super::motion::{MotionData, MotionRecorder};
use crate::error::CliError;

/// Run of a log.
pub struct RunEvents {
    /// Scenario of the run.
    pub scenario: Scenario,
    /// Number of the run.
    pub run: u64,
    /// End of the run (s).
    pub end: f64,
    /// External commands of the run; `None` if the log lacks them.
    pub commanded: Option<CommandLog>,
    /// Roles of the parts that a program supplied to the run, and that are not at hand.
    pub(super) absent_parts: Option<String>,
    /// True if a repetition of the run is noted on the terminal.
    pub is_noted: bool,
    /// True if the pointing error is shown about each axis.
    pub is_by_axis: bool,
    /// Indices of the requirements over time that are shown; all if none is named.
    pub requirements: Vec<usize>,
    /// Interval of time that figures show, if given.
    pub shown: Option<std::ops::Range<f64>>,
    /// Torque and gain at the start.
    pub start: (f64, f64),
    /// Switchings of the law.
    pub switchings: Vec<SwitchingEvent>,
    /// Window means of the envelope.
    pub means: Vec<WindowMean>,
    /// Window means of another objective of the adaptation.
    pub objective: Vec<WindowMean>,
    /// Steps of the adaptation.
    pub steps: Vec<AdaptationStep>,
    /// Starts of the modes of operation.
    pub modes: Vec<ModeStart>,
    /// Intervals in which a star tracker is blinded (s).
    pub blinded: Vec<[f64; 2]>,
}

/// Start of a mode of operation.
pub struct ModeStart {
    pub time: f64,
    /// Index of the mode in the scenario.
    pub index: usize,
}

/// Switching of the law.
pub struct SwitchingEvent {
    pub time: f64,
    /// Label of the new state.
    pub state: String,
    /// True if a timeout triggered the law's decision, not a guard.
    pub timeout: bool,
    pub torque: f64,
    pub angle: f64,
    pub rate: f64,
}

/// Mean of a quantity over a window.
pub struct WindowMean {
    pub from: f64,
    pub to: f64,
    pub value: f64,
}

/// Step of the adaptation.
pub struct AdaptationStep {
    pub time: f64,
    /// Label of the decision.
    pub decision: String,
    pub gain: f64,
}

impl RunEvents {
    /// Reads the events of a log, the scenario of which is `known` where the parts of a program are at hand.
    pub fn read(log: &Log, path: &Path, known: Option<&Scenario>) -> Result<Self, CliError> {
        let toml = log.require_scenario()?;
        let origin = || format!("{}: scenario.toml", path.display());
        let scenario = known.cloned().map_or_else(|| Scenario::parse_logged(&origin(), toml, log), Ok)?;
        let absent_parts = log.own_parts().filter(|_| known.is_none()).map(str::to_owned);
        let metadata = log.metadata();
        let run = metadata.get("run").and_then(|run| run.parse().ok()).unwrap_or(0);
        let [law, command, means, objective, adaptation] =
            topics(log, ["/law", "/command", "/envelope_mean", "/objective", "/adaptation"])?;
        let first = |name: &str| law.numbers(name).and_then(|column| column.first().copied());
        let gain = scenario.tuned_parameter().or(first("gain")).unwrap_or(scenario.law.tuned());
        let start = (first("torque_nm").unwrap_or(f64::NAN), gain);
        let switchings = switchings(&command);
        let means = rows(&means, ["from_s", "to_s", "mean_rad"]);
        let means: Vec<_> = means.map(|[from, to, value]| WindowMean { from, to, value }).collect();
        let objective = rows(&objective, ["from_s", "to_s", "value"]);
        let objective: Vec<_> = objective.map(|[from, to, value]| WindowMean { from, to, value }).collect();
        let decisions = labels(&adaptation, "decision");
        let steps = rows(&adaptation, ["time_s", "gain"]).zip(decisions);
        let steps = steps.map(|([time, gain], decision)| AdaptationStep { time, decision, gain }).collect();
        let [mode, blinding] = topics(log, ["/mode", "/blinding"])?;
        let indices = match mode.get("index") {
            Some(Column::Counts(indices)) => indices.as_slice(),
            _ => &[],
        };
        let starts = rows(&mode, ["time_s"]).zip(indices);
        let modes = starts.map(|([time], index)| ModeStart { time, index: *index as usize }).collect();
        let reported = metadata.get("time_s").and_then(|time| time.parse().ok());
        let last = switchings
            .last()
            .map(|s| s.time)
            .into_iter()
            .chain(means.last().or(objective.last()).map(|mean| mean.to));
        let end = match metadata.get("end").map(String::as_str) {
            Some("complete") => scenario.duration.seconds(),
            _ => last.chain(reported).fold(0.0, f64::max),
        };
        let none = || unusable(path, "holds commands that are none".to_owned());
        let commanded = match log.commands() {
            Some(text) => Some(CommandLog::parse(text).ok_or_else(none)?),
            // Commands follow the messages, and a killed run has none of them.
            None => (!metadata.contains_key("commands")).then(CommandLog::default),
        };
        Ok(Self {
            scenario,
            run,
            end,
            commanded,
            absent_parts,
            is_noted: false,
            is_by_axis: false,
            requirements: Vec::new(),
            shown: None,
            start,
            switchings,
            means,
            objective,
            steps,
            modes,
            blinded: blinded(&blinding, end),
        })
    }

    /// Returns the motion from a full log, or else from the repeated run, which keeps the whole motion only up to
    /// `early` and from `late` on, and the envelope always.
    pub fn motion(&self, log: &Log, path: &Path, early: f64, late: f64) -> Result<MotionData, CliError> {
        if log.topics().iter().any(|topic| topic == "/attitude") {
            return Ok(self.smooth(MotionData::read(log)?));
        }
        let mut recorder = MotionRecorder::new(early, late);
        self.repeat(log, path, "rows of /attitude", &mut recorder)?;
        Ok(self.smooth(recorder.motion))
    }

    /// Adds points between the rows of the motion under a switching law.
    fn smooth(&self, mut motion: MotionData) -> MotionData {
        if self.switches() {
            let frequencies = self.scenario.model.frequencies();
            let period = self.scenario.log.period_for(self.scenario.duration).seconds();
            motion.smoothed(period, frequencies.fold(0.0, f64::max));
        }
        motion
    }

    /// Returns the key of the law's tuned parameter; k_t if none is tuned.
    pub fn tunes(&self) -> &str {
        self.scenario.adaptation.as_ref().map_or("k_t", |adaptation| adaptation.tunes())
    }

    /// Returns true if the law is a switching law.
    pub fn switches(&self) -> bool {
        self.scenario.law.is_switching()
    }

    /// Returns the start of the last `count` cycles: a cycle lasts from one entry into the law's last state to the
    /// next, or for six switchings if that state is rare.
    pub fn last_cycles(&self, count: usize) -> f64 {
        let cycles = self.entries().rev().nth(count).unwrap_or(0.0);
        let switchings = self.switchings.iter().rev().nth(6 * count).map_or(0.0, |s| s.time);
        cycles.max(switchings)
    }

    /// Returns the end of the first `count` cycles, at most `before`.
    pub fn first_cycles(&self, count: usize, before: f64) -> f64 {
        let cycles = self.entries().nth(count).unwrap_or(before);
        let switchings = self.switchings.get(6 * count).map_or(before, |s| s.time);
        cycles.min(switchings).min(before)
    }

    /// Returns the times at which the law's last state was entered.
    fn entries(&self) -> impl DoubleEndedIterator<Item = f64> {
        let last = self.switchings.last().map(|s| &s.state);
        self.switchings.iter().filter(move |s| Some(&s.state) == last).map(|s| s.time)
    }
}

pub fn unusable(path: &Path, why: String) -> CliError {
    CliError::Draw { path: path.to_owned(), why }
}

fn switchings(columns: &Columns) -> Vec<SwitchingEvent> {
    let words = labels(columns, "state").into_iter().zip(labels(columns, "cause"));
    let numbers = rows(columns, ["time_s", "torque_nm", "angle_rad", "rate_rad_s"]);
    let switching = |([time, torque, angle, rate], (state, cause)): ([f64; 4], (String, String))| {
        SwitchingEvent { time, state, timeout: cause == "timeout", torque, angle, rate }
    };
    numbers.zip(words).map(switching).collect()
}

/// Returns the intervals in which any star tracker is blinded (s), from the rows of `/blinding`.
fn blinded(blinding: &Columns, end: f64) -> Vec<[f64; 2]> {
    let mut intervals = Vec::new();
    let (mut count, mut since) = (0_usize, 0.0);
    for ([time], onset) in rows(blinding, ["time_s"]).zip(labels(blinding, "onset")) {
        if onset == "begins" {
            since = if count == 0 { time } else { since };
            count += 1;
        } else {
            count = count.saturating_sub(1);
            if count == 0 {
                intervals.push([since, time]);
            }
        }
    }
    if count > 0 {
        intervals.push([since, end]);
    }
    intervals
}
