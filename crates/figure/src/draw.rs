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
/// Part of the left margin that the name of the axis takes (px).
const UNNAMED: u32 = 24;
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

/// Layout of a figure, or of a panel in a row of panels side by side.
#[derive(Copy, Clone)]
struct Layout {
    /// Width (px).
    width: u32,
    /// Margin to the left of the plot (px).
    left: u32,
    /// Height of each plot (px).
    plot: u32,
}

impl Layout {
    /// The layout of a figure of this width, each of whose plots is higher than usual (px).
    fn new(figure: &Figure, width: u32, higher: u32) -> Self {
        let part = f64::from(width.min(WIDTH)) / f64::from(WIDTH);
        // Narrow figures are also lower, but less than proportionally.
        let plot = f64::from(figure.panel_height) * part.powf(0.6);
        Self { width, left: LEFT, plot: plot.round() as u32 + higher }
    }

    /// Returns the layouts of the panels of a row, whose plots have one width: a panel without a name at its upward axis has a
    /// narrower margin.
    fn row(self, panels: &[Panel]) -> Vec<Self> {
        let left =
            |panel: &Panel| if panel.is_beside && panel.y.name.is_empty() { LEFT - UNNAMED } else { LEFT };
        let margins: u32 = panels.iter().map(|panel| left(panel) + RIGHT).sum();
        let plot = self.width.saturating_sub(margins) / panels.len().max(1) as u32;
        panels
            .iter()
            .map(|panel| Self { width: left(panel) + plot + RIGHT, left: left(panel), ..self })
            .collect()
    }

    /// Returns the height (px) of a figure with a title of `lines` lines.
    fn height(self, figure: &Figure, lines: usize) -> u32 {
        let title = TITLE + LINE * (lines.max(1) as u32 - 1);
        title + rows(figure).map(|row| self.row_height(row)).sum::<u32>()
    }

    /// Returns the width of a plot (px).
    fn across(self) -> u32 {
        self.width - self.left - RIGHT
    }

    /// Returns the height of a panel's legend (px).
    fn legend(self, panel: &Panel) -> u32 {
        LEGEND + ROW * self.entries(panel).last().map_or(0, |(_, (row, _))| *row)
    }

    /// Returns the layers in the legend, each with its row and the left end of its entry (px).
    fn entries(self, panel: &Panel) -> Vec<(&Layer, (u32, u32))> {
        let (mut row, mut column) = (0, self.left);
        let mut entries = Vec::new();
        for layer in panel.layers.iter().filter(|layer| !layer.name.is_empty() && layer.is_shown(panel)) {
            let wide = 23 + letters(&layer.name);
            if column > self.left && column + wide > self.width {
                (row, column) = (row + 1, self.left);
            }
            entries.push((layer, (row, column)));
            column += wide + 16;
        }
        entries
    }

    /// Returns the height of a panel including all around its plot (px).
    fn panel(self, panel: &Panel) -> u32 {
        let name = if panel.x.name.is_empty() { 0 } else { NAME };
        self.above(panel) + self.plot + NUMBERS + name
    }

    /// Returns the height of the head and the legend above a panel's plot (px).
    fn above(self, panel: &Panel) -> u32 {
        let head = if panel.head.is_empty() { 0 } else { LINE };
        head + self.legend(panel)
    }

    /// Returns the height of a row of panels (px), with a colour bar over its width.
    fn row_height(self, panels: &[Panel]) -> u32 {
        let each = || self.row(panels).into_iter().zip(panels);
        let above = each().map(|(layout, panel)| layout.above(panel)).max().unwrap_or(0);
        let rest = each().map(|(layout, panel)| layout.panel(panel) - layout.above(panel)).max().unwrap_or(0);
        bar_height(panels) + above + rest
    }
}

/// Returns the panels of each row: those side by side.
pub fn rows(figure: &Figure) -> impl Iterator<Item = &[Panel]> {
    figure.panels.chunk_by(|_, next| next.is_beside)
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
    let each = || layout.row(panels).into_iter().zip(panels);
    let above = each().map(|(layout, panel)| layout.above(panel)).max().unwrap_or(0);
    for ((layout, panel), y) in each().zip(upward) {
        let (own, after) = rest.split_horizontally(layout.width * UNITS);
        let (_, own) = own.split_vertically((above - layout.above(panel)) * UNITS);
        let (head, own) = own.split_vertically((layout.above(panel) - layout.legend(panel)) * UNITS);
        if !panel.head.is_empty() {
            let size = fitting(&panel.head, f64::from(layout.across() + RIGHT), 12.0);
            head.draw_text(
                &panel.head,
                &text(size, HPos::Left, VPos::Center),
                at(layout.left, LINE / 2 + 2),
            )?;
        }
        draw_legend(&own, panel, layout)?;
        draw_panel(&own, (panel, y), layout)?;
        rest = after;
    }
    Ok(())
}

/// Returns the height of the colour bar of panels side by side (px).
fn bar_height(panels: &[Panel]) -> u32 {
    if panels.iter().any(|panel| panel.bar.is_some()) { bar::HEIGHT } else { 0 }
}

/// Plot of a panel: the mapping from axis places to a rectangle of the backend.
struct Plot {
    window: Window,
    /// Distance from the left of the panel to the plot (px).
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
        top: layout.legend(panel),
        across: layout.across(),
        height: layout.plot,
    };
    draw_axes(area, (&panel.x, y), &plot, panel.is_plain)?;
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
    let visible = [
        (f64::from(plot.left), f64::from(plot.top)),
        (f64::from(plot.left + plot.across), f64::from(plot.top + plot.height)),
    ];
    for note in &panel.notes {
        let point = (panel.x.place(note.point.0), panel.y.place(note.point.1));
        if plot.window.contains(point) {
            let (x, y) = plot.place(point);
            let unit = f64::from(UNITS);
            note.draw(area, (f64::from(x) / unit, f64::from(y) / unit), visible)?;
        }
    }
    Ok(())
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
    let ticks = across.ticks(if plot.across < 400 { plot.across / 55 } else { plot.across / 85 });
    for (place, label) in
        ticks.at.iter().map(|tick| (plot.place((across.place(*tick), y.start)).0, ticks.text(*tick)))
    {
        let end = if is_plain { corner.1 + gap / 2 } else { opposite.1 };
        area.draw(&PathElement::new([(place, corner.1), (place, end)], if is_plain { frame } else { grid }))?;
        area.draw_text(&label, &text(11.0, HPos::Center, VPos::Top), (place, corner.1 + gap))?;
    }
    let ticks = up.ticks(if plot.height < 120 { plot.height / 20 } else { plot.height / 28 });
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
