//! Figures: panels of lines, areas and marks over axes, as SVG and, with the feature `png`, as PNG and PDF.

mod area;
mod axis;
mod bar;
mod contour;
mod draw;
#[cfg(feature = "png")]
mod image;
mod line;
pub mod palette;
#[cfg(feature = "png")]
mod pdf;
mod refine;
mod sheet;
mod style;
mod svg;

pub use area::band;
pub use axis::{FigureAxis, Scale, Ticks, name_and_unit, round_to_nice};
pub use bar::Bar;
pub use contour::{Ring, ScalarField};
#[cfg(feature = "png")]
pub use image::Renderer;
pub use line::{Point, Window, steps};
pub use plotters::style::RGBColor;
pub use sheet::sheet;
pub use style::Style;

/// Colours that also the colour-blind tell apart (Okabe and Ito).
pub mod colour {
    use plotters::style::RGBColor;

    /// For what is not data.
    pub const GREY: RGBColor = RGBColor(120, 120, 120);
    /// Black.
    pub const BLACK: RGBColor = RGBColor(0, 0, 0);
    /// Orange.
    pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
    /// Sky blue.
    pub const SKY: RGBColor = RGBColor(86, 180, 233);
    /// Bluish green.
    pub const GREEN: RGBColor = RGBColor(0, 158, 115);
    /// Blue.
    pub const BLUE: RGBColor = RGBColor(0, 114, 178);
    /// Vermillion.
    pub const VERMILLION: RGBColor = RGBColor(213, 94, 0);
}

/// A figure.
pub struct Figure {
    /// What it shows.
    pub title: String,
    /// Its panels, from top to bottom.
    pub panels: Vec<Panel>,
    /// Height of each panel in pixels.
    pub panel_height: u32,
}

/// A figure, after the name of its file without an extension.
pub type Named = (String, Figure);

/// A panel.
pub struct Panel {
    /// Axis to the right.
    pub x: FigureAxis,
    /// Axis upwards.
    pub y: FigureAxis,
    /// What is drawn, the lowest first.
    pub layers: Vec<Layer>,
    /// What the colours of a map stand for.
    pub bar: Option<Bar>,
}

/// What is drawn in one go.
#[derive(Clone)]
pub struct Layer {
    /// Name in the legend; empty for none.
    pub name: String,
    /// Colour.
    pub colour: RGBColor,
    /// Shape.
    pub shape: LayerShape,
    /// Where; a point that is not finite is a gap.
    pub points: Vec<Point>,
}

/// The shape of a layer.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum LayerShape {
    /// A line of this width in pixels.
    Line(f64),
    /// A dashed line.
    Dashes,
    /// The area within the points, with this opacity: a closed polygon between gaps.
    Area(f64),
    /// Discs at the points.
    Disc,
    /// Small discs, for points that may be many.
    Dot,
    /// Rings at the points.
    Ring,
    /// Triangles at the points.
    Triangle,
    /// Squares at the points.
    Square,
    /// Diamonds at the points.
    Diamond,
}

impl Figure {
    /// The figure as SVG, as large as on a screen.
    pub fn svg(&self) -> Result<String, String> {
        self.laid_out(&Style::default())
    }

    /// The vertical axes of the panels as they are drawn: those of one unit have one prefix.
    pub fn upward(&self) -> Vec<FigureAxis> {
        FigureAxis::stacked(self.panels.iter().map(|panel| &panel.y))
    }

    /// The figure as SVG, laid out for a style but in pixels of its own: [`Style::sized`] gives it its size.
    pub fn laid_out(&self, style: &Style) -> Result<String, String> {
        draw::svg(self, style.layout_width(), 0).map_err(|error| error.to_string())
    }
}

impl Panel {
    /// A panel of layers.
    pub fn new(x: FigureAxis, y: FigureAxis, layers: Vec<Layer>) -> Self {
        Self { x, y, layers, bar: None }
    }
}

impl Layer {
    /// A layer.
    pub fn new(name: &str, colour: RGBColor, shape: LayerShape, points: Vec<Point>) -> Self {
        Self { name: name.to_owned(), colour, shape, points }
    }
}
