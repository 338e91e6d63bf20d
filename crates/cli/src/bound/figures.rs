//! Figure of guaranteed ranges over time, with their limits and witnesses.

use flexsc_core::analysis::bound::OutputBound;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Note, Panel, Point, band, colour};

/// Returns the figure: a panel for each claim.
pub fn figure(name: &str, bounds: &[OutputBound]) -> Figure {
    Figure {
        title: format!("{name}: guaranteed ranges"),
        panels: bounds.iter().map(panel).collect(),
        panel_height: 240,
    }
}

fn panel(bound: &OutputBound) -> Panel {
    let end = |of: fn(&flexsc_core::analysis::bound::RangeRow) -> f64| -> Vec<Point> {
        bound.rows.iter().map(|row| (row.time_s, of(row))).collect()
    };
    let (lower, upper) = (end(|row| row.low), end(|row| row.high));
    let limits = bound.limits.iter().flatten().copied();
    let values = lower.iter().chain(&upper).map(|(_, value)| *value).chain(limits.clone());
    let y = FigureAxis::around(&bound.output.name.replace('_', " "), unit(&bound.output.unit), values);
    let x = FigureAxis::exact("time", "s", 0.0..bound.until_s);
    let mut layers = vec![
        Layer::new("guaranteed range", colour::BLUE, LayerShape::Area(0.25), band(&lower, &upper)),
        Layer::new("", colour::BLUE, LayerShape::Line(1.0), lower),
        Layer::new("", colour::BLUE, LayerShape::Line(1.0), upper),
    ];
    let mut notes = Vec::new();
    for limit in limits {
        let points = vec![(0.0, limit), (bound.until_s, limit)];
        layers.push(Layer::new("", colour::RED, LayerShape::Line(1.4), points));
        notes.push(Note::new(y.reader_unit().quantity(limit), (bound.until_s, limit), colour::RED));
    }
    if let Some(witness) = &bound.witness {
        let point = vec![(witness.time_s, witness.value)];
        layers.push(Layer::new("witness", colour::BLACK, LayerShape::Ring, point));
    }
    Panel::new(x, y, layers).noted(notes)
}

/// Returns a unit as figures have it.
fn unit(unit: &str) -> &'static str {
    match unit {
        "rad" => "rad",
        "rad/s" => "rad/s",
        "m" => "m",
        "m sqrt(kg)" => "m sqrt(kg)",
        "m sqrt(kg)/s" => "m sqrt(kg)/s",
        _ => "",
    }
}
