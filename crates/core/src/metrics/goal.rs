//! Verdict on a run's goal: the run must end inside a band about the goal, without leaving it over the last part of the
//! time.

use flexsc_numerics::polynomial::Polynomial;
use flexsc_scenario::metric_descriptions;

use super::{GOAL, GOAL_BAND, MetricValue, NamedMetric, REQUIREMENT, TIME_OUTSIDE};

/// Fraction of the time since the goal's start that the run must end with inside the band.
const LAST: f64 = 0.1;
/// Names of the metrics that are verdicts.
pub const NAMES: [&str; 2] = [GOAL.name, REQUIREMENT.name];
/// Words of a verdict.
const MET: &str = "met";
const MISSED: &str = "missed";
const NONE: &str = "none";

/// Removes the goal from the metrics of a run that is judged by requirements alone.
pub(super) fn remove(metrics: &mut [NamedMetric]) {
    for (meaning, value) in
        metrics.iter_mut().filter(|(meaning, _)| metric_descriptions::is_of_goal(meaning.name))
    {
        *value =
            if meaning.name == GOAL.name { MetricValue::Word(NONE) } else { MetricValue::Number(f64::NAN) };
    }
}

/// Returns the word of a verdict.
pub fn word(is_met: bool) -> &'static str {
    if is_met { MET } else { MISSED }
}

/// Collector of the time outside a band about the goal.
#[derive(Copy, Clone, Debug)]
pub struct GoalMetrics {
    /// Start of the goal (s).
    from: f64,
    band: f64,
    /// Total time outside (s), and the rounding carry of the sum.
    outside: (f64, f64),
    /// End of the last time outside (s).
    last: f64,
}

impl GoalMetrics {
    /// Creates a collector for a goal that starts at `from` (s), with a band of half width `band` (rad), NaN or 0
    /// without one.
    pub fn new(from: f64, band: f64) -> Self {
        Self { from, band, outside: (0.0, 0.0), last: from }
    }

    /// Returns the half width of the band (rad).
    pub fn band(&self) -> f64 {
        self.band
    }

    /// Adds a time outside the band, from one instant to another (s); times before the goal's start do not count. Calls
    /// must be in the order of time.
    pub fn add_outside(&mut self, from: f64, to: f64) {
        let from = from.max(self.from);
        if to <= from {
            return;
        }
        // Kahan summation, because there may be many intervals.
        let (sum, lost) = self.outside;
        let piece = (to - from) - lost;
        let total = sum + piece;
        self.outside = (total, (total - sum) - piece);
        self.last = to;
    }

    /// Records the distance from the goal (rad) over a piece of `length` (s) that begins at `from` (s).
    pub fn observe(&mut self, from: f64, length: f64, distance: &Polynomial) {
        let band = self.band;
        let (low, high) = distance.bounds();
        if low >= -band && high <= band {
            return;
        }
        let time = |s: f64| from + length * s;
        let mut times = vec![0.0];
        if low <= band && high >= -band {
            distance.roots(band, &mut times);
            distance.roots(-band, &mut times);
            times.sort_by(f64::total_cmp);
        }
        times.push(1.0);
        for ends in times.windows(2) {
            if distance.at(0.5 * (ends[0] + ends[1])).abs() > band {
                self.add_outside(time(ends[0]), time(ends[1]));
            }
        }
    }

    /// Returns the last time outside the band (s): the goal's start if the run never was outside, NaN if it ends
    /// outside, or if there is no band.
    pub fn settling_time(&self, end: f64) -> f64 {
        if self.band > 0.0 && self.last < end { self.last } else { f64::NAN }
    }

    /// Returns the metrics of a run that ends at `end` (s).
    pub fn finish(self, end: f64) -> [NamedMetric; 3] {
        // Comparisons with NaN are false.
        let (word, band, outside) = if self.band > 0.0 && self.from < end {
            let is_met = end - self.last >= LAST * (end - self.from);
            (if is_met { MET } else { MISSED }, self.band, self.outside.0)
        } else {
            (NONE, f64::NAN, f64::NAN)
        };
        [
            (&GOAL, MetricValue::Word(word)),
            (&GOAL_BAND, MetricValue::Number(band)),
            (&TIME_OUTSIDE, MetricValue::Number(outside)),
        ]
    }
}

/// Returns the value of a verdict in statistics: 1 for met, 0 for missed, so that the mean is the fraction of runs that
/// meet the goal; `None` for any other word.
pub fn score(word: &str) -> Option<f64> {
    match word {
        MET => Some(1.0),
        MISSED => Some(0.0),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value_before(verdict: GoalMetrics, end: f64) -> (&'static str, f64, f64) {
        match verdict.finish(end) {
            [
                (_, MetricValue::Word(word)),
                (_, MetricValue::Number(band)),
                (_, MetricValue::Number(outside)),
            ] => (word, band, outside),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_goal_is_met_by_the_last_tenth_of_its_time() {
        let until = |to: f64| {
            let mut verdict = GoalMetrics::new(10.0, 0.5);
            verdict.add_outside(0.0, 20.0);
            verdict.add_outside(30.0, to);
            value_before(verdict, 110.0)
        };
        assert_eq!(until(100.0), ("met", 0.5, 80.0));
        assert_eq!(until(100.001).0, "missed");
        assert_eq!(until(110.0), ("missed", 0.5, 90.0));
        // Inside from the start.
        assert_eq!(value_before(GoalMetrics::new(10.0, 0.5), 110.0), ("met", 0.5, 0.0));
    }

    #[test]
    fn without_a_band_or_a_time_there_is_no_goal() {
        for verdict in
            [GoalMetrics::new(0.0, f64::NAN), GoalMetrics::new(0.0, 0.0), GoalMetrics::new(7.0, 1.0)]
        {
            let (word, band, outside) = value_before(verdict, 7.0);
            assert!(word == "none" && band.is_nan() && outside.is_nan());
        }
    }

    #[test]
    fn many_pieces_lose_no_time() {
        let mut verdict = GoalMetrics::new(0.0, 1.0);
        // A plain sum of a million tenths is 1.3e-6 off.
        for _ in 0..1_000_000 {
            verdict.add_outside(0.0, 0.1);
        }
        assert!((value_before(verdict, 2000.0).2 - 1e5).abs() < 1e-10);
    }
}
