//! Colour bar of a map.

use plotters::element::Polygon;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, RGBColor};

use crate::svg::{Area, Error, UNITS, at, text};

/// Colour bar: the classes of a map's values, the lowest first.
pub struct Bar {
    /// Name of the values.
    pub name: String,
    /// Colour of each class.
    pub colours: Vec<RGBColor>,
    /// Values between each class and the next; empty texts are not drawn.
    pub edges: Vec<String>,
}

/// Height of the bar with its numbers (px).
pub const HEIGHT: u32 = 36;
/// Space above the colours (px).
const TOP: u32 = 6;
/// Maximum width of a class, maximum width of the bar, and height of the colours (px).
const CLASS: f64 = 40.0;
const BAR: f64 = 400.0;
const COLOUR: u32 = 10;

/// Draws a bar at `left` (px) with its name before it, within `width` (px).
pub fn draw(area: &Area<'_>, bar: &Bar, left: u32, width: u32) -> Result<(), Error> {
    let middle = TOP + COLOUR / 2;
    // A letter is about 0.53 of the font's size wide; a long name leaves half of the width.
    let letters = bar.name.chars().count() as f64;
    let size = (0.5 * f64::from(width) / (0.53 * letters)).min(11.0);
    area.draw_text(&bar.name, &text(size, HPos::Left, VPos::Center), at(left, middle))?;
    let first = f64::from(left) + letters * 0.53 * size + 14.0;
    let room = (f64::from(left + width) - first).min(BAR);
    let class = (room / bar.colours.len() as f64).min(CLASS);
    let place = |index: usize, down: u32| {
        let across = (first + index as f64 * class) * f64::from(UNITS);
        (across.round() as i32, (down * UNITS) as i32)
    };
    for (index, colour) in bar.colours.iter().enumerate() {
        let [top, bottom] = [TOP, TOP + COLOUR];
        let corners =
            [place(index, top), place(index + 1, top), place(index + 1, bottom), place(index, bottom)];
        area.draw(&Polygon::new(corners, colour.filled()))?;
    }
    // Texts that would touch the previous one are omitted.
    let mut free = f64::NEG_INFINITY;
    for (index, edge) in bar.edges.iter().enumerate().filter(|(_, edge)| !edge.is_empty()) {
        let (middle, half) = ((index + 1) as f64 * class, 3.1 * edge.chars().count() as f64);
        if middle - half > free {
            area.draw_text(
                edge,
                &text(10.0, HPos::Center, VPos::Center),
                place(index + 1, TOP + COLOUR + 9),
            )?;
            free = middle + half + 4.0;
        }
    }
    Ok(())
}
