//! Figure `deflection` of three axes: the displacement of each point of the structure, such as the tip of a panel, by
//! the elastic modes, relative to the first point, in axes of the hub.

use flexsc_core::numerics::attitude::Vector;
use flexsc_core::record::Vibrations;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, RGBColor, colour};

use super::cycle_data::{CycleData, RowSource};
use super::figure_spec::{FigureSpec, MotionPart};
use super::run_events::RunEvents;
use super::{time, title};

pub const SPEC: FigureSpec = FigureSpec {
    name: "deflection",
    contents: "Three axes: deflection of each point of the structure that modes move",
    rows: &[RowSource::new::<Vibrations>()],
    motion: MotionPart::Nothing,
    is_in: |story| !points(story).is_empty(),
    draw: |run| figure(run.story, run.cycles),
};

/// Largest number of points with a panel each.
const PANELS: usize = 6;
/// Colours of the axes.
const COLOURS: [RGBColor; 3] = [colour::BLUE, colour::VERMILLION, colour::GREEN];

/// Displacement by a unit of each mode (1/sqrt(kg)) below which a point belongs to the hub.
const ROUNDING: f64 = 1e-9;

/// Returns the points that modes move relative to the first, each with its displacement for a unit of each mode
/// (1/sqrt(kg)). Empty if drives or hinges turn the appendages, since modes then have no fixed shapes.
fn points(story: &RunEvents) -> Vec<(&str, Vec<Vector>)> {
    let Some(body) = story.scenario.model.three_axis() else { return Vec::new() };
    if story.scenario.study.drives.is_some() {
        return Vec::new();
    }
    let shifts = |point: &str| body.displacements(point, &Vector::zeros());
    let first = body.points.first().map_or_else(Vec::new, |point| shifts(&point.name));
    let against =
        |point: &str| shifts(point).iter().zip(&first).map(|(shift, first)| shift - first).collect();
    let points = body.points.iter().map(|point| (point.name.as_str(), against(&point.name)));
    points
        .filter(|(_, shifts): &(_, Vec<Vector>)| shifts.iter().any(|shift| shift.norm() > ROUNDING))
        .collect()
}

fn figure(story: &RunEvents, cycles: &CycleData) -> Figure {
    let all = points(story);
    let last = all.len().min(PANELS).saturating_sub(1);
    let panel = |(index, (name, shifts)): (usize, &(&str, Vec<Vector>))| {
        let line = |axis: usize| -> Vec<Point> {
            let moved = |row: &Vibrations| {
                let modes = row.modes.iter().map(|mode| mode.displacement);
                shifts.iter().zip(modes).map(|(shift, q)| shift[axis] * q).sum()
            };
            cycles.rows().map(|(time, row)| (time, moved(row))).collect()
        };
        let layer = |axis: usize| {
            let label = if index == 0 { ["x", "y", "z"][axis] } else { "" };
            Layer::new(label, COLOURS[axis], LayerShape::Line(1.0), line(axis))
        };
        let layers: Vec<Layer> = (0..3).map(layer).collect();
        let values: Vec<f64> = layers.iter().flat_map(|layer| &layer.points).map(|point| point.1).collect();
        let x = time(0.0..story.end);
        let x = if index == last { x } else { x.unnamed() };
        Panel::new(x, FigureAxis::around(name, "m", values), layers)
    };
    let panels = all.iter().take(PANELS).enumerate().map(panel).collect();
    let more = all.len().saturating_sub(PANELS);
    let omitted = if more > 0 { format!(", points left out: {more}") } else { String::new() };
    let subject = format!("elastic deflection, in axes of the hub{omitted}");
    Figure { title: title(story, &subject), panels, panel_height: 160 }
}
