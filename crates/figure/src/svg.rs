//! Drawing area of an SVG, whose integer coordinates are tenths of a pixel, and text in it.

use std::io;

use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind};
use plotters::prelude::SVGBackend;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontDesc, FontFamily, FontStyle, TextStyle};

/// Units of the backend's integer coordinates per pixel.
pub const UNITS: u32 = 10;

pub type Error = DrawingAreaErrorKind<io::Error>;
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Returns a style for black text of a size (px).
pub fn text(size: f64, h: HPos, v: VPos) -> TextStyle<'static> {
    // The backend's sizes are 1.24 times those of SVG.
    let size = 1.24 * size * f64::from(UNITS);
    TextStyle::from(FontDesc::new(FontFamily::SansSerif, size, FontStyle::Normal)).pos(Pos::new(h, v))
}

/// Converts a position in pixels to the backend's coordinates.
pub fn at(x: u32, y: u32) -> (i32, i32) {
    ((x * UNITS) as i32, (y * UNITS) as i32)
}
