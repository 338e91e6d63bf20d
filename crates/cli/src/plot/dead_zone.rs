//! Figure `angle` for a switching law: the angle at the end of the run, with the dead zone and the switchings.

use flexsc_core::control::law::RelaySides;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::motion::MotionData;
use super::run_events::RunEvents;
use super::{time, title, torque};

pub fn figure(story: &RunEvents, motion: &MotionData) -> Figure {
    let shown = torque::shown(story);
    let line = motion.time.iter().copied().zip(motion.angle.iter().copied());
    let line: Vec<Point> = line.filter(|(time, _)| *time >= shown.start - 1e-9).collect();
    let points = |timeout: bool| -> Vec<Point> {
        let angles = story
            .switchings
            .iter()
            .filter(|s| s.timeout == timeout && s.time >= shown.start && s.time <= shown.end);
        angles.map(|s| (s.time, s.angle)).collect()
    };
    let borders: Vec<f64> = match story.scenario.law.relay() {
        Some(relay) => match relay.sides {
            RelaySides::Two => vec![relay.dead_zone.get(), -relay.dead_zone.get()],
            RelaySides::One => vec![relay.dead_zone.get()],
        },
        None => Vec::new(),
    };
    let y =
        FigureAxis::around("angle x", "rad", line.iter().map(|point| point.1).chain(borders.iter().copied()));
    let border = |(index, height): (usize, &f64)| {
        let name = match (index, borders.len()) {
            (0, 1) => "ε",
            (0, _) => "±ε",
            _ => "",
        };
        Layer::new(name, colour::GREY, LayerShape::Dashes, vec![(shown.start, *height), (shown.end, *height)])
    };
    let mut layers: Vec<Layer> = borders.iter().enumerate().map(border).collect();
    layers.extend([
        Layer::new("angle", colour::BLACK, LayerShape::Line(1.2), line),
        Layer::new("switching by guard", colour::VERMILLION, LayerShape::Disc, points(false)),
        Layer::new("by timeout", colour::BLUE, LayerShape::Diamond, points(true)),
    ]);
    let panels = vec![Panel::new(time(shown), y, layers)];
    Figure { title: title(story, "angle"), panels, panel_height: 300 }
}
