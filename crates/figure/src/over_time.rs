//! Figures over time, panel by panel: lines with limits, and axes that follow from them.

use flexsc_formats::reader_units::ReaderUnits;
use plotters::style::RGBColor;

use crate::{Figure, FigureAxis, Layer, LayerShape, Note, Panel, Point, colour};

/// Colours of lines, in their order; cyclic.
const COLOURS: [RGBColor; 7] = [
    colour::BLUE,
    colour::VERMILLION,
    colour::GREEN,
    colour::ORANGE,
    colour::SKY,
    colour::BLACK,
    colour::GREY,
];

/// Part of a limit from which on it is a line in its panel, and multiple of it up to which the panel reaches.
const NEAR: f64 = 0.5;
const ROOM: f64 = 1.15;

/// Figure over time whose panels are added from top to bottom.
pub struct OverTime {
    end: f64,
    figure: Figure,
}

/// Contents of a panel over time: its vertical axis covers all of them.
pub struct PanelLines {
    layers: Vec<Layer>,
    limit: Option<f64>,
    line_count: usize,
    width: f64,
    is_from_zero: bool,
    is_of_rotors: bool,
}

impl OverTime {
    /// Creates a figure from 0 to `end` (s), whose panels are `height` pixels high.
    pub fn new(title: String, end: f64, height: u32) -> Self {
        Self { end, figure: Figure { title, panels: Vec::new(), panel_height: height } }
    }

    /// Adds a panel; nothing if it has no layers.
    #[must_use]
    pub fn panel(mut self, name: &str, unit: &'static str, lines: PanelLines) -> Self {
        let PanelLines { layers: own, limit, is_from_zero, is_of_rotors, .. } = lines;
        if own.is_empty() {
            return self;
        }
        let values = || own.iter().flat_map(|layer| &layer.points).map(|(_, value)| *value);
        let reaches = |limit: &f64| values().any(|value| value / limit >= NEAR);
        let near: Vec<f64> =
            limit.into_iter().flat_map(|limit| [limit, -limit]).filter(|limit| reaches(limit)).collect();
        // Beyond a limit there is room for its words.
        let values: Vec<f64> = values().chain(near.iter().map(|limit| ROOM * limit)).collect();
        let level = |height: &f64| {
            let points = vec![(0.0, *height), (self.end, *height)];
            Layer::new("", colour::RED, LayerShape::Line(1.6), points)
        };
        let layers: Vec<Layer> = near.iter().map(level).chain(own).collect();
        let y = if is_from_zero {
            FigureAxis::from_zero(name, unit, values)
        } else {
            FigureAxis::around(name, unit, values)
        };
        let y = if is_of_rotors { y.in_rpm() } else { y };
        if let Some(above) = self.figure.panels.last_mut() {
            above.x = above.x.unnamed();
        }
        let mut panel = Panel::new(FigureAxis::exact("time", "s", 0.0..self.end), y, layers);
        if let Some(limit) = limit {
            let unit = if is_of_rotors {
                panel.y.reader_unit()
            } else {
                ReaderUnits::Engineering.fitting(limit, unit)
            };
            let words = format!("limit {}", unit.limit(limit, None));
            match near.first() {
                Some(near) => {
                    let at = (f64::INFINITY, *near);
                    panel.notes.push(Note::new(words, at, colour::RED));
                }
                None => panel.remark = words,
            }
        }
        self.figure.panels.push(panel);
        self
    }

    /// Returns the figure.
    pub fn figure(self) -> Figure {
        self.figure.named_once()
    }
}

impl Default for PanelLines {
    fn default() -> Self {
        Self {
            layers: Vec::new(),
            limit: None,
            line_count: 0,
            width: 1.2,
            is_from_zero: false,
            is_of_rotors: false,
        }
    }
}

impl PanelLines {
    /// Adds lines at a limit and at its negative, if there is one and the other lines come near it; else its value in words.
    #[must_use]
    pub fn limits(self, limit: Option<f64>) -> Self {
        Self { limit, ..self }
    }

    /// Adds layers of any shape and colour.
    #[must_use]
    pub fn layers(mut self, layers: impl IntoIterator<Item = Layer>) -> Self {
        self.layers.extend(layers);
        self
    }

    /// Lets the vertical axis begin at 0.
    #[must_use]
    pub fn from_zero(self) -> Self {
        Self { is_from_zero: true, ..self }
    }

    /// Shows the speeds of rotors (rad/s) in rpm.
    #[must_use]
    pub fn of_rotors(self) -> Self {
        Self { is_of_rotors: true, ..self }
    }

    /// Sets the width of the lines that follow (pixels).
    #[must_use]
    pub fn width(self, width: f64) -> Self {
        Self { width, ..self }
    }

    /// Adds a layer of any shape and colour.
    #[must_use]
    pub fn layer(mut self, layer: Layer) -> Self {
        self.layers.push(layer);
        self
    }

    /// Adds a line in the next colour.
    #[must_use]
    pub fn line(mut self, name: &str, points: Vec<Point>) -> Self {
        let colour = COLOURS[self.line_count % COLOURS.len()];
        self.line_count += 1;
        let shape = LayerShape::Line(self.width);
        self.layer(Layer::new(name, colour, shape, points))
    }

    /// Adds lines with names of their own.
    #[must_use]
    pub fn named(self, lines: impl IntoIterator<Item = (String, Vec<Point>)>) -> Self {
        lines.into_iter().fold(self, |all, (name, points)| all.line(&name, points))
    }

    /// Adds a line for each of a list, named with its number from 1 on.
    #[must_use]
    pub fn numbered(self, name: &str, lines: impl IntoIterator<Item = Vec<Point>>) -> Self {
        self.named((1..).zip(lines).map(|(number, points)| (format!("{name} {number}"), points)))
    }

    /// Adds the components x, y and z of a vector.
    #[must_use]
    pub fn vector(self, components: impl Fn(usize) -> Vec<Point>) -> Self {
        [0, 1, 2].into_iter().fold(self, |all, axis| all.line(["x", "y", "z"][axis], components(axis)))
    }
}
