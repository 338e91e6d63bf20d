//! Figures: panels of lines, areas and marks over axes, as SVG and, with the feature `png`, as PNG and PDF.

mod area;
mod axis;
mod bar;
mod contour;
mod draw;
#[cfg(feature = "png")]
mod image;
mod layout;
mod line;
mod note;
mod origin;
mod over_time;
pub mod palette;
#[cfg(feature = "png")]
mod pdf;
mod sheet;
mod strip;
mod style;
mod svg;
mod text_width;
mod ticks;

pub use area::band;
pub use axis::{FigureAxis, Scale, name_and_unit, round_to_nice};
pub use bar::Bar;
pub use contour::{Ring, ScalarField};
#[cfg(feature = "png")]
pub use image::Renderer;
pub use line::{Point, Window, steps};
pub use note::{Note, NoteSide};
pub use origin::is_figure;
pub use over_time::{OverTime, PanelLines};
pub use plotters::style::RGBColor;
pub use sheet::sheet;
pub use strip::{Strip, StripSpan};
pub use style::Style;
pub use ticks::{Ticks, power_text};

/// Colours that are distinguishable with colour blindness (Okabe and Ito).
pub mod colour {
    use plotters::style::RGBColor;

    /// Grey, for elements other than data.
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
    /// Red, for limits alone.
    pub const RED: RGBColor = RGBColor(190, 30, 45);
    /// Vermillion.
    pub const VERMILLION: RGBColor = RGBColor(213, 94, 0);
}

/// Figure of stacked panels.
pub struct Figure {
    /// Title of the figure, which its caption says and which is drawn on demand.
    pub title: String,
    /// Panels, from top to bottom.
    pub panels: Vec<Panel>,
    /// Height of each panel in pixels.
    pub panel_height: u32,
}

/// Figure with the name of its file, without an extension.
pub type Named = (String, Figure);

/// Panel of a figure: layers over two axes.
pub struct Panel {
    /// Horizontal axis.
    pub x: FigureAxis,
    /// Vertical axis.
    pub y: FigureAxis,
    /// Layers, the lowest first.
    pub layers: Vec<Layer>,
    /// Colour bar of a map.
    pub bar: Option<Bar>,
    /// Strips above the panel, from top to bottom.
    pub strips: Vec<Strip>,
    /// Notes at points.
    pub notes: Vec<Note>,
    /// Words above the axes that belong to no layer; empty for none.
    pub remark: String,
    /// True for a panel to the right of the one before it, which is otherwise below that.
    pub is_beside: bool,
    /// True for a panel without grid lines.
    pub is_plain: bool,
    /// True for the only panel of a figure whose axes have one scale.
    pub is_equal: bool,
}

/// Set of points drawn with one shape and colour.
#[derive(Clone)]
pub struct Layer {
    /// Name in the legend; empty for none.
    pub name: String,
    /// Colour.
    pub colour: RGBColor,
    /// Shape.
    pub shape: LayerShape,
    /// Points; a point that is not finite is a gap.
    pub points: Vec<Point>,
}

/// Shape of a layer.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum LayerShape {
    /// Line with a width in pixels.
    Line(f64),
    /// Dashed line.
    Dashes,
    /// Area within the points, with an opacity: a closed polygon between gaps.
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
    /// Crosses at the points.
    Cross,
    /// Upright strokes at the points.
    Stroke,
}

impl Figure {
    /// Returns the figure as SVG, in the size for screens.
    pub fn svg(&self) -> Result<String, String> {
        self.laid_out(&Style::default())
    }

    /// Returns the vertical axes of the panels as drawn: axes of one quantity share a unit.
    pub fn upward(&self) -> Vec<FigureAxis> {
        FigureAxis::stacked(self.panels.iter().map(|panel| &panel.y))
    }

    /// Returns the figure without the legend of a panel whose layers are all named in the panel before it.
    #[must_use]
    pub fn named_once(mut self) -> Self {
        for index in (1..self.panels.len()).rev() {
            let (before, after) = self.panels.split_at_mut(index);
            let is_known = |layer: &Layer| {
                layer.name.is_empty()
                    || before[index - 1]
                        .layers
                        .iter()
                        .any(|other| other.name == layer.name && other.is_like(layer))
            };
            if after[0].layers.iter().all(is_known) {
                after[0].layers.iter_mut().for_each(|layer| layer.name.clear());
            }
        }
        self
    }

    /// Returns the figure as SVG, laid out for a style but in pixels of the layout: [`Style::sized`] sets its size.
    pub fn laid_out(&self, style: &Style) -> Result<String, String> {
        draw::svg(self, style.layout_width(), 0, style.is_titled()).map_err(|error| error.to_string())
    }
}

impl Panel {
    /// Creates a panel from its axes and layers.
    pub fn new(x: FigureAxis, y: FigureAxis, layers: Vec<Layer>) -> Self {
        Self {
            x,
            y,
            layers,
            bar: None,
            strips: Vec::new(),
            notes: Vec::new(),
            remark: String::new(),
            is_beside: false,
            is_plain: false,
            is_equal: false,
        }
    }

    /// Returns the panel with words above its axes.
    #[must_use]
    pub fn headed(self, remark: impl Into<String>) -> Self {
        Self { remark: remark.into(), ..self }
    }

    /// Returns the panel with words in it.
    #[must_use]
    pub fn noted(mut self, notes: impl IntoIterator<Item = Note>) -> Self {
        self.notes.extend(notes);
        self
    }

    /// Returns the panel to the right of the one before it.
    #[must_use]
    pub fn right_of_last(self) -> Self {
        Self { is_beside: true, ..self }
    }

    /// Returns the panel with one scale for both axes.
    #[must_use]
    pub fn equal(self) -> Self {
        Self { is_equal: true, ..self }
    }

    /// Returns the panel without grid lines.
    #[must_use]
    pub fn plain(self) -> Self {
        Self { is_plain: true, ..self }
    }
}

impl Layer {
    /// Creates a layer from its name, colour, shape and points.
    pub fn new(name: &str, colour: RGBColor, shape: LayerShape, points: Vec<Point>) -> Self {
        Self { name: name.to_owned(), colour, shape, points }
    }

    /// Returns true if another layer looks the same in a legend.
    fn is_like(&self, other: &Self) -> bool {
        self.colour == other.colour && self.shape == other.shape
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_legend_that_repeats_the_one_above_is_left_out() {
        let line = |name: &str, colour| Layer::new(name, colour, LayerShape::Line(1.0), vec![(0.0, 0.0)]);
        let panel = |layers| {
            let axis = FigureAxis::exact("x", "", 0.0..1.0);
            Panel::new(axis.clone(), axis, layers)
        };
        let both = || vec![line("roll", colour::BLUE), line("pitch", colour::GREEN)];
        let other = vec![line("roll", colour::BLUE), line("pitch", colour::RED)];
        let figure = Figure {
            title: String::new(),
            panels: vec![panel(both()), panel(both()), panel(both()), panel(other)],
            panel_height: 100,
        };
        let names = |panel: &Panel| panel.layers.iter().map(|layer| layer.name.clone()).collect::<Vec<_>>();
        let names: Vec<_> = figure.named_once().panels.iter().map(names).collect();
        assert_eq!(names, [["roll", "pitch"], ["", ""], ["", ""], ["roll", "pitch"]]);
    }
}
