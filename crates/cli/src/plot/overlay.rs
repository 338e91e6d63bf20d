//! Overlay of the figures of several runs, and the difference of two.

use std::borrow::Borrow;

use flexsc_figure::{
    Figure, FigureAxis, Layer, LayerShape, Note, Panel, Point, RGBColor, Scale, Strip, colour,
};

/// Colours of the runs, cyclic.
const COLOURS: [RGBColor; 6] =
    [colour::BLUE, colour::VERMILLION, colour::GREEN, colour::ORANGE, colour::SKY, colour::BLACK];
/// Fraction by which each further line of a run in a panel is lighter.
const LIGHTER: f64 = 0.3;
/// Widths of the main line of the first run and of other lines (px): where they coincide, both are seen.
const FIRST: f64 = 2.2;
const OTHERS: f64 = 0.9;
/// Largest number of points of a line that is a limit, a target or a mark.
const LEVEL: usize = 6;

/// Returns the overlay of the named runs' figures, of two runs with their difference below; `None` if their panels differ.
pub fn overlaid(subject: &str, runs: &[(String, impl Borrow<Figure>)]) -> Option<Figure> {
    let runs: Vec<(&str, &Figure)> =
        runs.iter().map(|(name, figure)| (name.as_str(), figure.borrow())).collect();
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
    let names: Vec<&str> = runs.iter().map(|(name, _)| *name).collect();
    let title = format!("{subject}: {}", names.join(", "));
    let panel = |index: usize| -> Panel {
        let panels: Vec<(&str, &Panel)> =
            runs.iter().map(|(name, figure)| (*name, &figure.panels[index])).collect();
        let (x, y) = (axis(&panels, |panel| &panel.x), axis(&panels, |panel| &panel.y));
        let mut layers = layers(&panels, index == 0);
        // Vertical lines are as high as the panel.
        for layer in layers.iter_mut().filter(|layer| upright(layer).is_some()) {
            let [first, last] = &mut layer.points[..] else { continue };
            (first.1, last.1) = (y.range.start, y.range.end);
        }
        Panel { notes: notes(&panels), strips: strips(&panels), ..Panel::new(x, y, layers) }
    };
    let mut panels: Vec<Panel> = (0..count).map(panel).collect();
    if let [one, other] = runs[..]
        && let Some(below) = difference(one, other)
    {
        if let Some(last) = panels.last_mut() {
            last.x = last.x.unnamed();
        }
        panels.push(below);
    }
    Some(Figure { title, panels, panel_height })
}

/// Returns the axis that contains the axes of all panels.
fn axis(panels: &[(&str, &Panel)], axis_of: fn(&Panel) -> &FigureAxis) -> FigureAxis {
    let first = axis_of(panels[0].1).clone();
    panels[1..].iter().fold(first, |all, (_, panel)| all.covering(axis_of(panel)))
}

/// Returns the abscissa of a vertical line; `None` for other layers.
fn upright(layer: &Layer) -> Option<f64> {
    match layer.points[..] {
        [(from, _), (to, _)] if from == to => Some(from),
        _ => None,
    }
}

/// Returns true for a curve or marks of a run, in contrast to bands, limits and targets.
fn is_data(layer: &Layer) -> bool {
    !matches!(layer.shape, LayerShape::Area(_)) && layer.colour != colour::RED
}

/// Returns the layers of all runs, each run in its colour; only the first panel names the runs.
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
        // Bands of several runs would hide each other. Limits stay those of each run.
        let own = || panel.layers.iter().filter(|layer| !common(layer));
        layers.extend(own().filter(|layer| layer.colour == colour::RED).cloned());
        let own: Vec<&Layer> = own().filter(|layer| is_data(layer)).collect();
        // The widest line is the main one of the panel.
        let width = |layer: &Layer| if let LayerShape::Line(width) = layer.shape { width } else { 0.0 };
        let main = (0..own.len()).max_by(|a, b| width(own[*a]).total_cmp(&width(own[*b])));
        let mut lines = 0;
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
            if let LayerShape::Line(width) = &mut layer.shape {
                *width = if Some(place) == main && run == 0 { FIRST } else { OTHERS };
            }
            layer.name = if named && Some(place) == main { (*name).to_owned() } else { String::new() };
            layers.push(layer);
        }
    }
    layers
}

/// Returns the notes of all runs: those that all share once, those at data in the colour of the run.
fn notes(panels: &[(&str, &Panel)]) -> Vec<Note> {
    let mut notes: Vec<Note> = Vec::new();
    for (run, (_, panel)) in panels.iter().enumerate() {
        for note in &panel.notes {
            let is_limit = note.colour == colour::RED;
            let colour = if is_limit { note.colour } else { COLOURS[run % COLOURS.len()] };
            if !notes.iter().any(|known| known.text == note.text && (is_limit || known.at == note.at)) {
                notes.push(Note { colour, ..note.clone() });
            }
        }
    }
    notes
}

/// Returns the strips of all runs: those that all share once, others with the name of the run.
fn strips(panels: &[(&str, &Panel)]) -> Vec<Strip> {
    let common = |strip: &Strip| panels.iter().all(|(_, panel)| panel.strips.contains(strip));
    let shared = panels[0].1.strips.iter().filter(|strip| common(strip)).cloned();
    let own = panels.iter().flat_map(|(name, panel)| {
        let own = panel.strips.iter().filter(|strip| !common(strip)).cloned();
        own.map(move |strip| Strip { name: format!("{}, {name}", strip.name), ..strip })
    });
    shared.chain(own).collect()
}

/// Returns the panel of the second run less the first, of the curves over time of one quantity; `None` without any.
fn difference((a, one): (&str, &Figure), (b, other): (&str, &Figure)) -> Option<Panel> {
    let curves = |figure: &Figure| -> Vec<(String, Vec<Point>)> {
        let first = &figure.panels[0];
        let is_alike = |panel: &&Panel| {
            panel.x.unit == "s" && panel.y.unit == first.y.unit && panel.y.scale == first.y.scale
        };
        let panels: Vec<&Panel> = figure.panels.iter().filter(is_alike).collect();
        let is_single = panels.len() == 1;
        let data = |layer: &&Layer| {
            let is_line = matches!(layer.shape, LayerShape::Line(_));
            is_line && is_data(layer) && layer.points.len() > LEVEL
        };
        let named = |panel: &Panel| -> Vec<(String, Vec<Point>)> {
            let name = |layer: &Layer| {
                if layer.name.is_empty() { panel.y.name.clone() } else { layer.name.clone() }
            };
            // Of several panels, the main line of each: that of the quantity itself, which has no name.
            let mut lines: Vec<&Layer> = panel.layers.iter().filter(data).collect();
            if !is_single {
                lines.sort_by_key(|layer| !layer.name.is_empty());
                lines.truncate(1);
            }
            lines.into_iter().map(|layer| (name(layer), layer.points.clone())).collect()
        };
        panels.into_iter().flat_map(named).collect()
    };
    let (first, last) = (one.panels.first()?, one.panels.last()?);
    let pairs = curves(one).into_iter().zip(curves(other)).filter(|(one, other)| one.0 == other.0);
    let lines = pairs.filter_map(|((name, one), (_, other))| Some((name, subtracted(&other, &one)?)));
    // A panel may show a part of another one again.
    let lines = lines.fold(Vec::<(String, Vec<Point>)>::new(), |mut lines, line| {
        if lines.iter().all(|(_, own)| *own != line.1) {
            lines.push(line);
        }
        lines
    });
    let y = FigureAxis::around(
        &format!("{b} − {a}"),
        first.y.unit,
        lines.iter().flat_map(|(_, line)| line).map(|point| point.1),
    );
    let times = || lines.iter().flat_map(|(_, line)| line.iter().map(|point| point.0));
    let both = times().fold(f64::INFINITY, f64::min)..times().fold(f64::NEG_INFINITY, f64::max);
    let is_named = lines.len() > 1;
    let same = |name: &str| lines.iter().filter(|(other, _)| other == name).count() > 1;
    let numbered: Vec<String> = lines
        .iter()
        .enumerate()
        .map(|(index, (name, _))| if same(name) { format!("{name} {}", index + 1) } else { name.clone() })
        .collect();
    let layer = |(index, (_, line)): (usize, (String, Vec<Point>))| {
        let name = if is_named { numbered[index].clone() } else { String::new() };
        let colour = if is_named { COLOURS[index % COLOURS.len()] } else { colour::BLACK };
        Layer::new(&name, colour, LayerShape::Line(1.0), line)
    };
    let is_something = lines.iter().flat_map(|(_, line)| line).any(|point| point.1.abs() > 0.0);
    let layers: Vec<Layer> = lines.into_iter().enumerate().map(layer).collect();
    is_something.then(|| {
        let mut x = last.x.clone();
        x.range = both;
        Panel::new(x, y.like(&first.y), layers)
    })
}

/// Returns a line less another, which is interpolated, where both are; `None` if one goes back in time or they share none.
fn subtracted(line: &[Point], other: &[Point]) -> Option<Vec<Point>> {
    let finite = |line: &[Point]| -> Vec<Point> {
        line.iter().filter(|(x, y)| x.is_finite() && y.is_finite()).copied().collect()
    };
    let (line, other) = (finite(line), finite(other));
    if !line.is_sorted_by(|a, b| a.0 <= b.0) || !other.is_sorted_by(|a, b| a.0 <= b.0) {
        return None;
    }
    let value_at = |x: f64| {
        let after = other.partition_point(|point| point.0 < x);
        let (to, from) = (other.get(after)?, other.get(after.saturating_sub(1))?);
        if to.0 == x {
            return Some(to.1);
        }
        (after > 0).then(|| from.1 + (x - from.0) / (to.0 - from.0) * (to.1 - from.1))
    };
    let difference: Vec<Point> = line.iter().filter_map(|(x, y)| Some((*x, y - value_at(*x)?))).collect();
    (difference.len() > 1).then_some(difference)
}

fn lighter(RGBColor(r, g, b): RGBColor, part: f64) -> RGBColor {
    let mixed = |own: u8| (f64::from(own) + part * (255.0 - f64::from(own))).round() as u8;
    RGBColor(mixed(r), mixed(g), mixed(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(height: f64, end: f64) -> Figure {
        let line = (0..=10).map(|i| f64::from(i) / 10.0).map(|part| (part * end, part * height)).collect();
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
    fn the_difference_is_over_the_time_that_both_have() {
        let runs = [("a".to_owned(), figure(1.0, 10.0)), ("b".to_owned(), figure(3.0, 5.0))];
        let both = overlaid("angle", &runs).expect("alike");
        let below = &both.panels[1];
        assert_eq!((below.y.name.as_str(), below.x.name.as_str()), ("b − a", "time"));
        // 3 x/5 - x/10 at 0, 0.5 ... 5.
        let points = &below.layers[0].points;
        assert_eq!(points.len(), 11);
        assert!(points.iter().all(|(x, y)| (y - 0.5 * x).abs() < 1e-12), "{points:?}");
        // A panel that shows the curve again adds nothing.
        let twice = |mut figure: Figure| {
            let (x, y, layers) = (&figure.panels[0].x, &figure.panels[0].y, &figure.panels[0].layers);
            figure.panels.push(Panel::new(x.clone(), y.clone(), layers.clone()));
            figure
        };
        let again = runs.map(|(name, figure)| (name, twice(figure)));
        assert_eq!(overlaid("angle", &again).expect("alike").panels[2].layers.len(), 1);
        // Equal runs have none.
        let runs = vec![("a".to_owned(), figure(1.0, 10.0)), ("b".to_owned(), figure(1.0, 10.0))];
        assert_eq!(overlaid("angle", &runs).expect("alike").panels.len(), 1);
    }

    #[test]
    fn figures_of_other_panels_are_not_mixed() {
        let mut other = figure(1.0, 1.0);
        other.panels[0].y.unit = "m";
        assert!(overlaid("x", &[("a".to_owned(), figure(1.0, 1.0)), ("b".to_owned(), other)]).is_none());
    }
}
