//! Drawing of a figure as SVG.

use std::ops::Range;

use plotters::drawing::IntoDrawingArea;
use plotters::element::{Circle, DashedPathElement, PathElement, Polygon};
use plotters::prelude::SVGBackend;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, FontTransform, RGBColor, ShapeStyle, WHITE};

use crate::area::polygons;
use crate::line::{Point, Window, pieces, straighten, thin};
use crate::svg::{Area, Error, UNITS, at, text};
use crate::{Figure, FigureAxis, Layer, LayerShape, Panel, bar, colour};

/// Width of a figure whose panels have their nominal height (px).
const WIDTH: u32 = 800;
/// Margins left and right of a panel's plot (px).
const LEFT: u32 = 70;
const RIGHT: u32 = 20;
/// Margins below the plot, for numbers and for the name of the axis (px).
const NUMBERS: u32 = 24;
const NAME: u32 = 18;
/// Heights of the title, of each further line of it, of a legend, and of each further row of it (px).
const TITLE: u32 = 30;
const LINE: u32 = 17;
const LEGEND: u32 = 22;
const ROW: u32 = 16;
const GRID: RGBColor = RGBColor(225, 225, 225);

/// Layout of a figure.
#[derive(Copy, Clone)]
struct Layout {
    /// Width of the figure (px).
    width: u32,
    /// Height of each plot (px).
    plot: u32,
}

impl Layout {
    /// The layout of a figure of this width, each of whose plots is higher than usual (px).
    fn new(figure: &Figure, width: u32, higher: u32) -> Self {
        let part = f64::from(width.min(WIDTH)) / f64::from(WIDTH);
        // Narrow figures are also lower, but less than proportionally.
        let plot = f64::from(figure.panel_height) * part.powf(0.6);
        Self { width, plot: plot.round() as u32 + higher }
    }

    /// Returns the height (px) of a figure with a title of `lines` lines.
    fn height(self, figure: &Figure, lines: usize) -> u32 {
        let title = TITLE + LINE * (lines.max(1) as u32 - 1);
        title + figure.panels.iter().map(|panel| self.panel(panel)).sum::<u32>()
    }

    /// Returns the width of a plot (px).
    fn across(self) -> u32 {
        self.width - LEFT - RIGHT
    }

    /// Returns the height of a panel's legend (px).
    fn legend(self, panel: &Panel) -> u32 {
        LEGEND + ROW * self.entries(panel).last().map_or(0, |(_, (row, _))| *row)
    }

    /// Returns the layers in the legend, each with its row and the left end of its entry (px).
    fn entries(self, panel: &Panel) -> Vec<(&Layer, (u32, u32))> {
        let (mut row, mut column) = (0, LEFT);
        let mut entries = Vec::new();
        for layer in panel.layers.iter().filter(|layer| !layer.name.is_empty() && layer.is_shown(panel)) {
            let wide = 23 + letters(&layer.name);
            if column > LEFT && column + wide > self.width {
                (row, column) = (row + 1, LEFT);
            }
            entries.push((layer, (row, column)));
            column += wide + 16;
        }
        entries
    }

    /// Returns the height of a panel including all around its plot (px).
    fn panel(self, panel: &Panel) -> u32 {
        let name = if panel.x.name.is_empty() { 0 } else { NAME };
        bar_height(panel) + self.legend(panel) + self.plot + NUMBERS + name
    }
}

/// Estimates the width of a legend text (px): the backend has no font metrics; a letter is about 0.6 of the font's
/// size wide.
fn letters(text: &str) -> u32 {
    text.chars().count() as u32 * 62 / 10
}

/// Returns the font size, at most `most` (px), at which a text fits into `room` (px): a letter is about 0.57 of it
/// wide.
fn fitting(text: &str, room: f64, most: f64) -> f64 {
    (room / (0.57 * text.chars().count() as f64)).min(most)
}

/// Splits a title between words into lines of legible size, the first as long as possible.
fn title_lines(title: &str, width: u32) -> Vec<String> {
    let room = f64::from(width - 20);
    let smallest = 11.0;
    let mut lines: Vec<String> = Vec::new();
    for word in title.split(' ') {
        match lines.last_mut() {
            Some(line) if fitting(&format!("{line} {word}"), room, 14.0) >= smallest => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Returns the height (px) of a figure of this width (px).
pub fn height(figure: &Figure, width: u32) -> u32 {
    Layout::new(figure, width, 0).height(figure, title_lines(&figure.title, width).len())
}

/// Returns the figure as SVG of this width (px), each plot higher than usual by `higher` (px).
pub fn svg(figure: &Figure, width: u32, higher: u32) -> Result<String, Error> {
    let layout = Layout::new(figure, width, higher);
    let lines = title_lines(&figure.title, width);
    let title = TITLE + LINE * (lines.len().max(1) as u32 - 1);
    let height = layout.height(figure, lines.len());
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
        for (panel, y) in figure.panels.iter().zip(&upward) {
            let (area, below) = rest.split_vertically(layout.panel(panel) * UNITS);
            let (key, area) = area.split_vertically(bar_height(panel) * UNITS);
            if let Some(bar) = &panel.bar {
                bar::draw(&key, bar, LEFT, layout.across())?;
            }
            draw_legend(&area, panel, layout)?;
            draw_panel(&area, (panel, y), layout)?;
            rest = below;
        }
        root.present()?;
    }
    // Sets the size in pixels, and round joins, because mitred ones extend far beyond sharp peaks.
    let fine = format!("width=\"{}\" height=\"{}\"", width * UNITS, height * UNITS);
    let size = format!("width=\"{width}\" height=\"{height}\" stroke-linejoin=\"round\"");
    Ok(svg.replacen(&fine, &size, 1))
}

fn bar_height(panel: &Panel) -> u32 {
    if panel.bar.is_some() { bar::HEIGHT } else { 0 }
}

/// Plot of a panel: the mapping from axis places to a rectangle of the backend.
struct Plot {
    window: Window,
    /// Distance from the top of the panel to the plot, width and height of the plot (px).
    top: u32,
    across: u32,
    height: u32,
}

impl Plot {
    /// Returns the backend's coordinates of a point.
    fn place(&self, (x, y): Point) -> (i32, i32) {
        let part = |value: f64, range: &Range<f64>| (value - range.start) / (range.end - range.start);
        let x = f64::from(LEFT) + part(x, &self.window.x) * f64::from(self.across);
        let y = f64::from(self.top) + (1.0 - part(y, &self.window.y)) * f64::from(self.height);
        ((x * f64::from(UNITS)).round() as i32, (y * f64::from(UNITS)).round() as i32)
    }
}

fn draw_panel(area: &Area<'_>, (panel, y): (&Panel, &FigureAxis), layout: Layout) -> Result<(), Error> {
    let plot = Plot {
        window: Window { x: panel.x.extent(), y: panel.y.extent() },
        top: layout.legend(panel),
        across: layout.across(),
        height: layout.plot,
    };
    draw_axes(area, (&panel.x, y), &plot)?;
    for layer in &panel.layers {
        let points: Vec<Point> =
            layer.points.iter().map(|(x, y)| (panel.x.place(*x), panel.y.place(*y))).collect();
        match layer.shape {
            LayerShape::Line(_) | LayerShape::Dashes => {
                for piece in pieces(&points, &plot.window) {
                    let piece = thin(&piece, &plot.window, plot.across).into_iter().map(|p| plot.place(p));
                    draw_line(area, layer, straighten(&piece.collect::<Vec<_>>()))?;
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
                    draw_mark(area, layer, plot.place(*point))?;
                }
            }
        }
    }
    Ok(())
}

/// Draws the grid, the numbers and the names of the axes.
fn draw_axes(area: &Area<'_>, (across, up): (&FigureAxis, &FigureAxis), plot: &Plot) -> Result<(), Error> {
    let Window { x, y } = &plot.window;
    let corner = plot.place((x.start, y.start));
    let opposite = plot.place((x.end, y.end));
    let gap = 5 * UNITS as i32;
    let (grid, frame) = (stroke(GRID, 0.6), stroke(colour::GREY, 0.8));
    let ticks = across.ticks(if plot.across < 400 { plot.across / 55 } else { plot.across / 85 });
    for (place, label) in
        ticks.at.iter().map(|tick| (plot.place((across.place(*tick), y.start)).0, ticks.text(*tick)))
    {
        area.draw(&PathElement::new([(place, corner.1), (place, opposite.1)], grid))?;
        area.draw_text(&label, &text(11.0, HPos::Center, VPos::Top), (place, corner.1 + gap))?;
    }
    let ticks = up.ticks(if plot.height < 120 { plot.height / 20 } else { plot.height / 28 });
    for (place, label) in
        ticks.at.iter().map(|tick| (plot.place((x.start, up.place(*tick))).1, ticks.text(*tick)))
    {
        area.draw(&PathElement::new([(corner.0, place), (opposite.0, place)], grid))?;
        area.draw_text(&label, &text(11.0, HPos::Right, VPos::Center), (corner.0 - gap, place))?;
    }
    let other = [(corner.0, opposite.1), (opposite.0, corner.1)];
    area.draw(&PathElement::new([corner, other[0], opposite, other[1], corner], frame))?;
    let below = at(LEFT + plot.across / 2, plot.top + plot.height + NUMBERS + NAME / 2 - 1);
    let name = across.label();
    let size = fitting(&name, f64::from(plot.across + LEFT), 12.0);
    area.draw_text(&name, &text(size, HPos::Center, VPos::Center), below)?;
    // A long name is drawn smaller.
    let (name, room) = (up.label(), f64::from(plot.height + plot.top + NUMBERS / 2));
    let size = fitting(&name, room, 12.0);
    let upright = text(size, HPos::Center, VPos::Center).transform(FontTransform::Rotate270);
    area.draw_text(&name, &upright, at(14, plot.top + plot.height / 2))
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
    for (layer, (row, column)) in layout.entries(panel) {
        let middle = LEGEND / 2 + 1 + ROW * row;
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
        area.draw_text(&layer.name, &text(11.0, HPos::Left, VPos::Center), at(column + 23, middle))?;
    }
    Ok(())
}

fn draw_mark(area: &Area<'_>, layer: &Layer, (x, y): (i32, i32)) -> Result<(), Error> {
    let corners: &[(i32, i32)] = match layer.shape {
        LayerShape::Triangle => &[(0, -42), (38, 26), (-38, 26)],
        LayerShape::Square => &[(-29, -29), (29, -29), (29, 29), (-29, 29)],
        LayerShape::Diamond => &[(0, -44), (44, 0), (0, 44), (-44, 0)],
        LayerShape::Dot => return area.draw(&Circle::new((x, y), 16, layer.style())),
        LayerShape::Ring => return area.draw(&Circle::new((x, y), 38, stroke(layer.colour, 1.2))),
        _ => return area.draw(&Circle::new((x, y), 32, layer.style())),
    };
    let corners: Vec<_> = corners.iter().map(|(dx, dy)| (x + dx, y + dy)).collect();
    area.draw(&Polygon::new(corners, layer.style()))
}

impl Layer {
    /// Whether a panel shows any of it.
    fn is_shown(&self, panel: &Panel) -> bool {
        let is_mark = !matches!(self.shape, LayerShape::Line(_) | LayerShape::Dashes | LayerShape::Area(_));
        let window = Window { x: panel.x.extent(), y: panel.y.extent() };
        let inside = |(x, y): &Point| window.contains((panel.x.place(*x), panel.y.place(*y)));
        if is_mark { self.points.iter().any(inside) } else { !self.points.is_empty() }
    }

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
