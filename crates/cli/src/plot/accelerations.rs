//! Figure `accelerations` of a spacecraft: the readings of each accelerometer along its axes.

use flexsc_core::control::sensor::Accelerometer;
use flexsc_core::record::Accelerations;
use flexsc_figure::{Figure, OverTime, PanelLines};

use super::cycle_data::RowSource;
use super::figure_spec::{FigureSpec, MotionPart, RunData};
use super::title;

pub const SPEC: FigureSpec = FigureSpec {
    name: "accelerations",
    contents: "Three axes: readings of the accelerometers",
    rows: &[RowSource::new::<Accelerations>()],
    motion: MotionPart::Nothing,
    is_in: |story| story.scenario.sensor.accelerometers().next().is_some(),
    draw: figure,
};

fn figure(RunData { story, cycles, .. }: &RunData<'_>) -> Figure {
    let scenario = &story.scenario;
    let whole = OverTime::new(title(story, "specific forces, as read by the accelerometers"), story.end, 200);
    let panel = |whole: OverTime, (index, accelerometer): (usize, &Accelerometer)| {
        let own = accelerometer.along.is_empty();
        let line = |axis: usize| {
            let name = if own { ["x", "y", "z"][axis].to_owned() } else { format!("axis {}", axis + 1) };
            let of = |row: &Accelerations| (row.sensor == index as u64).then(|| row.axes[axis].measured_m_s2);
            (name, cycles.line_where(of))
        };
        let axes = if own { 3 } else { accelerometer.along.len() };
        let lines = PanelLines::default().width(0.8).named((0..axes).map(line));
        whole.panel(&scenario.study.sensor_points[index], "m/s²", lines)
    };
    scenario.sensor.accelerometers().fold(whole, panel).figure()
}
