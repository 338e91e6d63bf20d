//! Figure `magnetorquers` of three axes: magnetic moments with their limits, and the momentum of the wheels or the
//! body.

use flexsc_core::record::Magnetorquers;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::cycle_data::CycleData;
use super::pointing::norm;
use super::run_events::RunEvents;
use super::{time, title};

const COLOURS: [(&str, plotters::style::RGBColor); 3] =
    [("x", colour::BLUE), ("y", colour::VERMILLION), ("z", colour::GREEN)];

/// Returns true if a scenario has magnetorquers.
pub fn applies_to(story: &RunEvents) -> bool {
    story.scenario.actuator.magnetorquers().is_some()
}

pub fn figure(story: &RunEvents, cycles: &CycleData) -> Figure {
    let limits = story.scenario.actuator.magnetorquers().map(|(torquers, _)| {
        [0, 1, 2].map(|axis| torquers.moment.about(axis).get()).into_iter().fold(0.0, f64::max)
    });
    let moments = COLOURS.iter().enumerate().map(|(axis, (name, colour))| {
        let points: Vec<Point> =
            cycles.rows::<Magnetorquers>().map(|(time, row)| (time, row.axes[axis].moment_am2)).collect();
        Layer::new(name, *colour, LayerShape::Line(1.2), points)
    });
    let levels: Vec<f64> = limits.into_iter().flat_map(|limit| [limit, -limit]).collect();
    let level = |(index, height): (usize, &f64)| {
        let name = if index == 0 { "largest" } else { "" };
        Layer::new(name, colour::GREY, LayerShape::Dashes, vec![(0.0, *height), (story.end, *height)])
    };
    let layers: Vec<Layer> = levels.iter().enumerate().map(level).chain(moments).collect();
    let values = layers.iter().flat_map(|layer| &layer.points).map(|(_, value)| *value);
    let y = FigureAxis::around("moment", "A m²", values.collect::<Vec<_>>());
    let x = time(0.0..story.end);
    let moments = Panel::new(x.unnamed(), y, layers);
    let wheels = story.scenario.study.wheels.is_some();
    let points: Vec<Point> =
        if wheels { cycles.wheel_momenta(story, norm) } else { cycles.rates(|rigid, _| norm(rigid)) };
    let (name, unit) = if wheels { ("momentum of the wheels", "N m s") } else { ("rate", "rad/s") };
    let y = FigureAxis::from_zero(name, unit, points.iter().map(|(_, value)| *value).collect::<Vec<_>>());
    let kept = Panel::new(x, y, vec![Layer::new("", colour::BLUE, LayerShape::Line(1.2), points)]);
    Figure { title: title(story, "magnetorquers"), panels: vec![moments, kept], panel_height: 200 }
}
