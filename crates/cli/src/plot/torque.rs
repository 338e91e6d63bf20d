//! Figure `torque`: the commanded torque at the end of the run, strong and weak.

use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour, round_to_nice, steps};

use super::figure_spec::{FigureSpec, MotionPart, RunData};
use super::run_events::RunEvents;
use super::{manoeuvre_torque, time, title};

pub const SPEC: FigureSpec = FigureSpec {
    name: "torque",
    contents: "Torque; with a switching law, at the end of the run",
    rows: &[],
    motion: MotionPart::Unswitched,
    is_in: |story| story.scenario.axis_count() == 1,
    draw,
};

fn draw(run: &RunData<'_>) -> Figure {
    if run.story.switches() { figure(run.story) } else { manoeuvre_torque::figure(run.story, run.motion) }
}

/// Approximate number of switchings that are shown: five cycles of a two-sided relay.
const SWITCHINGS: usize = 30;

/// Returns the interval at the end of the run that is shown (s): all of it if there are few switchings.
pub fn shown(story: &RunEvents) -> std::ops::Range<f64> {
    if let Some(shown) = &story.shown {
        return shown.clone();
    }
    let first = story.switchings.len().checked_sub(SWITCHINGS).map_or(0.0, |i| story.switchings[i].time);
    let span = round_to_nice(story.end - first);
    let from = if first > 0.0 { (story.end - span).max(0.0) } else { 0.0 };
    from..story.end
}

fn figure(story: &RunEvents) -> Figure {
    let commands = story.switchings.iter().map(|s| (s.time, s.torque));
    let line = steps([(0.0, story.start.0)].into_iter().chain(commands), story.end);
    let x = time(shown(story));

    // A panel for the strong torque, and a second one for a much weaker torque.
    let levels = line.iter().map(|(_, torque)| torque.abs()).filter(|torque| *torque > 0.0);
    let strong = levels.clone().fold(0.0, f64::max);
    let weak = levels.filter(|level| *level < 0.2 * strong).fold(0.0, f64::max);
    let (quantity, unit) = story.scenario.model.commanded_quantity();
    let panel = |x: FigureAxis, name: &str, most: f64, named: bool| {
        let most = if most > 0.0 { 1.3 * most } else { 1.0 };
        let marks = |timeout: bool| -> Vec<Point> {
            let switchings = story.switchings.iter().filter(|s| s.timeout == timeout);
            switchings.map(|s| (s.time, s.torque)).collect()
        };
        let legend = |name: &'static str| if named { name } else { "" };
        let zero = vec![(x.range.start, 0.0), (x.range.end, 0.0)];
        let layers = vec![
            Layer::new("", colour::GREY, LayerShape::Line(0.8), zero),
            Layer::new(legend(quantity), colour::BLACK, LayerShape::Line(1.2), line.clone()),
            Layer::new(legend("switching by guard"), colour::VERMILLION, LayerShape::Disc, marks(false)),
            Layer::new(legend("by timeout"), colour::BLUE, LayerShape::Diamond, marks(true)),
        ];
        Panel::new(x, FigureAxis::exact(name, unit, -most..most), layers)
    };
    let title = title(story, quantity);
    if weak > 0.0 {
        let panels = vec![
            panel(x.unnamed(), quantity, strong, true),
            panel(x, &format!("weak {quantity}"), weak, false),
        ];
        Figure { title, panels, panel_height: 200 }
    } else {
        Figure { title, panels: vec![panel(x, quantity, strong, true)], panel_height: 300 }
    }
}
