//! Figure `modes`: the displacement of each elastic mode at the end of the run.

use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::figure_spec::{FigureSpec, MotionPart};
use super::motion::MotionData;
use super::run_events::RunEvents;
use super::{swings, time, title};

pub const SPEC: FigureSpec = FigureSpec {
    name: "modes",
    contents: "Each elastic mode; with a switching law, at the end of the run",
    rows: &[],
    motion: MotionPart::Ends,
    is_in: |story| story.scenario.axis_count() == 1 && story.scenario.mode_count() > 0,
    draw: |run| figure(run.story, run.motion),
};

/// Largest number of modes with a panel each.
const PANELS: usize = 6;

fn figure(story: &RunEvents, motion: &MotionData) -> Figure {
    let shown = swings(story);
    let frequencies = story.scenario.model.frequencies();
    let since = if story.scenario.drift.is_some() { " at the start" } else { "" };
    let last = motion.modes.len().min(PANELS).saturating_sub(1);
    let panel = |(index, (values, frequency)): (usize, (&Vec<f64>, f64))| {
        let line = motion.time.iter().copied().zip(values.iter().copied());
        let line: Vec<Point> = line.filter(|(time, _)| *time >= shown.start).collect();
        let x = time(shown.clone());
        let frequency = ReaderUnits::Engineering.frequency().quantity(frequency);
        let name = format!("mode {index}, {frequency}{since}");
        Panel::new(
            if index == last { x } else { x.unnamed() },
            FigureAxis::around("displacement", "rad", line.iter().map(|(_, value)| *value)),
            vec![Layer::new(&name, colour::BLUE, LayerShape::Line(1.2), line)],
        )
    };
    let panels: Vec<_> = motion.modes.iter().zip(frequencies).take(PANELS).enumerate().map(panel).collect();
    let more = motion.modes.len().saturating_sub(PANELS);
    let subject =
        if more > 0 { format!("elastic modes, {more} more left out") } else { "elastic modes".to_owned() };
    Figure { title: title(story, &subject), panels, panel_height: 130 }
}
