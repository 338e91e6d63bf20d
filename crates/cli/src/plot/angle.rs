//! Figure `angle`: the hub's angle over the run with its goal, its distance from the goal, and the settling time.

use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, band, colour};

use super::figure_spec::{FigureSpec, MotionPart, RunData};
use super::motion::MotionData;
use super::run_events::RunEvents;
use super::{arrival, dead_zone, time, title};

pub const SPEC: FigureSpec = FigureSpec {
    name: "angle",
    contents: "Angle of the hub, with its goal and settling time; with a switching law, at the end of the run",
    rows: &[],
    motion: MotionPart::Ends,
    is_in: |story| story.scenario.axis_count() == 1,
    draw,
};

fn draw(run: &RunData<'_>) -> Figure {
    if run.story.switches() {
        dead_zone::figure(run.story, run.motion)
    } else {
        figure(run.story, run.motion)
    }
}

/// Errors below this fraction of the goal are rounding errors, and shown as zero on an axis that ends at `SMALL` (rad).
const ROUNDING: f64 = 1e-13;
const SMALL: f64 = 2e-9;
/// Half height of the second panel for a body that is brought to angle 0, as a multiple of the band.
const BANDS: f64 = 4.0;

fn figure(story: &RunEvents, motion: &MotionData) -> Figure {
    let over_time =
        |values: &[f64]| -> Vec<Point> { motion.time.iter().copied().zip(values.iter().copied()).collect() };
    let x = time(0.0..story.end);
    let error: Vec<f64> = motion.angle.iter().zip(&motion.goal).map(|(angle, goal)| angle - goal).collect();
    let settled = SettlingCurve::from_events(story, &motion.time, &error);
    let marks =
        |y: &FigureAxis| settled.iter().flat_map(|settled| settled.layers(story, y)).collect::<Vec<_>>();
    let panels = if story.scenario.plan.is_some() {
        let whole = FigureAxis::around("angle", "rad", motion.angle.iter().chain(&motion.goal).copied());
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let beyond = if largest(&error) > ROUNDING * largest(&motion.goal) {
            FigureAxis::around("error", "rad", error.iter().copied())
        } else {
            FigureAxis::exact("error", "rad", -SMALL..SMALL)
        };
        let mut above: Vec<Layer> = arrival(story, &whole).into_iter().collect();
        above.extend([
            Layer::new("angle of the hub", colour::BLACK, LayerShape::Line(1.4), over_time(&motion.angle)),
            Layer::new("commanded angle", colour::ORANGE, LayerShape::Dashes, over_time(&motion.goal)),
        ]);
        let mut below: Vec<Layer> = arrival(story, &beyond).into_iter().chain(marks(&beyond)).collect();
        below.push(Layer::new(
            "angle minus commanded angle",
            colour::BLUE,
            LayerShape::Line(1.2),
            over_time(&error),
        ));
        vec![Panel::new(x.unnamed(), whole, above), Panel::new(x, beyond, below)]
    } else {
        let whole = FigureAxis::around("angle", "rad", motion.angle.iter().copied());
        let near = settled.as_ref().map(|settled| BANDS * settled.band);
        let near = near.map(|half| FigureAxis::exact("angle", "rad", -half..half));
        let panel = |x: FigureAxis, y: FigureAxis, named: bool| {
            let mut layers = marks(&y);
            layers.push(Layer::new("angle", colour::BLACK, LayerShape::Line(1.2), over_time(&motion.angle)));
            for layer in layers.iter_mut().filter(|_| !named) {
                layer.name.clear();
            }
            Panel::new(x, y, layers)
        };
        match near {
            Some(near) => vec![panel(x.unnamed(), whole, true), panel(x, near, false)],
            None => vec![panel(x, whole, true)],
        }
    };
    Figure { title: title(story, "angle"), panels, panel_height: 220 }
}

/// Settling to the goal, as defined by the metric `settling_time_s`.
struct SettlingCurve {
    /// Half width of the band in which the angle has settled (rad).
    band: f64,
    /// Start of the goal (s).
    from: f64,
    /// Time at which the band is entered for good (s); `None` if the run ends outside it.
    settled_at: Option<f64>,
}

impl SettlingCurve {
    /// Returns `None` without motion, without a goal, or if no band is given after a manoeuvre, which may end anywhere near its
    /// goal.
    fn from_events(story: &RunEvents, times: &[f64], error: &[f64]) -> Option<Self> {
        if !story.scenario.has_goal() {
            return None;
        }
        let from = story.scenario.plan.as_ref().map_or(0.0, |plan| plan.time);
        let band = story.scenario.reference.band.map(flexsc_core::numerics::quantity::Positive::get);
        let promise = story.scenario.expected_band();
        let promised = if from > 0.0 { None } else { error.first().map(|first| promise.band(first.abs())) };
        let band = band.or(promised).filter(|band| *band > 0.0)?;
        let beyond = |row: usize| error[row].abs() - band;
        let outside = |row: &usize| times[*row] >= from - 1e-9 && beyond(*row) > 0.0;
        let settled_at = match (0..times.len().min(error.len())).rfind(outside) {
            None => Some(from),
            // The last row outside and the next one, between which the band is entered.
            Some(last) => times.get(last + 1).map(|next| {
                let part = beyond(last) / (beyond(last) - beyond(last + 1));
                times[last] + part * (next - times[last])
            }),
        };
        Some(Self { band, from, settled_at })
    }

    fn layers(&self, story: &RunEvents, y: &FigureAxis) -> Vec<Layer> {
        let level = |height: f64| [(self.from, height), (story.end, height)];
        let width = format!("within ±{}", ReaderUnits::Engineering.quantity(self.band, "rad"));
        let within = band(&level(-self.band), &level(self.band));
        let mut layers = vec![Layer::new(&width, colour::GREEN, LayerShape::Area(0.25), within)];
        if let Some(settling) = self.settled_at {
            let line = vec![(settling, y.range.start), (settling, y.range.end)];
            let name = format!("settled at {settling:.1} s");
            layers.push(Layer::new(&name, colour::VERMILLION, LayerShape::Dashes, line));
        }
        layers
    }
}
