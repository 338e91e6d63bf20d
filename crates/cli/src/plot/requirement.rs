//! Figure `requirement`: what each requirement over time reads, with its limit, the time in which it counts, and the instant that
//! decides, from the motion that judges it.

use flexsc_core::answer::requirement_id;
use flexsc_core::control::operation::{Expression, ModeQuantity, ModeReadings, TimeWindow, Timed};
use flexsc_core::formats::reader_units::{ReaderUnit, ReaderUnits, number};
use flexsc_core::numerics::time::Span;
use flexsc_core::record::RequirementRobustness;
use flexsc_core::scenario::{AssessedRequirement, RequirementFormula, RequirementSource};
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Note, Panel, Point, colour};

use super::figure_spec::{FigureSpec, MotionPart, RunData};
use super::pointing::logarithmic_sizes;
use super::run_events::RunEvents;
use super::{time, title};
use crate::error::CliError;
use crate::required_limit::RequiredLimit;

pub const SPEC: FigureSpec = FigureSpec {
    name: "requirement",
    contents: "Requirements over time: what each reads, its limit, the time in which it counts, and the instant that decides; \
               requirement:R2 is that one alone",
    rows: &[],
    motion: MotionPart::Nothing,
    is_in: |story| story.scenario.study.requirements.iter().any(|own| formula(own).is_some()),
    draw: figure,
};

/// Ratio of the largest to the least value from which on an axis has decades.
const WIDE: f64 = 30.0;
/// Part of the largest value by which rounding may change one.
const ROUNDING: f64 = 1e-6;

/// Signals of a requirement by the quantities that it reads.
struct OwnSignals<'a>(Vec<(ModeQuantity, &'a [Point])>);

impl OwnSignals<'_> {
    fn points(&self, quantity: ModeQuantity) -> &[Point] {
        self.0.iter().find(|(own, _)| *own == quantity).map_or(&[], |(_, points)| points)
    }

    /// Returns the value of a quantity at a time (s), on the straight line between two points.
    fn value(&self, quantity: ModeQuantity, at: f64) -> f64 {
        let points = self.points(quantity);
        let next = points.partition_point(|point| point.0 <= at);
        let Some(before) = next.checked_sub(1).map(|last| points[last]) else { return f64::NAN };
        let after = points.get(next).copied().unwrap_or(before);
        let part = if after.0 > before.0 { (at - before.0) / (after.0 - before.0) } else { 0.0 };
        before.1 + (after.1 - before.1) * part
    }

    /// Returns the times (s) from which on a condition holds or does not, and whether it does.
    fn changes(&self, condition: &Expression) -> Vec<(f64, bool)> {
        let leaves = condition.leaves();
        let mut times: Vec<f64> =
            leaves.iter().flat_map(|(quantity, _)| self.points(*quantity)).map(|point| point.0).collect();
        times.sort_by(f64::total_cmp);
        let mut changes: Vec<(f64, bool)> = Vec::new();
        for at in times {
            let holds = condition.holds(&ReadingsAt { signals: self, at });
            match changes.last_mut() {
                Some(last) if last.0 == at => last.1 = holds,
                Some(last) if last.1 == holds => {}
                _ => changes.push((at, holds)),
            }
        }
        changes
    }

    /// Returns the intervals (s) in which an expression reads quantities that are measured, if it is judged in some intervals.
    fn counted(&self, expression: &Expression, at: &[[f64; 2]], end: f64) -> Vec<[f64; 2]> {
        let after = |window: TimeWindow| -> Vec<[f64; 2]> {
            let moved = |[from, to]: &[f64; 2]| {
                [from + window.from, window.to.map_or(end, |length| to + length).min(end)]
            };
            at.iter().map(moved).filter(|[from, to]| from <= to).collect()
        };
        match expression {
            Expression::Compared { .. } | Expression::Flag(_) => at.to_vec(),
            Expression::Not(inner) => self.counted(inner, at, end),
            Expression::All(all) | Expression::Any(all) => {
                all.iter().flat_map(|inner| self.counted(inner, at, end)).collect()
            }
            Expression::Timed(timed) => match &**timed {
                Timed::Always(window, inner) => self.counted(inner, &after(*window), end),
                Timed::Until(_, window, _) => after(TimeWindow { from: 0.0, ..*window }),
                Timed::While(scope, inner) => {
                    let holding = self.holding(scope, end);
                    let common = |[from, to]: [f64; 2]| {
                        holding.iter().map(move |own| [own[0].max(from), own[1].min(to)])
                    };
                    let inside: Vec<[f64; 2]> =
                        at.iter().copied().flat_map(common).filter(|[from, to]| from < to).collect();
                    self.counted(inner, &inside, end)
                }
                Timed::When(event, then) => {
                    let starts: Vec<[f64; 2]> =
                        self.holding(event, end).into_iter().map(|[from, _]| [from; 2]).collect();
                    self.counted(then, &starts, end)
                }
            },
        }
    }

    /// Returns the intervals (s) in which a condition holds.
    fn holding(&self, condition: &Expression, end: f64) -> Vec<[f64; 2]> {
        let changes = self.changes(condition);
        let ends = changes.iter().skip(1).map(|(at, _)| *at).chain([end]);
        changes.iter().zip(ends).filter(|((_, holds), _)| *holds).map(|((from, _), to)| [*from, to]).collect()
    }
}

/// Readings at a time (s).
struct ReadingsAt<'a, 'b> {
    signals: &'a OwnSignals<'b>,
    at: f64,
}

impl ModeReadings for ReadingsAt<'_, '_> {
    fn value(&self, quantity: ModeQuantity) -> f64 {
        self.signals.value(quantity, self.at)
    }

    fn clock(&self, quantity: ModeQuantity) -> Span {
        Span::from_seconds(self.value(quantity))
    }
}

fn formula(own: &AssessedRequirement) -> Option<&RequirementFormula> {
    if let RequirementSource::Formula(formula) = &own.source { Some(formula) } else { None }
}

/// Returns the index of the requirement over time with an identifier or a name.
///
/// # Errors
/// A name of no requirement over time.
pub fn index_of(story: &RunEvents, name: &str) -> Result<usize, CliError> {
    let all = story.scenario.study.requirements.iter().enumerate();
    let mut timed = all.filter(|(_, own)| formula(own).is_some());
    let found = timed.clone().find(|(index, own)| own.name == name || requirement_id(*index) == name);
    found.map(|(index, _)| index).ok_or_else(|| {
        let known: Vec<String> =
            timed.by_ref().map(|(index, own)| format!("{} ({})", requirement_id(index), own.name)).collect();
        let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        CliError::Arguments(format!(
            "--what requirement:{name}: no requirement over time of this name; there are {known}"
        ))
    })
}

fn figure(run: &RunData<'_>) -> Figure {
    let (story, judged) = (run.story, run.judged);
    let mut panels = Vec::new();
    for (requirement, places) in &judged.signals.of_requirements {
        let own = &story.scenario.study.requirements[*requirement];
        let Some(formula) = formula(own)
            .filter(|_| story.requirements.is_empty() || story.requirements.contains(requirement))
        else {
            continue;
        };
        let leaves = formula.expression.leaves().into_iter().map(|(quantity, _)| quantity);
        let points = places.iter().map(|place| &judged.signals.signals[*place][..]);
        let signals = OwnSignals(leaves.zip(points).collect());
        let robustness = judged.robustness.iter().find(|found| found.requirement == *requirement);
        panels.extend(requirement_panels(story, (*requirement, own, formula), &signals, robustness));
    }
    let last = panels.len().saturating_sub(1);
    for panel in panels.iter_mut().take(last) {
        panel.x = panel.x.unnamed();
    }
    let panel_height = if panels.len() > 1 { 180 } else { 300 };
    Figure { title: title(story, "requirements over time"), panels, panel_height }
}

/// Returns the panels of a requirement: one for each limit of a quantity, or one that shows whether a condition of flags holds.
fn requirement_panels(
    story: &RunEvents,
    (index, own, formula): (usize, &AssessedRequirement, &RequirementFormula),
    signals: &OwnSignals<'_>,
    robustness: Option<&RequirementRobustness>,
) -> Vec<Panel> {
    let (end, decided) = (story.end, robustness.and_then(RequirementRobustness::decided));
    let verdict = match decided {
        Some(f64::INFINITY) => "not exercised".to_owned(),
        Some(value) => format!("robustness {}", number(value)),
        None => "undecided".to_owned(),
    };
    let head = format!("{} {}: {verdict}", requirement_id(index), own.name);
    let counted = signals.counted(&formula.expression, &[[0.0; 2]], end);
    let at = robustness.filter(|_| decided.is_some_and(f64::is_finite)).map(|found| found.at);
    let mut compared: Vec<(ModeQuantity, f64)> = Vec::new();
    let mut flags = Vec::new();
    for leaf in formula.expression.measured() {
        match leaf {
            Expression::Compared { quantity, limit, .. } if !compared.contains(&(*quantity, *limit)) => {
                compared.push((*quantity, *limit));
            }
            Expression::Flag(_) => flags.push(leaf.clone()),
            _ => {}
        }
    }
    let single = formula.limited_quantity().map(|_| RequiredLimit::new(own));
    let shown = story.shown.clone().unwrap_or(0.0..end);
    let mut panels: Vec<Panel> = compared
        .into_iter()
        .map(|(quantity, limit)| {
            let points = signals.points(quantity).to_vec();
            let name = story.scenario.quantity_name(quantity).replace('_', " ");
            let unit = quantity.unit();
            let y = axis(&name, unit, &points, limit);
            let y = single.as_ref().map_or(y.clone(), |single| RequiredLimit::shown(Some(single), y));
            let words = single
                .as_ref()
                .map_or_else(|| ReaderUnits::Engineering.quantity(limit, unit), |single| single.text.clone());
            let mut panel = Panel::new(
                time(shown.clone()),
                y,
                vec![Layer::new("", colour::BLUE, LayerShape::Line(1.0), points)],
            );
            let line =
                counted.iter().flat_map(|[from, to]| [(*from, limit), (*to, limit), (f64::NAN, f64::NAN)]);
            let line = line.collect();
            panel.layers.push(Layer::new(
                &format!("limit {words}"),
                colour::RED,
                LayerShape::Line(1.6),
                line,
            ));
            if let Some(at) = at {
                let here = (at, signals.value(quantity, at));
                panel.layers.push(Layer::new("", colour::BLACK, LayerShape::Disc, vec![here]));
                let at = ReaderUnit::for_time_axis(shown.end - shown.start).quantity(at);
                panel.notes.push(Note::new(format!("decides at {at}"), here, colour::BLACK));
            }
            panel
        })
        .collect();
    if panels.is_empty() {
        let holds_there = at.map(|at| (at, decided > Some(0.0)));
        panels.push(condition_panel(signals, &Expression::Any(flags), time(shown), (end, holds_there)));
    }
    for panel in &mut panels {
        let [low, high] = [panel.y.range.start, panel.y.range.end];
        let area = counted.iter().flat_map(|[from, to]| {
            [(*from, low), (*to, low), (*to, high), (*from, high), (f64::NAN, f64::NAN)]
        });
        let area = area.collect();
        panel.layers.insert(0, Layer::new("counts", colour::ORANGE, LayerShape::Area(0.15), area));
    }
    if let Some(first) = panels.first_mut() {
        first.remark = head;
    }
    panels
}

/// Returns the panel of a condition of flags up to the end of the run (s), with the instant that decides and whether the
/// condition holds there.
fn condition_panel(
    signals: &OwnSignals<'_>,
    condition: &Expression,
    x: FigureAxis,
    (end, decides): (f64, Option<(f64, bool)>),
) -> Panel {
    let level = |holds: bool| f64::from(u8::from(holds));
    let holds = signals.changes(condition);
    let ends = holds.iter().skip(1).map(|(at, _)| *at).chain([end]);
    let steps =
        holds.iter().zip(ends).flat_map(|((from, holds), to)| [(*from, level(*holds)), (to, level(*holds))]);
    let mut layers = vec![Layer::new("", colour::BLUE, LayerShape::Line(1.2), steps.collect())];
    layers.extend(
        decides.map(|(at, holds)| Layer::new("", colour::BLACK, LayerShape::Disc, vec![(at, level(holds))])),
    );
    Panel::new(x, FigureAxis::exact("condition holds", "", -0.1..1.1), layers)
}

/// Returns the axis of a quantity with its limit: with decades if it has no sign and its values are far apart.
fn axis(name: &str, unit: &'static str, points: &[Point], limit: f64) -> FigureAxis {
    let values = || points.iter().map(|point| point.1).chain([limit]).filter(|value| value.is_finite());
    let sizes = logarithmic_sizes(values());
    let (least, most) = (sizes.first().copied().unwrap_or(0.0), sizes.last().copied().unwrap_or(0.0));
    // A size may be below 0 by rounding.
    let is_size = values().all(|value| value >= -ROUNDING * most);
    match is_size {
        true if unit.starts_with("rad") && most > WIDE * least => FigureAxis::decades(name, unit, sizes),
        true => FigureAxis::from_zero(name, unit, values()),
        false => FigureAxis::around(name, unit, values()),
    }
}
