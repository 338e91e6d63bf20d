//! Figure `torques` of three axes: about each axis the torque of the actuators with the torque demanded by the law, and
//! the disturbances with the environment.

use flexsc_core::numerics::attitude::AXES;
use flexsc_core::record::{Torque, Torques};
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, RGBColor, colour};

use super::cycle_data::{CycleData, RowSource};
use super::figure_spec::{FigureSpec, MotionPart};
use super::run_events::RunEvents;
use super::three_axis::panels;
use super::{time, title};

pub const SPEC: FigureSpec = FigureSpec {
    name: "torques",
    contents: "Three axes: torques demanded by the law, given by the actuators, and of disturbances",
    rows: &[RowSource::new::<Torques>()],
    motion: MotionPart::Nothing,
    is_in: applies_to,
    draw: |run| figure(run.story, run.cycles),
};

/// Colours of the axes.
const COLOURS: [RGBColor; 3] = [colour::BLUE, colour::VERMILLION, colour::GREEN];

/// Returns true if a log has torques: pulses of jets that act alone are in the figure `jets`.
fn applies_to(story: &RunEvents) -> bool {
    let scenario = &story.scenario;
    scenario.axis_count() == 3 && (!scenario.study.jets_alone || scenario.environment.is_some())
}

fn figure(story: &RunEvents, cycles: &CycleData) -> Figure {
    let torque_about = |axis: usize, value_of: fn(&Torque) -> f64| -> Vec<Point> {
        cycles.rows::<Torques>().map(|(time, row)| (time, value_of(&row.axes[axis]))).collect()
    };
    // Demands are steps, drawn with a wider line than the actuators' response.
    let lines = |axis: usize| {
        let name = |name| if axis == 0 { name } else { "" };
        let [demanded, applied] =
            [torque_about(axis, |torque| torque.feedback_nm), torque_about(axis, |torque| torque.applied_nm)];
        vec![
            Layer::new(name("demanded by the law"), colour::SKY, LayerShape::Line(2.8), demanded),
            Layer::new(name("given by the actuators"), colour::BLACK, LayerShape::Line(1.0), applied),
        ]
    };
    let mut panels = panels(story, "N m", lines);
    let disturbing: Vec<Vec<Point>> =
        (0..3).map(|axis| torque_about(axis, |torque| torque.disturbance_nm)).collect();
    if disturbing.iter().flatten().any(|(_, torque)| *torque != 0.0) {
        if let Some(last) = panels.last_mut() {
            last.x = last.x.unnamed();
        }
        let values: Vec<f64> = disturbing.iter().flatten().map(|(_, torque)| *torque).collect();
        let line = |(axis, points): (usize, Vec<Point>)| {
            Layer::new(AXES[axis], COLOURS[axis], LayerShape::Line(1.2), points)
        };
        let layers = disturbing.into_iter().enumerate().map(line).collect();
        panels.push(Panel::new(
            time(0.0..story.end),
            FigureAxis::around("disturbance", "N m", values),
            layers,
        ));
    }
    Figure { title: title(story, "torques on the body"), panels, panel_height: 160 }
}
