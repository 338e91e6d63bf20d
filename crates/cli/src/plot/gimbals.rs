//! Figure `gimbals` of a spacecraft with control moment gyros: gimbal angles, gimbal rates with their limits, the
//! singularity measure, and the momentum of the rotors.

use flexsc_core::numerics::quantity::Positive;
use flexsc_core::record::ControlMomentGyros;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::cycle_data::CycleData;
use super::run_events::RunEvents;
use super::{time, title};

/// Colours of gimbals, cyclic.
const COLOURS: [plotters::style::RGBColor; 5] =
    [colour::BLUE, colour::VERMILLION, colour::GREEN, colour::ORANGE, colour::SKY];

/// Returns true if a scenario has control moment gyros.
pub fn applies_to(story: &RunEvents) -> bool {
    !story.scenario.study.gimbals.is_empty()
}

pub fn figure(story: &RunEvents, cycles: &CycleData) -> Figure {
    let line = |value_of: &dyn Fn(&ControlMomentGyros) -> f64| -> Vec<Point> {
        cycles.rows().map(|(time, row)| (time, value_of(row))).collect()
    };
    let named = |lines: Vec<(String, Vec<Point>)>| -> Vec<Layer> {
        let layer = |(index, (name, points)): (usize, (String, Vec<Point>))| {
            Layer::new(&name, COLOURS[index % COLOURS.len()], LayerShape::Line(1.2), points)
        };
        lines.into_iter().enumerate().map(layer).collect()
    };
    let each = |value_of: fn(&flexsc_core::record::ControlMomentGyro) -> f64| {
        let gimbal =
            |index: usize| (format!("gimbal {}", index + 1), line(&|row| value_of(&row.gyros[index])));
        named((0..story.scenario.study.gimbals.len()).map(gimbal).collect())
    };
    let values = |layers: &[Layer]| -> Vec<f64> {
        layers.iter().flat_map(|layer| &layer.points).map(|(_, value)| *value).collect()
    };
    let x = time(0.0..story.end);
    let panel_around = |name: &str, unit: &'static str, layers: Vec<Layer>| {
        Panel::new(x.unnamed(), FigureAxis::around(name, unit, values(&layers)), layers)
    };
    let limit = story.scenario.actuator.control_moment_gyros();
    let limit = limit.and_then(|(gyros, _)| gyros.rate_limit).map(Positive::get);
    let limits = limit.into_iter().flat_map(|limit| [("limits", limit), ("", -limit)]);
    let mut rates: Vec<Layer> = limits
        .map(|(name, height)| {
            Layer::new(name, colour::GREY, LayerShape::Dashes, vec![(0.0, height), (story.end, height)])
        })
        .collect();
    rates.extend(each(|gyro| gyro.rate_rad_s));
    let measure = Layer::new("", colour::BLUE, LayerShape::Line(1.2), line(&|row| row.singularity));
    let momentum = named(vec![
        ("x".to_owned(), line(&|row| row.momentum_x_nm_s)),
        ("y".to_owned(), line(&|row| row.momentum_y_nm_s)),
        ("z".to_owned(), line(&|row| row.momentum_z_nm_s)),
    ]);
    let measured = values(std::slice::from_ref(&measure));
    let panels = vec![
        panel_around("gimbal angle", "rad", each(|gyro| gyro.angle_rad)),
        panel_around("gimbal rate", "rad/s", rates),
        Panel::new(x.unnamed(), FigureAxis::from_zero("singularity measure", "", measured), vec![measure]),
        Panel { x: x.clone(), ..panel_around("momentum", "N m s", momentum) },
    ];
    Figure { title: title(story, "control moment gyros"), panels, panel_height: 180 }
}
