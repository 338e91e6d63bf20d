//! Figure `outputs`: each observed coordinate over the run.

use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour, name_and_unit};

use super::figure_spec::{FigureSpec, MotionPart};
use super::motion::MotionData;
use super::run_events::RunEvents;
use super::{arrival, time, title};

pub const SPEC: FigureSpec = FigureSpec {
    name: "outputs",
    contents: "Each observed coordinate",
    rows: &[],
    motion: MotionPart::Unswitched,
    is_in: |story| !story.scenario.model.outputs().is_empty() && !story.switches(),
    draw: |run| figure(run.story, run.motion),
};

/// Largest number of coordinates with a panel each: the last ones, such as the outermost of a solar panel.
const PANELS: usize = 6;

fn figure(story: &RunEvents, motion: &MotionData) -> Figure {
    let outputs = story.scenario.model.outputs();
    let skipped = motion.outputs.len().saturating_sub(PANELS);
    let panel =
        |(index, (values, output)): (usize, (&Vec<f64>, &flexsc_core::dynamics::axis_model::AxisOutput))| {
            let x = time(0.0..story.end);
            let (name, unit) = name_and_unit(&output.name, &output.unit);
            let y = FigureAxis::around(&name, unit, values.iter().copied());
            let line: Vec<Point> = motion.time.iter().copied().zip(values.iter().copied()).collect();
            let line = Layer::new(&output.name, colour::BLUE, LayerShape::Line(1.2), line);
            let x = if index + 1 == motion.outputs.len() { x } else { x.unnamed() };
            let layers = arrival(story, &y).into_iter().chain([line]).collect();
            Panel::new(x, y, layers)
        };
    let panels = motion.outputs.iter().zip(outputs).enumerate().skip(skipped).map(panel).collect();
    let subject = if skipped > 0 {
        format!("observed coordinates, the first {skipped} left out")
    } else {
        "observed coordinates".to_owned()
    };
    Figure { title: title(story, &subject), panels, panel_height: 130 }
}
