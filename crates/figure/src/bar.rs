//! The bar that tells what the colours of a map stand for.

use plotters::element::Polygon;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, RGBColor};

use crate::svg::{Area, Error, at, text};

/// The classes of a map's values, the lowest first.
pub struct Bar {
    /// What the values are.
    pub name: String,
    /// The colour of each class.
    pub colours: Vec<RGBColor>,
    /// The values between each class and the next.
    pub edges: Vec<String>,
}

/// Height of the bar with its numbers (px).
pub const HEIGHT: u32 = 30;
/// Width of a class, and height of its colour (px).
const CLASS: u32 = 40;
const COLOUR: u32 = 10;

/// Draws a bar from here on, its name before it.
pub fn draw(area: &Area<'_>, bar: &Bar, left: u32) -> Result<(), Error> {
    let middle = 2 + COLOUR / 2;
    area.draw_text(&bar.name, &text(11.0, HPos::Left, VPos::Center), at(left, middle))?;
    let first = left + bar.name.chars().count() as u32 * 58 / 10 + 14;
    let across = |index: usize| first + index as u32 * CLASS;
    for (index, colour) in bar.colours.iter().enumerate() {
        let (from, to) = (across(index), across(index + 1));
        let corners = [at(from, 2), at(to, 2), at(to, 2 + COLOUR), at(from, 2 + COLOUR)];
        area.draw(&Polygon::new(corners, colour.filled()))?;
    }
    for (index, edge) in bar.edges.iter().enumerate() {
        let below = at(across(index + 1), COLOUR + 11);
        area.draw_text(edge, &text(10.0, HPos::Center, VPos::Center), below)?;
    }
    Ok(())
}
