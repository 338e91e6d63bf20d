//! Figure `region`: a metric of a sweep over two keys, as a map.

use flexsc_figure::{Axis, Bar, Figure, Layer, Panel, Point, RGBColor, Shape, colour};

use super::table::{Metric, Runs};

/// The colours of the classes, darker for larger values also in print without colours (after Brewer).
const COLOURS: [RGBColor; 8] = [
    RGBColor(247, 251, 255),
    RGBColor(222, 235, 247),
    RGBColor(198, 219, 239),
    RGBColor(158, 202, 225),
    RGBColor(107, 174, 214),
    RGBColor(66, 146, 198),
    RGBColor(33, 113, 181),
    RGBColor(8, 69, 148),
];
/// Where there is no value.
const NONE: RGBColor = RGBColor(170, 170, 170);
/// Part of a cell by which it reaches into the next.
const SEAM: f64 = 0.02;
/// Positive values that lie further apart have classes of equal ratios.
const FAR: f64 = 50.0;

/// None if the values of two keys do not make up a grid.
pub fn figure(runs: &Runs, metric: &Metric) -> Option<Figure> {
    let swept = runs.swept();
    let [first, second] = swept[..] else { return None };
    let (columns, rows) = (distinct(&first.values), distinct(&second.values));
    let (name, unit) = metric.label();
    let sorted = metric.sorted();
    let classes = Classes::of(&sorted, &name, unit);
    let mut cells = vec![None; columns.len() * rows.len()];
    for ((x, y), value) in first.values.iter().zip(&second.values).zip(&metric.values) {
        let (i, j) = (place(&columns, *x)?, place(&rows, *y)?);
        cells[i * rows.len() + j] = Some(*value);
    }
    let class = |value: f64| if value.is_finite() { classes.of_value(value) } else { COLOURS.len() };
    let (across, up) = (borders(&columns), borders(&rows));
    let mut areas: Vec<Vec<Point>> = vec![Vec::new(); COLOURS.len() + 1];
    for (i, column) in cells.chunks(rows.len()).enumerate() {
        let mut from = 0;
        for alike in column.chunk_by(|a, b| a.map(class) == b.map(class)) {
            let to = from + alike.len();
            if let Some(value) = alike[0] {
                let (left, low) = (across[i], up[from]);
                let (right, high) = (beyond(&across, i + 1), beyond(&up, to));
                let corners = [(left, low), (right, low), (right, high), (left, high), (f64::NAN, f64::NAN)];
                areas[class(value)].extend(corners);
            }
            from = to;
        }
    }
    let none = areas.pop().unwrap_or_default();
    let used = classes.edges.len() + 1;
    let shades = areas.into_iter().zip(spread(used));
    let mut layers: Vec<Layer> =
        shades.map(|(points, shade)| Layer::new("", shade, Shape::Area(1.0), points)).collect();
    layers.push(Layer::new("no value", NONE, Shape::Area(1.0), none));
    let least = sorted.first().and_then(|least| metric.values.iter().position(|value| value == least));
    let least = least.map(|run| (first.values[run], second.values[run]));
    layers.push(Layer::new("least", colour::VERMILLION, Shape::Diamond, least.into_iter().collect()));
    let ends = |borders: &[f64]| borders[0]..borders[borders.len() - 1];
    let (x, y) = (Axis::exact(&first.name, "", ends(&across)), Axis::exact(&second.name, "", ends(&up)));
    let bar = Bar { name: classes.axis.label(), colours: spread(used), edges: classes.texts() };
    let panel = Panel { bar: Some(bar), ..Panel::new(x, y, layers) };
    let title = format!("{}: {name} ({} runs)", runs.name, runs.numbers.len());
    Some(Figure { title, panels: vec![panel], panel_height: 420 })
}

/// The colours of so many classes, from the lightest to the darkest.
fn spread(classes: usize) -> Vec<RGBColor> {
    let last = COLOURS.len() - 1;
    (0..classes).map(|class| COLOURS[(class * last).checked_div(classes - 1).unwrap_or(last / 2)]).collect()
}

/// Classes of values, and the axis with their unit.
struct Classes {
    axis: Axis,
    edges: Vec<f64>,
}

impl Classes {
    fn of(sorted: &[f64], name: &str, unit: &'static str) -> Self {
        let (low, high) = (sorted.first().copied().unwrap_or(0.0), sorted.last().copied().unwrap_or(0.0));
        let most = COLOURS.len() - 1;
        let axis = Axis::exact(name, unit, low..high);
        let inside = |edge: &f64| *edge > low && *edge < high;
        let edges: Vec<f64> = if low > 0.0 && high / low > FAR {
            let all = (-20..20).flat_map(|power| [1.0, 2.0, 5.0].map(|nice| nice * 10_f64.powi(power)));
            let nice: Vec<f64> = all.filter(inside).collect();
            let step = nice.len().div_ceil(most).max(1);
            nice.into_iter().step_by(step).collect()
        } else {
            let ticks = (3..=most as u32).rev().map(|most| axis.ticks(most).at.into_iter().filter(inside));
            ticks.map(Iterator::collect::<Vec<f64>>).find(|edges| edges.len() <= most).unwrap_or_default()
        };
        Self { axis, edges }
    }

    fn of_value(&self, value: f64) -> usize {
        self.edges.iter().filter(|edge| value >= **edge).count()
    }

    /// The edges in the unit of the axis.
    fn texts(&self) -> Vec<String> {
        let scale = self.axis.factor();
        let text = |edge: &f64| {
            let value = edge / scale;
            // Nice numbers have few digits, but for rounding.
            format!("{}", (value * 1e6).round() / 1e6).replace('-', "−")
        };
        self.edges.iter().map(text).collect()
    }
}

/// A border, a little further than it is: what is drawn later covers it, and no seam is left between cells.
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

/// The borders of the cells around values: halfway between them, and as far beyond the ends.
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
