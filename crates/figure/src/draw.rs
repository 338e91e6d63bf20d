//! Drawing of a figure as SVG.

use std::ops::Range;

use plotters::drawing::IntoDrawingArea;
use plotters::element::{Circle, DashedPathElement, PathElement, Polygon};
use plotters::prelude::SVGBackend;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, FontTransform, RGBColor, ShapeStyle, WHITE};

use crate::area::polygons;
use crate::layout::{LEGEND, LETTERS, Layout, MARK, NAME, NUMBERS, ROW, bar_height, rows, ticks_upward};
use crate::line::{Point, Window, pieces, straighten, thin};
use crate::note::{self, Note, PlotBox};
use crate::svg::{Area, Error, UNITS, at, text};
use crate::text_width::{SMALLEST, fitting, split, wide};
use crate::{Figure, FigureAxis, Layer, LayerShape, Panel, Ticks, bar, colour, strip};

/// Height of a title, and of each further line of it (px).
const TITLE: u32 = 30;
const LINE: u32 = 17;
/// Half the width of a mark that notes leave free (px).
const MARKED: f64 = 8.0;
/// Least space between numbers below an axis (px).
const SPACE: f64 = 6.0;
const GRID: RGBColor = RGBColor(225, 225, 225);

/// Splits a title between words into lines of legible size.
fn title_lines(title: &str, width: u32) -> Vec<String> {
    split(title, |line| wide(line, 11.0) <= f64::from(width - 20))
}

/// Returns the height of a title of lines (px).
fn title_height(lines: &[String]) -> u32 {
    if lines.is_empty() { 0 } else { TITLE + LINE * (lines.len() as u32 - 1) }
}

/// Returns the lines of the title that a figure of this width (px) shows.
fn shown_title(figure: &Figure, width: u32, is_titled: bool) -> Vec<String> {
    if is_titled && !figure.title.is_empty() { title_lines(&figure.title, width) } else { Vec::new() }
}

/// Returns the height (px) of a figure of this width (px).
pub fn height(figure: &Figure, width: u32, is_titled: bool) -> u32 {
    Layout::new(figure, width, 0).height(figure) + title_height(&shown_title(figure, width, is_titled))
}

/// Returns the figure as SVG of this width (px), each plot higher than usual by `higher` (px), with its title or without.
pub fn svg(figure: &Figure, width: u32, higher: u32, is_titled: bool) -> Result<String, Error> {
    let layout = Layout::new(figure, width, higher);
    let lines = shown_title(figure, width, is_titled);
    let title = title_height(&lines);
    let height = layout.height(figure) + title;
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (width * UNITS, height * UNITS)).into_drawing_area();
        root.fill(&WHITE)?;
        let (head, body) = root.split_vertically(title * UNITS);
        for (index, line) in lines.iter().enumerate() {
            let size = fitting(line, f64::from(width - 20), 14.0);
            let place = at(width / 2, TITLE / 2 + 2 + LINE * index as u32);
            head.draw_text(line, &text(size, HPos::Center, VPos::Center), place)?;
        }
        let mut rest = body;
        let upward = figure.upward();
        let mut upward = upward.iter();
        for row in rows(figure) {
            let (area, below) = rest.split_vertically(layout.row_height(row) * UNITS);
            draw_row(&area, (row, upward.by_ref()), layout)?;
            rest = below;
        }
        root.present()?;
    }
    // Sets the size in pixels, and round joins, because mitred ones extend far beyond sharp peaks.
    let fine = format!("width=\"{}\" height=\"{}\"", width * UNITS, height * UNITS);
    let size = format!("width=\"{width}\" height=\"{height}\" stroke-linejoin=\"round\"");
    Ok(svg.replacen(&fine, &size, 1))
}

/// Draws panels side by side, whose plots begin at one height, below the colour bar that they share.
fn draw_row<'a>(
    area: &Area<'_>,
    (panels, upward): (&[Panel], impl Iterator<Item = &'a FigureAxis>),
    layout: Layout,
) -> Result<(), Error> {
    let (key, mut rest) = area.split_vertically(bar_height(panels) * UNITS);
    if let Some(bar) = panels.iter().find_map(|panel| panel.bar.as_ref()) {
        bar::draw(&key, bar, layout.left, layout.across())?;
    }
    let top = layout.row_top(panels);
    for ((layout, panel), y) in layout.row(panels).into_iter().zip(panels).zip(upward) {
        let (own, after) = rest.split_horizontally(layout.width * UNITS);
        let (_, own) = own.split_vertically((top - layout.top(panel)) * UNITS);
        strip::draw(&own, panel, (layout.left, layout.across()))?;
        draw_legend(&own, panel, layout)?;
        draw_panel(&own, (panel, y), layout)?;
        rest = after;
    }
    Ok(())
}

/// Plot of a panel: the mapping from axis places to a rectangle of the backend.
struct Plot {
    window: Window,
    /// Distance from the left end of the figure to the plot (px).
    left: u32,
    /// Distance from the top of the panel to the plot, width and height of the plot (px).
    top: u32,
    across: u32,
    height: u32,
}

impl Plot {
    /// Returns the backend's coordinates of a point.
    fn place(&self, (x, y): Point) -> (i32, i32) {
        let part = |value: f64, range: &Range<f64>| (value - range.start) / (range.end - range.start);
        let x = f64::from(self.left) + part(x, &self.window.x) * f64::from(self.across);
        let y = f64::from(self.top) + (1.0 - part(y, &self.window.y)) * f64::from(self.height);
        ((x * f64::from(UNITS)).round() as i32, (y * f64::from(UNITS)).round() as i32)
    }
}

fn draw_panel(area: &Area<'_>, (panel, y): (&Panel, &FigureAxis), layout: Layout) -> Result<(), Error> {
    let plot = Plot {
        window: Window { x: panel.x.extent(), y: panel.y.extent() },
        left: layout.left,
        top: layout.top(panel),
        across: layout.across(),
        height: layout.plot,
    };
    draw_axes(area, (&panel.x, y), &plot, panel.is_plain)?;
    // Curves that notes leave free (px).
    let mut curves: Vec<Vec<Point>> = Vec::new();
    for layer in &panel.layers {
        let points: Vec<Point> =
            layer.points.iter().map(|(x, y)| (panel.x.place(*x), panel.y.place(*y))).collect();
        match layer.shape {
            LayerShape::Line(_) | LayerShape::Dashes => {
                for piece in pieces(&points, &plot.window) {
                    let piece = thin(&piece, &plot.window, plot.across).into_iter().map(|p| plot.place(p));
                    let line = straighten(&piece.collect::<Vec<_>>());
                    curves.push(line.iter().map(|place| pixels(*place)).collect());
                    draw_line(area, layer, line)?;
                }
            }
            LayerShape::Area(_) => {
                for polygon in polygons(&points, &plot.window, plot.across) {
                    let corners: Vec<_> = polygon.into_iter().map(|p| plot.place(p)).collect();
                    area.draw(&Polygon::new(straighten(&corners), layer.style()))?;
                }
            }
            _ => {
                for point in points.iter().filter(|point| plot.window.contains(**point)) {
                    let place = plot.place(*point);
                    let (x, y) = pixels(place);
                    let ends = [(x - MARKED, y), (x + MARKED, y), (x, y - MARKED), (x, y + MARKED)];
                    curves.push(ends.to_vec());
                    draw_mark(area, layer, place)?;
                }
            }
        }
    }
    let [left, top] = [plot.left, plot.top].map(f64::from);
    let (right, bottom) = (left + f64::from(plot.across), top + f64::from(plot.height));
    let at = |x: f64, y: f64| pixels(plot.place((panel.x.place(x), panel.y.place(y))));
    let end = panel.x.range.end;
    let abscissa = |note: &Note| if note.at.0 == f64::INFINITY { end } else { note.at.0 };
    let notes = panel.notes.iter().map(|note| (note, at(abscissa(note), note.at.1)));
    let shown = notes.filter(|(_, (x, _))| (left - 1.0..=right + 1.0).contains(x));
    note::draw(area, shown, PlotBox { left, top, right, bottom }, &curves)
}

/// Returns a place of the backend in pixels.
fn pixels((x, y): (i32, i32)) -> Point {
    (f64::from(x) / f64::from(UNITS), f64::from(y) / f64::from(UNITS))
}

/// Draws the grid, the numbers and the names of the axes.
fn draw_axes(
    area: &Area<'_>,
    (across, up): (&FigureAxis, &FigureAxis),
    plot: &Plot,
    is_plain: bool,
) -> Result<(), Error> {
    let Window { x, y } = &plot.window;
    let corner = plot.place((x.start, y.start));
    let opposite = plot.place((x.end, y.end));
    let gap = 5 * UNITS as i32;
    let (grid, frame) = (stroke(GRID, 0.6), stroke(colour::GREY, 0.8));
    let ticks = ticks_across(across, plot.across);
    for (place, label) in
        ticks.at.iter().map(|tick| (plot.place((across.place(*tick), y.start)).0, ticks.text(*tick)))
    {
        let end = if is_plain { corner.1 + gap / 2 } else { opposite.1 };
        area.draw(&PathElement::new([(place, corner.1), (place, end)], if is_plain { frame } else { grid }))?;
        area.draw_text(&label, &text(11.0, HPos::Center, VPos::Top), (place, corner.1 + gap))?;
    }
    let ticks = up.ticks(ticks_upward(plot.height));
    for (place, label) in
        ticks.at.iter().map(|tick| (plot.place((x.start, up.place(*tick))).1, ticks.text(*tick)))
    {
        let end = if is_plain { corner.0 - gap / 2 } else { opposite.0 };
        area.draw(&PathElement::new([(corner.0, place), (end, place)], if is_plain { frame } else { grid }))?;
        area.draw_text(&label, &text(11.0, HPos::Right, VPos::Center), (corner.0 - gap, place))?;
    }
    let other = [(corner.0, opposite.1), (opposite.0, corner.1)];
    area.draw(&PathElement::new([corner, other[0], opposite, other[1], corner], frame))?;
    let below = at(plot.left + plot.across / 2, plot.top + plot.height + NUMBERS + NAME / 2 - 1);
    let name = across.label();
    let size = fitting(&name, f64::from(plot.across + plot.left), 12.0);
    area.draw_text(&name, &text(size, HPos::Center, VPos::Center), below)?;
    // A long name has two lines.
    let (name, room) = (up.label(), f64::from(plot.height + NUMBERS));
    let lines = if wide(&name, SMALLEST) > room { halves(&name) } else { vec![name] };
    let first = if lines.len() > 1 { 7 } else { plot.left.saturating_sub(60).clamp(10, 14) };
    for (index, line) in lines.iter().enumerate() {
        let size = fitting(line, room, 12.0);
        let upright = text(size, HPos::Center, VPos::Center).transform(FontTransform::Rotate270);
        area.draw_text(line, &upright, at(first + 11 * index as u32, plot.top + plot.height / 2))?;
    }
    Ok(())
}

/// Returns the ticks of a horizontal axis of a width (px), as many as have room for their numbers.
fn ticks_across(axis: &FigureAxis, width: u32) -> Ticks {
    let most = if width < 400 { width / 55 } else { width / 85 };
    let place = |tick: f64| {
        let extent = axis.extent();
        (axis.place(tick) - extent.start) / (extent.end - extent.start) * f64::from(width)
    };
    let has_room = |ticks: &Ticks| {
        ticks.at.windows(2).all(|pair| {
            let texts = [0, 1].map(|k| wide(&ticks.text(pair[k]), 11.0));
            (place(pair[1]) - place(pair[0])).abs() >= f64::midpoint(texts[0], texts[1]) + SPACE
        })
    };
    let mut fewer = (1..=most).rev().map(|most| axis.ticks(most));
    fewer.find(has_room).unwrap_or_else(|| axis.ticks(1))
}

/// Splits a text at the space nearest to its middle.
fn halves(text: &str) -> Vec<String> {
    let spaces = text.match_indices(' ').map(|(place, _)| place);
    match spaces.min_by_key(|place| place.abs_diff(text.len() / 2)) {
        Some(place) => vec![text[..place].to_owned(), text[place + 1..].to_owned()],
        None => vec![text.to_owned()],
    }
}

fn draw_line(area: &Area<'_>, layer: &Layer, points: Vec<(i32, i32)>) -> Result<(), Error> {
    if layer.shape == LayerShape::Dashes {
        area.draw(&DashedPathElement::new(points, 5 * UNITS, 4 * UNITS, layer.style()))
    } else {
        area.draw(&PathElement::new(points, layer.style()))
    }
}

/// Draws the legend above the panel, in rows.
fn draw_legend(area: &Area<'_>, panel: &Panel, layout: Layout) -> Result<(), Error> {
    let top = layout.strips(panel);
    for entry in layout.entries(panel) {
        let (middle, column) = (top + LEGEND / 2 + 1 + ROW * entry.row, entry.column);
        let mut left = column;
        if let Some(layer) = entry.layer {
            left += MARK;
            let (from, to) = (at(column, middle), at(column + 18, middle));
            match layer.shape {
                LayerShape::Line(_) | LayerShape::Dashes => draw_line(area, layer, vec![from, to])?,
                LayerShape::Area(_) => {
                    let [low, high] = [middle + 5, middle - 5];
                    let corners =
                        [at(column, low), at(column + 18, low), at(column + 18, high), at(column, high)];
                    area.draw(&Polygon::new(corners, layer.style()))?;
                }
                _ => draw_mark(area, layer, at(column + 9, middle))?,
            }
        }
        area.draw_text(&entry.words, &text(LETTERS, HPos::Left, VPos::Center), at(left, middle))?;
    }
    Ok(())
}

fn draw_mark(area: &Area<'_>, layer: &Layer, (x, y): (i32, i32)) -> Result<(), Error> {
    let corners: &[(i32, i32)] = match layer.shape {
        LayerShape::Triangle => &[(0, -42), (38, 26), (-38, 26)],
        LayerShape::Square => &[(-29, -29), (29, -29), (29, 29), (-29, 29)],
        LayerShape::Diamond => &[(0, -44), (44, 0), (0, 44), (-44, 0)],
        LayerShape::Dot => return area.draw(&Circle::new((x, y), 16, layer.style())),
        LayerShape::Cross => {
            for (dx, dy) in [(32, 32), (32, -32)] {
                let ends = [(x - dx, y - dy), (x + dx, y + dy)];
                area.draw(&PathElement::new(ends, stroke(layer.colour, 1.2)))?;
            }
            return Ok(());
        }
        LayerShape::Stroke => {
            return area.draw(&PathElement::new([(x, y - 30), (x, y + 30)], stroke(layer.colour, 0.5)));
        }
        LayerShape::Ring => {
            area.draw(&Circle::new((x, y), 38, WHITE.filled()))?;
            return area.draw(&Circle::new((x, y), 38, stroke(layer.colour, 1.2)));
        }
        _ => return area.draw(&Circle::new((x, y), 32, layer.style())),
    };
    let corners: Vec<_> = corners.iter().map(|(dx, dy)| (x + dx, y + dy)).collect();
    area.draw(&Polygon::new(corners, layer.style()))
}

impl Layer {
    fn style(&self) -> ShapeStyle {
        match self.shape {
            LayerShape::Line(width) => stroke(self.colour, width),
            LayerShape::Dashes => stroke(self.colour, 1.0),
            LayerShape::Area(opacity) => self.colour.mix(opacity).filled(),
            _ => self.colour.filled(),
        }
    }
}

fn stroke(colour: RGBColor, width: f64) -> ShapeStyle {
    colour.stroke_width((width * f64::from(UNITS)).round() as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_below_an_axis_do_not_touch() {
        // "0.000", "0.005" and so on would touch at 55 px each.
        for (axis, width) in [
            (FigureAxis::exact("real part", "", -0.0321..0.0127), 110),
            (FigureAxis::exact("time", "s", 19_800.0..20_000.0), 230),
            (FigureAxis::decades("frequency", "Hz", [1e-6, 5.0]), 120),
        ] {
            let (ticks, extent) = (ticks_across(&axis, width), axis.extent());
            let places = ticks.at.iter().map(|tick| {
                let part = (axis.place(*tick) - extent.start) / (extent.end - extent.start);
                (part * f64::from(width), wide(&ticks.text(*tick), 11.0))
            });
            let places: Vec<(f64, f64)> = places.collect();
            assert!(places.len() > 1, "{}", axis.name);
            assert!(
                places
                    .windows(2)
                    .all(|pair| { (pair[1].0 - pair[0].0).abs() > f64::midpoint(pair[0].1, pair[1].1) })
            );
        }
    }
}
