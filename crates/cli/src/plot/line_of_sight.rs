//! Figure `line-of-sight` of a three-axis body: the error of each line of sight, and the displacement of its point.

use flexsc_core::record::{LineOfSightAxis, LineOfSightSample};
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::cycle_data::CycleData;
use super::run_events::RunEvents;
use super::{time, title};

const COLOURS: [plotters::style::RGBColor; 3] = [colour::BLUE, colour::VERMILLION, colour::GREEN];

/// Returns true if a scenario has lines of sight.
pub fn applies_to(story: &RunEvents) -> bool {
    !story.scenario.line_of_sight.is_empty()
}

pub fn figure(story: &RunEvents, cycles: &CycleData) -> Figure {
    let lines = &story.scenario.line_of_sight;
    let mut panels = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        let layers = |names: [&str; 3], value_of: fn(&LineOfSightAxis) -> f64| -> Vec<Layer> {
            let layer = |axis: usize| {
                let rows =
                    cycles.rows().filter(|(_, row): &(f64, &LineOfSightSample)| row.line == index as u64);
                let points: Vec<Point> = rows.map(|(t, row)| (t, value_of(&row.axes[axis]))).collect();
                Layer::new(names[axis], COLOURS[axis], LayerShape::Line(0.8), points)
            };
            (0..3).map(layer).filter(|layer| layer.points.iter().any(|(_, value)| *value != 0.0)).collect()
        };
        let errors = layers(["about x", "about y", "about z"], |axis| axis.error_rad);
        let displacements = layers(["along x", "along y", "along z"], |axis| axis.displacement_m);
        for (name, unit, layers) in [("error", "rad", errors), ("displacement", "m", displacements)] {
            if layers.is_empty() {
                continue;
            }
            let values: Vec<f64> =
                layers.iter().flat_map(|layer| &layer.points).map(|(_, value)| *value).collect();
            let y = FigureAxis::around(&format!("{}: {name}", line.point), unit, values);
            panels.push((y, layers));
        }
    }
    let last = panels.len().saturating_sub(1);
    let panel = |(place, (y, layers)): (usize, (FigureAxis, Vec<Layer>))| {
        let x = time(0.0..story.end);
        Panel::new(if place == last { x } else { x.unnamed() }, y, layers)
    };
    Figure {
        title: title(story, "lines of sight, against their target directions"),
        panels: panels.into_iter().enumerate().map(panel).collect(),
        panel_height: 200,
    }
}
