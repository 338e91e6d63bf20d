//! Figure `line-of-sight` of a three-axis body: the error of each line of sight, and the displacement of its point.

use flexsc_core::record::{LineOfSightAxis, LineOfSightSample};
use flexsc_figure::{Figure, Layer, LayerShape, OverTime, PanelLines, RGBColor, colour};

use super::cycle_data::RowSource;
use super::figure_spec::{FigureSpec, MotionPart, RunData};
use super::title;

pub const SPEC: FigureSpec = FigureSpec {
    name: "line-of-sight",
    contents: "Three axes: error of each line of sight, and displacement of its point",
    rows: &[RowSource::new::<LineOfSightSample>()],
    motion: MotionPart::Nothing,
    is_in: |story| !story.scenario.line_of_sight.is_empty(),
    draw: figure,
};

const COLOURS: [RGBColor; 3] = [colour::BLUE, colour::VERMILLION, colour::GREEN];

fn figure(RunData { story, cycles, .. }: &RunData<'_>) -> Figure {
    let subject = title(story, "lines of sight, against their target directions");
    let mut figure = OverTime::new(subject, story.end, 200);
    for (index, line) in story.scenario.line_of_sight.iter().enumerate() {
        // Axes along which nothing happens have no line.
        let lines = |names: [&str; 3], value_of: fn(&LineOfSightAxis) -> f64| {
            let layer = |axis: usize| {
                let of =
                    |row: &LineOfSightSample| (row.line == index as u64).then(|| value_of(&row.axes[axis]));
                Layer::new(names[axis], COLOURS[axis], LayerShape::Line(0.8), cycles.line_where(of))
            };
            let moving = |layer: &Layer| layer.points.iter().any(|(_, value)| *value != 0.0);
            (0..3).map(layer).filter(moving).fold(PanelLines::default(), PanelLines::layer)
        };
        let errors = lines(["about x", "about y", "about z"], |axis| axis.error_rad);
        let displacements = lines(["along x", "along y", "along z"], |axis| axis.displacement_m);
        figure = figure.panel(&format!("{}: error", line.point), "rad", errors).panel(
            &format!("{}: displacement", line.point),
            "m",
            displacements,
        );
    }
    figure.figure()
}
