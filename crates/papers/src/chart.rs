//! Charts drawn from a page's own numbers, and functions that evaluate curves.

#![expect(clippy::needless_pass_by_value, reason = "templates hand their values over")]

use minijinja::Environment;
use minijinja::value::{Serde, Value};
use serde::Deserialize;

use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, band, colour, name_and_unit};

/// A chart as a template gives it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Chart {
    title: String,
    /// Names of the axes.
    x: String,
    y: String,
    /// Unit of the ordinates: `rad`, or another to be shown in the name of the axis.
    #[serde(default)]
    unit: String,
    lines: Vec<Line>,
}

/// A line of a chart.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    name: String,
    x: Vec<f64>,
    y: Vec<Option<f64>>,
    /// With it, the area from here to `y`.
    #[serde(default)]
    lower: Option<Vec<Option<f64>>>,
    /// Points instead of a line.
    #[serde(default)]
    marks: bool,
}

impl Chart {
    /// Returns the figure of the chart.
    pub fn figure(&self) -> Figure {
        let colours =
            [colour::BLUE, colour::VERMILLION, colour::GREEN, colour::ORANGE, colour::SKY, colour::BLACK];
        let points = |x: &[f64], y: &[Option<f64>]| -> Vec<Point> {
            x.iter().copied().zip(y.iter().map(|y| y.unwrap_or(f64::NAN))).collect()
        };
        let layer = |(index, line): (usize, &Line)| {
            let (colour, upper) = (colours[index % colours.len()], points(&line.x, &line.y));
            let (shape, points) = match &line.lower {
                Some(lower) => (LayerShape::Area(0.35), band(&points(&line.x, lower), &upper)),
                None if line.marks => (LayerShape::Disc, upper),
                None => (LayerShape::Line(1.2), upper),
            };
            Layer::new(&line.name, colour, shape, points)
        };
        let layers: Vec<Layer> = self.lines.iter().enumerate().map(layer).collect();
        let all = || layers.iter().flat_map(|layer| &layer.points);
        let ends = |(low, high): (f64, f64), x: f64| (low.min(x), high.max(x));
        let (low, high) = all()
            .map(|point| point.0)
            .filter(|x| x.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), ends);
        let (name, unit) =
            if self.unit.is_empty() { (self.y.clone(), "") } else { name_and_unit(&self.y, &self.unit) };
        let y = FigureAxis::around(&name, unit, all().map(|point| point.1));
        let x = FigureAxis::exact(&self.x, "", low..high);
        Figure { title: self.title.clone(), panels: vec![Panel::new(x, y, layers)], panel_height: 340 }
    }
}

/// Registers the functions that evaluate curves in a template environment.
pub fn register(environment: &mut Environment) {
    environment.add_function("minima", minima);
    environment.add_function("stretches", stretches);
    environment.add_function("bands", bands);
}

/// Returns the keys at which a curve has a local minimum.
fn minima(keys: Vec<f64>, values: Vec<f64>) -> Vec<f64> {
    let lower = |i: &usize| values[i - 1] > values[*i] && values[*i] < values[i + 1];
    (1..values.len().saturating_sub(1)).filter(lower).filter_map(|i| keys.get(i).copied()).collect()
}

/// Returns the ranges of keys, first and last, over which at least `least` consecutive values are present.
fn stretches(keys: Vec<f64>, values: Vec<Value>, least: usize) -> Vec<Vec<f64>> {
    let all: Vec<(f64, bool)> = keys.into_iter().zip(values.iter().map(|value| !value.is_none())).collect();
    let runs = all.chunk_by(|a, b| a.1 == b.1).filter(|run| run[0].1 && run.len() >= least);
    runs.map(|run| vec![run[0].0, run[run.len() - 1].0]).collect()
}

/// Returns the number of periods in a map at which an unstable frequency lies below a stable one.
fn bands(rows: Serde<Vec<Cell>>) -> usize {
    let mut rows = rows.0;
    rows.sort_by(|a, b| {
        a.period_s.total_cmp(&b.period_s).then(a.frequency_rad_s.total_cmp(&b.frequency_rad_s))
    });
    let columns = rows.chunk_by(|a, b| a.period_s == b.period_s);
    let ends = |cells: &&[Cell]| {
        cells.windows(2).any(|pair| pair[0].spectral_radius >= 1.0 && pair[1].spectral_radius < 1.0)
    };
    columns.filter(ends).count()
}

/// A cell of a map.
#[derive(Deserialize)]
struct Cell {
    frequency_rad_s: f64,
    period_s: f64,
    spectral_radius: f64,
}
