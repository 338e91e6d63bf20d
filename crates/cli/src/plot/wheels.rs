//! Figure `wheel` of three axes: speed of each wheel with its limit, torque where it matters, with friction also the friction
//! torque, and the pointing error.

use flexsc_core::control::actuator::Wheels;
use flexsc_core::dynamics::three_axis::Bearing;
use flexsc_core::numerics::quantity::Positive;
use flexsc_core::record;
use flexsc_figure::{Figure, Layer, LayerShape, OverTime, PanelLines, Point, RGBColor, colour};

use super::figure_spec::RunData;
use super::run_events::RunEvents;
use super::{pointing, title};

/// Colours of the wheels, cyclic.
const COLOURS: [RGBColor; 6] =
    [colour::BLUE, colour::GREEN, colour::ORANGE, colour::BLACK, colour::SKY, colour::VERMILLION];
/// Part of its limit from which on a torque is shown.
const SHOWN: f64 = 0.1;
/// Part of the range of all wheels within which two curves are one.
const ONE: f64 = 0.01;
/// Number of marks on a curve that is under two others.
const MARKS: usize = 12;

/// Returns the wheels of a scenario, if it has them.
pub fn wheels(story: &RunEvents) -> Option<&Wheels> {
    story.scenario.actuator.wheels().map(|(wheels, _)| wheels)
}

/// Returns the largest speed (rad/s) and torque (N m) of a wheel, each if it is limited.
pub fn limits(story: &RunEvents) -> [Option<f64>; 2] {
    wheels(story).map_or([None; 2], |wheels| [wheels.speed_bound(), wheels.torque.map(Positive::get)])
}

pub fn figure(RunData { story, cycles, .. }: &RunData<'_>) -> Figure {
    let count = cycles.first::<record::Wheels>().map_or(0, |row| row.wheels.len());
    let [speed, torque] = limits(story);
    let panel = |lines: Vec<Vec<Point>>, limit: Option<f64>| {
        PanelLines::default().limits(limit).layers(named(&lines))
    };
    let lines = |value_of: fn(&record::Wheel) -> f64| -> Vec<Vec<Point>> {
        let line = |wheel: usize| cycles.line(|row: &record::Wheels| value_of(&row.wheels[wheel]));
        (0..count).map(line).collect()
    };
    let speeds = panel(lines(|wheel| wheel.speed_rad_s), speed).of_rotors();
    let mut figure =
        OverTime::new(title(story, "wheels"), story.end, 180).panel("wheel speed", "rad/s", speeds);
    let torques = lines(|wheel| wheel.torque_nm);
    let largest = torques.iter().flatten().fold(0.0, |most: f64, point| most.max(point.1.abs()));
    if torque.is_none_or(|limit| largest > SHOWN * limit) {
        figure = figure.panel("wheel torque", "N m", panel(torques, torque));
    }
    if story.scenario.study.bearings.iter().any(Bearing::can_stick) {
        let friction = |wheel: usize| cycles.line(|row: &record::Bearings| row.wheels[wheel].friction_nm);
        figure = figure.panel("friction", "N m", panel((0..count).map(friction).collect(), None));
    }
    let mut figure = figure.figure();
    // The first panel names the wheels of all.
    for panel in figure.panels.iter_mut().skip(1) {
        panel.layers.iter_mut().for_each(|layer| layer.name.clear());
    }
    if let Some(last) = figure.panels.last_mut() {
        last.x = last.x.unnamed();
    }
    let shown = story.shown.clone().unwrap_or(0.0..story.end);
    figure.panels.push(pointing::error_panel(
        story,
        &pointing::with_target(story, cycles.errors(pointing::norm)),
        shown,
    ));
    figure
}

/// Returns the lines of wheels with their names. A line that lies on others is dashed or has marks, so that all are seen.
fn named(lines: &[Vec<Point>]) -> Vec<Layer> {
    let values = || lines.iter().flatten().map(|point| point.1);
    let (low, high) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    let near = ONE * (high - low);
    let is_one = |a: &[Point], b: &[Point]| a.iter().zip(b).all(|(a, b)| (a.1 - b.1).abs() <= near);
    let layer = |(index, line): (usize, &Vec<Point>)| {
        let below = lines[..index].iter().filter(|other| is_one(line, other)).count();
        let above = lines[index + 1..].iter().filter(|other| is_one(line, other)).count();
        let (shape, points) = match (below, above) {
            (0, 0) => (LayerShape::Line(1.2), line.clone()),
            (0, _) => (LayerShape::Line(3.0), line.clone()),
            (1, _) => (LayerShape::Dashes, line.clone()),
            (other, _) => {
                let step = line.len().div_ceil(MARKS).max(1);
                let marks = line.iter().skip(step / 2).step_by(step).copied().collect();
                (if other == 2 { LayerShape::Ring } else { LayerShape::Square }, marks)
            }
        };
        Layer::new(&format!("wheel {}", index + 1), COLOURS[index % COLOURS.len()], shape, points)
    };
    lines.iter().enumerate().map(layer).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_on_each_other_are_all_seen() {
        let line = |height: f64| (0..100).map(|i| (f64::from(i), height)).collect::<Vec<Point>>();
        let layers = named(&[line(1.0), line(1.0), line(5.0), line(1.0)]);
        let shapes = [LayerShape::Line(3.0), LayerShape::Dashes, LayerShape::Line(1.2), LayerShape::Ring];
        assert_eq!(layers.iter().map(|layer| layer.shape).collect::<Vec<_>>(), shapes);
        assert_eq!(layers[3].points.len(), 11);
    }
}
