//! Figure of a worst case: the value at every point over each uncertain key.

use flexsc_core::worst_case::WorstCase;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

/// Largest number of keys, each of which has a panel.
const MOST_PANELS: usize = 8;

/// Returns the figure, with the limit of a requirement.
pub fn figure(name: &str, case: &WorstCase, limit: Option<f64>) -> Figure {
    let keys = case.ranges.keys.len().min(MOST_PANELS);
    Figure {
        title: format!("{name}: worst case of {}", case.quantity.replace('_', " ")),
        panels: (0..keys).map(|key| panel(case, key, limit)).collect(),
        panel_height: 200,
    }
}

fn panel(case: &WorstCase, key: usize, limit: Option<f64>) -> Panel {
    let own = &case.ranges.keys[key];
    let place = |point: usize| -> Point {
        (own.number_at(case.points[point].parts[key]), case.points[point].assessed.value)
    };
    let all: Vec<Point> = (0..case.points.len()).map(place).filter(|point| point.1.is_finite()).collect();
    let [low, high] = own.limits();
    let x = FigureAxis::exact(&own.key, "", low..high);
    let values = all.iter().map(|point| point.1).chain(limit);
    let y = FigureAxis::around(&case.quantity.replace('_', " "), unit(&case.unit), values);
    let mut layers = vec![Layer::new("point", colour::GREY, LayerShape::Dot, all)];
    if let Some(limit) = limit {
        layers.push(Layer::new(
            "limit",
            colour::VERMILLION,
            LayerShape::Dashes,
            vec![(low, limit), (high, limit)],
        ));
    }
    for (name, colour, point) in [("nominal", colour::BLUE, 0), ("worst", colour::BLACK, case.worst)] {
        let shown: Vec<Point> = [place(point)].into_iter().filter(|point| point.1.is_finite()).collect();
        layers.push(Layer::new(name, colour, LayerShape::Ring, shown));
    }
    Panel::new(x, y, layers)
}

/// Returns a unit as figures have it.
fn unit(unit: &str) -> &'static str {
    ["rad", "rad/s", "s", "m", "N m", "N m s", "J", "kg", "N s"]
        .into_iter()
        .find(|known| *known == unit)
        .unwrap_or_default()
}
