//! Figure `drives` of a spacecraft with turning appendages: drive angles, and natural frequencies relative to their
//! highest.

use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_core::record::DrivesMotion;
use flexsc_figure::{Figure, OverTime, PanelLines, Point};

use super::cycle_data::RowSource;
use super::figure_spec::{FigureSpec, MotionPart, RunData};
use super::title;

pub const SPEC: FigureSpec = FigureSpec {
    name: "drives",
    contents: "Rotating appendages: drive angles and natural frequencies",
    rows: &[RowSource::new::<DrivesMotion>()],
    motion: MotionPart::Nothing,
    is_in: |story| story.scenario.study.articulation().is_some(),
    draw: figure,
};

/// Ratio of its lowest to its highest value above which a frequency is constant.
const CONSTANT: f64 = 0.999;

fn figure(RunData { story, cycles, .. }: &RunData<'_>) -> Figure {
    let (drives, modes) =
        cycles.first::<DrivesMotion>().map_or((0, 0), |row| (row.drives.len(), row.modes.len()));
    let angle = |drive: usize| unwrapped(cycles.line(|row: &DrivesMotion| row.drives[drive].angle_rad));
    let relative = |mode: usize| {
        let line = cycles.line(|row: &DrivesMotion| row.modes[mode].frequency_rad_s);
        let highest = line.iter().map(|(_, value)| *value).fold(0.0, f64::max);
        let varies = line.iter().any(|(_, value)| *value < CONSTANT * highest);
        let ratio = line.into_iter().map(|(time, value)| (time, value / highest)).collect();
        varies.then(|| (ReaderUnits::Engineering.frequency().quantity(highest), ratio))
    };
    let frequencies: Vec<(String, Vec<Point>)> = (0..modes).filter_map(relative).collect();
    let subject = match (frequencies.len(), modes - frequencies.len()) {
        (0, _) => "drives".to_owned(),
        (_, 0) => "drives and natural frequencies".to_owned(),
        (_, constant) => format!("drives and natural frequencies ({constant} constant ones left out)"),
    };
    OverTime::new(title(story, &subject), story.end, 240)
        .panel("angle", "rad", PanelLines::default().numbered("drive", (0..drives).map(angle)))
        .panel("frequency over its highest", "", PanelLines::default().named(frequencies))
        .figure()
}

/// Adds a gap to a line wherever an angle wraps around.
fn unwrapped(line: Vec<Point>) -> Vec<Point> {
    let mut parted: Vec<Point> = Vec::new();
    for point in line {
        if parted.last().is_some_and(|last| (point.1 - last.1).abs() > std::f64::consts::PI) {
            parted.push((point.0, f64::NAN));
        }
        parted.push(point);
    }
    parted
}
