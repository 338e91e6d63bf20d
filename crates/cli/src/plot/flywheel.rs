//! Figure `wheel`: speed and momentum of the flywheel with its limits.

use flexsc_core::control::actuator::FlywheelRotor;
use flexsc_core::numerics::quantity::Positive;
use flexsc_core::record::{Bearings, Pointing, Wheels};
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Note, Panel, Point, colour};

use super::cycle_data::RowSource;
use super::figure_spec::{FigureSpec, MotionPart, RunData};
use super::motion::MotionData;
use super::run_events::RunEvents;
use super::{swings, time, title, wheels};

pub const SPEC: FigureSpec = FigureSpec {
    name: "wheel",
    contents: "Speed and momentum of the flywheel, or speed of each wheel with limits and the pointing error",
    rows: &[RowSource::new::<Wheels>(), RowSource::new::<Bearings>(), RowSource::new::<Pointing>()],
    motion: MotionPart::All,
    is_in: |story| {
        rotor(story).is_some() && story.scenario.axis_count() == 1 || wheels::wheels(story).is_some()
    },
    draw,
};

/// Name of the speed of the rotor.
const SPEED: &str = "speed";

fn draw(run: &RunData<'_>) -> Figure {
    if wheels::wheels(run.story).is_some() { wheels::figure(run) } else { figure(run.story, run.motion) }
}

/// Returns the rotor of a scenario's wheel, if it has one that stores momentum.
fn rotor(story: &RunEvents) -> Option<&FlywheelRotor> {
    story.scenario.actuator.flywheel().and_then(|(wheel, _)| wheel.rotor.as_ref())
}

/// Returns the largest speed of the wheel of a single-axis body (rad/s), if it is limited.
pub fn speed_limit(story: &RunEvents) -> Option<f64> {
    rotor(story).filter(|_| story.scenario.axis_count() == 1)?.speed_limit.map(Positive::get)
}

fn figure(story: &RunEvents, motion: &MotionData) -> Figure {
    let limit = rotor(story).and_then(|rotor| Some((rotor.speed_limit?.get(), rotor.inertia.get())));
    let x = time(swings(story));
    let panel = |x: FigureAxis, name: &str, unit: &'static str, values: &[f64], limit: Option<f64>| {
        let line: Vec<Point> = motion.time.iter().copied().zip(values.iter().copied()).collect();
        let limits: Vec<f64> = limit.into_iter().flat_map(|limit| [limit, -limit]).collect();
        let y = FigureAxis::around(name, unit, values.iter().chain(&limits).copied());
        let y = if name == SPEED { y.in_rpm() } else { y };
        let level = |height: &f64| {
            let points = vec![(0.0, *height), (story.end, *height)];
            Layer::new("", colour::RED, LayerShape::Line(1.6), points)
        };
        let mut layers: Vec<Layer> = limits.iter().map(level).collect();
        layers.push(Layer::new("", colour::BLUE, LayerShape::Line(1.2), line));
        let unit = y.reader_unit();
        let note = |limit: f64| {
            Note::new(format!("limit {}", unit.quantity(limit)), (f64::INFINITY, limit), colour::RED)
        };
        Panel { notes: limit.map(note).into_iter().collect(), ..Panel::new(x, y, layers) }
    };
    // For a body without inertia, torques are accelerations of the body, and their integral is a rate.
    let (momentum, unit) = match super::unit_of_torque(story) {
        "N m" => ("momentum", "N m s"),
        _ => ("momentum over inertia", "rad/s"),
    };
    let [speeds, momenta] = &motion.wheel;
    let panels = vec![
        panel(x.unnamed(), SPEED, "rad/s", speeds, limit.map(|(speed, _)| speed)),
        panel(x, momentum, unit, momenta, limit.map(|(speed, inertia)| speed * inertia)),
    ];
    Figure { title: title(story, "flywheel"), panels, panel_height: 200 }
}
