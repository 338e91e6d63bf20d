//! Figure `hinges` of a spacecraft whose appendages swing on hinges: angles and rates of the hinges.

use flexsc_core::record::{HingeMotion, Hinges};
use flexsc_figure::{Figure, OverTime, PanelLines};

use super::cycle_data::RowSource;
use super::figure_spec::{FigureSpec, MotionPart, RunData};
use super::title;

pub const SPEC: FigureSpec = FigureSpec {
    name: "hinges",
    contents: "Appendages on hinges: their angles and rates",
    rows: &[RowSource::new::<Hinges>()],
    motion: MotionPart::Nothing,
    is_in: |story| story.scenario.study.hinges() > 0,
    draw: figure,
};

fn figure(RunData { story, cycles, .. }: &RunData<'_>) -> Figure {
    let each = |of: fn(&HingeMotion) -> f64| {
        let hinges = 0..cycles.first::<Hinges>().map_or(0, |row| row.hinges.len());
        PanelLines::default()
            .numbered("hinge", hinges.map(|hinge| cycles.line(|row: &Hinges| of(&row.hinges[hinge]))))
    };
    OverTime::new(title(story, "hinges"), story.end, 240)
        .panel("angle", "rad", each(|hinge| hinge.angle_rad))
        .panel("rate", "rad/s", each(|hinge| hinge.rate_rad_s))
        .figure()
}
