//! Figure `gimbals` of a spacecraft with control moment gyros: gimbal angles, gimbal rates with their limits, the
//! singularity measure, and the momentum of the rotors.

use flexsc_core::numerics::quantity::Positive;
use flexsc_core::record::{ControlMomentGyro, ControlMomentGyros};
use flexsc_figure::{Figure, OverTime, PanelLines};

use super::cycle_data::RowSource;
use super::figure_spec::{FigureSpec, MotionPart, RunData};
use super::title;

pub const SPEC: FigureSpec = FigureSpec {
    name: "gimbals",
    contents: "Control moment gyros: gimbal angles and rates, singularity measure, momentum",
    rows: &[RowSource::new::<ControlMomentGyros>()],
    motion: MotionPart::Nothing,
    is_in: |story| !story.scenario.study.gimbals.is_empty(),
    draw: figure,
};

fn figure(RunData { story, cycles, .. }: &RunData<'_>) -> Figure {
    let each = |of: fn(&ControlMomentGyro) -> f64| {
        let gyros = 0..story.scenario.study.gimbals.len();
        gyros.map(move |gyro| cycles.line(|row: &ControlMomentGyros| of(&row.gyros[gyro])))
    };
    let gyros = story.scenario.actuator.control_moment_gyros();
    let limit = gyros.and_then(|(gyros, _)| gyros.rate_limit).map(Positive::get);
    let momentum = |axis: usize| {
        cycles.line(|row: &ControlMomentGyros| {
            [row.momentum_x_nm_s, row.momentum_y_nm_s, row.momentum_z_nm_s][axis]
        })
    };
    let angles = PanelLines::default().numbered("gimbal", each(|gyro| gyro.angle_rad));
    let rates = PanelLines::default().limits(limit).numbered("gimbal", each(|gyro| gyro.rate_rad_s));
    let measure =
        PanelLines::default().from_zero().line("", cycles.line(|row: &ControlMomentGyros| row.singularity));
    OverTime::new(title(story, "control moment gyros"), story.end, 180)
        .panel("gimbal angle", "rad", angles)
        .panel("gimbal rate", "rad/s", rates)
        .panel("singularity measure", "", measure)
        .panel("momentum", "N m s", PanelLines::default().vector(momentum))
        .figure()
}
