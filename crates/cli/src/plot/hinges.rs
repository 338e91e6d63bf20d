//! Figure `hinges` of a spacecraft whose appendages swing on hinges: angles and rates of the hinges.

use flexsc_core::record::{HingeMotion, Hinges};
use flexsc_figure::{Figure, Point};

use super::cycle_data::CycleData;
use super::drives::alike;
use super::run_events::RunEvents;
use super::{time, title};

pub fn figure(story: &RunEvents, cycles: &CycleData) -> Figure {
    let hinges = cycles.rows::<Hinges>().next().map_or(0, |(_, row)| row.hinges.len());
    let lines = |value_of: &dyn Fn(&HingeMotion) -> f64| -> Vec<(String, Vec<Point>)> {
        let line = |hinge: usize| {
            cycles.rows::<Hinges>().map(|(time, row)| (time, value_of(&row.hinges[hinge]))).collect()
        };
        (0..hinges).map(|hinge| (format!("hinge {}", hinge + 1), line(hinge))).collect()
    };
    let x = time(0.0..story.end);
    let angles = alike(x.unnamed(), "angle", "rad", lines(&|hinge| hinge.angle_rad));
    let rates = alike(x, "rate", "rad/s", lines(&|hinge| hinge.rate_rad_s));
    Figure { title: title(story, "hinges"), panels: vec![angles, rates], panel_height: 240 }
}
