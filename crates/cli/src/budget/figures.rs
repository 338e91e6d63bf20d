//! Figure of a budget: the fraction of all values of the index that are within a value.

use flexsc_core::analysis::budget::{BudgetLevel, CampaignBudget, INTERPRETATIONS, LEVELS};
use flexsc_core::scenario::Interpretation;
use flexsc_figure::{
    Figure, FigureAxis, Layer, LayerShape, Named, Note, NoteSide, Panel, Point, colour, name_and_unit,
};

use crate::required_limit::RequiredLimit;

/// Number of points of a line.
const POINTS: usize = 200;

/// Returns the figure of a budget, with the name of its file.
pub fn named(scenario: &str, budget: &CampaignBudget) -> Named {
    let requirement = &budget.requirement;
    let largest = budget.magnitudes.last().copied().unwrap_or(0.0).max(requirement.limit);
    let points = || (0..=POINTS).map(move |index| 1.05 * largest * index as f64 / POINTS as f64);
    let count = budget.magnitudes.len() as f64;
    let shown = points().map(|most| {
        let within = budget.magnitudes.partition_point(|value| *value <= most);
        (most, 100.0 * within as f64 / count)
    });
    let mut layers = vec![Layer::new("runs", colour::BLUE, LayerShape::Line(1.6), shown.collect())];
    if let Some(sources) = &budget.sources {
        let distribution = sources.distribution(Interpretation::Mixed);
        let convolved = points().map(|most| (most, 100.0 * distribution.probability(most)));
        layers.push(Layer::new("convolved", colour::ORANGE, LayerShape::Dashes, convolved.collect()));
    }
    let required = RequiredLimit::new(requirement);
    layers.push(required.line(vec![(requirement.limit, 0.0), (requirement.limit, 100.0)]));
    let (name, unit) = name_and_unit(&requirement.name, requirement.unit);
    let x = RequiredLimit::shown(Some(&required), FigureAxis::exact(&name, unit, 0.0..1.05 * largest));
    let mixed = INTERPRETATIONS.iter().position(|way| *way == Interpretation::Mixed).unwrap_or(0);
    let level = |(level, of): (f64, &[BudgetLevel; 3])| (of[mixed].campaign, 100.0 * level);
    let levels = LEVELS.into_iter().zip(&budget.levels).map(level);
    let levels: Vec<Point> = levels.filter(|(value, _)| value.is_finite()).collect();
    let note = |(value, percent): &Point| {
        let text = format!("{percent:.1} %: {}", x.reader_unit().quantity(*value));
        Note::new(text, (*value, *percent), colour::BLUE).on(NoteSide::Right)
    };
    // From the lowest to the highest, so that names of levels close to each other go downwards.
    let notes: Vec<Note> = levels.iter().map(note).collect();
    layers.push(Layer::new("", colour::BLUE, LayerShape::Disc, levels));
    let y = FigureAxis::exact("within (%)", "", 0.0..104.0);
    let title = format!("{scenario}: {}", requirement.description());
    let figure = Figure { title, panels: vec![Panel::new(x, y, layers).noted(notes)], panel_height: 260 };
    (format!("{scenario}-budget-{}", file_part(&requirement.name)), figure)
}

/// Returns a name as a part of a file's name.
fn file_part(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect()
}
