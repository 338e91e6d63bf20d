//! Figure `gain`: the gain and the decisions of the adaptation, and the windows of its objective.

use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour, steps};

use super::envelope::means;
use super::figure_spec::{FigureSpec, MotionPart};
use super::run_events::{RunEvents, WindowMean};
use super::{time, title};
use crate::key_axis::key_axis;

pub const SPEC: FigureSpec = FigureSpec {
    name: "gain",
    contents: "Gain and decisions of the adaptation",
    rows: &[],
    motion: MotionPart::Nothing,
    is_in: |story| !story.steps.is_empty(),
    draw: |run| figure(run.story),
};

fn figure(story: &RunEvents) -> Figure {
    let x = time(0.0..story.end);
    let gains = story.steps.iter().map(|step| (step.time, step.gain));
    let line = steps([(0.0, story.start.1)].into_iter().chain(gains), story.end);
    let decided = |decision: &str| -> Vec<Point> {
        let steps = story.steps.iter().filter(|step| step.decision == decision);
        steps.map(|step| (step.time, step.gain)).collect()
    };
    let kinds = [
        ("begin", "first step", colour::BLACK, LayerShape::Ring),
        ("keep", "better: same direction", colour::GREEN, LayerShape::Disc),
        ("turn", "worse: new direction", colour::VERMILLION, LayerShape::Triangle),
        ("ignore", "window ignored", colour::ORANGE, LayerShape::Square),
        ("freeze", "frozen", colour::BLUE, LayerShape::Diamond),
    ];
    let tunes = story.tunes();
    let key = story.scenario.tuned_key().unwrap_or_default();
    let mut y = key_axis(Some(&story.scenario), &key, line.iter().map(|(_, gain)| *gain));
    y.name = if y.unit.is_empty() { format!("gain {tunes}") } else { tunes.to_owned() };
    let mut layers = vec![Layer::new(tunes, colour::BLACK, LayerShape::Line(1.2), line)];
    let marks =
        kinds.map(|(decision, name, colour, shape)| Layer::new(name, colour, shape, decided(decision)));
    layers.extend(marks.into_iter().filter(|layer| !layer.points.is_empty()));
    let gain = Panel::new(x.unnamed(), y, layers);
    let (name, unit, layer, windows) = learnt(story);
    let all = windows.iter().map(|mean| mean.value);
    let means = Panel::new(
        x,
        FigureAxis::from_zero(&name, unit, all),
        vec![Layer::new(layer, colour::BLUE, LayerShape::Line(1.6), means(windows))],
    );
    Figure { title: title(story, "adaptation"), panels: vec![gain, means], panel_height: 220 }
}

/// Returns the objective of the adaptation: its name, its unit, the name of its windows, and the windows.
fn learnt(story: &RunEvents) -> (String, &'static str, &'static str, &[WindowMean]) {
    match story.scenario.objective().filter(|_| !story.objective.is_empty()) {
        None => ("mean envelope".to_owned(), "rad", "window means", &story.means),
        Some(objective) => {
            let unit = objective.unit(story.scenario.torque_unit());
            (objective.key().replace('_', " "), unit, "windows", &story.objective)
        }
    }
}
