//! Limits of requirements as lines over the time in which they count, with their values as they were written.

use flexsc_core::control::operation::ModeQuantity;
use flexsc_core::formats::reader_units::percent;
use flexsc_core::numerics::time::Instant;
use flexsc_core::scenario::{
    AssessedRequirement, ErrorAxis, IndexWindow, Interpretation, RequirementSource, SampledQuantity, mode_of,
};
use flexsc_figure::{Layer, LayerShape, Note, Panel, colour};

use super::run_events::RunEvents;
use crate::required_limit::RequiredLimit;

/// Part of the time of a figure from which on a limit is seen as a line.
const SEEN: f64 = 0.01;

/// Limit of a requirement over the time in which it counts.
pub struct LimitOverTime {
    /// Limit.
    pub required: RequiredLimit,
    /// Intervals in which it counts (s).
    windows: Vec<[f64; 2]>,
    /// Name, limit and level in words.
    words: String,
}

/// Returns the limits on an error of a quantity itself, of its norm or about an axis.
pub fn limits(
    story: &RunEvents,
    is_quantity: impl Fn(&SampledQuantity) -> bool,
    axis: Option<ErrorAxis>,
) -> Vec<LimitOverTime> {
    let limit = |own: &AssessedRequirement| {
        let (span, mode) = match &own.source {
            RequirementSource::Error(error)
                if error.index == IndexWindow::Absolute
                    && error.axis == axis
                    && is_quantity(&error.quantity) =>
            {
                let scope = error.scope.as_ref().and_then(|(condition, _)| mode_of(condition));
                ([error.from, error.to].map(Instant::seconds), scope)
            }
            RequirementSource::Formula(formula)
                if axis.is_none()
                    && is_quantity(&SampledQuantity::PointingError)
                    && formula.limited_quantity() == Some(ModeQuantity::PointingError) =>
            {
                formula.span()
            }
            _ => return None,
        };
        let [from, to] = span;
        let required = RequiredLimit::new(own);
        let level = match own.interpretation {
            _ if own.level >= 1.0 => String::new(),
            Interpretation::Ensemble => format!(", {} of runs", percent(own.level)),
            Interpretation::Temporal | Interpretation::Mixed => {
                format!(", {} of the time", percent(own.level))
            }
        };
        let words = format!("{}: {}{level}", own.name, required.text);
        let whole = [from, if from > to { story.end } else { to.min(story.end) }];
        let windows = mode.map_or_else(|| vec![whole], |mode| in_mode(story, mode, whole));
        Some(LimitOverTime { required, windows, words })
    };
    story.scenario.study.requirements.iter().filter_map(limit).collect()
}

/// Returns the parts of an interval (s) in a mode of operation.
fn in_mode(story: &RunEvents, mode: usize, [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let ends = story.modes.iter().skip(1).map(|start| start.time).chain([story.end]);
    let of_mode = story.modes.iter().zip(ends).filter(|(start, _)| start.index == mode);
    let parts = of_mode.map(|(start, end)| [start.time.max(from), end.min(to)]);
    parts.filter(|[from, to]| from < to).collect()
}

/// Adds limits to a panel over time: a line over each window, or a mark where it is short, and the words once.
pub fn add(panel: &mut Panel, limits: &[LimitOverTime], is_mirrored: bool) {
    let shown = panel.x.range.clone();
    for own in limits {
        let inside = |[from, to]: &[f64; 2]| [from.max(shown.start), to.min(shown.end)];
        let windows = own.windows.iter().map(inside).filter(|[from, to]| from <= to);
        let windows: Vec<[f64; 2]> = windows.collect();
        let signs: &[f64] = if is_mirrored { &[1.0, -1.0] } else { &[1.0] };
        for sign in signs {
            let height = sign * own.required.limit;
            let (mut line, mut marks) = (Vec::new(), Vec::new());
            for [from, to] in &windows {
                line.extend([(*from, height), (*to, height), (f64::NAN, f64::NAN)]);
                if to - from < SEEN * (shown.end - shown.start) {
                    marks.push((f64::midpoint(*from, *to), height));
                }
            }
            panel.layers.push(Layer::new("", colour::RED, LayerShape::Line(1.8), line));
            panel.layers.push(Layer::new("", colour::RED, LayerShape::Diamond, marks));
        }
        let longest = windows.iter().max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
        panel.notes.extend(longest.map(|[from, to]| {
            Note::new(own.words.clone(), (f64::midpoint(*from, *to), own.required.limit), colour::RED)
        }));
    }
}
