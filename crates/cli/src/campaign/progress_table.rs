//! Progress of a running campaign on the terminal: completed runs, speed, and statistics of a few metrics.

use std::fmt::Write;
use std::time::{Duration, Instant};

use flexsc_core::campaign::{MAIN_METRICS, RunOutcome};
use flexsc_core::metrics::{MetricValue, Metrics, goal};
use indicatif::ProgressBar;
use serde_json::{Value as Json, json};

use crate::number::short;
use crate::progress::{self, Lines};
use crate::success_rate::success_rate;

/// Largest number of metrics in the table.
const SHOWN: usize = 4;
/// Shortest time between two updates of the table.
const AGAIN: Duration = Duration::from_millis(250);

/// Running mean and spread of a metric (Welford's recurrence).
#[derive(Clone, Debug, Default)]
pub struct RunningMean {
    count: u64,
    mean: f64,
    squares: f64,
    least: f64,
    most: f64,
}

impl RunningMean {
    /// Adds a value; a value that is not finite is ignored.
    pub fn add(&mut self, value: f64) {
        if !value.is_finite() {
            return;
        }
        if self.count == 0 {
            (self.least, self.most) = (value, value);
        }
        self.count += 1;
        let from_mean = value - self.mean;
        self.mean += from_mean / self.count as f64;
        self.squares += from_mean * (value - self.mean);
        (self.least, self.most) = (self.least.min(value), self.most.max(value));
    }

    /// Returns the statistics as JSON.
    pub fn to_json(&self) -> Json {
        let Self { count, mean, least, most, .. } = self;
        json!({"runs": count, "mean": mean, "sd": self.sd(), "least": least, "most": most})
    }

    fn sd(&self) -> f64 {
        if self.count > 1 { (self.squares / (self.count - 1) as f64).sqrt() } else { f64::NAN }
    }
}

/// Returns the lines of a table with the statistics of some metrics.
pub fn table(metrics: &[(&str, RunningMean)]) -> String {
    let mut text = String::new();
    let any = metrics.iter().filter(|(_, statistics)| statistics.count > 0);
    let (verdicts, any): (Vec<_>, Vec<_>) = any.partition(|(name, _)| goal::NAMES.contains(name));
    for (name, RunningMean { count, mean, .. }) in verdicts {
        let _ = writeln!(text, "  {name:32}{:>10}", success_rate(*count, *mean));
    }
    if any.is_empty() {
        text.truncate(text.trim_end().len());
    } else {
        let _ = write!(
            text,
            "  {:32}{:>10}{:>12}{:>11}{:>11}{:>11}",
            "so far", "runs", "mean", "sd", "least", "most"
        );
    }
    for (name, statistics) in any {
        let RunningMean { count, mean, least, most, .. } = statistics;
        let _ = write!(
            text,
            "\n  {name:32}{count:>10}{:>12}{:>11}{:>11}{:>11}",
            short(*mean),
            short(statistics.sd()),
            short(*least),
            short(*most)
        );
    }
    text
}

/// Returns the value of a metric as a number.
fn number(metrics: &Metrics, name: &str) -> Option<f64> {
    match metrics.get(name)? {
        MetricValue::Count(count) => Some(*count as f64),
        MetricValue::Number(number) => Some(*number),
        MetricValue::Word(word) => goal::score(word),
        MetricValue::Numbers(_) | MetricValue::Quantities(_) | MetricValue::Words(_) => None,
    }
}

/// Progress bar with a table of statistics below it.
pub struct LiveStatistics {
    bar: ProgressBar,
    lines: Lines,
    metrics: Vec<(&'static str, RunningMean)>,
    failed: u64,
    shown: Instant,
}

impl LiveStatistics {
    /// Creates a bar over `runs` runs, of which `present` were completed before.
    pub fn new(runs: u64, present: u64) -> Self {
        let bar = progress::bar_from(runs, present, "runs");
        let lines = Lines::new(runs, present, "runs");
        Self { bar, lines, metrics: Vec::new(), failed: 0, shown: Instant::now() }
    }

    /// Counts a completed run and adds its metrics to the statistics.
    pub fn add(&mut self, outcome: &RunOutcome) {
        self.bar.inc(1);
        match &outcome.metrics {
            Ok(metrics) => {
                if self.metrics.is_empty() {
                    let has = |name: &&str| number(metrics, name).is_some();
                    self.metrics = MAIN_METRICS
                        .into_iter()
                        .filter(has)
                        .take(SHOWN)
                        .map(|name| (name, RunningMean::default()))
                        .collect();
                }
                for (name, running) in &mut self.metrics {
                    running.add(number(metrics, name).unwrap_or(f64::NAN));
                }
            }
            Err(_) => self.failed += 1,
        }
        self.show();
    }

    /// Updates the table unless the last update was less than [`AGAIN`] ago.
    pub fn show(&mut self) {
        if self.bar.is_hidden() {
            return self.lines.show(self.bar.position());
        }
        if self.shown.elapsed() < AGAIN {
            return;
        }
        self.shown = Instant::now();
        let failed = if self.failed > 0 { format!("  {} failed\n", self.failed) } else { String::new() };
        self.bar.set_message(format!("{failed}{}", table(&self.metrics)));
    }
}

impl Drop for LiveStatistics {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn running_statistics_are_those_of_all() {
        let mut running = RunningMean::default();
        // Python: statistics.fmean and statistics.stdev of [1, 2, 4, 8].
        for value in [1.0, 2.0, f64::NAN, 4.0, 8.0] {
            running.add(value);
        }
        assert_eq!((running.count, running.mean, running.least, running.most), (4, 3.75, 1.0, 8.0));
        assert!((running.sd() - 3.095_695_936_834_452).abs() < 1e-15);
        let goal = RunningMean { count: 4, mean: 0.75, ..RunningMean::default() };
        let lines = table(&[("settling_time_s", running), ("goal", goal), ("duty", RunningMean::default())]);
        assert!(lines.lines().count() == 3 && lines.contains("3.75"), "{lines}");
        assert!(lines.contains("3 of 4 met (75 %, 95 % interval 30 to 95)"), "{lines}");
    }
}
