//! Figure `region`: a metric of a sweep over two keys, as a map of levels at round numbers.

use flexsc_core::formats::count::counted;
use flexsc_core::formats::reader_units::{ReaderUnit, number};
use flexsc_figure::palette::between;
use flexsc_figure::{
    Bar, Figure, FigureAxis, Layer, LayerShape, Note, Panel, Point, RGBColor, ScalarField, colour,
    round_to_nice,
};

use super::super::readable;
use super::metric_column::MetricColumn;
use super::table::{CampaignKey, CampaignRuns};
use crate::required_limit::RequiredLimit;

/// Colours of the levels, the lowest first (after Brewer).
const COLOURS: [RGBColor; 7] = [
    RGBColor(247, 251, 255),
    RGBColor(222, 235, 247),
    RGBColor(198, 219, 239),
    RGBColor(158, 202, 225),
    RGBColor(107, 174, 214),
    RGBColor(33, 113, 181),
    RGBColor(8, 48, 107),
];
/// Number of equal levels.
const LEVELS: f64 = 8.0;
/// Ratio of positive values above which the levels are 1, 2 and 5 times powers of ten, and the number of such levels.
const FAR: f64 = 20.0;
const DECADES: f64 = 4.0;
/// Largest number of levels at powers of ten.
const MOST_DECADES: f64 = 12.0;
/// Range of values, relative to their size, that is a rounding error.
const NARROW: f64 = 1e-9;
/// Largest number of points of a grid that have dots, which hide the levels of a fine one.
const MOST_DOTS: usize = 400;
/// Values of the best region, relative to the least one.
const BEST: f64 = 1.1;

/// Returns the map; `None` if the values of the two keys do not form a grid.
pub fn figure(runs: &CampaignRuns, metric: &MetricColumn) -> Option<Figure> {
    let swept = runs.swept();
    let [first, second] = swept[..] else { return None };
    let (field, nothing) = field((first, second), metric)?;
    let (name, unit) = metric.label();
    let sorted = metric.sorted();
    let (least, largest) = (*sorted.first()?, *sorted.last()?);
    let required = runs.required(metric);
    let shown = RequiredLimit::shown(required.as_ref(), FigureAxis::exact(&name, unit, least..largest));
    let unit = shown.reader_unit();
    let levels = levels(unit.value(least), unit.value(largest));
    let edges: Vec<f64> = levels.iter().map(|level| level * unit.size()).collect();
    let colour = |class: usize| {
        let part = class as f64 / levels.len().max(1) as f64;
        between(&COLOURS, part * (COLOURS.len() - 1) as f64)
    };
    let fill =
        |(class, points): (usize, Vec<Point>)| Layer::new("", colour(class), LayerShape::Area(1.0), points);
    let mut layers: Vec<Layer> = field.areas(&edges).into_iter().map(fill).collect();
    if field.values.len() <= MOST_DOTS {
        let grid = field.x.iter().flat_map(|x| field.y.iter().map(move |y| (*x, *y))).collect();
        layers.push(Layer::new("", colour::GREY, LayerShape::Dot, grid));
    }
    layers.push(Layer::new("no value", colour::BLACK, LayerShape::Cross, nothing));
    if least > 0.0 && BEST * least < largest {
        let name = format!("within 10 % of the least, {}", quantity(&unit, least));
        layers.push(Layer::new(&name, colour::GREEN, LayerShape::Dashes, field.lines(BEST * least)));
    }
    let mut notes = Vec::new();
    if let Some(own @ RequiredLimit { limit, .. }) = &required {
        let line = field.lines(*limit);
        let points: Vec<&Point> = line.iter().filter(|point| point.0.is_finite()).collect();
        if let Some(middle) = points.get(points.len() / 2) {
            notes.push(Note::new(own.words(), **middle, colour::RED));
        }
        layers.push(Layer::new("", colour::RED, LayerShape::Line(2.0), line));
    }
    layers.push(Layer::new("as designed", colour::BLACK, LayerShape::Ring, runs.design_point(first, second)));
    let ends = |values: &[f64]| values[0]..values[values.len() - 1];
    let x = runs.key_axis(first).over(ends(&field.x));
    let y = runs.key_axis(second).over(ends(&field.y));
    let bar = Bar {
        name: shown.label(),
        colours: (0..=levels.len()).map(colour).collect(),
        edges: levels.iter().map(|level| number_without_zeros(*level)).collect(),
    };
    let remark = if runs.has_same_noise { "same noise at all points" } else { "" };
    let panel = Panel { bar: Some(bar), ..Panel::new(x, y, layers).noted(notes).plain().headed(remark) };
    let title = format!("{}: {name} ({})", readable(&runs.name), counted(runs.numbers.len(), "run"));
    Some(Figure { title, panels: vec![panel], panel_height: 420 })
}

/// Returns the values of a metric over the grid of two keys, and the points without a value; `None` if they do not form a grid.
fn field(
    (first, second): (&CampaignKey, &CampaignKey),
    metric: &MetricColumn,
) -> Option<(ScalarField, Vec<Point>)> {
    let (x, y) = (distinct(&first.values), distinct(&second.values));
    let mut values = vec![f64::NAN; x.len() * y.len()];
    for ((a, b), value) in first.values.iter().zip(&second.values).zip(&metric.values) {
        values[place(&x, *a)? * y.len() + place(&y, *b)?] = *value;
    }
    let points = x.iter().flat_map(|x| y.iter().map(move |y| (*x, *y)));
    let nothing = points.zip(&values).filter(|(_, value)| !value.is_finite()).map(|(point, _)| point);
    let nothing = nothing.collect();
    Some((ScalarField { x, y, values }, nothing))
}

/// Returns round numbers between two.
fn levels(low: f64, high: f64) -> Vec<f64> {
    let is_between = |level: &f64| *level > low && *level < high;
    if low > 0.0 && high / low > FAR {
        let decades = (high / low).log10();
        let parts: &[f64] = if decades < DECADES { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
        let every = (decades / MOST_DECADES).ceil() as usize;
        let all = (first..=last)
            .step_by(every.max(1))
            .flat_map(|power| parts.iter().map(move |part| part * 10_f64.powi(power)));
        return all.filter(is_between).collect();
    }
    // Values beside each other in double precision have no round numbers between them.
    if !(FigureAxis::LEAST.max(NARROW * low.abs().max(high.abs()))..f64::INFINITY).contains(&(high - low)) {
        return Vec::new();
    }
    let step = round_to_nice((high - low) / LEVELS);
    let (first, last) = ((low / step).floor() as i64, (high / step).ceil() as i64);
    (first..=last).map(|count| count as f64 * step).filter(is_between).collect()
}

/// Returns a round number without rounding errors in its last digits.
fn number_without_zeros(value: f64) -> String {
    let text = format!("{value:.9}");
    text.trim_end_matches('0').trim_end_matches('.').replace('-', "−")
}

fn quantity(unit: &ReaderUnit, value: f64) -> String {
    format!("{} {}", number(unit.value(value)), unit.name).trim_end().to_owned()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_round_numbers() {
        assert_eq!(levels(7.49, 62.0), [10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0]);
        assert_eq!(levels(0.9, 60.0), [1.0, 2.0, 5.0, 10.0, 20.0, 50.0]);
        assert_eq!(levels(-1.0, 1.0).len(), 9);
        for (low, high) in [(2.0, 2.0), (0.0, 5e-324), (-1.5e308, 1.5e308), (1.0, 1.0 + 1e-15)] {
            assert!(levels(low, high).is_empty(), "{low} {high}");
        }
        assert!(levels(5e-324, 1.5e308).len() < 20);
        assert_eq!(number_without_zeros(0.1 + 0.2), "0.3");
    }
}
