//! Figure `extra`: the gain of the extra loop over the run, and the frequency of the dominant mode that schedules it.

use flexsc_core::Scenario;
use flexsc_core::control::law::Extra;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::figure_spec::{FigureSpec, MotionPart};
use super::motion::MotionData;
use super::run_events::RunEvents;
use super::{time, title};

pub const SPEC: FigureSpec = FigureSpec {
    name: "extra",
    contents: "Gain of the extra loop, and the frequency it is scheduled on",
    rows: &[],
    motion: MotionPart::All,
    is_in: |story| extra(story).is_some(),
    draw: |run| figure(run.story, run.motion),
};

/// Returns the extra loop of a scenario, if it has one.
pub fn extra(story: &RunEvents) -> Option<&Extra> {
    story.scenario.law.pd()?.extra.as_ref()
}

fn figure(story: &RunEvents, motion: &MotionData) -> Figure {
    let read: Vec<Point> = if motion.estimates.is_empty() {
        motion.time.iter().map(|t| (*t, frequency(&story.scenario, *t))).collect()
    } else {
        motion.estimates.iter().map(|estimate| (estimate.time, estimate.read_frequency)).collect()
    };
    let gain = |w: f64| extra(story).map_or(0.0, |extra| extra.gain(w));
    let gains: Vec<Point> = read.iter().map(|(t, w)| (*t, gain(*w))).collect();
    let x = time(0.0..story.end);
    let panel = |x: FigureAxis, (name, unit): (&str, &'static str), line: Vec<Point>| {
        let y = FigureAxis::around(name, unit, line.iter().map(|point| point.1)).in_hertz();
        Panel::new(x, y, vec![Layer::new("", colour::BLUE, LayerShape::Line(1.4), line)])
    };
    let panels =
        vec![panel(x.unnamed(), ("gain k_d", ""), gains), panel(x, ("frequency read", "rad/s"), read)];
    Figure { title: title(story, "extra loop"), panels, panel_height: 200 }
}

/// Returns the natural frequency of the dominant mode (rad/s) that an ideal observer gives the law at time `t` (s).
fn frequency(scenario: &Scenario, t: f64) -> f64 {
    let ratio = |mode: usize| scenario.study.drift.as_ref().map_or(1.0, |drift| drift.ratio(mode, t));
    let modes = scenario.model.one_axis().into_iter().flat_map(|body| &body.modes).enumerate();
    let now = modes.map(|(index, mode)| {
        let ratio = ratio(index);
        (mode.frequency.get() * ratio, mode.excitability().abs() / (ratio * ratio))
    });
    now.reduce(|best, mode| if mode.1 > best.1 { mode } else { best }).map_or(f64::NAN, |(w, _)| w)
}
