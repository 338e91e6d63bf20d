//! Figure `wheel` of three axes: speed and torque of each wheel with their limits; with friction also the friction
//! torque and the pointing error.

use flexsc_core::control::actuator::Wheels;
use flexsc_core::dynamics::three_axis::Bearing;
use flexsc_core::numerics::attitude::AXES;
use flexsc_core::numerics::quantity::Positive;
use flexsc_core::record;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::cycle_data::CycleData;
use super::run_events::RunEvents;
use super::{time, title};

/// Colours of wheels, cyclic.
const COLOURS: [plotters::style::RGBColor; 5] =
    [colour::BLUE, colour::VERMILLION, colour::GREEN, colour::ORANGE, colour::SKY];

/// Returns the wheels of a scenario, if it has them.
pub fn wheels(story: &RunEvents) -> Option<&Wheels> {
    story.scenario.actuator.wheels().map(|(wheels, _)| wheels)
}

pub fn figure(story: &RunEvents, cycles: &CycleData) -> Figure {
    let (speed, torque) = wheels(story).map_or((None, None), |wheels| {
        let by_momentum = wheels.momentum.map(|momentum| momentum.get() / wheels.inertia.get());
        let speeds = [wheels.speed_limit.map(Positive::get), by_momentum];
        (speeds.into_iter().flatten().reduce(f64::min), wheels.torque.map(Positive::get))
    });
    let rubs = story.scenario.study.bearings.iter().any(Bearing::can_stick);
    let count = cycles.rows::<record::Wheels>().next().map_or(0, |(_, row)| row.wheels.len());
    let each = |value_of: fn(&record::Wheel) -> f64| -> Vec<Vec<Point>> {
        let line = |wheel: usize| {
            cycles.rows::<record::Wheels>().map(|(time, row)| (time, value_of(&row.wheels[wheel]))).collect()
        };
        (0..count).map(line).collect()
    };
    let panel =
        |x: FigureAxis, name: &str, unit: &'static str, limit: Option<f64>, lines: Vec<Vec<Point>>| {
            let limits: Vec<f64> = limit.into_iter().flat_map(|limit| [limit, -limit]).collect();
            let values = lines.iter().flatten().map(|(_, value)| *value);
            let y = FigureAxis::around(name, unit, values.chain(limits.iter().copied()));
            let level = |(index, height): (usize, &f64)| {
                let name = if index == 0 { "limits" } else { "" };
                Layer::new(name, colour::GREY, LayerShape::Dashes, vec![(0.0, *height), (story.end, *height)])
            };
            let mut layers: Vec<Layer> = limits.iter().enumerate().map(level).collect();
            layers.extend(lines.into_iter().enumerate().map(|(wheel, points)| {
                let name = format!("wheel {}", wheel + 1);
                Layer::new(&name, COLOURS[wheel % COLOURS.len()], LayerShape::Line(1.2), points)
            }));
            Panel::new(x, y, layers)
        };
    let x = time(0.0..story.end);
    let last = if rubs { x.unnamed() } else { x.clone() };
    let mut panels = vec![
        panel(x.unnamed(), "speed", "rad/s", speed, each(|wheel| wheel.speed_rad_s)),
        panel(last, "torque", "N m", torque, each(|wheel| wheel.torque_nm)),
    ];
    if rubs {
        let friction = |wheel: usize| {
            cycles
                .rows::<record::Bearings>()
                .map(|(time, row)| (time, row.wheels[wheel].friction_nm))
                .collect()
        };
        panels.push(panel(x.unnamed(), "friction", "N m", None, (0..count).map(friction).collect()));
        let error = |axis: usize| cycles.errors(|error| error[axis]);
        let axes = AXES.iter().enumerate().map(|(axis, name)| {
            Layer::new(name, COLOURS[axis % COLOURS.len()], LayerShape::Line(1.2), error(axis))
        });
        let values = (0..3).flat_map(|axis| error(axis).into_iter().map(|(_, value)| value));
        panels.push(Panel::new(x, FigureAxis::around("error", "rad", values), axes.collect()));
    }
    Figure { title: title(story, "wheels"), panels, panel_height: 200 }
}
