//! Figure `curve`: metrics of a sweep over its key.

use flexsc_core::formats::count::counted;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::super::readable;
use super::metric_column::MetricColumn;
use super::table::{CampaignKey, CampaignRuns};
use crate::required_limit::RequiredLimit;

/// Largest number of values that have a marker each.
const MARKS: usize = 100;

pub fn figure(runs: &CampaignRuns, metrics: &[&MetricColumn], key: &CampaignKey) -> Figure {
    let mut order: Vec<usize> = (0..key.values.len()).collect();
    order.sort_by(|a, b| key.values[*a].total_cmp(&key.values[*b]));
    let panel = |(index, metric): (usize, &&MetricColumn)| {
        let (name, unit) = metric.label();
        let line: Vec<Point> = order.iter().map(|run| (key.values[*run], metric.values[*run])).collect();
        let ends = order.first().map_or(0.0, |run| key.values[*run])
            ..order.last().map_or(1.0, |run| key.values[*run]);
        let x = runs.key_axis(key).over(ends);
        let required = runs.required(metric);
        let limit = required.as_ref().map(|own| own.limit);
        let mut layers = vec![Layer::new("", colour::BLUE, LayerShape::Line(1.2), line.clone())];
        if line.len() <= MARKS {
            layers.push(Layer::new("", colour::BLUE, LayerShape::Dot, line));
        }
        layers.extend(required.as_ref().map(|own| own.across(&x)));
        let x = if index + 1 == metrics.len() { x } else { x.unnamed() };
        let y = FigureAxis::around(&name, unit, metric.values.iter().copied().chain(limit));
        Panel::new(x, RequiredLimit::shown(required.as_ref(), y), layers)
    };
    let panels = metrics.iter().enumerate().map(panel).collect();
    let title = format!(
        "{}: metrics over {} ({})",
        readable(&runs.name),
        key.name,
        counted(runs.numbers.len(), "run")
    );
    Figure { title, panels, panel_height: 180 }
}
