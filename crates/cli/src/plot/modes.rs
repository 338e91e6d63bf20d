//! Figure `modes`: the displacement of each elastic mode at the end of the run.

use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::figure_spec::{FigureSpec, MotionPart};
use super::motion::MotionData;
use super::run_events::RunEvents;
use super::{swings, time, title};

pub const SPEC: FigureSpec = FigureSpec {
    name: "modes",
    contents: "Each elastic mode; with a switching law, at the end of the run",
    rows: &[],
    motion: MotionPart::Ends,
    is_in: |story| story.scenario.axis_count() == 1 && story.scenario.mode_count() > 0,
    draw: |run| figure(run.story, run.motion),
};

/// Largest number of modes with a panel each.
const PANELS: usize = 6;

fn figure(story: &RunEvents, motion: &MotionData) -> Figure {
    let shown = swings(story);
    let frequencies = story.scenario.model.frequencies();
    let since = if story.scenario.drift.is_some() { " at the start" } else { "" };
    let last = motion.modes.len().min(PANELS).saturating_sub(1);
    let panel = |(index, (values, frequency)): (usize, (&Vec<f64>, f64))| {
        let line = motion.time.iter().copied().zip(values.iter().copied());
        let line: Vec<Point> = line.filter(|(time, _)| *time >= shown.start).collect();
        let x = time(shown.clone());
        let name = format!("mode {index}, {} rad/s{since}", digits(frequency, 5));
        Panel::new(
            if index == last { x } else { x.unnamed() },
            FigureAxis::around("displacement", "rad", line.iter().map(|(_, value)| *value)),
            vec![Layer::new(&name, colour::BLUE, LayerShape::Line(1.2), line)],
        )
    };
    let panels: Vec<_> = motion.modes.iter().zip(frequencies).take(PANELS).enumerate().map(panel).collect();
    let more = motion.modes.len().saturating_sub(PANELS);
    let subject =
        if more > 0 { format!("elastic modes, {more} more left out") } else { "elastic modes".to_owned() };
    Figure { title: title(story, &subject), panels, panel_height: 130 }
}

/// Formats a positive number with at most `most` significant digits.
fn digits(number: f64, most: i32) -> String {
    let decimals = (f64::from(most) - 1.0 - number.log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{number:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frequencies_are_short() {
        let numbers = [0.44, 10.0, 3.330_081_535_753_227, 22.348_647_095_581_605, 123_456.7, 1e-4];
        let texts = ["0.44", "10", "3.3301", "22.349", "123457", "0.0001"];
        assert_eq!(numbers.map(|number| digits(number, 5)), texts);
    }
}
