//! Figure `fine-mirror` of a three-axis body: each line of sight before its mirror, the angle of the mirror, and what is left.

use flexsc_core::record::{FineMirrorAxis, FineMirrorSample};
use flexsc_core::scenario::LineOfSight;
use flexsc_figure::{Figure, Layer, LayerShape, OverTime, PanelLines, RGBColor, colour};

use super::cycle_data::RowSource;
use super::figure_spec::{FigureSpec, MotionPart, RunData};
use super::title;

pub const SPEC: FigureSpec = FigureSpec {
    name: "fine-mirror",
    contents: "Three axes: lines of sight before their fine mirrors, angles of the mirrors, and what is left",
    rows: &[RowSource::new::<FineMirrorSample>()],
    motion: MotionPart::Nothing,
    is_in: |story| story.scenario.line_of_sight.iter().any(|line| line.mirror.is_some()),
    draw: figure,
};

const COLOURS: [RGBColor; 3] = [colour::BLUE, colour::VERMILLION, colour::GREEN];
const NAMES: [&str; 3] = ["about x", "about y", "about z"];

/// Value about an axis, with its name.
type Shown = (&'static str, fn(&FineMirrorAxis) -> f64);

const SHOWN: [Shown; 3] = [
    ("before the mirror", |axis| axis.before_rad),
    ("mirror", |axis| axis.angle_rad),
    ("behind the mirror", |axis| axis.before_rad - axis.angle_rad),
];

fn figure(RunData { story, cycles, .. }: &RunData<'_>) -> Figure {
    let subject = title(story, "fine mirrors of lines of sight");
    let mut figure = OverTime::new(subject, story.end, 160);
    let lines = story.scenario.line_of_sight.iter().enumerate();
    for (index, LineOfSight { point, .. }) in lines.filter(|(_, line)| line.mirror.is_some()) {
        for (name, value_of) in SHOWN {
            let layer = |axis: usize| {
                let of =
                    |row: &FineMirrorSample| (row.line == index as u64).then(|| value_of(&row.axes[axis]));
                Layer::new(NAMES[axis], COLOURS[axis], LayerShape::Line(0.8), cycles.line_where(of))
            };
            // Axes along which nothing happens have no line.
            let moving = |layer: &Layer| layer.points.iter().any(|(_, value)| *value != 0.0);
            let layers = (0..3).map(layer).filter(moving).fold(PanelLines::default(), PanelLines::layer);
            figure = figure.panel(&format!("{point}: {name}"), "rad", layers);
        }
    }
    figure.figure()
}
