//! Figure `pointing` of three axes: the norm of the pointing error after the acquisition with the limits of requirements, or
//! the error about each axis with its goal and the dead zone.

use std::ops::Range;

use flexsc_core::formats::reader_units::{ReaderUnits, number, time as time_text};
use flexsc_core::numerics::quantity::Positive;
use flexsc_core::record::Pointing;
use flexsc_core::scenario::{ErrorAxis, SampledQuantity};
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Note, Panel, Point, band, colour};

use super::cycle_data::{CycleData, RowSource};
use super::figure_spec::{FigureSpec, MotionPart};
use super::run_events::RunEvents;
use super::three_axis::panels;
use super::{requirement_lines, time, title};

pub const SPEC: FigureSpec = FigureSpec {
    name: "pointing",
    contents: "Three axes: pointing error after the acquisition, with limits; with --axes about each axis",
    rows: &[RowSource::new::<Pointing>()],
    motion: MotionPart::Nothing,
    is_in: |story| story.scenario.axis_count() == 3,
    draw: |run| {
        if run.story.is_by_axis { by_axis(run.story, run.cycles) } else { norms(run.story, run.cycles) }
    },
};

/// Ratio of a band to the errors above which the band does not determine the height of a panel.
const WIDE: f64 = 3.0;
/// Multiple of the median below which an error ends the acquisition, and the largest part of a run that is left out.
const ACQUIRED: f64 = 10.0;
const MOST_LEFT_OUT: f64 = 1.0 / 3.0;
/// Part of the errors that may lie below the axis.
const BELOW: f64 = 0.02;
/// Part of the largest error, and size (rad), below both of which errors are below the axis.
const FAR_BELOW: f64 = 1e-4;
const NOTHING: f64 = 1e-7;

fn norms(story: &RunEvents, cycles: &CycleData) -> Figure {
    let errors = with_target(story, cycles.errors(norm));
    let start = acquisition_end(story, &errors);
    let shown = story.shown.clone().unwrap_or(start..story.end);
    let mut panel = error_panel(story, &errors, shown);
    if story.shown.is_none() && start > 0.0 {
        panel.remark = format!("from {}: acquisition left out", time_text(start.round()));
    }
    Figure { title: title(story, "pointing error"), panels: vec![panel], panel_height: 300 }
}

/// Returns the panel of the norm of the error over an interval of time, with limits, goal and largest value.
pub fn error_panel(story: &RunEvents, errors: &[Point], shown: Range<f64>) -> Panel {
    let limits = requirement_lines::limits(story, |own| *own == SampledQuantity::PointingError, None);
    let inside: Vec<Point> =
        errors.iter().filter(|(time, _)| (shown.start..=shown.end).contains(time)).copied().collect();
    // A goal is not shown beside a requirement.
    let goal = story.scenario.reference.band.map(Positive::get);
    let goal = goal.filter(|_| story.scenario.has_goal() && limits.is_empty());
    let lines = limits.iter().map(|own| own.required.limit).chain(goal);
    let values = logarithmic_sizes(inside.iter().map(|point| point.1)).into_iter().chain(lines);
    let y = FigureAxis::decades("pointing error", "rad", values);
    let y = limits.first().map_or(y.clone(), |own| y.in_unit(own.required.unit.clone()));
    let unit = y.reader_unit();
    let line = Layer::new("", colour::BLUE, LayerShape::Line(1.0), inside.clone());
    let mut panel = Panel::new(time(shown.clone()), y, vec![line]);
    if let Some(band) = goal {
        let name = format!("goal of each axis, {}", ReaderUnits::Engineering.quantity(band, "rad"));
        let level = vec![(shown.start, band), (shown.end, band)];
        panel.layers.push(Layer::new(&name, colour::GREEN, LayerShape::Dashes, level));
    }
    requirement_lines::add(&mut panel, &limits, false);
    let largest = inside.iter().filter(|point| point.1 > 0.0).max_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((at, size)) = largest {
        panel.layers.push(Layer::new("", colour::BLACK, LayerShape::Disc, vec![(*at, *size)]));
        panel.notes.push(Note::new(
            format!("{} at {} s", unit.quantity(*size), number(*at)),
            (*at, *size),
            colour::BLACK,
        ));
    }
    panel
}

/// Returns the sizes that a logarithmic axis shows: without the smallest, and those far below the largest.
pub fn logarithmic_sizes(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let mut sizes: Vec<f64> = values.into_iter().filter(|size| *size > 0.0 && size.is_finite()).collect();
    sizes.sort_by(f64::total_cmp);
    let least = NOTHING.min(FAR_BELOW * sizes.last().copied().unwrap_or(0.0));
    sizes.drain(..(BELOW * sizes.len() as f64) as usize);
    sizes.retain(|size| *size >= least);
    sizes
}

/// Returns errors with gaps while a mode of operation without a target acts.
pub fn with_target(story: &RunEvents, mut errors: Vec<Point>) -> Vec<Point> {
    let scenario = &story.scenario;
    if !scenario.has_mode_targets() {
        return errors;
    }
    let has_target = |index: usize| scenario.mode.get(index).is_none_or(|mode| mode.target.is_some());
    for (time, size) in &mut errors {
        let mode = story.modes.iter().rev().find(|start| start.time <= *time);
        if mode.is_some_and(|start| !has_target(start.index)) {
            *size = f64::NAN;
        }
    }
    errors
}

/// Returns the time at which the acquisition ends (s): the error has fallen below ten times its median, after the start of
/// the first mode with a target. That start if too much of the rest would be left out.
fn acquisition_end(story: &RunEvents, errors: &[Point]) -> f64 {
    let pursued = || errors.iter().filter(|point| point.1.is_finite());
    let begins = errors.iter().position(|point| point.1.is_finite()).unwrap_or(0);
    let first = if begins == 0 { 0.0 } else { errors[begins].0 };
    let mut sizes: Vec<f64> = pursued().map(|point| point.1).collect();
    sizes.sort_by(f64::total_cmp);
    let Some(median) = sizes.get(sizes.len() / 2) else { return first };
    let below = pursued().skip_while(|point| point.1 >= ACQUIRED * median);
    // It may still fall.
    let low = below.clone().zip(below.skip(1)).find(|(now, next)| next.1 >= now.1);
    let acquired = low.map_or(first, |(now, _)| now.0);
    let is_large = pursued().next().is_some_and(|point| point.1 >= ACQUIRED * median);
    let is_cut = is_large && acquired - first <= MOST_LEFT_OUT * (story.end - first);
    if is_cut { acquired } else { first }
}

/// Returns the figure of the error about each axis.
fn by_axis(story: &RunEvents, cycles: &CycleData) -> Figure {
    let line = |axis: usize| {
        let points = cycles.errors(|error| error[axis]);
        let name = if axis == 0 { "pointing error" } else { "" };
        vec![Layer::new(name, colour::BLUE, LayerShape::Line(1.2), points)]
    };
    let mut panels = panels(story, "rad", line);
    let largest_error =
        |panel: &Panel| panel.layers[0].points.iter().map(|point| point.1.abs()).fold(0.0, f64::max);
    for (axis, panel) in panels.iter_mut().enumerate() {
        let about = [ErrorAxis::X, ErrorAxis::Y, ErrorAxis::Z][axis];
        let limits =
            requirement_lines::limits(story, |own| *own == SampledQuantity::PointingError, Some(about));
        let [goal, zone] = bands(story, axis);
        let largest = largest_error(panel);
        let required = limits.iter().map(|own| own.required.limit);
        let shown = [goal, zone]
            .into_iter()
            .flatten()
            .chain(required)
            .filter(|half| *half <= WIDE * largest)
            .fold(0.0, f64::max);
        let values: Vec<f64> = panel.layers[0].points.iter().map(|point| point.1).collect();
        if shown > 0.0 {
            panel.y = FigureAxis::around(&panel.y.name, "rad", values.into_iter().chain([-shown, shown]));
        }
        if let Some(own) = limits.first() {
            panel.y = panel.y.clone().in_unit(own.required.unit.clone());
        }
        let level = |height: f64| [(0.0, height), (story.end, height)];
        let wide =
            |name: &str, half: f64| format!("{name} ±{}", ReaderUnits::Engineering.quantity(half, "rad"));
        let mut below = Vec::new();
        if let Some(half) = goal {
            let area = band(&level(-half), &level(half));
            below.push(Layer::new(&wide("goal band", half), colour::GREEN, LayerShape::Area(0.2), area));
        }
        let target = if axis == 0 { "target" } else { "" };
        below.push(Layer::new(target, colour::GREY, LayerShape::Line(0.8), level(0.0).to_vec()));
        if let Some(half) = zone {
            let bounds =
                [(0.0, half), (story.end, half), (f64::NAN, f64::NAN), (0.0, -half), (story.end, -half)];
            below.push(Layer::new(
                &wide("dead zone", half),
                colour::GREY,
                LayerShape::Dashes,
                bounds.to_vec(),
            ));
        }
        below.append(&mut panel.layers);
        panel.layers = below;
        requirement_lines::add(panel, &limits, true);
    }
    Figure { title: title(story, "pointing error about each axis"), panels, panel_height: 160 }
}

/// Returns the length of a vector.
pub fn norm(vector: [f64; 3]) -> f64 {
    vector.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// Returns a panel of angles (rad) over time with a logarithmic axis, which shows small errors after a large transient.
pub fn decades(story: &RunEvents, name: &str, layers: Vec<Layer>) -> Panel {
    let values = logarithmic_sizes(layers.iter().flat_map(|layer| &layer.points).map(|point| point.1));
    let y = FigureAxis::decades(name, "rad", values);
    Panel::new(time(0.0..story.end), y, layers)
}

/// Returns half widths about an axis: of the goal, and of the law's dead zone (rad).
fn bands(story: &RunEvents, axis: usize) -> [Option<f64>; 2] {
    let scenario = &story.scenario;
    let own = scenario.study.expected_bands.get(axis).copied().flatten();
    let goal = scenario.reference.band.map(Positive::get).or(own);
    let zone = scenario.law.about(axis).coasting_zone();
    [goal.filter(|half| *half > 0.0 && scenario.has_goal()), zone.filter(|half| *half > 0.0)]
}
