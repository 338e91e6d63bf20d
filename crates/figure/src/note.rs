//! Notes: words at a point of a panel, such as the value of a limit.

use plotters::element::Polygon;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, FontTransform, RGBColor, WHITE};

use crate::colour;
use crate::line::{Point, Window};
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
    /// Side of the point on which the words are.
    pub side: NoteSide,
}

/// Side of a point.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum NoteSide {
    /// Above the point, or below it where there is no room.
    Free,
    /// Below the point.
    Below,
    /// To the left of the point.
    Left,
    /// To the right of the point.
    Right,
    /// On the point.
    Centre,
    /// On the point, read upwards.
    Upright,
}

impl Note {
    /// Creates a note above a point; its lines are one below the other.
    pub fn new(text: impl Into<String>, at: Point, colour: RGBColor) -> Self {
        Self { text: text.into(), at, colour, side: NoteSide::Free }
    }

    /// Returns the note on a side of its point.
    #[must_use]
    pub fn on(self, side: NoteSide) -> Self {
        Self { side, ..self }
    }
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
/// Length of covered curves (px) by which a place may exceed the next one and still be preferred.
const PREFERENCE: f64 = 4.0;
/// Opacity of the ground under the words.
const GROUND: f64 = 0.7;

/// Draws notes, each with its point (px), within a plot: where they cover least of the curves (px), above their points if
/// possible, and beside each other.
pub fn draw<'a>(
    area: &Area<'_>,
    notes: impl IntoIterator<Item = (&'a Note, Point)>,
    plot: PlotBox,
    curves: &[Vec<Point>],
) -> Result<(), Error> {
    let mut taken: Vec<PlotBox> = Vec::new();
    for (note, (x, y)) in notes {
        let lines: Vec<&str> = note.text.lines().collect();
        let width = lines.iter().map(|line| wide(line, LETTERS)).fold(0.0, f64::max) + 4.0;
        let height = HEIGHT * lines.len() as f64;
        let is_upright = note.side == NoteSide::Upright;
        let (width, height) = if is_upright { (height, width) } else { (width, height) };
        let boxed = |(x, y): (f64, f64)| {
            let left = (x - width / 2.0).min(plot.right - width - 1.0).max(plot.left + 1.0);
            let top = y - height / 2.0;
            PlotBox { left, top, right: left + width, bottom: top + height }
        };
        let (up, across) = (DISTANCE + height / 2.0, BESIDE + width / 2.0);
        let beside = |across: f64| [0.0, -1.0, 1.0, -2.0, 2.0, 3.0].map(|lines| (across, lines * HEIGHT));
        let (above, below) = ([(0.0, -up), (0.0, -up - HEIGHT)], [(0.0, up), (0.0, up + HEIGHT)]);
        let offsets = match note.side {
            // The words of a limit are not on its line.
            NoteSide::Free if note.colour == colour::RED => [above, below].concat(),
            NoteSide::Free => {
                let corners = [(across, -up), (-across, -up), (across, up), (-across, up)];
                [&[above[0], (across, 0.0), (-across, 0.0), below[0], above[1], below[1]], &corners[..]]
                    .concat()
            }
            NoteSide::Below => below.to_vec(),
            NoteSide::Left => beside(-across).to_vec(),
            NoteSide::Right => beside(across).to_vec(),
            NoteSide::Centre | NoteSide::Upright => vec![(0.0, 0.0)],
        };
        let places: Vec<PlotBox> = offsets.iter().map(|(dx, dy)| boxed((x + dx, y + dy))).collect();
        // Words beside a point are not moved over it.
        let is_over =
            |place: &PlotBox| place.left < x && x < place.right && place.top < y && y < place.bottom;
        let is_on = matches!(note.side, NoteSide::Centre | NoteSide::Upright);
        let inside = |place: &&PlotBox| {
            place.top >= plot.top && place.bottom <= plot.bottom && (is_on || !is_over(place))
        };
        let free = |place: &&PlotBox| !taken.iter().any(|other| place.covers(other));
        let allowed: Vec<&PlotBox> = places.iter().filter(inside).collect();
        let is_any_free = allowed.iter().any(free);
        let covered = |index: usize, place: &PlotBox| {
            curves.iter().map(|curve| place.covered(curve)).sum::<f64>() + PREFERENCE * index as f64
        };
        let ranked = allowed.into_iter().filter(|place| !is_any_free || free(place)).enumerate();
        let ranked = ranked.map(|(index, place)| (covered(index, place), *place));
        let place = ranked.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, place)| place);
        let held = |top: f64| top.clamp(plot.top, (plot.bottom - height).max(plot.top));
        let place = place.unwrap_or_else(|| boxed((x + offsets[0].0, held(places[0].top) + height / 2.0)));
        let at =
            |x: f64, y: f64| ((x * f64::from(UNITS)).round() as i32, (y * f64::from(UNITS)).round() as i32);
        let corners = [
            at(place.left, place.top),
            at(place.right, place.top),
            at(place.right, place.bottom),
            at(place.left, place.bottom),
        ];
        area.draw(&Polygon::new(corners, WHITE.mix(GROUND).filled()))?;
        let (x, y) = (f64::midpoint(place.left, place.right), f64::midpoint(place.top, place.bottom));
        for (index, line) in lines.iter().enumerate() {
            let off = HEIGHT * (index as f64 + 0.5 - lines.len() as f64 / 2.0);
            let style = text(LETTERS, HPos::Center, VPos::Center).color(&note.colour);
            let (style, middle) = if is_upright {
                (style.transform(FontTransform::Rotate270), at(x + off, y))
            } else {
                (style, at(x, y + off))
            };
            area.draw_text(line, &style, middle)?;
        }
        taken.push(place);
    }
    Ok(())
}

impl PlotBox {
    /// Returns the length of a curve within the rectangle (px).
    fn covered(&self, curve: &[Point]) -> f64 {
        let window = Window { x: self.left..self.right, y: self.top..self.bottom };
        let parts = curve.windows(2).filter_map(|pair| window.clip((pair[0], pair[1])));
        parts.map(|(a, b)| (b.0 - a.0).hypot(b.1 - a.1)).sum()
    }

    fn covers(&self, other: &Self) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }
}
