//! Figure `modes`: the displacement of each elastic mode at the end of the run.

use super::motion::Motion;
use super::story::Story;
use super::{swings, time, title};
use crate::figure::{Axis, Figure, Layer, Panel, Point, Shape, colour};

/// So many modes have a panel, at most.
const PANELS: usize = 6;

pub fn figure(story: &Story, motion: &Motion) -> Figure {
    let shown = swings(story);
    let frequencies = story.scenario.model.modes.iter().map(|mode| mode.frequency.get());
    let since = if story.scenario.drift.is_some() { " at the start" } else { "" };
    let last = motion.modes.len().min(PANELS).saturating_sub(1);
    let panel = |(index, (values, frequency)): (usize, (&Vec<f64>, f64))| {
        let line = motion.time.iter().copied().zip(values.iter().copied());
        let line: Vec<Point> = line.filter(|(time, _)| *time >= shown.start).collect();
        let x = time(shown.clone());
        let name = format!("mode {index}, {frequency} rad/s{since}");
        Panel::new(
            if index == last { x } else { x.unnamed() },
            Axis::around("displacement", "rad", line.iter().map(|(_, value)| *value)),
            vec![Layer::new(&name, colour::BLUE, Shape::Line(1.2), line)],
        )
    };
    let panels: Vec<_> = motion.modes.iter().zip(frequencies).take(PANELS).enumerate().map(panel).collect();
    let more = motion.modes.len().saturating_sub(PANELS);
    let what =
        if more > 0 { format!("elastic modes, {more} more left out") } else { "elastic modes".to_owned() };
    Figure { title: title(story, &what), panels, panel_height: 130 }
}
