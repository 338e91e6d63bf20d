//! Figure `fan`: the main signals of many runs over time, from their logs: the median, and the ranges of half and of
//! nine tenths of the runs.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use flexsc_core::formats::count::counted;
use flexsc_core::record::Log;
use flexsc_core::statistics::quantile;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, band, colour};
use rayon::prelude::*;

use super::super::cycle_data::CycleData;
use super::super::motion::MotionData;
use super::super::pointing::norm;
use super::super::run_events::RunEvents;
use super::super::time;
use super::super::{pointing, readable, three_axis};
use crate::error::CliError;
use crate::{progress, say};

/// Number of evenly spaced instants at which quantiles are computed.
const INSTANTS: usize = 801;

/// Signal of a run over time.
struct SignalFan {
    name: String,
    unit: &'static str,
    line: Vec<Point>,
    /// True if a value holds until the next one; otherwise values are interpolated linearly.
    held: bool,
}

/// Name, unit, and values at the instants.
type Sampled = (String, &'static str, Vec<f64>);

/// Returns the logs of a directory by the names of their scenarios, each with at least two runs. Unreadable logs are
/// left out, unless every log is needed.
pub fn logs(
    directory: &Path,
    files: &[String],
    all_needed: bool,
) -> Result<BTreeMap<String, Vec<PathBuf>>, CliError> {
    let paths = files.iter().filter(|file| Path::new(file).extension().is_some_and(|e| e == "mcap"));
    let paths: Vec<PathBuf> = paths.map(|file| directory.join(file)).collect();
    let name = |path: &PathBuf| {
        Log::open(path).map(|log| log.metadata().get("scenario").cloned().unwrap_or_default())
    };
    let names: Vec<_> = paths.par_iter().map(name).collect();
    let mut logs: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for (name, path) in names.into_iter().zip(paths) {
        match name {
            Ok(name) => logs.entry(name).or_default().push(path),
            Err(error) if all_needed => return Err(error.into()),
            Err(error) => say!("left out: {error}"),
        }
    }
    logs.retain(|_, paths| paths.len() > 1);
    Ok(logs)
}

/// # Errors
/// An invalid log, or a run that cannot be repeated.
pub fn figure(name: &str, paths: &[PathBuf]) -> Result<Figure, CliError> {
    let first = RunEvents::read(&Log::open(&paths[0])?, &paths[0], None)?;
    let end = first.scenario.duration.seconds();
    let instants: Vec<f64> = (0..INSTANTS).map(|i| end * i as f64 / (INSTANTS - 1) as f64).collect();
    let bar = progress::bar(paths.len() as u64, "logs");
    let sampled = |path: &PathBuf| -> Result<Vec<Sampled>, CliError> {
        let signals = signals(path)?;
        bar.inc(1);
        Ok(signals
            .into_iter()
            .map(|signal| (signal.name.clone(), signal.unit, signal.value_at(&instants)))
            .collect())
    };
    let runs = paths.par_iter().map(sampled).collect::<Result<Vec<_>, _>>()?;
    bar.finish_and_clear();
    let count = runs.iter().map(Vec::len).min().unwrap_or(0);
    // A signal that is the same number all the time in all runs shows nothing.
    let varies = |signal: &usize| {
        let mut values = runs.iter().flat_map(|run| &run[*signal].2).filter(|value| value.is_finite());
        values.next().is_some_and(|first| values.any(|value| value != first))
    };
    let shown: Vec<usize> = (0..count).filter(varies).collect();
    let panel = |signal: usize| {
        let (is_first, is_last) = (shown.first() == Some(&signal), shown.last() == Some(&signal));
        let (name, unit, _) = &runs[0][signal];
        let quantiles: Vec<[f64; 5]> = (0..INSTANTS)
            .map(|instant| {
                let values = runs.iter().map(|run| run[signal].2[instant]).filter(|value| value.is_finite());
                let mut values: Vec<f64> = values.collect();
                values.sort_by(f64::total_cmp);
                [0.05, 0.25, 0.5, 0.75, 0.95].map(|q| quantile(&values, q))
            })
            .collect();
        let line = |q: usize| -> Vec<Point> {
            instants.iter().copied().zip(quantiles.iter().map(|quantiles| quantiles[q])).collect()
        };
        let named = |name: &'static str| if is_first { name } else { "" };
        let layers = vec![
            Layer::new(named("5 to 95 %"), colour::SKY, LayerShape::Area(0.3), band(&line(0), &line(4))),
            Layer::new(named("25 to 75 %"), colour::BLUE, LayerShape::Area(0.4), band(&line(1), &line(3))),
            Layer::new(named("median"), colour::BLACK, LayerShape::Line(1.4), line(2)),
        ];
        let values = quantiles.iter().flatten().copied();
        let positive = values.clone().all(|value| value.is_nan() || value >= 0.0);
        let y = if positive {
            FigureAxis::from_zero(name, unit, values)
        } else {
            FigureAxis::around(name, unit, values)
        };
        let x = time(0.0..end);
        Panel::new(if is_last { x } else { x.unnamed() }, y, layers)
    };
    let panels = shown.iter().copied().map(panel).collect();
    Ok(Figure {
        title: format!("{}: {} over time", readable(name), counted(paths.len(), "run")),
        panels,
        panel_height: 180,
    })
}

/// Returns the signals of a run that are shown.
fn signals(path: &Path) -> Result<Vec<SignalFan>, CliError> {
    let log = Log::open(path)?;
    let story = RunEvents::read(&log, path, None)?;
    let signal = |name: &str, unit, line, held| SignalFan { name: name.to_owned(), unit, line, held };
    let mut signals = Vec::new();
    if story.scenario.axis_count() == 3 {
        let rows = [pointing::SPEC.rows, three_axis::ENERGY.rows].concat();
        let cycles = CycleData::read(&story, &log, path, &rows)?;
        let [elastic, _] = cycles.elastic_energies();
        signals.push(signal("pointing error", "rad", cycles.errors(norm), false));
        signals.push(signal("elastic energy", "J", elastic, false));
        signals.push(signal("propellant", "kg", cycles.fuel(&story), false));
        signals.extend(adaptation_fans(&story));
    } else if story.switches() {
        if !story.means.is_empty() {
            let ends = story.means.iter().flat_map(|mean| [(mean.from, mean.value), (mean.to, mean.value)]);
            signals.push(signal("mean envelope", "rad", ends.collect(), true));
        }
        if story.scenario.adaptation.is_some() {
            signals.extend(adaptation_fans(&story));
        }
        let counts = story.switchings.iter().enumerate().map(|(index, s)| (s.time, (index + 1) as f64));
        let all = (story.end, story.switchings.len() as f64);
        let counts = [(0.0, 0.0)].into_iter().chain(counts).chain([all]).collect();
        signals.push(signal("switchings so far", "", counts, true));
    } else {
        let motion = story.motion(&log, path, 0.0, 0.0)?;
        signals.extend(rotation_fans(&story, &motion));
        signals.extend(adaptation_fans(&story));
    }
    Ok(signals)
}

/// Returns the tuned parameter, and the objective if it is not the envelope.
fn adaptation_fans(story: &RunEvents) -> Vec<SignalFan> {
    let signal = |name: String, unit, line| SignalFan { name, unit, line, held: true };
    let mut signals = Vec::new();
    let Some(adaptation) = &story.scenario.adaptation else { return signals };
    let windows =
        story.objective.iter().flat_map(|window| [(window.from, window.value), (window.to, window.value)]);
    if !story.objective.is_empty() {
        let objective = adaptation.objective();
        let unit = objective.unit(story.scenario.torque_unit());
        signals.push(signal(objective.key().replace('_', " "), unit, windows.collect()));
    }
    let steps = story.steps.iter().map(|step| (step.time, step.gain));
    let gains = [(0.0, story.start.1)].into_iter().chain(steps).chain([last(story)]);
    signals.push(signal(format!("gain {}", story.tunes()), "", gains.collect()));
    signals
}

/// Returns the gain at the end.
fn last(story: &RunEvents) -> Point {
    (story.end, story.steps.last().map_or(story.start.1, |step| step.gain))
}

fn rotation_fans(story: &RunEvents, motion: &MotionData) -> Vec<SignalFan> {
    let over_time = |values: &mut dyn Iterator<Item = f64>| motion.time.iter().copied().zip(values).collect();
    let mut beyond = motion.angle.iter().zip(&motion.goal).map(|(angle, goal)| angle - goal);
    let mut signals = vec![SignalFan {
        name: "angle error".to_owned(),
        unit: "rad",
        line: over_time(&mut beyond),
        held: false,
    }];
    if let (Some(output), Some(values)) = (story.scenario.model.outputs().last(), motion.outputs.last()) {
        let (name, unit) = flexsc_figure::name_and_unit(&output.name, &output.unit);
        signals.push(SignalFan { name, unit, line: over_time(&mut values.iter().copied()), held: false });
    }
    if !motion.estimates.is_empty() {
        let error = motion.estimates.iter().map(|e| (e.time, e.read_frequency - e.true_frequency));
        let name = "frequency error".to_owned();
        signals.push(SignalFan { name, unit: "rad/s", line: error.collect(), held: true });
    }
    signals
}

impl SignalFan {
    /// Returns the values at increasing instants; NaN outside the signal.
    fn value_at(&self, instants: &[f64]) -> Vec<f64> {
        let mut values = Vec::with_capacity(instants.len());
        for now in instants {
            // The times of a log are whole nanoseconds.
            let after = self.line.partition_point(|point| point.0 <= now + 1e-9);
            let value = match (after.checked_sub(1).map(|index| self.line[index]), self.line.get(after)) {
                (Some((time, value)), _) if self.held && (after < self.line.len() || time >= now - 1e-6) => {
                    value
                }
                (Some((time, value)), None) if time >= now - 1e-6 => value,
                (Some((from, before)), Some((to, value))) if !self.held => {
                    before + (value - before) * (now - from) / (to - from)
                }
                _ => f64::NAN,
            };
            values.push(value);
        }
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signals_are_read_at_instants() {
        let line = vec![(1.0, 10.0), (2.0, 20.0), (4.0, 0.0)];
        let signal = |held| SignalFan { name: String::new(), unit: "", line: line.clone(), held };
        let instants = [0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0];
        let texts = |held| signal(held).value_at(&instants).iter().map(f64::to_string).collect::<Vec<_>>();
        assert_eq!(texts(false), ["NaN", "10", "15", "20", "10", "0", "NaN"]);
        assert_eq!(texts(true), ["NaN", "10", "10", "20", "20", "0", "NaN"]);
    }
}
