//! Figure of a worst case: the value at every point over the uncertain keys on which it depends most.

use flexsc_core::worst_case::WorstCase;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour, name_and_unit};

use crate::key_axis::key_axis;
use crate::required_limit::RequiredLimit;

/// Largest number of keys, each of which has a panel.
const MOST_PANELS: usize = 4;
/// Width of the axis of values, relative to their size, below which its numbers would be equal.
const NARROW: f64 = 0.01;

/// Returns the figure, with the limit of a requirement.
pub fn figure(name: &str, case: &WorstCase, required: Option<&RequiredLimit>) -> Figure {
    let count = case.ranges.keys.len();
    let mut keys: Vec<usize> = (0..count).collect();
    keys.sort_by(|a, b| influence(case, *b).total_cmp(&influence(case, *a)));
    let mut panels: Vec<Panel> =
        keys.into_iter().take(MOST_PANELS).map(|key| panel(case, key, required)).collect();
    if let Some(first) = panels.first_mut().filter(|_| count > MOST_PANELS) {
        first.remark = format!("the {MOST_PANELS} of {count} keys that matter most");
    }
    let title = format!("{name}: worst case of {}", case.quantity.replace('_', " "));
    Figure { title, panels, panel_height: 200 }.named_once()
}

/// Returns the place on the range of a key and the value of each point that has one.
fn places(case: &WorstCase, key: usize) -> impl Iterator<Item = Point> {
    let own = &case.ranges.keys[key];
    let all = case.points.iter().map(move |point| (own.number_at(point.parts[key]), point.assessed.value));
    all.filter(|point| point.1.is_finite())
}

/// Returns the size of the correlation of the values with a key; 0 if either is the same at all points.
fn influence(case: &WorstCase, key: usize) -> f64 {
    let points: Vec<Point> = places(case, key).collect();
    let count = points.len().max(1) as f64;
    let middle =
        points.iter().fold((0.0, 0.0), |sum, point| (sum.0 + point.0 / count, sum.1 + point.1 / count));
    let sum = |product: fn(f64, f64) -> f64| -> f64 {
        points.iter().map(|point| product(point.0 - middle.0, point.1 - middle.1)).sum()
    };
    let size = (sum(|x, _| x * x) * sum(|_, y| y * y)).sqrt();
    if size > 0.0 { (sum(|x, y| x * y) / size).abs() } else { 0.0 }
}

fn panel(case: &WorstCase, key: usize, required: Option<&RequiredLimit>) -> Panel {
    let own = &case.ranges.keys[key];
    let place = |point: usize| -> Point {
        (own.number_at(case.points[point].parts[key]), case.points[point].assessed.value)
    };
    let all: Vec<Point> = places(case, key).collect();
    let [low, high] = own.limits();
    let x = key_axis(Some(&case.witness), &own.key, [low, high]).over(low..high);
    let largest = all.iter().map(|point| point.1.abs()).fold(0.0, f64::max);
    let ends = all
        .iter()
        .map(|point| point.1)
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
    let is_narrow = ends[1] - ends[0] < NARROW * largest;
    let apart = ends.into_iter().zip([-NARROW, NARROW]).map(|(end, part)| end + part * largest);
    let values = all.iter().map(|point| point.1).chain(required.map(|own| own.limit));
    let (name, unit) = name_and_unit(&case.quantity.replace('_', " "), &case.unit);
    let y = FigureAxis::around(&name, unit, values.chain(apart.filter(|_| is_narrow)));
    let y = RequiredLimit::shown(required, y);
    let mut layers = vec![Layer::new("point", colour::GREY, LayerShape::Dot, all)];
    layers.extend(required.map(|own| own.across(&x)));
    for (name, colour, point) in [("nominal", colour::BLUE, 0), ("worst", colour::BLACK, case.worst)] {
        let shown: Vec<Point> = [place(point)].into_iter().filter(|point| point.1.is_finite()).collect();
        layers.push(Layer::new(name, colour, LayerShape::Ring, shown));
    }
    Panel::new(x, y, layers)
}
