//! Figure `orbit` of three axes: the magnetic field and the directions to planet and Sun in the body's axes.

use flexsc_core::record::{Orbit, OrbitAxis};
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::cycle_data::{CycleData, RowSource};
use super::figure_spec::{FigureSpec, MotionPart};
use super::run_events::RunEvents;
use super::{time, title};

pub const SPEC: FigureSpec = FigureSpec {
    name: "orbit",
    contents: "Three axes in orbit: magnetic field, nadir and Sun in body axes, and the eclipse",
    rows: &[RowSource::new::<Orbit>()],
    motion: MotionPart::Nothing,
    is_in: applies_to,
    draw: |run| figure(run.story, run.cycles),
};

/// Function that reads a component of an axis.
type AxisSeries = fn(&OrbitAxis) -> f64;

const COLOURS: [(&str, plotters::style::RGBColor); 3] =
    [("x", colour::BLUE), ("y", colour::VERMILLION), ("z", colour::GREEN)];

/// Returns true if a scenario has an orbit.
fn applies_to(story: &RunEvents) -> bool {
    let environment = story.scenario.environment.as_ref();
    story.scenario.axis_count() == 3 && environment.is_some_and(|environment| environment.orbit.is_some())
}

fn figure(story: &RunEvents, cycles: &CycleData) -> Figure {
    let shown: [(&str, &str, AxisSeries); 3] = [
        ("magnetic field", "T", |axis| axis.field_t),
        ("nadir", "", |axis| axis.nadir),
        ("Sun", "", |axis| axis.sun),
    ];
    let mut panels = Vec::new();
    for (name, unit, value_of) in shown {
        let line = |axis: usize| -> Vec<Point> {
            cycles.rows::<Orbit>().map(|(time, row)| (time, value_of(&row.axes[axis]))).collect()
        };
        let lines = [0, 1, 2].map(line);
        if lines.iter().flatten().all(|(_, value)| value.is_nan()) {
            continue;
        }
        let values: Vec<f64> = lines.iter().flatten().map(|(_, value)| *value).collect();
        let y = FigureAxis::around(name, unit, values);
        let layers = lines.into_iter().zip(COLOURS).map(|(points, (axis, colour))| {
            Layer::new(if panels.is_empty() { axis } else { "" }, colour, LayerShape::Line(1.2), points)
        });
        let layers = layers.collect();
        panels.push(Panel::new(time(0.0..story.end).unnamed(), y, layers));
    }
    if let Some(last) = panels.last_mut() {
        last.x = time(0.0..story.end);
    }
    let shown: Vec<&str> = panels.iter().map(|panel| panel.y.name.as_str()).collect();
    let subject = format!("{} in body axes", shown.join(", "));
    Figure { title: title(story, &subject), panels, panel_height: 160 }
}
