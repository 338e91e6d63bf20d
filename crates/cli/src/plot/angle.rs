//! Figure `angle`: the hub's angle over the run with its goal, and how far it is from it.

use super::story::{Motion, Story};
use super::{arrival, time, title};
use crate::figure::{Axis, Figure, Layer, Panel, Point, Shape, colour};

pub fn figure(story: &Story, motion: &Motion) -> Figure {
    let over_time =
        |values: &[f64]| -> Vec<Point> { motion.time.iter().copied().zip(values.iter().copied()).collect() };
    let x = time(0.0..story.end);
    let error: Vec<f64> = motion.angle.iter().zip(&motion.goal).map(|(angle, goal)| angle - goal).collect();
    let panel = |x: Axis, y: Axis, layers: Vec<Layer>| {
        let layers = arrival(story, &y).into_iter().chain(layers).collect();
        Panel { x, y, layers }
    };
    let panels = vec![
        panel(
            x.unnamed(),
            Axis::around("angle", "rad", motion.angle.iter().chain(&motion.goal).copied()),
            vec![
                Layer::new("goal of a rigid body", colour::ORANGE, Shape::Line(1.2), over_time(&motion.goal)),
                Layer::new("hub", colour::BLACK, Shape::Line(1.4), over_time(&motion.angle)),
            ],
        ),
        panel(
            x,
            Axis::around("beyond the goal", "rad", error.iter().copied()),
            vec![Layer::new("", colour::BLUE, Shape::Line(1.2), over_time(&error))],
        ),
    ];
    Figure { title: title(story, "angle"), panels, panel_height: 220 }
}
