//! Figure `magnetorquers` of three axes: magnetic moments with their limits, and the momentum of the wheels or the
//! rate of the body.

use flexsc_core::record::{Magnetorquers, Rates, Wheels};
use flexsc_figure::{Figure, OverTime, PanelLines};

use super::cycle_data::RowSource;
use super::figure_spec::{FigureSpec, MotionPart, RunData};
use super::pointing::norm;
use super::title;

pub const SPEC: FigureSpec = FigureSpec {
    name: "magnetorquers",
    contents: "Three axes: magnetic moments, and the momentum of the wheels or the rate",
    rows: &[RowSource::new::<Magnetorquers>(), RowSource::new::<Wheels>(), RowSource::new::<Rates>()],
    motion: MotionPart::Nothing,
    is_in: |story| story.scenario.actuator.magnetorquers().is_some(),
    draw: figure,
};

fn figure(RunData { story, cycles, .. }: &RunData<'_>) -> Figure {
    let largest = story.scenario.actuator.magnetorquers().map(|(torquers, _)| {
        [0, 1, 2].map(|axis| torquers.moment.about(axis).get()).into_iter().fold(0.0, f64::max)
    });
    let moment = |axis: usize| cycles.line(|row: &Magnetorquers| row.axes[axis].moment_am2);
    let (name, unit, kept) = if story.scenario.study.wheels.is_some() {
        ("momentum of the wheels", "N m s", cycles.wheel_momenta(story, norm))
    } else {
        ("rate", "rad/s", cycles.rates(|rigid, _| norm(rigid)))
    };
    OverTime::new(title(story, "magnetorquers"), story.end, 200)
        .panel("moment", "A m²", PanelLines::default().limits(largest).vector(moment))
        .panel(name, unit, PanelLines::default().from_zero().line("", kept))
        .figure()
}
