//! Figure `wheel` of three axes: speed and torque of each wheel with their limits; with friction also the friction
//! torque and the pointing error.

use flexsc_core::control::actuator::Wheels;
use flexsc_core::dynamics::three_axis::Bearing;
use flexsc_core::numerics::attitude::AXES;
use flexsc_core::numerics::quantity::Positive;
use flexsc_core::record;
use flexsc_figure::{Figure, OverTime, PanelLines};

use super::figure_spec::RunData;
use super::run_events::RunEvents;
use super::title;

/// Returns the wheels of a scenario, if it has them.
pub fn wheels(story: &RunEvents) -> Option<&Wheels> {
    story.scenario.actuator.wheels().map(|(wheels, _)| wheels)
}

pub fn figure(RunData { story, cycles, .. }: &RunData<'_>) -> Figure {
    let (speed, torque) = wheels(story).map_or((None, None), |wheels| {
        let by_momentum = wheels.momentum.map(|momentum| momentum.get() / wheels.inertia.get());
        let speeds = [wheels.speed_limit.map(Positive::get), by_momentum];
        (speeds.into_iter().flatten().reduce(f64::min), wheels.torque.map(Positive::get))
    });
    let count = cycles.first::<record::Wheels>().map_or(0, |row| row.wheels.len());
    let each = |limit: Option<f64>, value_of: fn(&record::Wheel) -> f64| {
        let line = |wheel: usize| cycles.line(|row: &record::Wheels| value_of(&row.wheels[wheel]));
        PanelLines::default().limits("limits", limit).numbered("wheel", (0..count).map(line))
    };
    let figure = OverTime::new(title(story, "wheels"), story.end, 200)
        .panel("speed", "rad/s", each(speed, |wheel| wheel.speed_rad_s).of_rotors())
        .panel("torque", "N m", each(torque, |wheel| wheel.torque_nm));
    if !story.scenario.study.bearings.iter().any(Bearing::can_stick) {
        return figure.figure();
    }
    let friction = |wheel: usize| cycles.line(|row: &record::Bearings| row.wheels[wheel].friction_nm);
    let errors =
        AXES.iter().enumerate().map(|(axis, name)| ((*name).to_owned(), cycles.errors(|error| error[axis])));
    figure
        .panel("friction", "N m", PanelLines::default().numbered("wheel", (0..count).map(friction)))
        .panel("error", "rad", PanelLines::default().named(errors))
        .figure()
}
