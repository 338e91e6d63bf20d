//! Shading of the failures of sensors and actuators in every figure over time.

use flexsc_figure::{Figure, Layer, LayerShape, Point, colour};

use super::run_events::RunEvents;
use super::time;

/// Opacity of the shading of a failure.
const DARKNESS: f64 = 0.15;

/// Adds the failures of a run to a figure.
pub fn shaded(mut figure: Figure, story: &RunEvents) -> Figure {
    let failures = story.scenario.failures();
    if failures.is_empty() {
        return figure;
    }
    let axis = time(0.0..1.0).name;
    let is_over_time = figure.panels.last().is_some_and(|panel| panel.x.name == axis);
    if !is_over_time {
        return figure;
    }
    let mut name = "failure";
    for panel in &mut figure.panels {
        let (x, y) = (&panel.x.range, &panel.y.range);
        let area = |failing: &flexsc_core::scenario::FailureInterval| -> Vec<Point> {
            let from = failing.interval.start().seconds().max(x.start);
            let to = failing.interval.end().map_or(x.end, |ends| ends.seconds().min(x.end));
            if from >= to {
                return Vec::new();
            }
            vec![(from, y.start), (to, y.start), (to, y.end), (from, y.end), (f64::NAN, f64::NAN)]
        };
        let points: Vec<Point> = failures.iter().flat_map(area).collect();
        if !points.is_empty() {
            let layer =
                Layer::new(std::mem::take(&mut name), colour::VERMILLION, LayerShape::Area(DARKNESS), points);
            panel.layers.insert(0, layer);
        }
    }
    figure
}
