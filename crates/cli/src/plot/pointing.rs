//! Figure `pointing` of three axes: the pointing error about each axis, with its goal and the dead zone.

use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_core::record::Pointing;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, band, colour};

use super::cycle_data::{CycleData, RowSource};
use super::figure_spec::{FigureSpec, MotionPart};
use super::run_events::RunEvents;
use super::three_axis::panels;
use super::{time, title};

pub const SPEC: FigureSpec = FigureSpec {
    name: "pointing",
    contents: "Three axes: pointing error, with its goal band and dead zone",
    rows: &[RowSource::new::<Pointing>()],
    motion: MotionPart::Nothing,
    is_in: |story| story.scenario.axis_count() == 3,
    draw: |run| figure(run.story, run.cycles),
};

/// Ratio of a band to the errors above which the band does not determine the height of a panel.
const WIDE: f64 = 3.0;

fn figure(story: &RunEvents, cycles: &CycleData) -> Figure {
    let line = |axis: usize| {
        let points = cycles.errors(|error| error[axis]);
        let name = if axis == 0 { "pointing error" } else { "" };
        vec![Layer::new(name, colour::BLUE, LayerShape::Line(1.2), points)]
    };
    let mut panels = panels(story, "rad", line);
    let largest_error =
        |panel: &Panel| panel.layers[0].points.iter().map(|point| point.1.abs()).fold(0.0, f64::max);
    for (axis, panel) in panels.iter_mut().enumerate() {
        let [goal, zone] = bands(story, axis);
        let largest = largest_error(panel);
        let shown =
            [goal, zone].into_iter().flatten().filter(|half| *half <= WIDE * largest).fold(0.0, f64::max);
        let values: Vec<f64> = panel.layers[0].points.iter().map(|point| point.1).collect();
        if shown > 0.0 {
            panel.y = FigureAxis::around(&panel.y.name, "rad", values.into_iter().chain([-shown, shown]));
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
    }
    if let Some(last) = panels.last_mut() {
        last.x = last.x.unnamed();
    }
    let length = cycles.errors(norm);
    panels.push(decades(story, "norm", vec![Layer::new("", colour::BLUE, LayerShape::Line(1.2), length)]));
    Figure { title: title(story, "pointing error"), panels, panel_height: 160 }
}

/// Returns the length of a vector.
pub fn norm(vector: [f64; 3]) -> f64 {
    vector.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// Returns a panel of angles (rad) over time with a logarithmic axis, which shows small errors after a large transient.
pub fn decades(story: &RunEvents, name: &str, layers: Vec<Layer>) -> Panel {
    let y =
        FigureAxis::decades(name, "rad", layers.iter().flat_map(|layer| &layer.points).map(|point| point.1));
    Panel::new(time(0.0..story.end), y, layers)
}

/// Returns half widths about an axis: of the goal, and of the law's dead zone (rad).
fn bands(story: &RunEvents, axis: usize) -> [Option<f64>; 2] {
    let scenario = &story.scenario;
    let own = scenario.study.expected_bands.get(axis).copied().flatten();
    let goal = scenario.reference.band.map(flexsc_core::numerics::quantity::Positive::get).or(own);
    let zone = scenario.law.about(axis).coasting_zone();
    [goal.filter(|half| *half > 0.0 && scenario.has_goal()), zone.filter(|half| *half > 0.0)]
}
