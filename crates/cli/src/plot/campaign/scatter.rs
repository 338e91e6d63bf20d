//! Figure `scatter`: a metric against each swept key, or else against each drawn key, the most strongly correlated
//! first.

use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::super::readable;
use super::metric_column::MetricColumn;
use super::table::{CampaignKey, CampaignRuns};
use crate::required_limit::RequiredLimit;

/// Largest number of keys with a panel each.
const PANELS: usize = 4;

pub fn figure(runs: &CampaignRuns, metric: &MetricColumn) -> Figure {
    let (name, unit) = metric.label();
    let required = runs.required(metric);
    let mut keys: Vec<(f64, &CampaignKey)> =
        keys(runs).into_iter().map(|key| (correlation(&key.values, &metric.values), key)).collect();
    let strength = |r: f64| if r.is_nan() { 0.0 } else { r.abs() };
    keys.sort_by(|a, b| strength(b.0).total_cmp(&strength(a.0)));
    let more = keys.len().saturating_sub(PANELS);
    let panel = |(r, key): (f64, &CampaignKey)| {
        let points: Vec<Point> = key.values.iter().copied().zip(metric.values.iter().copied()).collect();
        let x = runs.key_axis(key);
        let limit = required.as_ref().map(|own| own.limit);
        let y = FigureAxis::around(&name, unit, metric.values.iter().copied().chain(limit));
        let y = RequiredLimit::shown(required.as_ref(), y);
        let reported =
            if r.is_nan() { String::new() } else { format!("rank correlation {r:+.2}").replace('-', "−") };
        let mut layers = vec![Layer::new(&reported, colour::BLUE, LayerShape::Dot, points)];
        layers.extend(required.as_ref().map(|own| own.across(&x)));
        Panel::new(x, y, layers)
    };
    let panels = keys.into_iter().take(PANELS).map(panel).collect();
    let omitted = if more > 0 { format!(", keys left out: {more}") } else { String::new() };
    let title = format!("{}: {name} against the keys that vary{omitted}", readable(&runs.name));
    Figure { title, panels, panel_height: 180 }
}

/// Returns the keys of the figure: the swept ones, else the drawn ones.
pub fn keys(runs: &CampaignRuns) -> Vec<&CampaignKey> {
    let swept = runs.swept();
    if swept.is_empty() { runs.drawn() } else { swept }
}

/// Returns Spearman's rank correlation over the pairs of numbers; NaN if either does not vary.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let pairs: Vec<(f64, f64)> =
        a.iter().copied().zip(b.iter().copied()).filter(|(a, b)| a.is_finite() && b.is_finite()).collect();
    let [a, b] =
        [0, 1].map(|side| ranks(&pairs.iter().map(|pair| [pair.0, pair.1][side]).collect::<Vec<_>>()));
    let middle = f64::midpoint(1.0, pairs.len() as f64);
    let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - middle) * (b - middle)).sum::<f64>();
    sum(&a, &b) / (sum(&a, &a) * sum(&b, &b)).sqrt()
}

/// Returns the rank of each value, from 1; equal values share their mean rank.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    let mut before = 0;
    for equal in order.chunk_by(|a, b| values[*a] == values[*b]) {
        for index in equal {
            ranks[*index] = before as f64 + f64::midpoint(1.0, equal.len() as f64);
        }
        before += equal.len();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn correlations_are_those_of_spearman() {
        // scipy.stats.spearmanr
        let a = [1.0, 2.0, 2.0, 5.0, 9.0, f64::NAN];
        let b = [3.0, 1.0, 4.0, 4.0, 8.0, 7.0];
        assert!((correlation(&a, &b) - 0.763_157_894_736_842).abs() < 1e-12, "{}", correlation(&a, &b));
        assert!(correlation(&[1.0, 1.0], &[2.0, 3.0]).is_nan());
    }
}
