//! Figure `frequency`: the natural frequency of the dominant mode as a filter estimates it, the true frequency, and the
//! error with two standard deviations to each side.

use flexsc_core::record::ElasticEstimates;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, band, colour};

use super::cycle_data::RowSource;
use super::estimate::filters_one_axis;
use super::figure_spec::{FigureSpec, MotionPart, RunData};
use super::motion::{DominantModeEstimate, MotionData};
use super::run_events::RunEvents;
use super::{identified_frequencies, time, title};

pub const SPEC: FigureSpec = FigureSpec {
    name: "frequency",
    contents: "Frequency of the dominant mode, or of those that an attitude filter identifies, estimated and true",
    rows: &[RowSource::new::<ElasticEstimates>()],
    motion: MotionPart::All,
    is_in: |story| identified_frequencies::applies_to(story) || filters_one_axis(story),
    draw,
};

fn draw(run: &RunData<'_>) -> Figure {
    if run.story.scenario.axis_count() == 3 {
        identified_frequencies::figure(run.story, run.cycles)
    } else {
        figure(run.story, run.motion)
    }
}

/// Upper end of the axis, as a multiple of the largest frequency, even if the filter's uncertainty is larger.
const BEYOND: f64 = 1.5;

fn figure(story: &RunEvents, motion: &MotionData) -> Figure {
    let line = |value: &dyn Fn(&DominantModeEstimate) -> f64| -> Vec<Point> {
        motion.estimates.iter().map(|estimate| (estimate.time, value(estimate))).collect()
    };
    let (estimated, truth) = (line(&|e| e.frequency), line(&|e| e.true_frequency));
    let [lower, upper] = [-2.0, 2.0].map(|deviations| line(&|e| e.frequency + deviations * e.frequency_sd));
    let heights = |points: &[Point]| points.iter().map(|point| point.1).collect::<Vec<_>>();
    let most = BEYOND * heights(&truth).into_iter().fold(0.0, f64::max);
    let shown = [&estimated, &truth, &lower, &upper].into_iter().flat_map(|points| heights(points));
    let y = FigureAxis::around("frequency", "rad/s", shown.map(|value| value.clamp(0.0, most))).in_hertz();
    let x = time(0.0..story.end);
    let mut layers = vec![
        Layer::new("± 2 standard deviations", colour::SKY, LayerShape::Area(0.35), band(&lower, &upper)),
        Layer::new("estimated", colour::BLUE, LayerShape::Line(1.4), estimated),
        Layer::new("true", colour::BLACK, LayerShape::Dashes, truth),
    ];
    if motion.estimates.iter().any(|estimate| estimate.read_frequency != estimate.frequency) {
        let apart = |e: &DominantModeEstimate| e.read_frequency != e.frequency;
        let read = line(&|e| if apart(e) { e.read_frequency } else { f64::NAN });
        layers.push(Layer::new("held for the law", colour::ORANGE, LayerShape::Line(1.2), read));
    }
    let whole = Panel::new(x.unnamed(), y, layers);

    let error = line(&|e| e.frequency - e.true_frequency);
    let [lower, upper] = [-2.0, 2.0].map(|deviations| line(&|e| deviations * e.frequency_sd));
    let shown = [&error, &lower, &upper].into_iter().flat_map(|points| heights(points));
    let y = FigureAxis::around("error", "rad/s", shown.map(|value| value.clamp(-most, most))).in_hertz();
    let layers = vec![
        Layer::new("", colour::SKY, LayerShape::Area(0.35), band(&lower, &upper)),
        Layer::new("", colour::GREY, LayerShape::Line(0.8), vec![(0.0, 0.0), (story.end, 0.0)]),
        Layer::new("", colour::BLUE, LayerShape::Line(1.2), error),
    ];
    let panels = vec![whole, Panel::new(x, y, layers)];
    Figure { title: title(story, "frequency of the dominant mode"), panels, panel_height: 200 }
}
