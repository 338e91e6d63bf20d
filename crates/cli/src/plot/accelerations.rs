//! Figure `accelerations` of a spacecraft: the readings of each accelerometer along its axes.

use flexsc_core::record::Accelerations;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::cycle_data::CycleData;
use super::run_events::RunEvents;
use super::{time, title};

const COLOURS: [plotters::style::RGBColor; 3] = [colour::BLUE, colour::VERMILLION, colour::GREEN];

/// Returns true if a scenario has accelerometers.
pub fn applies_to(story: &RunEvents) -> bool {
    story.scenario.sensor.accelerometers().next().is_some()
}

pub fn figure(story: &RunEvents, cycles: &CycleData) -> Figure {
    let scenario = &story.scenario;
    let all: Vec<_> = scenario.sensor.accelerometers().collect();
    let panel =
        |(place, (index, accelerometer)): (usize, &(usize, &flexsc_core::control::sensor::Accelerometer))| {
            let rows =
                || cycles.rows().filter(|(_, row): &(f64, &Accelerations)| row.sensor == *index as u64);
            let own = accelerometer.along.is_empty();
            let layer = |axis: usize| {
                let points: Vec<Point> = rows().map(|(t, row)| (t, row.axes[axis].measured_m_s2)).collect();
                let name = if own { ["x", "y", "z"][axis].to_owned() } else { format!("axis {}", axis + 1) };
                Layer::new(&name, COLOURS[axis], LayerShape::Line(0.8), points)
            };
            let axes = if own { 3 } else { accelerometer.along.len() };
            let layers: Vec<Layer> = (0..axes).map(layer).collect();
            let values = layers.iter().flat_map(|layer| &layer.points).map(|(_, value)| *value);
            let y =
                FigureAxis::around(&scenario.study.sensor_points[*index], "m/s²", values.collect::<Vec<_>>());
            let x = time(0.0..story.end);
            Panel::new(if place + 1 == all.len() { x } else { x.unnamed() }, y, layers)
        };
    Figure {
        title: title(story, "specific forces, as read by the accelerometers"),
        panels: all.iter().enumerate().map(panel).collect(),
        panel_height: 200,
    }
}
