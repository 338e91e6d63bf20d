//! Drawing a figure as SVG.

use std::ops::Range;

use plotters::drawing::IntoDrawingArea;
use plotters::element::{Circle, DashedPathElement, PathElement, Polygon};
use plotters::prelude::SVGBackend;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, FontTransform, RGBColor, ShapeStyle, WHITE};

use crate::area::polygons;
use crate::line::{Point, Window, pieces, straighten, thin};
use crate::svg::{Area, Error, UNITS, at, text};
use crate::{Figure, Layer, Panel, Shape, bar, colour};

/// Width of every figure (px).
const WIDTH: u32 = 800;
/// Room left of a panel's plot, and the width of the plot (px).
const LEFT: u32 = 70;
const ACROSS: u32 = WIDTH - LEFT - 20;
/// Room below it, for numbers, and for a name of the axis (px).
const NUMBERS: u32 = 24;
const NAME: u32 = 18;
/// Room for the title, and for each legend (px).
const TITLE: u32 = 30;
const LEGEND: u32 = 22;
/// Columns of pixels that a line is told apart on.
const COLUMNS: u32 = 2 * ACROSS;
const GRID: RGBColor = RGBColor(225, 225, 225);

/// The figure as SVG.
pub fn svg(figure: &Figure) -> Result<String, Error> {
    let heights = figure.panels.iter().map(|panel| total_height(panel, figure.panel_height));
    let height = TITLE + heights.sum::<u32>();
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (WIDTH * UNITS, height * UNITS)).into_drawing_area();
        root.fill(&WHITE)?;
        let (head, body) = root.split_vertically(TITLE * UNITS);
        head.draw_text(&figure.title, &text(14.0, HPos::Center, VPos::Center), at(WIDTH / 2, TITLE / 2 + 2))?;
        let mut rest = body;
        for panel in &figure.panels {
            let (area, below) = rest.split_vertically(total_height(panel, figure.panel_height) * UNITS);
            let (key, area) = area.split_vertically(bar_height(panel) * UNITS);
            if let Some(bar) = &panel.bar {
                bar::draw(&key, bar, LEFT)?;
            }
            draw_legend(&area, panel)?;
            draw_panel(&area, panel, figure.panel_height)?;
            rest = below;
        }
        root.present()?;
    }
    // The size in pixels; and round joins, since mitred ones point far beyond sharp peaks.
    let fine = format!("width=\"{}\" height=\"{}\"", WIDTH * UNITS, height * UNITS);
    let size = format!("width=\"{WIDTH}\" height=\"{height}\" stroke-linejoin=\"round\"");
    Ok(svg.replacen(&fine, &size, 1))
}

/// The height of a panel with all that is around its plot (px).
fn total_height(panel: &Panel, plot: u32) -> u32 {
    bar_height(panel) + LEGEND + plot + NUMBERS + if panel.x.name.is_empty() { 0 } else { NAME }
}

fn bar_height(panel: &Panel) -> u32 {
    if panel.bar.is_some() { bar::HEIGHT } else { 0 }
}

/// A panel's plot: a window of the plane, in the places that values have on the axes, on a rectangle of the backend.
struct Plot {
    window: Window,
    height: u32,
}

impl Plot {
    /// Where a point of the plane is.
    fn place(&self, (x, y): Point) -> (i32, i32) {
        let part = |value: f64, range: &Range<f64>| (value - range.start) / (range.end - range.start);
        let x = f64::from(LEFT) + part(x, &self.window.x) * f64::from(ACROSS);
        let y = f64::from(LEGEND) + (1.0 - part(y, &self.window.y)) * f64::from(self.height);
        ((x * f64::from(UNITS)).round() as i32, (y * f64::from(UNITS)).round() as i32)
    }
}

fn draw_panel(area: &Area<'_>, panel: &Panel, height: u32) -> Result<(), Error> {
    let plot = Plot { window: Window { x: panel.x.extent(), y: panel.y.extent() }, height };
    draw_axes(area, panel, &plot)?;
    for layer in &panel.layers {
        let points: Vec<Point> =
            layer.points.iter().map(|(x, y)| (panel.x.place(*x), panel.y.place(*y))).collect();
        match layer.shape {
            Shape::Line(_) | Shape::Dashes => {
                for piece in pieces(&points, &plot.window) {
                    let piece = thin(&piece, &plot.window, COLUMNS).into_iter().map(|p| plot.place(p));
                    draw_line(area, layer, straighten(&piece.collect::<Vec<_>>()))?;
                }
            }
            Shape::Area(_) => {
                for polygon in polygons(&points, &plot.window, ACROSS) {
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
fn draw_axes(area: &Area<'_>, panel: &Panel, plot: &Plot) -> Result<(), Error> {
    let Window { x, y } = &plot.window;
    let corner = plot.place((x.start, y.start));
    let opposite = plot.place((x.end, y.end));
    let gap = 5 * UNITS as i32;
    let (grid, frame) = (stroke(GRID, 0.6), stroke(colour::GREY, 0.8));
    let ticks = panel.x.ticks(ACROSS / 85);
    for (across, label) in
        ticks.at.iter().map(|at| (plot.place((panel.x.place(*at), y.start)).0, ticks.text(*at)))
    {
        area.draw(&PathElement::new([(across, corner.1), (across, opposite.1)], grid))?;
        area.draw_text(&label, &text(11.0, HPos::Center, VPos::Top), (across, corner.1 + gap))?;
    }
    let ticks = panel.y.ticks(plot.height / 28);
    for (up, label) in
        ticks.at.iter().map(|at| (plot.place((x.start, panel.y.place(*at))).1, ticks.text(*at)))
    {
        area.draw(&PathElement::new([(corner.0, up), (opposite.0, up)], grid))?;
        area.draw_text(&label, &text(11.0, HPos::Right, VPos::Center), (corner.0 - gap, up))?;
    }
    let other = [(corner.0, opposite.1), (opposite.0, corner.1)];
    area.draw(&PathElement::new([corner, other[0], opposite, other[1], corner], frame))?;
    let below = at(LEFT + ACROSS / 2, LEGEND + plot.height + NUMBERS + NAME / 2 - 1);
    area.draw_text(&panel.x.label(), &text(12.0, HPos::Center, VPos::Center), below)?;
    // A letter is some 0.57 of the font's size wide; a long name becomes smaller.
    let (name, room) = (panel.y.label(), f64::from(plot.height + LEGEND + NUMBERS / 2));
    let size = (room / (0.57 * name.chars().count() as f64)).min(12.0);
    let upright = text(size, HPos::Center, VPos::Center).transform(FontTransform::Rotate270);
    area.draw_text(&name, &upright, at(14, LEGEND + plot.height / 2))
}

fn draw_line(area: &Area<'_>, layer: &Layer, points: Vec<(i32, i32)>) -> Result<(), Error> {
    if layer.shape == Shape::Dashes {
        area.draw(&DashedPathElement::new(points, 5 * UNITS, 4 * UNITS, layer.style()))
    } else {
        area.draw(&PathElement::new(points, layer.style()))
    }
}

/// Names the layers above the panel, in a row.
fn draw_legend(area: &Area<'_>, panel: &Panel) -> Result<(), Error> {
    let middle = LEGEND / 2 + 1;
    let mut left = LEFT;
    for layer in panel.layers.iter().filter(|layer| !layer.name.is_empty() && !layer.points.is_empty()) {
        let (from, to) = (at(left, middle), at(left + 18, middle));
        match layer.shape {
            Shape::Line(_) | Shape::Dashes => draw_line(area, layer, vec![from, to])?,
            Shape::Area(_) => {
                let [low, high] = [middle + 5, middle - 5];
                let corners = [at(left, low), at(left + 18, low), at(left + 18, high), at(left, high)];
                area.draw(&Polygon::new(corners, layer.style()))?;
            }
            _ => draw_mark(area, layer, at(left + 9, middle))?,
        }
        area.draw_text(&layer.name, &text(11.0, HPos::Left, VPos::Center), at(left + 23, middle))?;
        // The backend knows no font: a letter is some 0.6 of the font's size wide.
        left += 23 + layer.name.chars().count() as u32 * 62 / 10 + 16;
    }
    Ok(())
}

fn draw_mark(area: &Area<'_>, layer: &Layer, (x, y): (i32, i32)) -> Result<(), Error> {
    let corners: &[(i32, i32)] = match layer.shape {
        Shape::Triangle => &[(0, -42), (38, 26), (-38, 26)],
        Shape::Square => &[(-29, -29), (29, -29), (29, 29), (-29, 29)],
        Shape::Diamond => &[(0, -44), (44, 0), (0, 44), (-44, 0)],
        Shape::Dot => return area.draw(&Circle::new((x, y), 16, layer.style())),
        Shape::Ring => return area.draw(&Circle::new((x, y), 38, stroke(layer.colour, 1.2))),
        _ => return area.draw(&Circle::new((x, y), 32, layer.style())),
    };
    let corners: Vec<_> = corners.iter().map(|(dx, dy)| (x + dx, y + dy)).collect();
    area.draw(&Polygon::new(corners, layer.style()))
}

impl Layer {
    fn style(&self) -> ShapeStyle {
        match self.shape {
            Shape::Line(width) => stroke(self.colour, width),
            Shape::Dashes => stroke(self.colour, 1.0),
            Shape::Area(opacity) => self.colour.mix(opacity).filled(),
            _ => self.colour.filled(),
        }
    }
}

fn stroke(colour: RGBColor, width: f64) -> ShapeStyle {
    colour.stroke_width((width * f64::from(UNITS)).round() as u32)
}
