//! Figures of a plan: torque, hub angle and an output over time, and the residual vibration over the frequency error
//! (\[Rotation\], figures 3 to 8 and beyond).

use flexsc_core::dynamics::axis_model::CommandedQuantity;
use flexsc_core::spacecraft::manoeuvre::Plan;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Named, Panel, Point, colour, name_and_unit};

use super::family::{CommandFamily, FamilyMember};
use super::trajectory::{self, PlannedMotion};
use crate::plot::readable;

/// Number of points of the frequency band.
const BAND: u32 = 401;

/// Returns all figures; `band` is the relative uncertainty of the frequencies.
pub fn all(family: &CommandFamily, band: f64) -> Vec<Named> {
    let named = |suffix: &str, figure| (format!("{}-plan-{suffix}", family.name), figure);
    let mut all = vec![named("torque", family.torque()), named("angle", family.angle())];
    // The hub's angle has a figure of its own.
    if family.shown > 0 {
        all.push(named(&in_a_path(&family.coordinate().0), family.output()));
    }
    all.push(named("robustness", family.robustness(band)));
    all
}

/// Replaces all characters but letters, digits, `-`, `_` and `.` by `-`.
fn in_a_path(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '-' }).collect()
}

impl CommandFamily<'_> {
    /// Returns the name and the unit of the shown coordinate.
    fn coordinate(&self) -> (String, String) {
        match self.shown.checked_sub(1).and_then(|index| self.body.outputs.get(index)) {
            Some(output) => (output.name.clone(), output.unit.clone()),
            None => ("angle".to_owned(), "rad".to_owned()),
        }
    }

    fn torque(&self) -> Figure {
        let lines = self.lines(|plan| plan.torque(self.body, trajectory::step(self.body, self.plan.time)));
        let name = if self.body.has_unit_inertia() { "acceleration" } else { "torque" };
        let y = FigureAxis::around(name, self.body.torque_unit(), heights(&lines));
        let zero =
            Layer::new("", colour::GREY, LayerShape::Line(0.8), vec![(0.0, 0.0), (self.plan.time, 0.0)]);
        let moves = if self.body.drive == CommandedQuantity::Motion { " that moves the hub" } else { "" };
        self.figure(&format!("{name}{moves}"), time(self.plan.time), y, vec![zero], lines)
    }

    fn angle(&self) -> Figure {
        let lines =
            self.lines(|plan| self.motion(plan).into_iter().map(|(t, motion)| (t, motion[0])).collect());
        let y = FigureAxis::around("hub angle", "rad", heights(&lines));
        let (plan, end) = (self.plan, self.end());
        let target = self.body.angle.get() + plan.angle;
        let goal = vec![(plan.time, target), (end, target + plan.end_rate * (end - plan.time))];
        let goal = Layer::new("goal", colour::BLACK, LayerShape::Dashes, goal);
        let below = vec![self.arrival(&y)];
        let mut figure = self.figure("hub angle", time(end), y, below, lines);
        figure.panels.iter_mut().for_each(|panel| panel.layers.push(goal.clone()));
        figure
    }

    fn output(&self) -> Figure {
        let (name, unit) = self.coordinate();
        let lines =
            self.lines(|plan| self.motion(plan).into_iter().map(|(t, motion)| (t, motion[1])).collect());
        let (label, unit) = name_and_unit(&name, &unit);
        let y = FigureAxis::around(&label, unit, heights(&lines));
        let below = vec![self.arrival(&y)];
        self.figure(&name, time(self.end()), y, below, lines)
    }

    fn robustness(&self, band: f64) -> Figure {
        let factor = |i: u32| band * (2.0 * f64::from(i) / f64::from(BAND - 1) - 1.0);
        let residual = |plan: &Plan, off: f64| plan.residual_at(self.body, 1.0 + off)[self.shown];
        let lines =
            self.lines(|plan| (0..BAND).map(factor).map(|off| (1e2 * off, residual(plan, off))).collect());
        let (name, unit) = self.coordinate();
        let (label, unit) = name_and_unit(&format!("left in {name}"), &unit);
        let y = FigureAxis::decades(&label, unit, heights(&lines));
        let x = FigureAxis::exact("all frequencies off by (%)", "", -1e2 * band..1e2 * band);
        self.figure(&format!("vibration left in {name}"), x, y, Vec::new(), lines)
    }

    fn lines(&self, line: impl Fn(&Plan) -> Vec<Point>) -> Vec<Vec<Point>> {
        self.members.iter().map(|member| line(&member.plan)).collect()
    }

    fn figure(
        &self,
        quantity: &str,
        x: FigureAxis,
        y: FigureAxis,
        below: Vec<Layer>,
        lines: Vec<Vec<Point>>,
    ) -> Figure {
        let layer = |(FamilyMember { name, colour, .. }, points): (&FamilyMember, Vec<Point>)| {
            Layer::new(name, *colour, LayerShape::Line(1.5), points)
        };
        let layers = below.into_iter().chain(self.members.iter().zip(lines).map(layer)).collect();
        let title = format!("{}: {quantity}", readable(self.name));
        Figure { title, panels: vec![Panel::new(x, y, layers)], panel_height: 340 }
    }

    /// Returns a line at the end of the manoeuvre.
    fn arrival(&self, y: &FigureAxis) -> Layer {
        let ends = vec![(self.plan.time, y.range.start), (self.plan.time, y.range.end)];
        Layer::new("", colour::GREY, LayerShape::Dashes, ends)
    }

    /// Returns the end of the shown time (s).
    fn end(&self) -> f64 {
        trajectory::end(self.body, self.plan)
    }

    /// Returns the hub's angle and the shown coordinate under a plan, by the exact solution.
    fn motion(&self, plan: &Plan) -> Vec<(f64, [f64; 2])> {
        let end = self.end();
        let count = (end / trajectory::step(self.body, end)).ceil();
        let mut motion = PlannedMotion::new(self.body, plan);
        let output = self.shown.checked_sub(1).and_then(|index| self.body.outputs.get(index));
        let mut sample_at = |t: f64| {
            let (hub, state) = motion.evaluate(t);
            (t, [hub.angle, output.map_or(hub.angle, |output| output.evaluate(state))])
        };
        (0..=count as u32).map(|i| sample_at(end * (f64::from(i) / count))).collect()
    }
}

fn heights(lines: &[Vec<Point>]) -> impl Iterator<Item = f64> {
    lines.iter().flatten().map(|point| point.1)
}

fn time(end: f64) -> FigureAxis {
    FigureAxis::exact("time", "s", 0.0..end)
}
