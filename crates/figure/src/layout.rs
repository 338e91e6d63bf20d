//! Layout of a figure: places and sizes of its panels, and of the words above their axes.

use crate::text_width::{split, wide};
use crate::{Figure, Layer, LayerShape, Panel, bar, strip};

/// Width of a figure whose panels have their nominal height (px).
const WIDTH: u32 = 800;
/// Least margin left of a panel's plot, and margin right of it (px).
const LEFT: u32 = 70;
pub const RIGHT: u32 = 20;
/// Part of the left margin that the name of the upward axis takes (px).
const UNNAMED: u32 = 24;
/// Margins below the plot, for numbers and for the name of the axis (px).
pub const NUMBERS: u32 = 24;
pub const NAME: u32 = 18;
/// Margin above a plot without a legend, height of a legend, and of each further row of it (px).
const TOP: u32 = 10;
pub const LEGEND: u32 = 22;
pub const ROW: u32 = 16;
/// Width of a mark in the legend with the space after it, and space between entries (px).
pub const MARK: u32 = 23;
const BETWEEN: u32 = 16;
/// Size of a digit that is wider than a letter, and room for the name of an axis and the spaces around its numbers (px).
const NUMBER: f64 = 12.2;
const BEFORE_NUMBERS: u32 = 28;
/// Size of the letters of a legend (px).
pub const LETTERS: f64 = 11.0;

/// Layout of a figure, or of a panel in a row of panels side by side.
#[derive(Copy, Clone)]
pub struct Layout {
    /// Width (px).
    pub width: u32,
    /// Margin left of each plot (px).
    pub left: u32,
    /// Height of each plot (px).
    pub plot: u32,
}

/// Entry of a legend: a line of words, with the mark of a layer before the first.
pub struct LegendEntry<'a> {
    /// Layer whose mark is drawn.
    pub layer: Option<&'a Layer>,
    /// Words.
    pub words: String,
    /// Row, and left end (px).
    pub row: u32,
    pub column: u32,
}

impl Layout {
    /// Returns the layout of a figure of this width, each of whose plots is higher than usual (px).
    pub fn new(figure: &Figure, width: u32, higher: u32) -> Self {
        let part = f64::from(width.min(WIDTH)) / f64::from(WIDTH);
        // Narrow figures are also lower, but less than proportionally.
        let plot = f64::from(figure.panel_height) * part.powf(0.6);
        let plot = plot.round() as u32 + higher;
        let names = figure.panels.iter().map(|panel| strip::names_width(&panel.strips));
        let numbers = figure.upward().into_iter().map(|axis| {
            let ticks = axis.ticks(ticks_upward(plot));
            let longest = ticks.at.iter().map(|tick| wide(&ticks.text(*tick), NUMBER)).fold(0.0, f64::max);
            BEFORE_NUMBERS + longest.ceil() as u32
        });
        let left = names.chain(numbers).fold(LEFT, u32::max).min(width / 2);
        let plot = match &figure.panels[..] {
            [panel] if panel.is_equal => {
                let [x, y] = [&panel.x, &panel.y].map(|axis| axis.range.end - axis.range.start);
                (f64::from(width.saturating_sub(left + RIGHT)) * y / x).round() as u32 + higher
            }
            _ => plot,
        };
        Self { width, left, plot }
    }

    /// Returns the height (px) of all panels of a figure.
    pub fn height(self, figure: &Figure) -> u32 {
        rows(figure).map(|row| self.row_height(row)).sum()
    }

    /// Returns the layouts of the panels of a row, whose plots have one width: a panel without a name at its upward axis has a
    /// narrower margin.
    pub fn row(self, panels: &[Panel]) -> Vec<Self> {
        let left = |panel: &Panel| {
            if panel.is_beside && panel.y.name.is_empty() { self.left - UNNAMED } else { self.left }
        };
        let margins: u32 = panels.iter().map(|panel| left(panel) + RIGHT).sum();
        let plot = self.width.saturating_sub(margins) / panels.len().max(1) as u32;
        let own = |panel: &Panel| Self { width: left(panel) + plot + RIGHT, left: left(panel), ..self };
        panels.iter().map(own).collect()
    }

    /// Returns the height of a row of panels (px), with a colour bar over its width.
    pub fn row_height(self, panels: &[Panel]) -> u32 {
        let name = if panels.iter().all(|panel| panel.x.name.is_empty()) { 0 } else { NAME };
        bar_height(panels) + self.row_top(panels) + self.plot + NUMBERS + name
    }

    /// Returns the distance from the top of a row, below its colour bar, to its plots (px).
    pub fn row_top(self, panels: &[Panel]) -> u32 {
        self.row(panels).into_iter().zip(panels).map(|(layout, panel)| layout.top(panel)).max().unwrap_or(0)
    }

    /// Returns the width of a plot (px).
    pub fn across(self) -> u32 {
        self.width - self.left - RIGHT
    }

    /// Returns the distance from the top of a panel, below its colour bar, to its plot (px).
    pub fn top(self, panel: &Panel) -> u32 {
        self.strips(panel) + self.legend(panel)
    }

    /// Returns the height of a panel's strips (px).
    pub fn strips(self, panel: &Panel) -> u32 {
        strip::height((self.left, self.across()), panel)
    }

    /// Returns the height of a panel's legend (px).
    fn legend(self, panel: &Panel) -> u32 {
        self.entries(panel).last().map_or(TOP, |entry| LEGEND + ROW * entry.row)
    }

    /// Returns the words above a panel: the names of its layers, and its remark. None goes beyond the plot.
    pub fn entries(self, panel: &Panel) -> Vec<LegendEntry<'_>> {
        let named = panel.layers.iter().filter(|layer| !layer.name.is_empty() && is_shown(layer, panel));
        let all = named.map(|layer| (Some(layer), layer.name.as_str()));
        let remark = Some((None, panel.remark.as_str())).filter(|(_, text)| !text.is_empty());
        let end = self.width - RIGHT;
        let (mut row, mut column) = (0, self.left);
        let mut entries: Vec<LegendEntry<'_>> = Vec::new();
        for (layer, text) in all.chain(remark) {
            let mark = if layer.is_some() { MARK } else { 0 };
            if column > self.left && column + mark + letters(text) > end {
                (row, column) = (row + 1, self.left);
            }
            // A text that is wider than the plot has several rows.
            for (index, words) in wrapped(text, end - self.left - mark).into_iter().enumerate() {
                if index > 0 {
                    (row, column) = (row + 1, self.left);
                }
                let wide = mark + letters(&words);
                let (layer, at) = (layer.filter(|_| index == 0), column + if index > 0 { mark } else { 0 });
                entries.push(LegendEntry { layer, words, row, column: at });
                column += wide + BETWEEN;
            }
        }
        entries
    }
}

/// Returns the largest number of ticks of a vertical axis of a height (px).
pub fn ticks_upward(height: u32) -> u32 {
    if height < 120 { height / 20 } else { height / 28 }
}

/// Returns the panels of each row: those side by side.
pub fn rows(figure: &Figure) -> impl Iterator<Item = &[Panel]> {
    figure.panels.chunk_by(|_, next| next.is_beside)
}

/// Returns the height of the colour bar of panels side by side (px).
pub fn bar_height(panels: &[Panel]) -> u32 {
    if panels.iter().any(|panel| panel.bar.is_some()) { bar::HEIGHT } else { 0 }
}

/// Estimates the width of a legend text (px): the backend has no font metrics; a letter is about 0.6 of the font's
/// size wide.
fn letters(text: &str) -> u32 {
    wide(text, LETTERS).round() as u32
}

/// Splits a text between words into lines of legend letters within `room` (px).
fn wrapped(text: &str, room: u32) -> Vec<String> {
    split(text, |line| letters(line) <= room)
}

/// Whether a panel shows any of a layer.
fn is_shown(layer: &Layer, panel: &Panel) -> bool {
    let is_mark = !matches!(layer.shape, LayerShape::Line(_) | LayerShape::Dashes | LayerShape::Area(_));
    let window = crate::Window { x: panel.x.extent(), y: panel.y.extent() };
    let inside = |(x, y): &crate::Point| window.contains((panel.x.place(*x), panel.y.place(*y)));
    if is_mark { layer.points.iter().any(inside) } else { !layer.points.is_empty() }
}
