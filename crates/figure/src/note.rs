//! Words within a panel, beside a point of its axes.

use plotters::element::Rectangle;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, FontTransform, RGBColor, WHITE};

use crate::line::Point;
use crate::svg::{Area, Error, UNITS, text};

/// Words beside a point of a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct FigureNote {
    /// Text; its lines are one below the other.
    pub text: String,
    /// Point, in the units of the axes; a note on a point out of the panel is not drawn.
    pub point: Point,
    /// Side of the point on which the words are.
    pub side: NoteSide,
    /// Colour of the words.
    pub colour: RGBColor,
}

/// Side of a point.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum NoteSide {
    /// To the left of the point, at its height.
    Left,
    /// To the right of the point, at its height.
    Right,
    /// Above the point, centred.
    Above,
    /// Below the point, centred.
    Below,
    /// On the point itself.
    Centre,
    /// On the point, read upwards.
    Upright,
}

/// Size of the letters, height of a line, and distance from the point (px).
const SIZE: f64 = 10.0;
const LINE: f64 = 12.0;
const GAP: f64 = 4.0;
/// Width of a letter (px), on average.
const LETTER: f64 = 5.6;

impl FigureNote {
    /// Creates a note from its text, point, side and colour.
    pub fn new(text: impl Into<String>, point: Point, side: NoteSide, colour: RGBColor) -> Self {
        Self { text: text.into(), point, side, colour }
    }

    /// Draws the words beside a place (px) on a white ground, within a rectangle from its left and upper to its right and lower
    /// end (px).
    pub(crate) fn draw(
        &self,
        area: &Area<'_>,
        (x, y): Point,
        [least, largest]: [Point; 2],
    ) -> Result<(), Error> {
        let lines: Vec<&str> = self.text.lines().collect();
        let letters = lines.iter().map(|line| line.chars().count()).max().unwrap_or(0);
        let (width, height) = (LETTER * letters as f64, LINE * lines.len() as f64);
        let is_upright = self.side == NoteSide::Upright;
        let (width, height) = if is_upright { (height, width) } else { (width, height) };
        let (x, y) = match self.side {
            NoteSide::Left => (x - GAP - width / 2.0, y),
            NoteSide::Right => (x + GAP + width / 2.0, y),
            NoteSide::Above => (x, y - GAP - height / 2.0),
            NoteSide::Below => (x, y + GAP + height / 2.0),
            NoteSide::Centre | NoteSide::Upright => (x, y),
        };
        let held =
            |value: f64, half: f64, low: f64, high: f64| value.min(high - half - 1.0).max(low + half + 1.0);
        let (x, y) = (held(x, width / 2.0, least.0, largest.0), held(y, height / 2.0, least.1, largest.1));
        let at =
            |x: f64, y: f64| ((x * f64::from(UNITS)).round() as i32, (y * f64::from(UNITS)).round() as i32);
        let corners = [at(x - width / 2.0, y - height / 2.0), at(x + width / 2.0, y + height / 2.0)];
        area.draw(&Rectangle::new(corners, WHITE.mix(0.7).filled()))?;
        for (index, line) in lines.iter().enumerate() {
            let off = LINE * (index as f64 + 0.5 - lines.len() as f64 / 2.0);
            let style = text(SIZE, HPos::Center, VPos::Center).color(&self.colour);
            let (style, place) = if is_upright {
                (style.transform(FontTransform::Rotate270), at(x + off, y))
            } else {
                (style, at(x, y + off))
            };
            area.draw_text(line, &style, place)?;
        }
        Ok(())
    }
}
