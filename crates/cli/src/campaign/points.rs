//! Table of a sweep on the terminal: the metrics that vary, point by point.

use std::fmt::Write;
use std::ops::Range;

use flexsc_core::campaign::{Campaign, ColumnCells, MAIN_METRICS};
use flexsc_core::metrics::{Selection, goal};
use flexsc_core::statistics::Statistics;

use super::verdict;
use crate::number::short;

/// Number of points that are printed at each end of a long sweep.
const ENDS: u64 = 8;
/// Largest number of points of a sweep that is printed completely.
const ALL: u64 = 24;
/// Largest number of runs of a sweep whose points are printed.
const MOST_RUNS: u64 = 20_000;
/// Largest width of the table (characters), unless a single metric needs more.
const WIDTH: usize = 110;

/// Printed points of a sweep.
pub struct Points {
    /// Total number of points.
    all: u64,
    replicas: u64,
    /// Names of keys and metrics, with a cell for each run that is printed.
    keys: Vec<(String, ColumnCells)>,
    metrics: Vec<(String, ColumnCells)>,
    /// Number of varying metrics that the table has no room for.
    more: usize,
}

/// Returns the runs whose points are printed; empty for a campaign that is not a sweep.
pub fn runs(campaign: &Campaign, range: &Range<u64>) -> Vec<Range<u64>> {
    let replicas = campaign.design().replicas;
    let points = campaign.design().point(range.start)..campaign.design().point(range.end - 1) + 1;
    let count = points.end - points.start;
    let shown = if count <= ALL {
        vec![points]
    } else {
        vec![points.start..points.start + ENDS, points.end - ENDS..points.end]
    };
    let most = count.min(ALL).saturating_mul(replicas);
    if campaign.design().keys().is_empty() || most > MOST_RUNS {
        return Vec::new();
    }
    let runs_of = |points: Range<u64>| {
        (points.start * replicas).max(range.start)..(points.end * replicas).min(range.end)
    };
    shown.into_iter().map(runs_of).collect()
}

impl Points {
    /// Returns the points of the runs in a range; `column` returns the cells of the printed runs for a column name,
    /// `None` for an unknown one.
    pub fn new<E>(
        (campaign, range): (&Campaign, &Range<u64>),
        (statistics, selection): (&[Statistics], &Selection),
        column: impl Fn(&str) -> Result<Option<ColumnCells>, E>,
    ) -> Result<Option<Self>, E> {
        let design = campaign.design();
        if runs(campaign, range).is_empty() {
            return Ok(None);
        }
        let mut keys = Vec::new();
        for name in design.keys() {
            keys.extend(column(name)?.map(|cells| (name.to_owned(), cells)));
        }
        let mut width: usize = keys.iter().map(|(name, _)| cell_width(name)).sum();
        let (mut metrics, mut more) = (Vec::new(), 0);
        for name in chosen(statistics, selection) {
            if width + cell_width(name) > WIDTH && !metrics.is_empty() {
                more += 1;
                continue;
            }
            // A metric that only repeats a key is redundant.
            let repeats = |cells: &ColumnCells| keys.iter().any(|(_, key)| key.numbers() == cells.numbers());
            let Some(cells) = column(name)?.filter(|cells| !repeats(cells)) else { continue };
            width += cell_width(name);
            metrics.push((name.to_owned(), cells));
        }
        let all = design.point(range.end - 1) + 1 - design.point(range.start);
        Ok(Some(Self { all, replicas: design.replicas, keys, metrics, more }))
    }

    /// Returns the table as text.
    pub fn text(&self) -> String {
        let mut text = String::from("\n ");
        for (name, _) in self.keys.iter().chain(&self.metrics) {
            let _ = write!(text, " {name:>width$}", width = cell_width(name) - 1);
        }
        text.push('\n');
        let cells = self.keys.first().map_or(0, |(_, cells)| cells.len());
        let shown = cells.div_ceil(self.replicas as usize);
        for point in 0..shown {
            if shown as u64 == 2 * ENDS && self.all > ALL && point as u64 == ENDS {
                let _ = writeln!(text, "  ... {} more points", self.all - 2 * ENDS);
            }
            let first = point * self.replicas as usize;
            let cells_of_point = first..(first + self.replicas as usize).min(cells);
            text.push(' ');
            for (name, cells) in &self.keys {
                let _ = write!(text, " {:>width$}", value(cells, first), width = cell_width(name) - 1);
            }
            for (name, cells) in &self.metrics {
                let _ = write!(
                    text,
                    " {:>width$}",
                    metric(name, cells, cells_of_point.clone()),
                    width = cell_width(name) - 1
                );
            }
            text.push('\n');
        }
        if self.replicas > 1 {
            let _ = writeln!(text, "  each a mean of {} runs", self.replicas);
        }
        if self.more > 0 {
            let _ = writeln!(text, "  {} more metrics vary", self.more);
        }
        text
    }
}

fn cell_width(name: &str) -> usize {
    name.chars().count().max(10) + 2
}

/// Returns the metrics to print: the selected ones, else the main ones that vary, else any that vary.
fn chosen<'a>(statistics: &'a [Statistics], selection: &'a Selection) -> Vec<&'a str> {
    let has_runs = |name: &str| statistics.iter().find(|s| s.name == name && s.runs + s.infinite > 0);
    if let Some(names) = selection.names() {
        return names.iter().copied().filter(|name| has_runs(name).is_some()).collect();
    }
    let varies = |s: &&Statistics| s.sd > 0.0 || s.infinite > 0;
    let all: Vec<&str> = statistics.iter().filter(varies).map(|s| s.name.as_str()).collect();
    let (main, rest): (Vec<&str>, Vec<&str>) = all.iter().partition(|name| MAIN_METRICS.contains(name));
    let mut names: Vec<&str> = MAIN_METRICS.into_iter().filter(|name| main.contains(name)).collect();
    names.extend(rest);
    names
}

/// Returns the value of a key as text.
fn value(cells: &ColumnCells, index: usize) -> String {
    if let ColumnCells::Text(words) = cells {
        return words.get(index).cloned().flatten().unwrap_or_default();
    }
    let number = cells.numbers().get(index).copied().unwrap_or(f64::NAN);
    let text = format!("{number}");
    if text.len() <= 10 { text } else { short(number) }
}

/// Returns the value of a metric at a point as text: the mean over the point's runs.
fn metric(name: &str, cells: &ColumnCells, runs: Range<usize>) -> String {
    let values: Vec<f64> = cells.numbers()[runs].iter().copied().filter(|value| !value.is_nan()).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    match (goal::NAMES.contains(&name), &values[..]) {
        (_, []) => "-".to_owned(),
        (true, [value]) => verdict(*value > 0.0).to_owned(),
        (true, _) => format!("{:.0} of {}", mean * values.len() as f64, values.len()),
        _ if matches!(cells, ColumnCells::Integers(_)) && mean == mean.trunc() => format!("{mean}"),
        _ => short(mean),
    }
}
