//! Overlay of the figures of several runs, with a colour for each run.

use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, RGBColor, Scale, colour};

/// Colours of the runs, cyclic.
const COLOURS: [RGBColor; 6] =
    [colour::BLUE, colour::VERMILLION, colour::GREEN, colour::ORANGE, colour::SKY, colour::BLACK];
/// Fraction by which each further line of a run in a panel is lighter.
const LIGHTER: f64 = 0.45;

/// Returns the overlay of the named runs' figures; `None` if their panels differ.
pub fn overlaid(subject: &str, runs: &[(String, Figure)]) -> Option<Figure> {
    let (_, first) = runs.first()?;
    let alike = |figure: &Figure| {
        let axes = |figure: &Figure| -> Vec<[(String, &'static str, Scale); 2]> {
            let axis = |axis: &FigureAxis| (axis.name.clone(), axis.unit, axis.scale);
            figure.panels.iter().map(|panel| [axis(&panel.x), axis(&panel.y)]).collect()
        };
        axes(figure) == axes(first)
    };
    let plain = |figure: &Figure| figure.panels.iter().all(|panel| panel.bar.is_none());
    if !runs.iter().all(|(_, figure)| alike(figure) && plain(figure)) {
        return None;
    }
    let (panel_height, count) = (first.panel_height, first.panels.len());
    let names: Vec<&str> = runs.iter().map(|(name, _)| name.as_str()).collect();
    let title = format!("{subject}: {}", names.join(", "));
    let panel = |index: usize| -> Panel {
        let panels: Vec<(&str, &Panel)> =
            runs.iter().map(|(name, figure)| (name.as_str(), &figure.panels[index])).collect();
        let (x, y) = (axis(&panels, |panel| &panel.x), axis(&panels, |panel| &panel.y));
        let mut layers = layers(&panels, index == 0);
        // Vertical lines are as high as the panel.
        for layer in layers.iter_mut().filter(|layer| upright(layer).is_some()) {
            let [first, last] = &mut layer.points[..] else { continue };
            (first.1, last.1) = (y.range.start, y.range.end);
        }
        Panel::new(x, y, layers)
    };
    Some(Figure { title, panels: (0..count).map(panel).collect(), panel_height })
}

/// Returns the axis that contains the axes of all panels.
fn axis(panels: &[(&str, &Panel)], axis_of: fn(&Panel) -> &FigureAxis) -> FigureAxis {
    let mut all = axis_of(panels[0].1).clone();
    for (_, panel) in panels {
        let range = &axis_of(panel).range;
        all.range = all.range.start.min(range.start)..all.range.end.max(range.end);
    }
    all
}

/// Returns the abscissa of a vertical line; `None` for other layers.
fn upright(layer: &Layer) -> Option<f64> {
    match layer.points[..] {
        [(from, _), (to, _)] if from == to => Some(from),
        _ => None,
    }
}

fn layers(panels: &[(&str, &Panel)], named: bool) -> Vec<Layer> {
    let mut layers: Vec<Layer> = Vec::new();
    let same = |a: &Layer, b: &Layer| {
        let alike = a.points == b.points || (upright(a).is_some() && upright(a) == upright(b));
        a.shape == b.shape && a.name == b.name && alike
    };
    // Layers that all runs share, such as a dead zone, are drawn once and unchanged.
    let common =
        |layer: &Layer| panels.iter().all(|(_, panel)| panel.layers.iter().any(|other| same(layer, other)));
    layers.extend(panels[0].1.layers.iter().filter(|layer| common(layer)).cloned());
    for (run, (name, panel)) in panels.iter().enumerate() {
        let own: Vec<&Layer> = panel.layers.iter().filter(|layer| !common(layer)).collect();
        // The widest line is the main one of the panel.
        let width = |layer: &Layer| if let LayerShape::Line(width) = layer.shape { width } else { 0.0 };
        let main = (0..own.len()).max_by(|a, b| width(own[*a]).total_cmp(&width(own[*b])));
        let mut lines = 0;
        let mut reported = false;
        for (place, layer) in own.iter().enumerate() {
            let mut layer = (*layer).clone();
            let is_line = matches!(layer.shape, LayerShape::Line(_) | LayerShape::Dashes);
            let shade = if Some(place) == main || !is_line {
                0.0
            } else {
                lines += 1;
                LIGHTER + 0.2 * f64::from((lines - 1).min(2))
            };
            layer.colour = lighter(COLOURS[run % COLOURS.len()], shade);
            layer.name = match (layer.name.as_str(), named) {
                (_, true) if layer.points.is_empty() => String::new(),
                ("", true) if Some(place) == main && !reported => (*name).to_owned(),
                ("", _) => String::new(),
                (own, _) => format!("{name}, {own}"),
            };
            reported |= !layer.name.is_empty();
            layers.push(layer);
        }
    }
    layers
}

fn lighter(RGBColor(r, g, b): RGBColor, part: f64) -> RGBColor {
    let mixed = |own: u8| (f64::from(own) + part * (255.0 - f64::from(own))).round() as u8;
    RGBColor(mixed(r), mixed(g), mixed(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(height: f64, end: f64) -> Figure {
        let line = vec![(0.0, 0.0), (end, height)];
        let zone = vec![(0.0, 0.5), (100.0, 0.5)];
        let layers = vec![
            Layer::new("dead zone", colour::GREY, LayerShape::Dashes, zone),
            Layer::new("", colour::BLUE, LayerShape::Line(1.2), line),
        ];
        let panel = Panel::new(
            FigureAxis::exact("time", "s", 0.0..end),
            FigureAxis::exact("angle", "rad", 0.0..height),
            layers,
        );
        Figure { title: "one".to_owned(), panels: vec![panel], panel_height: 100 }
    }

    #[test]
    fn each_run_has_its_colour_and_what_is_common_its_own() {
        let runs = vec![("a".to_owned(), figure(1.0, 10.0)), ("b".to_owned(), figure(3.0, 5.0))];
        let both = overlaid("angle", &runs).expect("alike");
        assert_eq!(both.title, "angle: a, b");
        let panel = &both.panels[0];
        assert_eq!((panel.x.range.clone(), panel.y.range.clone()), (0.0..10.0, 0.0..3.0));
        let reported: Vec<_> = panel.layers.iter().map(|layer| (layer.name.as_str(), layer.colour)).collect();
        assert_eq!(reported, [("dead zone", colour::GREY), ("a", colour::BLUE), ("b", colour::VERMILLION)]);
    }

    #[test]
    fn figures_of_other_panels_are_not_mixed() {
        let mut other = figure(1.0, 1.0);
        other.panels[0].y.unit = "m";
        assert!(overlaid("x", &[("a".to_owned(), figure(1.0, 1.0)), ("b".to_owned(), other)]).is_none());
    }
}
