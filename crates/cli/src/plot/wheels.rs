//! Figure `wheel` of three axes: speed and torque of each wheel, with their limits.

use flexsc_core::actuator::{Actuator, Wheels};
use flexsc_core::quantity::Positive;
use flexsc_core::record;
use flexsc_figure::{Axis, Figure, Layer, Panel, Point, Shape, colour};

use super::spatial::Cycles;
use super::story::Story;
use super::{time, title};

/// Colours of wheels, again from the first after the last.
const COLOURS: [plotters::style::RGBColor; 5] =
    [colour::BLUE, colour::VERMILLION, colour::GREEN, colour::ORANGE, colour::SKY];

/// The wheels of a scenario, if it has them.
pub fn of(story: &Story) -> Option<&Wheels> {
    if let Actuator::Wheels(wheels) = &story.scenario.actuator { Some(wheels) } else { None }
}

pub fn figure(story: &Story, cycles: &Cycles) -> Figure {
    let (speed, torque) = of(story).map_or((None, None), |wheels| {
        let by_momentum = wheels.momentum.map(|momentum| momentum.get() / wheels.inertia.get());
        let speeds = [wheels.speed_limit.map(Positive::get), by_momentum];
        (speeds.into_iter().flatten().reduce(f64::min), wheels.torque.map(Positive::get))
    });
    let count = cycles.wheels.first().map_or(0, |(_, row)| row.wheels.len());
    let panel =
        |x: Axis, name: &str, unit: &'static str, limit: Option<f64>, of: fn(&record::Wheel) -> f64| {
            let line = |wheel: usize| -> Vec<Point> {
                cycles.wheels.iter().map(|(time, row)| (*time, of(&row.wheels[wheel]))).collect()
            };
            let lines: Vec<_> = (0..count).map(line).collect();
            let limits: Vec<f64> = limit.into_iter().flat_map(|limit| [limit, -limit]).collect();
            let values = lines.iter().flatten().map(|(_, value)| *value);
            let y = Axis::around(name, unit, values.chain(limits.iter().copied()));
            let level = |(index, height): (usize, &f64)| {
                let name = if index == 0 { "limits" } else { "" };
                Layer::new(name, colour::GREY, Shape::Dashes, vec![(0.0, *height), (story.end, *height)])
            };
            let mut layers: Vec<Layer> = limits.iter().enumerate().map(level).collect();
            layers.extend(lines.into_iter().enumerate().map(|(wheel, points)| {
                let name = format!("wheel {}", wheel + 1);
                Layer::new(&name, COLOURS[wheel % COLOURS.len()], Shape::Line(1.2), points)
            }));
            Panel::new(x, y, layers)
        };
    let x = time(0.0..story.end);
    let panels = vec![
        panel(x.unnamed(), "speed", "rad/s", speed, |wheel| wheel.speed_rad_s),
        panel(x, "torque", "N m", torque, |wheel| wheel.torque_nm),
    ];
    Figure { title: title(story, "wheels"), panels, panel_height: 200 }
}
