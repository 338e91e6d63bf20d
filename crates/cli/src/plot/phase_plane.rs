//! Figure `phase-plane`: rate against angle, with the law's switching lines and switchings.

use flexsc_core::control::law::{Relay, RelaySides};
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::figure_spec::{FigureSpec, MotionPart};
use super::motion::MotionData;
use super::run_events::{RunEvents, SwitchingEvent};
use super::title;

pub const SPEC: FigureSpec = FigureSpec {
    name: "phase-plane",
    contents: "Rate against angle, with the law's switching lines",
    rows: &[],
    motion: MotionPart::Ends,
    is_in: |story| story.switches() && story.scenario.axis_count() == 1,
    draw: |run| figure(run.story, run.motion),
};

/// Number of cycles that are shown at the start of a run, and at its end.
const CYCLES: usize = 10;

/// Returns the start of the last cycles (s), or the requested time.
pub fn late(story: &RunEvents) -> f64 {
    story.shown.as_ref().map_or_else(|| story.last_cycles(CYCLES), |shown| shown.start)
}

/// Returns the end of the first cycles (s); a time before the start if a time is requested.
pub fn early(story: &RunEvents) -> f64 {
    if story.shown.is_some() {
        return -1.0;
    }
    story.first_cycles(CYCLES, late(story))
}

fn figure(story: &RunEvents, motion: &MotionData) -> Figure {
    let (early, late) = (early(story), late(story));
    let end = story.shown.as_ref().map_or(story.end, |shown| shown.end);
    let path = |shown: &dyn Fn(f64) -> bool| -> Vec<Point> {
        let states = motion.angle.iter().copied().zip(motion.rate.iter().copied());
        motion.time.iter().zip(states).filter(|(time, _)| shown(**time)).map(|(_, state)| state).collect()
    };
    let first = path(&|time| time <= early && late > 0.0);
    // The times of a log are whole nanoseconds.
    let last = path(&|time| time >= late - 1e-9 && time <= end + 1e-9);
    let shown = |s: &&SwitchingEvent| (s.time >= late && s.time <= end) || s.time <= early;
    let points = |timeout: bool| -> Vec<Point> {
        let switchings = story.switchings.iter().filter(shown).filter(|s| s.timeout == timeout);
        switchings.map(|s| (s.angle, s.rate)).collect()
    };
    let relay = story.scenario.law.relay();
    let zone = relay.into_iter().flat_map(|relay| [-relay.dead_zone.get(), relay.dead_zone.get()]);
    let all = || first.iter().chain(&last).copied();
    let x = FigureAxis::around("angle x", "rad", all().map(|p| p.0).chain(zone));
    let y = FigureAxis::around("rate dx/dt", "rad/s", all().map(|p| p.1));
    let line = |name: &str, shape, angle: f64| {
        Layer::new(name, colour::GREY, shape, vec![(angle, y.range.start), (angle, y.range.end)])
    };
    let (boundary, brake) = (LayerShape::Line(1.0), LayerShape::Dashes);
    let lines = |relay: &Relay| {
        let (dead_zone, back) = (relay.dead_zone.get(), relay.dead_zone.get() - relay.hysteresis.get());
        match relay.sides {
            RelaySides::Two => vec![
                line("±ε", boundary, dead_zone),
                line("", boundary, -dead_zone),
                line("±(ε − γ)", brake, back),
                line("", brake, -back),
            ],
            RelaySides::One => vec![line("ε", boundary, dead_zone), line("ε − γ", brake, back)],
        }
    };
    let mut layers = relay.map_or_else(Vec::new, lines);
    let whole = first.is_empty() || story.shown.is_some();
    let name = if whole { "trajectory" } else { "end of the run" };
    layers.extend([
        Layer::new("start of the run", colour::SKY, LayerShape::Line(0.6), first),
        Layer::new(name, colour::BLACK, LayerShape::Line(1.1), last),
        Layer::new("switching by guard", colour::VERMILLION, LayerShape::Disc, points(false)),
        Layer::new("by timeout", colour::BLUE, LayerShape::Diamond, points(true)),
    ]);
    Figure { title: title(story, "phase plane"), panels: vec![Panel::new(x, y, layers)], panel_height: 480 }
}
