//! Panels that would show nothing: all their values are zero, or none is a number.

use flexsc_figure::{Figure, Layer, LayerShape, Panel};

/// Largest number of points of a level, such as a limit or a target.
const LEVEL: usize = 6;

/// Part of the largest value of panels of one unit below which values are rounding errors.
const ROUNDING: f64 = 1e-9;

/// Returns a figure without its empty panels; `None` if all are.
pub fn without_empty(mut figure: Figure) -> Option<Figure> {
    let (first, last) = (figure.panels.first()?, figure.panels.last()?);
    let (names, axis) = (first.layers.clone(), last.x.clone());
    let sizes: Vec<f64> = figure.panels.iter().map(size).collect();
    let largest = |unit: &str| {
        let alike = figure.panels.iter().zip(&sizes).filter(|(panel, _)| panel.y.unit == unit);
        alike.map(|(_, size)| *size).fold(0.0, f64::max)
    };
    let least: Vec<f64> = figure.panels.iter().map(|panel| ROUNDING * largest(panel.y.unit)).collect();
    let mut least = least.into_iter();
    figure.panels.retain(|panel| !is_empty(panel, least.next().unwrap_or(0.0)));
    if let Some(last) = figure.panels.last_mut().filter(|panel| panel.x.name.is_empty()) {
        last.x.name.clone_from(&axis.name);
    }
    let first = figure.panels.first_mut()?;
    // The first panel names the layers of all.
    if first.layers.len() == names.len() {
        for (layer, named) in first.layers.iter_mut().zip(names).filter(|(layer, _)| layer.name.is_empty()) {
            layer.name = named.name;
        }
    }
    Some(figure)
}

/// Returns the largest value of a panel's layers.
fn size(panel: &Panel) -> f64 {
    let values = panel.layers.iter().filter(|layer| !is_level(layer)).flat_map(|layer| &layer.points);
    values.map(|point| point.1.abs()).filter(|value| value.is_finite()).fold(0.0, f64::max)
}

/// Returns true if a panel has layers of which one has no values larger than rounding errors, and the others are levels. One
/// with a remark says something also then.
fn is_empty(panel: &Panel, least: f64) -> bool {
    if !panel.remark.is_empty() {
        return false;
    }
    let is_nothing =
        |layer: &Layer| layer.points.iter().all(|(_, value)| !value.is_finite() || value.abs() <= least);
    let data = || panel.layers.iter().filter(|layer| !is_level(layer));
    panel.bar.is_none() && data().next().is_some() && data().all(is_nothing)
        || panel.layers.iter().all(is_nothing)
}

/// Returns true for a line or an area at constant heights, which is a limit, a band or a target.
fn is_level(layer: &Layer) -> bool {
    let is_line = matches!(layer.shape, LayerShape::Line(_) | LayerShape::Dashes | LayerShape::Area(_));
    let values = || layer.points.iter().map(|point| point.1).filter(|value| value.is_finite());
    let size = values().next().map(f64::abs);
    let is_constant = values().all(|value| Some(value.abs()) == size);
    is_line && layer.points.len() <= LEVEL && is_constant && size.is_some_and(|size| size > 0.0)
}

#[cfg(test)]
mod tests {
    use flexsc_figure::{FigureAxis, Point, colour};

    use super::*;

    fn panel(name: &str, layers: &[Vec<Point>]) -> Panel {
        let layer =
            |points: &Vec<Point>| Layer::new(name, colour::BLUE, LayerShape::Line(1.0), points.clone());
        let axis = |name: &str| FigureAxis::exact(name, "s", 0.0..1.0);
        Panel::new(axis(name), axis("y"), layers.iter().map(layer).collect())
    }

    #[test]
    fn panels_of_zeros_are_left_out() {
        let limit = vec![(0.0, 2.0), (1.0, 2.0)];
        let zeros: Vec<Point> = (0..9).map(|i| (f64::from(i), if i > 4 { f64::NAN } else { 0.0 })).collect();
        let line = vec![(0.0, 0.0), (0.5, 1.0)];
        let panels = vec![
            panel("", &[limit.clone(), line]),
            panel("", &[limit.clone(), zeros.clone()]),
            panel("time", std::slice::from_ref(&zeros)),
        ];
        let figure = Figure { title: String::new(), panels, panel_height: 100 };
        let left = without_empty(figure).expect("one panel");
        assert_eq!((left.panels.len(), left.panels[0].x.name.as_str()), (1, "time"));
        let empty = Figure { title: String::new(), panels: vec![panel("time", &[zeros])], panel_height: 100 };
        assert!(without_empty(empty).is_none());
        // A constant that is not zero is a value.
        let constant =
            Figure { title: String::new(), panels: vec![panel("time", &[limit])], panel_height: 9 };
        assert!(without_empty(constant).is_some());
    }
}
