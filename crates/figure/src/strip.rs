//! Strips above the axes: the times at which something holds, such as modes of operation and eclipses.

use plotters::element::Polygon;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, RGBColor};

use crate::Panel;
use crate::svg::{Area, Error, UNITS, at, text};
use crate::text_width::wide;

/// Thin bar above the axes, with a name before it.
#[derive(Clone, Debug, PartialEq)]
pub struct Strip {
    /// Name.
    pub name: String,
    /// Parts of the horizontal axis that are filled.
    pub spans: Vec<StripSpan>,
}

/// Filled part of a strip.
#[derive(Clone, Debug, PartialEq)]
pub struct StripSpan {
    /// Start, in the unit of the horizontal axis.
    pub from: f64,
    /// End.
    pub to: f64,
    /// Name within it; empty for none.
    pub name: String,
    /// Colour.
    pub colour: RGBColor,
}

/// Height of a strip with the space below it, and of its bar (px).
const ROW: u32 = 14;
const BAR: u32 = 11;
/// Space above and below all strips (px).
const MARGIN: u32 = 5;
/// Size of the names (px), and space between a name and its bar.
const LETTERS: f64 = 10.0;
const SPACE: u32 = 6;
/// Least width of a span, so that it is seen (px).
const LEAST: f64 = 1.2;

/// Returns the room that the names of strips need left of the plot (px).
pub fn names_width(strips: &[Strip]) -> u32 {
    let longest = strips.iter().map(|strip| wide(&strip.name, LETTERS)).fold(0.0, f64::max);
    if longest > 0.0 { longest.ceil() as u32 + SPACE + 2 } else { 0 }
}

/// Returns the height of a panel's strips (px).
pub fn height((left, across): (u32, u32), panel: &Panel) -> u32 {
    let strips = panel.strips.len() as u32;
    let keys = keys((left, across), panel).last().map_or(0, |(_, _, row, _)| row + 1);
    if strips == 0 { 0 } else { 2 * MARGIN + ROW * (strips + keys) }
}

/// Returns the pixels of a span from the left end of the plot; `None` if it is outside.
fn pixels(across: u32, panel: &Panel, span: &StripSpan) -> Option<(f64, f64)> {
    let extent = panel.x.extent();
    let scale = f64::from(across) / (extent.end - extent.start);
    let place = |x: f64| (panel.x.place(x).clamp(extent.start, extent.end) - extent.start) * scale;
    let (from, to) = (place(span.from), place(span.to));
    let is_outside = span.to < panel.x.range.start || span.from > panel.x.range.end;
    (!is_outside && span.to > span.from).then(|| (from, to.max(from + LEAST)))
}

/// Returns true if the name of a span fits into it.
fn has_room(span: &StripSpan, (from, to): (f64, f64)) -> bool {
    wide(&span.name, LETTERS) + 6.0 <= to - from
}

/// Returns names that fit into none of their spans, each with its colour, row and left end (px): they are a legend.
fn keys((left, across): (u32, u32), panel: &Panel) -> Vec<(&str, RGBColor, u32, u32)> {
    let mut names: Vec<(&StripSpan, bool)> = Vec::new();
    for span in panel.strips.iter().flat_map(|strip| &strip.spans).filter(|span| !span.name.is_empty()) {
        let Some(shown) = pixels(across, panel, span) else { continue };
        let fits = has_room(span, shown);
        match names.iter_mut().find(|(known, _)| known.name == span.name) {
            Some((_, is_named)) => *is_named |= fits,
            None => names.push((span, fits)),
        }
    }
    let (mut row, mut column) = (0, left);
    let unnamed = names.into_iter().filter(|(_, is_named)| !is_named);
    unnamed
        .map(|(span, _)| {
            let width = 14 + wide(&span.name, LETTERS).ceil() as u32;
            if column > left && column + width > left + across {
                (row, column) = (row + 1, left);
            }
            let key = (span.name.as_str(), span.colour, row, column);
            column += width + 12;
            key
        })
        .collect()
}

/// Draws the strips of a panel from its top.
pub fn draw(area: &Area<'_>, panel: &Panel, (left, across): (u32, u32)) -> Result<(), Error> {
    let unit = f64::from(UNITS);
    let bar = |from: f64, to: f64, top: u32, colour: RGBColor| {
        let [left, right] = [from, to].map(|x| ((f64::from(left) + x) * unit).round() as i32);
        let [top, bottom] = [top, top + BAR].map(|y| (y * UNITS) as i32);
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
        area.draw(&Polygon::new(corners, colour.filled()))
    };
    let mut top = MARGIN;
    let letters = |h: HPos| text(LETTERS, h, VPos::Center);
    for (name, colour, row, column) in keys((left, across), panel) {
        let (from, own) = (f64::from(column - left), MARGIN + ROW * row);
        bar(from, from + 10.0, own, colour)?;
        area.draw_text(name, &letters(HPos::Left), at(column + 14, own + BAR / 2))?;
        top = own + ROW;
    }
    for strip in &panel.strips {
        let middle = top + BAR / 2;
        area.draw_text(&strip.name, &letters(HPos::Right), at(left - SPACE, middle))?;
        for span in &strip.spans {
            let Some(shown) = pixels(across, panel, span) else { continue };
            bar(shown.0, shown.1, top, span.colour)?;
            if !span.name.is_empty() && has_room(span, shown) {
                let centre = f64::from(left) + f64::midpoint(shown.0, shown.1);
                area.draw_text(&span.name, &letters(HPos::Center), at(centre.round() as u32, middle))?;
            }
        }
        top += ROW;
    }
    Ok(())
}
