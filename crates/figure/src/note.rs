//! Notes: words at a point of a panel, such as the value of a limit.

use plotters::element::Polygon;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, RGBColor, WHITE};

use crate::colour;
use crate::line::Point;
use crate::svg::{Area, Error, UNITS, text};
use crate::text_width::wide;

/// Words at a point of a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// Words.
    pub text: String,
    /// Point, beside which they are; an infinite abscissa is the right end of the panel.
    pub at: Point,
    /// Colour.
    pub colour: RGBColor,
}

/// Rectangle of a plot (px).
#[derive(Copy, Clone)]
pub struct PlotBox {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

/// Size of the letters, and distance of a note from its point (px).
const LETTERS: f64 = 10.5;
const DISTANCE: f64 = 5.0;
const BESIDE: f64 = 8.0;
const HEIGHT: f64 = 13.0;
/// Opacity of the ground under the words.
const GROUND: f64 = 0.8;

/// Draws notes, each with its point (px), within a plot: above their points where there is room, and beside each other.
pub fn draw<'a>(
    area: &Area<'_>,
    notes: impl IntoIterator<Item = (&'a Note, (f64, f64))>,
    plot: PlotBox,
) -> Result<(), Error> {
    let mut taken: Vec<PlotBox> = Vec::new();
    for (note, (x, y)) in notes {
        let width = wide(&note.text, LETTERS) + 4.0;
        let left = (x - width / 2.0).min(plot.right - width - 1.0).max(plot.left + 1.0);
        let boxed =
            |(left, top): (f64, f64)| PlotBox { left, top, right: left + width, bottom: top + HEIGHT };
        let (above, below, beside) = (y - DISTANCE - HEIGHT, y + DISTANCE, y - HEIGHT / 2.0);
        let (right, before) = (x + BESIDE, x - BESIDE - width);
        let places = [
            (left, above),
            (right, beside),
            (before, beside),
            (left, below),
            (left, above - HEIGHT),
            (left, below + HEIGHT),
        ];
        let places = places.map(boxed);
        // The words of a limit are not on its line.
        let is_limit = note.colour == colour::RED;
        let inside = |place: &&PlotBox| {
            !(is_limit && place.top == beside)
                && place.top >= plot.top
                && place.bottom <= plot.bottom
                && place.left >= plot.left
                && place.right <= plot.right
        };
        let free = |place: &&PlotBox| !taken.iter().any(|other| place.covers(other));
        let place = places.iter().filter(inside).find(free).or(places.iter().find(inside)).copied();
        let place =
            place.unwrap_or(boxed((left, above.clamp(plot.top, (plot.bottom - HEIGHT).max(plot.top)))));
        let at =
            |x: f64, y: f64| ((x * f64::from(UNITS)).round() as i32, (y * f64::from(UNITS)).round() as i32);
        let corners = [
            at(place.left, place.top),
            at(place.right, place.top),
            at(place.right, place.bottom),
            at(place.left, place.bottom),
        ];
        area.draw(&Polygon::new(corners, WHITE.mix(GROUND).filled()))?;
        let middle = at(f64::midpoint(place.left, place.right), f64::midpoint(place.top, place.bottom));
        let style = text(LETTERS, HPos::Center, VPos::Center).color(&note.colour);
        area.draw_text(&note.text, &style, middle)?;
        taken.push(place);
    }
    Ok(())
}

impl PlotBox {
    fn covers(&self, other: &Self) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }
}
