//! Whether a run meets its goal: inside a band about it, without a break, up to the end.

use super::{GOAL, GOAL_BAND, Meaning, MetricValue, REQUIREMENT, TIME_OUTSIDE, Value};
use crate::numerics::polynomial::Polynomial;

/// The goal is met if the run ends with so much of its time inside the band.
const LAST: f64 = 0.1;
/// What it tells of one angle.
pub(super) const TOLD: &[Meaning] = &[GOAL, GOAL_BAND, TIME_OUTSIDE];
/// The names of verdicts among the metrics.
pub const NAMES: [&str; 2] = [GOAL.name, REQUIREMENT.name];
/// What it says.
const MET: &str = "met";
const MISSED: &str = "missed";
const NONE: &str = "none";

/// Whether a value is at most another: met or missed, none without a value.
pub fn within(value: f64, most: f64) -> &'static str {
    if value.is_nan() {
        NONE
    } else if value <= most {
        MET
    } else {
        MISSED
    }
}

/// Gathers the time outside a band about the goal.
#[derive(Copy, Clone, Debug)]
pub struct Verdict {
    /// When the goal begins (s).
    from: f64,
    band: f64,
    /// Time outside so far (s), and what rounding has taken from that sum.
    outside: (f64, f64),
    /// Until when it was outside last (s).
    last: f64,
}

impl Verdict {
    /// Nothing seen of a goal that begins at a time (s), with a band of this half width (rad): NaN or 0 if there is none.
    pub fn new(from: f64, band: f64) -> Self {
        Self { from, band, outside: (0.0, 0.0), last: from }
    }

    /// Half width of the band (rad).
    pub fn band(&self) -> f64 {
        self.band
    }

    /// Takes a time outside the band, from one instant to another (s); what is before the goal begins does not count.
    /// Times come in order.
    pub fn outside(&mut self, from: f64, to: f64) {
        let from = from.max(self.from);
        if to <= from {
            return;
        }
        // Kahan's sum: there may be many pieces.
        let (sum, lost) = self.outside;
        let piece = (to - from) - lost;
        let total = sum + piece;
        self.outside = (total, (total - sum) - piece);
        self.last = to;
    }

    /// Takes the distance from the goal (rad) over a stretch that begins at a time and is so long (s).
    pub fn see(&mut self, from: f64, length: f64, distance: &Polynomial) {
        let band = self.band;
        let (low, high) = distance.bounds();
        if low >= -band && high <= band {
            return;
        }
        let time = |s: f64| from + length * s;
        let mut edges = vec![0.0];
        if low <= band && high >= -band {
            distance.roots(band, &mut edges);
            distance.roots(-band, &mut edges);
            edges.sort_by(f64::total_cmp);
        }
        edges.push(1.0);
        for ends in edges.windows(2) {
            if distance.at(0.5 * (ends[0] + ends[1])).abs() > band {
                self.outside(time(ends[0]), time(ends[1]));
            }
        }
    }

    /// Until when the run was outside the band (s): the goal's beginning if it never was; NaN if it was at the end, or if
    /// there is no band.
    pub fn settled(&self, end: f64) -> f64 {
        if self.band > 0.0 && self.last < end { self.last } else { f64::NAN }
    }

    /// The metrics of a run that ends at a time (s).
    pub fn finish(self, end: f64) -> [MetricValue; 3] {
        // Of what is no number, no comparison holds.
        let (word, band, outside) = if self.band > 0.0 && self.from < end {
            let met = end - self.last >= LAST * (end - self.from);
            (if met { MET } else { MISSED }, self.band, self.outside.0)
        } else {
            (NONE, f64::NAN, f64::NAN)
        };
        [
            (&GOAL, Value::Word(word)),
            (&GOAL_BAND, Value::Number(band)),
            (&TIME_OUTSIDE, Value::Number(outside)),
        ]
    }
}

/// What a verdict counts in statistics: 1 for a goal that is met, 0 for one that is missed, so that the mean is the
/// fraction of runs that meet it. None of any other word.
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

    fn told(verdict: Verdict, end: f64) -> (&'static str, f64, f64) {
        match verdict.finish(end) {
            [(_, Value::Word(word)), (_, Value::Number(band)), (_, Value::Number(outside))] => {
                (word, band, outside)
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_goal_is_met_by_the_last_tenth_of_its_time() {
        let until = |to: f64| {
            let mut verdict = Verdict::new(10.0, 0.5);
            verdict.outside(0.0, 20.0);
            verdict.outside(30.0, to);
            told(verdict, 110.0)
        };
        assert_eq!(until(100.0), ("met", 0.5, 80.0));
        assert_eq!(until(100.001).0, "missed");
        assert_eq!(until(110.0), ("missed", 0.5, 90.0));
        // Inside from the beginning.
        assert_eq!(told(Verdict::new(10.0, 0.5), 110.0), ("met", 0.5, 0.0));
    }

    #[test]
    fn without_a_band_or_a_time_there_is_no_goal() {
        for verdict in [Verdict::new(0.0, f64::NAN), Verdict::new(0.0, 0.0), Verdict::new(7.0, 1.0)] {
            let (word, band, outside) = told(verdict, 7.0);
            assert!(word == "none" && band.is_nan() && outside.is_nan());
        }
    }

    #[test]
    fn many_pieces_lose_no_time() {
        let mut verdict = Verdict::new(0.0, 1.0);
        // A plain sum of so many tenths is 1.3e-6 off.
        for _ in 0..1_000_000 {
            verdict.outside(0.0, 0.1);
        }
        assert!((told(verdict, 2000.0).2 - 1e5).abs() < 1e-10);
    }
}
