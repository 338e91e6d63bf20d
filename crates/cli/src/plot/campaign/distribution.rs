//! Figure `distribution`: a metric over the runs of a campaign, as histogram with a tick for each run, the median, the 95 %
//! quantile, the limit of a requirement, and the share of the runs that meet it.

use flexsc_core::formats::count::counted;
use flexsc_core::formats::reader_units::{grouped, percent};
use flexsc_core::statistics::{quantile, wilson};
use flexsc_figure::{
    Figure, FigureAxis, Layer, LayerShape, Note, NoteSide, Panel, Point, RGBColor, colour, round_to_nice,
};

use super::super::readable;
use super::metric_column::MetricColumn;
use super::table::CampaignRuns;
use crate::required_limit::RequiredLimit;

/// Least and largest number of bars of a histogram.
const BARS: [f64; 2] = [5.0, 60.0];
/// Least height of the axis of a histogram (runs).
const LOWEST: f64 = 5.0;
/// Height of the axis relative to that of the highest bar: with the names of the quantiles, and with that of a limit above them.
const HEADROOM: f64 = 1.25;
const LIMITED: f64 = 1.4;
/// Height of the ticks of the runs below the bars, relative to that of the highest bar.
const TICKS: f64 = 0.08;
/// Rounding of the end of a bar at the limit.
const ROUNDING: f64 = 1e-9;
const WHITE: RGBColor = RGBColor(255, 255, 255);

pub fn figure(runs: &CampaignRuns, metric: &MetricColumn) -> Figure {
    let sorted = metric.sorted();
    let (name, unit) = metric.label();
    let required = runs.required(metric);
    let limit = required.as_ref().map(|own| own.limit);
    let bars = bars(&sorted, limit);
    let ends = bars.iter().flat_map(|((from, to), _)| [*from, *to]);
    let x = RequiredLimit::shown(required.as_ref(), FigureAxis::around(&name, unit, ends.chain(limit)));
    let highest = bars.iter().map(|bar| bar.1).max().unwrap_or(0) as f64;
    let upper = if required.is_some() { LIMITED } else { HEADROOM };
    let label = format!("runs (of {})", grouped(&sorted.len().to_string()));
    let y = FigureAxis::exact(&label, "", -TICKS * highest..upper * highest.max(LOWEST));
    let side = |is_met: bool| {
        let own = bars.iter().filter(|((_, to), _)| {
            limit.is_some_and(|limit| *to <= limit + ROUNDING * limit.abs()) == is_met
        });
        let corners = own.flat_map(|((from, to), count)| {
            let height = *count as f64;
            [(*from, 0.0), (*from, height), (*to, height), (*to, 0.0), (f64::NAN, f64::NAN)]
        });
        corners.collect::<Vec<Point>>()
    };
    let beyond = if limit.is_some() { colour::RED } else { colour::BLUE };
    let mut layers = vec![
        Layer::new("", colour::GREEN, LayerShape::Area(0.7), side(true)),
        Layer::new("", beyond, LayerShape::Area(0.7), side(false)),
        Layer::new("", WHITE, LayerShape::Line(0.8), [side(true), side(false)].concat()),
        Layer::new("", colour::GREY, LayerShape::Line(0.8), vec![(x.range.start, 0.0), (x.range.end, 0.0)]),
    ];
    let ticks = sorted.iter().map(|value| (*value, -0.5 * TICKS * highest)).collect();
    layers.push(Layer::new("", colour::GREY, LayerShape::Stroke, ticks));
    let mut notes = Vec::new();
    let shown = x.reader_unit();
    if !sorted.is_empty() {
        for (part, word, side) in [(0.5, "median", NoteSide::Left), (0.95, "95 %", NoteSide::Right)] {
            let value = quantile(&sorted, part);
            let top = if part > 0.5 { 1.13 } else { 1.06 } * highest;
            layers.push(Layer::new("", colour::BLACK, LayerShape::Dashes, vec![(value, 0.0), (value, top)]));
            let text = format!("{word}: {}", shown.quantity(value));
            notes.push(Note::new(text, (value, top), colour::BLACK).on(side));
        }
    }
    if let Some(own @ RequiredLimit { limit, .. }) = &required {
        let line = vec![(*limit, 0.0), (*limit, y.range.end)];
        layers.push(Layer::new("", colour::RED, LayerShape::Line(1.6), line));
        let is_left = *limit > f64::midpoint(x.range.start, x.range.end);
        let side = if is_left { NoteSide::Left } else { NoteSide::Right };
        notes.push(Note::new(own.words(), (*limit, 1.3 * highest), colour::RED).on(side));
    }
    let head = head(&sorted, limit, runs.numbers.len() - sorted.len());
    let panel = Panel::new(x, y, layers).noted(notes).headed(head);
    Figure { title: format!("{}: {name}", readable(&runs.name)), panels: vec![panel], panel_height: 280 }
}

/// Returns the line above the panel: the share of the runs that meet the limit with its interval of 95 % confidence, and the number
/// of runs without a value.
fn head(sorted: &[f64], limit: Option<f64>, without: usize) -> String {
    let without = if without > 0 { format!(", {without} without a value") } else { String::new() };
    let runs = counted(sorted.len(), "run");
    let Some(limit) = limit else { return format!("{runs}{without}") };
    let successes = sorted.iter().filter(|value| **value <= limit).count();
    let (low, high) = wilson(successes as u64, sorted.len() as u64);
    let [low, high] = [low, high].map(|part| format!("{:.0}", 100.0 * part));
    let share = percent(successes as f64 / sorted.len().max(1) as f64);
    format!("{successes} of {runs} meet the limit: {share} ({low} to {high} %){without}")
}

/// Returns the bars of a histogram over sorted values: their ends, and the number of values in each. The width is
/// 2 IQR/n^(1/3) (Freedman and Diaconis), rounded to 1, 2 or 5 times a power of ten. An end of a bar is at the limit, if there is
/// one: a value at an end belongs to the bar below it.
fn bars(sorted: &[f64], limit: Option<f64>) -> Vec<((f64, f64), usize)> {
    let (Some(low), Some(high)) = (sorted.first(), sorted.last()) else { return Vec::new() };
    let (low, range) = (*low, high - low);
    if !(FigureAxis::LEAST..f64::INFINITY).contains(&range) {
        return vec![((low - 0.5, high + 0.5), sorted.len())];
    }
    let quartiles = quantile(sorted, 0.75) - quantile(sorted, 0.25);
    let wanted = 2.0 * quartiles / (sorted.len() as f64).cbrt();
    let [fewest, most] = BARS;
    let mut width = round_to_nice(wanted.clamp(range / most, range / fewest));
    // Bars over integers have integer widths.
    if sorted.iter().all(|value| value.fract() == 0.0) {
        width = width.max(1.0).round();
    }
    // A limit far away has no bars up to it.
    let near = limit.filter(|limit| (limit - low).abs().max((limit - high).abs()) < most * width);
    let start = near.unwrap_or(0.0);
    let place = |value: f64| match near {
        Some(_) => ((value - start) / width).ceil() - 1.0,
        None => (value / width).floor(),
    };
    let first = place(low);
    let count = (place(*high) - first) as usize + 1;
    let mut counts = vec![0; count];
    for value in sorted {
        counts[((place(*value) - first) as usize).min(count - 1)] += 1;
    }
    // A quantity without negative values has no bar below 0.
    let least = if low >= 0.0 { 0.0 } else { f64::NEG_INFINITY };
    let end = |index: usize| (start + (first + index as f64) * width).max(least);
    counts.into_iter().enumerate().map(|(index, count)| ((end(index), end(index + 1)), count)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_is_in_a_bar() {
        for values in [
            vec![3.0],
            vec![1.0, 1.0, 1.0],
            vec![0.1, 0.2, 0.3, 0.4, 9.0],
            vec![-1e-6, 0.0, 2e-6],
            vec![0.0, 5e-324, 1e-323],
            vec![0.0, 1e-290],
            vec![-1.5e308, 1.5e308],
        ] {
            let bars = bars(&values, None);
            assert_eq!(bars.iter().map(|bar| bar.1).sum::<usize>(), values.len(), "{values:?}");
            for value in &values {
                assert!(bars.iter().any(|((from, to), count)| *count > 0 && from <= value && value <= to));
            }
        }
        let even: Vec<f64> = (0..100).map(f64::from).collect();
        // IQR 49.5, 2 IQR/100^(1/3) = 21.3, at most a fifth of the range: 20.
        assert_eq!(bars(&even, None), [0.0, 20.0, 40.0, 60.0, 80.0].map(|from| ((from, from + 20.0), 20)));
        assert!(bars(&[], None).is_empty());
    }

    #[test]
    fn an_end_of_a_bar_is_at_the_limit() {
        let values: Vec<f64> = (0..100).map(|i| 0.37 * f64::from(i)).collect();
        for limit in [7.0, 7.03, 0.37 * 40.0, 30.0] {
            let bars = bars(&values, Some(limit));
            assert!(bars.iter().any(|((_, to), _)| (to - limit).abs() < 1e-9), "{limit}: {bars:?}");
            let below: usize =
                bars.iter().filter(|((_, to), _)| *to <= limit + 1e-9).map(|(_, count)| count).sum();
            assert_eq!(below, values.iter().filter(|value| **value <= limit).count(), "{limit}");
            assert_eq!(bars.iter().map(|(_, count)| count).sum::<usize>(), 100);
        }
    }
}
