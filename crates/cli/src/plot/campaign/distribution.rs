//! Figure `distribution`: a metric over the runs of a campaign, as histogram and as empirical distribution, with the
//! median and the 5 % and 95 % quantiles.

use flexsc_core::formats::count::counted;
use flexsc_core::statistics::quantile;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour, round_to_nice};

use super::super::readable;
use super::metric_column::MetricColumn;
use super::table::CampaignRuns;

/// Least and largest number of bars of a histogram.
const BARS: [f64; 2] = [5.0, 60.0];
/// Least height of the axis of a histogram (runs).
const LOWEST: usize = 5;

pub fn figure(runs: &CampaignRuns, metric: &MetricColumn) -> Figure {
    let sorted = metric.sorted();
    let (name, unit) = metric.label();
    let bars = bars(&sorted);
    let required = runs.required(metric);
    let ends = bars.iter().flat_map(|((from, to), _)| [*from, *to]);
    let x = FigureAxis::around(&name, unit, ends.chain(required.iter().map(|(most, _)| *most)));
    // The axis of run numbers has integer labels.
    let highest = bars.iter().map(|bar| bar.1).max().unwrap_or(0).max(LOWEST);
    let counts = FigureAxis::from_zero("runs", "", [highest as f64]);
    let parts = FigureAxis::exact("fraction of runs", "", 0.0..1.0);
    let outline = bars.iter().flat_map(|((from, to), count)| {
        let height = *count as f64;
        let corners = [(*from, 0.0), (*from, height), (*to, height), (*to, 0.0)];
        corners.into_iter().chain([(f64::NAN, f64::NAN)])
    });
    let outline: Vec<Point> = outline.collect();
    let n = sorted.len() as f64;
    let mut steps = vec![(x.range.start, 0.0)];
    for (index, value) in sorted.iter().enumerate() {
        steps.extend([(*value, index as f64 / n), (*value, (index + 1) as f64 / n)]);
    }
    steps.push((x.range.end, 1.0));
    let marks = |y: &FigureAxis, named: bool| {
        let line = |q: f64| vec![(quantile(&sorted, q), y.range.start), (quantile(&sorted, q), y.range.end)];
        let name = |name: &str| if named { name.to_owned() } else { String::new() };
        let mut marks = vec![
            Layer::new(&name("median"), colour::VERMILLION, LayerShape::Line(1.6), line(0.5)),
            Layer::new(&name("5 and 95 %"), colour::VERMILLION, LayerShape::Dashes, line(0.05)),
            Layer::new("", colour::VERMILLION, LayerShape::Dashes, line(0.95)),
        ];
        marks.extend(required.as_ref().map(|(most, requirement)| {
            let line = vec![(*most, y.range.start), (*most, y.range.end)];
            Layer::new(&name(requirement), colour::BLACK, LayerShape::Line(1.6), line)
        }));
        marks
    };
    let histogram = [
        Layer::new("", colour::SKY, LayerShape::Area(0.6), outline.clone()),
        Layer::new("", colour::BLUE, LayerShape::Line(0.8), outline),
    ];
    let above: Vec<Layer> = histogram.into_iter().chain(marks(&counts, true)).collect();
    let curve = Layer::new("", colour::BLUE, LayerShape::Line(1.4), steps);
    let below: Vec<Layer> = [curve].into_iter().chain(marks(&parts, false)).collect();
    let panels = vec![Panel::new(x.unnamed(), counts, above), Panel::new(x, parts, below)];
    Figure { title: title(runs, &name, sorted.len()), panels, panel_height: 200 }
}

/// Returns the title: the metric, and the number of runs.
fn title(runs: &CampaignRuns, name: &str, count: usize) -> String {
    let without = runs.numbers.len() - count;
    let without = if without > 0 { format!(", {without} without") } else { String::new() };
    format!("{}: {name} ({}{without})", readable(&runs.name), counted(count, "run"))
}

/// Returns the bars of a histogram over sorted values: their ends, and the number of values in each. The width is
/// 2 IQR/n^(1/3) (Freedman and Diaconis), rounded to 1, 2 or 5 times a power of ten.
fn bars(sorted: &[f64]) -> Vec<((f64, f64), usize)> {
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
    let first = (low / width).floor();
    let count = ((high / width).floor() - first) as usize + 1;
    let mut counts = vec![0; count];
    for value in sorted {
        counts[(((value / width).floor() - first) as usize).min(count - 1)] += 1;
    }
    let end = |index: usize| (first + index as f64) * width;
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
            let bars = bars(&values);
            assert_eq!(bars.iter().map(|bar| bar.1).sum::<usize>(), values.len(), "{values:?}");
            for value in &values {
                assert!(bars.iter().any(|((from, to), count)| *count > 0 && from <= value && value <= to));
            }
        }
        let even: Vec<f64> = (0..100).map(f64::from).collect();
        // IQR 49.5, 2 IQR/100^(1/3) = 21.3, at most a fifth of the range: 20.
        assert_eq!(bars(&even), [0.0, 20.0, 40.0, 60.0, 80.0].map(|from| ((from, from + 20.0), 20)));
        assert!(bars(&[]).is_empty());
    }
}
