//! Figure `estimate`: the displacement of the dominant mode as the law reads it from a filter, the true displacement,
//! and the difference.

use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::figure_spec::{FigureSpec, MotionPart};
use super::motion::MotionData;
use super::run_events::RunEvents;
use super::{time, title};

pub const SPEC: FigureSpec = FigureSpec {
    name: "estimate",
    contents: "Displacement of the dominant mode, estimated and true",
    rows: &[],
    motion: MotionPart::All,
    is_in: filters_one_axis,
    draw: |run| figure(run.story, run.motion),
};

/// Returns true if a filter of one axis estimates its modes from measurements.
pub fn filters_one_axis(story: &RunEvents) -> bool {
    let estimator = story.scenario.estimator.as_ref();
    story.scenario.axis_count() == 1 && estimator.is_some_and(|estimator| estimator.filters_measurements())
}

fn figure(story: &RunEvents, motion: &MotionData) -> Figure {
    let samples = &motion.estimates;
    let estimated: Vec<Point> = samples.iter().map(|e| (e.time, e.displacement)).collect();
    let truth: Vec<Point> = samples.iter().map(|e| (e.time, motion.displacement(e.mode, e.time))).collect();
    let error: Vec<Point> = estimated.iter().zip(&truth).map(|(e, t)| (e.0, e.1 - t.1)).collect();
    let x = time(0.0..story.end);
    let heights = estimated.iter().chain(&truth).map(|point| point.1);
    let y = FigureAxis::around("displacement", "rad", heights);
    let layers = vec![
        Layer::new("estimated, as the law reads it", colour::ORANGE, LayerShape::Line(2.0), estimated),
        Layer::new("true", colour::BLACK, LayerShape::Dashes, truth),
    ];
    let whole = Panel::new(x.unnamed(), y, layers);
    let y = FigureAxis::around("error", "rad", error.iter().map(|point| point.1));
    let layers = vec![
        Layer::new("", colour::GREY, LayerShape::Line(0.8), vec![(0.0, 0.0), (story.end, 0.0)]),
        Layer::new("", colour::BLUE, LayerShape::Line(1.0), error),
    ];
    let panels = vec![whole, Panel::new(x, y, layers)];
    Figure { title: title(story, "displacement of the dominant mode"), panels, panel_height: 200 }
}
