//! Figure `region`: a metric of a sweep over two keys, as a map.

use flexsc_core::formats::count::counted;
use flexsc_figure::palette::viridis;
use flexsc_figure::{Bar, Figure, FigureAxis, Layer, LayerShape, Panel, Point, RGBColor, colour};

use super::super::readable;
use super::metric_column::MetricColumn;
use super::table::CampaignRuns;

/// Number of shades.
const SHADES: usize = 48;
/// Colour of cells without a value.
const NONE: RGBColor = RGBColor(170, 170, 170);
/// Overlap of a cell with the next one, as a fraction of the cell.
const SEAM: f64 = 0.02;
/// Ratio of positive values above which the shades are logarithmic.
const FAR: f64 = 50.0;

/// Returns the map; `None` if the values of the two keys do not form a grid.
pub fn figure(runs: &CampaignRuns, metric: &MetricColumn) -> Option<Figure> {
    let swept = runs.swept();
    let [first, second] = swept[..] else { return None };
    let (columns, rows) = (distinct(&first.values), distinct(&second.values));
    let (name, unit) = metric.label();
    let sorted = metric.sorted();
    let classes = ColourClasses::from_values(&sorted, &name, unit);
    let mut cells = vec![None; columns.len() * rows.len()];
    for ((x, y), value) in first.values.iter().zip(&second.values).zip(&metric.values) {
        let (i, j) = (place(&columns, *x)?, place(&rows, *y)?);
        cells[i * rows.len() + j] = Some(*value);
    }
    let class = |value: f64| if value.is_finite() { classes.colour_index(value) } else { SHADES };
    let (across, up) = (borders(&columns), borders(&rows));
    let mut areas: Vec<Vec<Point>> = vec![Vec::new(); SHADES + 1];
    for (i, column) in cells.chunks(rows.len()).enumerate() {
        let mut from = 0;
        for alike in column.chunk_by(|a, b| a.map(class) == b.map(class)) {
            let to = from + alike.len();
            if let Some(value) = alike[0] {
                let (left_edge, low) = (across[i], up[from]);
                let (right_edge, high) = (beyond(&across, i + 1), beyond(&up, to));
                let corners = [
                    (left_edge, low),
                    (right_edge, low),
                    (right_edge, high),
                    (left_edge, high),
                    (f64::NAN, f64::NAN),
                ];
                areas[class(value)].extend(corners);
            }
            from = to;
        }
    }
    let none = areas.pop().unwrap_or_default();
    let shades = areas.into_iter().zip(viridis(SHADES));
    let mut layers: Vec<Layer> =
        shades.map(|(points, shade)| Layer::new("", shade, LayerShape::Area(1.0), points)).collect();
    layers.push(Layer::new("no value", NONE, LayerShape::Area(1.0), none));
    let least = sorted.first().and_then(|least| metric.values.iter().position(|value| value == least));
    let least = least.map(|run| (first.values[run], second.values[run]));
    layers.push(Layer::new("least", colour::VERMILLION, LayerShape::Diamond, least.into_iter().collect()));
    let ends = |borders: &[f64]| borders[0]..borders[borders.len() - 1];
    let (x, y) = (
        FigureAxis::exact(&runs.label_of(first), "", ends(&across)),
        FigureAxis::exact(&runs.label_of(second), "", ends(&up)),
    );
    let bar = Bar { name: classes.axis.label(), colours: viridis(SHADES), edges: classes.texts() };
    let panel = Panel { bar: Some(bar), ..Panel::new(x, y, layers) };
    let title = format!("{}: {name} ({})", readable(&runs.name), counted(runs.numbers.len(), "run"));
    Some(Figure { title, panels: vec![panel], panel_height: 420 })
}

/// Scale of the shades, and the axis with the unit of the values.
struct ColourClasses {
    axis: FigureAxis,
    /// Least and largest value, or their logarithms.
    ends: [f64; 2],
    by_ratio: bool,
}

impl ColourClasses {
    fn from_values(sorted: &[f64], name: &str, unit: &'static str) -> Self {
        let (low, high) = (sorted.first().copied().unwrap_or(0.0), sorted.last().copied().unwrap_or(0.0));
        let by_ratio = low > 0.0 && high / low > FAR;
        let ends = if by_ratio { [low.log10(), high.log10()] } else { [low, high] };
        Self { axis: FigureAxis::exact(name, unit, low..high), ends, by_ratio }
    }

    /// Returns the position of a value on the scale, from 0 to 1.
    fn place(&self, value: f64) -> f64 {
        let [low, high] = self.ends;
        let value = if self.by_ratio { value.log10() } else { value };
        if high > low { (value - low) / (high - low) } else { 0.5 }
    }

    fn colour_index(&self, value: f64) -> usize {
        ((self.place(value) * SHADES as f64) as usize).min(SHADES - 1)
    }

    /// Returns labels at round values, each at the nearest limit between two shades.
    fn texts(&self) -> Vec<String> {
        let nice: Vec<f64> = if self.by_ratio {
            (-20..20).flat_map(|power| [1.0, 2.0, 5.0].map(|nice| nice * 10_f64.powi(power))).collect()
        } else {
            self.axis.ticks(7).at
        };
        let mut texts = vec![String::new(); SHADES - 1];
        let scale = self.axis.factor();
        for value in nice {
            let limit = (self.place(value) * SHADES as f64).round();
            if (1.0..SHADES as f64).contains(&limit) {
                let shown = value / scale;
                // Removes rounding errors, so that round numbers have few digits.
                let few = (shown * 1e6).round() / 1e6;
                let text = if few == 0.0 && shown != 0.0 { format!("{shown:.0e}") } else { few.to_string() };
                texts[limit as usize - 1] = text.replace('-', "−");
            }
        }
        texts
    }
}

/// Returns a border moved slightly outwards: the next cell covers it, so that no seam remains between cells.
fn beyond(borders: &[f64], index: usize) -> f64 {
    borders[index] + SEAM * (borders[index] - borders[index - 1])
}

fn distinct(values: &[f64]) -> Vec<f64> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    sorted
}

fn place(sorted: &[f64], value: f64) -> Option<usize> {
    sorted.binary_search_by(|other| other.total_cmp(&value)).ok()
}

/// Returns the borders of the cells around values: halfway between values, and as far beyond the first and the last.
fn borders(values: &[f64]) -> Vec<f64> {
    let n = values.len();
    if n < 2 {
        return values.iter().flat_map(|value| [value - 0.5, value + 0.5]).collect();
    }
    let inner = values.windows(2).map(|pair| f64::midpoint(pair[0], pair[1]));
    let first = values[0] - (values[1] - values[0]) / 2.0;
    let last = values[n - 1] + (values[n - 1] - values[n - 2]) / 2.0;
    [first].into_iter().chain(inner).chain([last]).collect()
}
