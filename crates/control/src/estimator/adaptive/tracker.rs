//! Modes that an observer tracks: those of one measured channel, with close ones merged, each in its own frequency
//! interval.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Finite, Frequency};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Fraction of the Nyquist frequency up to which a frequency can be distinguished from its alias.
const SAMPLED: f64 = 0.98;

/// Initial values of one mode in the observer of a channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tracker {
    /// Natural frequency (rad/s).
    pub frequency: Frequency,
    /// Influence of each input: the jump of the elastic rate in this channel for a unit jump of the rigid rate that the
    /// input makes about its own axis (\[Timakov14\], page 41; dimensionless).
    pub influence: Vec<Finite>,
    /// Bounds `[low, high]` of the frequency (rad/s); default: the midpoints between it and its
    /// neighbours.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bounds: Option<[Frequency; 2]>,
}

impl Tracker {
    /// Returns the sum of the absolute influences of all inputs.
    pub fn strength(&self) -> f64 {
        self.influence.iter().map(|influence| influence.get().abs()).sum()
    }

    /// Returns both trackers merged: mean frequency weighted by strength, sum of influences.
    fn merge(&self, other: &Self) -> Self {
        let (a, b) = (self.strength(), other.strength());
        let (a, b) = if a + b > 0.0 { (a / (a + b), b / (a + b)) } else { (0.5, 0.5) };
        let mean = a * self.frequency.get() + b * other.frequency.get();
        let sum = |(a, b): (&Finite, &Finite)| Finite::new(a.get() + b.get()).unwrap_or(*a);
        Self {
            frequency: Frequency::new(mean).unwrap_or(self.frequency),
            influence: self.influence.iter().zip(&other.influence).map(sum).collect(),
            bounds: None,
        }
    }
}

/// Tracker and the modes that it represents.
#[derive(Clone, Debug, PartialEq)]
pub struct MergedTracker {
    /// Tracker of the merged modes.
    pub tracker: Tracker,
    /// Indices of the modes.
    pub modes: Vec<usize>,
}

/// Returns the trackers of a channel's modes, by frequency. Two whose relative difference is below `merge`, such as
/// 0.08, cannot be distinguished and are merged, the closest first. Bounds are dropped.
pub fn merge(modes: &[Tracker], merge: f64) -> Vec<MergedTracker> {
    let unmerged = |(index, mode): (usize, &Tracker)| MergedTracker {
        tracker: Tracker { bounds: None, ..mode.clone() },
        modes: vec![index],
    };
    let mut merged: Vec<MergedTracker> = modes.iter().enumerate().map(unmerged).collect();
    merged.sort_by(|a, b| a.tracker.frequency.get().total_cmp(&b.tracker.frequency.get()));
    while let Some(index) = nearest(&merged, merge) {
        let above = merged.remove(index + 1);
        let below = &mut merged[index];
        below.tracker = below.tracker.merge(&above.tracker);
        below.modes.extend(above.modes);
    }
    merged
}

/// Returns the index of the first tracker of the closest pair within a ratio.
fn nearest(merged: &[MergedTracker], merge: f64) -> Option<usize> {
    let frequency_of = |index: usize| merged[index].tracker.frequency.get();
    let ratio = |index: usize| frequency_of(index + 1) / frequency_of(index) - 1.0;
    let pairs = (0..merged.len().saturating_sub(1)).filter(|&index| ratio(index) < merge);
    pairs.min_by(|&a, &b| ratio(a).total_cmp(&ratio(b)))
}

/// Returns the bounds of each tracker (rad/s): its own, or from its frequency divided by `reach` to its frequency times
/// `reach`, limited by the geometric mean with a neighbour, the neighbour's own bound, and 0.98 of the Nyquist
/// frequency at the sampling period `period` (s).
pub fn bounds(trackers: &[Tracker], reach: f64, period: f64) -> Vec<[f64; 2]> {
    let highest = SAMPLED * std::f64::consts::PI / period;
    let range_of = |tracker: &Tracker| {
        let frequency = tracker.frequency.get();
        if let Some(bounds) = tracker.bounds {
            return bounds.map(Frequency::get);
        }
        let [mut low, mut high] = [frequency / reach, (frequency * reach).min(highest)];
        for other in trackers {
            let other_frequency = other.frequency.get();
            let middle = f64::sqrt(frequency * other_frequency);
            if other_frequency < frequency {
                low = low.max(other.bounds.map_or(middle, |bounds| bounds[1].get()));
            } else if other_frequency > frequency {
                high = high.min(other.bounds.map_or(middle, |bounds| bounds[0].get()));
            }
        }
        [low, high]
    };
    trackers.iter().map(range_of).collect()
}

/// Checks the trackers against the number of inputs, the sampling period (s) and each other; returns the first
/// inconsistent key and the reason.
pub fn validate(trackers: &[Tracker], reach: f64, inputs: usize, period: f64) -> Option<ConfigError> {
    if trackers.is_empty() {
        return Some(ConfigError::new("trackers", "must have at least one mode to track, got none"));
    }
    let nyquist = std::f64::consts::PI / period;
    let bounds = bounds(trackers, reach, period);
    for (index, (tracker, [low, high])) in trackers.iter().zip(&bounds).enumerate() {
        let error_at =
            |key: &str, why: String| Some(ConfigError::new(format!("trackers[{index}].{key}"), why));
        let (frequency, found) = (tracker.frequency.get(), tracker.influence.len());
        if found != inputs {
            return error_at(
                "influence",
                format!("must be one number for each of {inputs} inputs, got {found}"),
            );
        }
        if tracker.strength() == 0.0 {
            return error_at(
                "influence",
                "must not be 0 for every input: nothing excites the mode".to_owned(),
            );
        }
        if frequency >= nyquist {
            let why = format!("must be below the Nyquist frequency of {nyquist} rad/s, got {frequency}");
            return error_at("frequency", why);
        }
        if low >= high {
            return error_at("bounds", format!("must be [low, high] in this order, got [{low}, {high}]"));
        }
        if *high >= nyquist {
            let why = format!("must end below the Nyquist frequency of {nyquist} rad/s, got {high}");
            return error_at("bounds", why);
        }
        if !(low..=high).contains(&&frequency) {
            return error_at(
                "frequency",
                format!("must lie within the bounds [{low}, {high}], got {frequency}"),
            );
        }
        let overlaps = |other: &[f64; 2]| low < &other[1] && &other[0] < high;
        if let Some(other) = bounds[..index].iter().position(overlaps) {
            let [from, to] = bounds[other];
            let why =
                format!("must not overlap those of trackers[{other}], [{from}, {to}], got [{low}, {high}]");
            return error_at("bounds", why);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::estimator::adaptive::{Gradient, Recurrence};
    use flexsc_numerics::quantity::NonNegative;

    const CYCLE: f64 = 0.2;

    fn hertz(hertz: f64) -> Frequency {
        Frequency::new(2.0 * PI * hertz).expect("a frequency")
    }

    fn tracker(frequency: f64, influence: f64) -> Tracker {
        let influence = vec![Finite::new(influence).expect("finite")];
        Tracker { frequency: hertz(frequency), influence, bounds: None }
    }

    #[track_caller]
    fn close(value: f64, exact: f64, relative: f64) {
        assert!((value / exact - 1.0).abs() <= relative, "{value} is off {exact}");
    }

    #[test]
    fn near_modes_become_one_tracker() {
        let modes = [
            tracker(0.6096, 1.6),
            tracker(0.2476, 2.89),
            tracker(0.6049, 1.4),
            tracker(0.65, -0.2),
            tracker(0.9, 0.1),
        ];
        let trackers = |ratio: f64| -> Vec<Tracker> {
            merge(&modes, ratio).into_iter().map(|merged| merged.tracker).collect()
        };
        let found = trackers(0.08);
        let found_at = |tracker: &Tracker| tracker.frequency.get() / (2.0 * PI);
        // The pair is merged first, to 0.60741 Hz; then 0.65 Hz is within 8 % of it.
        assert_eq!(found.len(), 3);
        close(found_at(&found[0]), 0.2476, 1e-12);
        let pair = (1.6 * 0.6096 + 1.4 * 0.6049) / 3.0;
        close(found_at(&found[1]), (3.0 * pair + 2.8 * 0.65) / 5.8, 0.05);
        close(found[1].influence[0].get(), 2.8, 1e-12);
        assert_eq!(trackers(0.0).len(), 5);
        let two = &found[..2];
        assert_eq!(validate(two, 2.0, 1, CYCLE), None);
        let [first, second] = bounds(two, 2.0, CYCLE)[..] else { panic!("two") };
        assert_eq!(first[1], second[0]);
        close(first[0], PI * 0.2476, 1e-12);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let new_tracker = |low: f64, frequency: f64, high: f64| Tracker {
            frequency: hertz(frequency),
            bounds: Some([hertz(low), hertz(high)]),
            ..tracker(frequency, 1.0)
        };
        let wrong = |trackers: &[Tracker], inputs| {
            let ConfigError { key, why, .. } =
                Gradient::default().validate(trackers, inputs, CYCLE).expect("wrong");
            format!("{key} {why}")
        };
        for (found, expected) in [
            (wrong(&[], 1), "trackers must have at least one mode to track, got none"),
            (
                wrong(&[new_tracker(0.1, 0.2, 0.3)], 2),
                "trackers[0].influence must be one number for each of 2 inputs, got 1",
            ),
            (wrong(&[tracker(0.2, 0.0)], 1), "trackers[0].influence must not be 0 for every input: nothing"),
            (
                wrong(&[new_tracker(0.3, 0.2, 0.1)], 1),
                "trackers[0].bounds must be [low, high] in this order, got",
            ),
            (wrong(&[new_tracker(0.1, 0.4, 0.3)], 1), "trackers[0].frequency must lie within the bounds"),
            (
                wrong(&[new_tracker(0.1, 0.2, 2.6)], 1),
                "trackers[0].bounds must end below the Nyquist frequency of 15.7",
            ),
            (
                wrong(&[new_tracker(2.0, 2.6, 2.7)], 1),
                "trackers[0].frequency must be below the Nyquist frequency of 15.7",
            ),
            (
                wrong(&[new_tracker(0.1, 0.2, 0.3), new_tracker(0.29, 0.4, 0.5)], 1),
                "trackers[1].bounds must not overlap those of trackers[0]",
            ),
        ] {
            assert!(found.starts_with(expected), "{found}");
        }
        let number = |value| NonNegative::new(value).expect("0 or more");
        let spec = Recurrence { influence_bounds: [2.0, 3.0].map(number), ..Recurrence::default() };
        assert_eq!(spec.validate(&tracker(0.2, 2.0), CYCLE).expect("wrong").key, "influence_bounds");
        let spec = Gradient { damping: number(1.0), ..Gradient::default() };
        assert_eq!(spec.validate(&[tracker(0.2, 2.0)], 1, CYCLE).expect("wrong").key, "damping");
        let unknown: Result<Gradient, _> = flexsc_formats::document::from_text("damping = 0.01\nlg = 0.1");
        assert!(unknown.is_err());
        let known: Gradient =
            flexsc_formats::document::from_text("damping = 0.01\nelastic_gain = 0.1").expect("known");
        assert_eq!(known.damping, number(0.01));
    }
}
