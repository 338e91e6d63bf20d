//! Figure `envelope`: the envelope of the elastic modes over the run with its window means, and the elastic angle
//! within it at the end (figures 5v and 5g of \[Silaev\]).

use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::figure_spec::{FigureSpec, MotionPart, RunData};
use super::motion::MotionData;
use super::run_events::{RunEvents, WindowMean};
use super::{swings, time, title};

pub const SPEC: FigureSpec = FigureSpec {
    name: "envelope",
    contents: "Envelope of the elastic modes with its window means, and the elastic angle",
    rows: &[],
    motion: MotionPart::Ends,
    is_in: has_envelope,
    draw,
};

fn draw(run: &RunData<'_>) -> Figure {
    if run.story.scenario.axis_count() == 3 { over_windows(run.story) } else { figure(run.story, run.motion) }
}

fn has_envelope(story: &RunEvents) -> bool {
    story.scenario.estimator.as_ref().is_some_and(|estimator| estimator.envelope().is_some())
}

fn figure(story: &RunEvents, motion: &MotionData) -> Figure {
    let all = motion.envelope.iter().map(|(_, value)| *value);
    let whole = Panel::new(
        time(0.0..story.end),
        FigureAxis::from_zero("envelope a", "rad", all),
        vec![
            Layer::new("envelope", colour::SKY, LayerShape::Line(0.6), motion.envelope.clone()),
            Layer::new("window means", colour::VERMILLION, LayerShape::Line(2.0), means(&story.means)),
        ],
    );
    let shown = swings(story);
    let bound = |sign: f64| -> Vec<Point> {
        let within = motion.envelope.iter().filter(|(time, _)| *time >= shown.start);
        within.map(|(time, value)| (*time, sign * value)).collect()
    };
    let elastic = motion.time.iter().copied().zip(motion.elastic.iter().copied());
    let elastic: Vec<Point> = elastic.filter(|(time, _)| *time >= shown.start).collect();
    let (upper, lower) = (bound(1.0), bound(-1.0));
    let values = upper.iter().chain(&lower).chain(&elastic).map(|(_, value)| *value);
    let y = FigureAxis::around("elastic angle", "rad", values);
    let end = Panel::new(
        time(shown),
        y,
        vec![
            Layer::new("± envelope", colour::ORANGE, LayerShape::Line(1.2), upper),
            Layer::new("", colour::ORANGE, LayerShape::Line(1.2), lower),
            Layer::new("elastic angle", colour::BLUE, LayerShape::Line(1.2), elastic),
        ],
    );
    let subject = "envelope of the elastic modes";
    Figure { title: title(story, subject), panels: vec![whole, end], panel_height: 220 }
}

/// Returns the figure of the window means alone, for three axes.
fn over_windows(story: &RunEvents) -> Figure {
    let all = story.means.iter().map(|mean| mean.value);
    let line = Layer::new("window means", colour::VERMILLION, LayerShape::Line(2.0), means(&story.means));
    let panel = Panel::new(time(0.0..story.end), FigureAxis::from_zero("envelope a", "rad", all), vec![line]);
    let subject = "envelope of the elastic modes";
    Figure { title: title(story, subject), panels: vec![panel], panel_height: 300 }
}

/// Returns the window means as a line, constant over each window.
pub fn means(means: &[WindowMean]) -> Vec<Point> {
    means.iter().flat_map(|m| [(m.from, m.value), (m.to, m.value)]).collect()
}
