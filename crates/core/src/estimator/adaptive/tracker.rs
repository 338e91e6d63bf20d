//! What an observer tracks: modes of one measured channel, near ones merged, each in an interval of frequency of its own.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::{Finite, Frequency};

/// The part of the Nyquist frequency up to which a frequency can be told from its alias.
const SAMPLED: f64 = 0.98;

/// A mode as an observer of one channel begins with it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tracker {
    /// Natural frequency (rad/s).
    pub frequency: Frequency,
    /// Influence of each input: the jump of the elastic rate in this channel for a unit jump of the rigid rate that the
    /// input makes about its own axis (seed paper 4, page 41; dimensionless).
    pub influence: Vec<Finite>,
    /// `[low, high]` between which the frequency is looked for (rad/s); left out, up to the middle between it and its
    /// neighbours.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bounds: Option<[Frequency; 2]>,
}

impl Tracker {
    /// The influence of all inputs together, by absolute values.
    pub fn strength(&self) -> f64 {
        self.influence.iter().map(|influence| influence.get().abs()).sum()
    }

    /// Both as one: the frequency by the strengths, the influences summed.
    fn merged(&self, other: &Self) -> Self {
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

/// The trackers of a channel's modes, by frequency: two nearer to each other than a ratio, such as 0.08, cannot be told
/// apart and become one. The nearest are merged first. Bounds are not kept.
pub fn trackers(modes: &[Tracker], merge: f64) -> Vec<Tracker> {
    let mut trackers: Vec<Tracker> =
        modes.iter().map(|mode| Tracker { bounds: None, ..mode.clone() }).collect();
    sort(&mut trackers);
    while let Some(index) = nearest(&trackers, merge) {
        let above = trackers.remove(index + 1);
        trackers[index] = trackers[index].merged(&above);
    }
    trackers
}

/// So many of the trackers with the greatest strength, by frequency: an observer follows one or two.
pub fn dominant(mut trackers: Vec<Tracker>, count: usize) -> Vec<Tracker> {
    trackers.sort_by(|a, b| b.strength().total_cmp(&a.strength()));
    trackers.truncate(count);
    sort(&mut trackers);
    trackers
}

fn sort(trackers: &mut [Tracker]) {
    trackers.sort_by(|a, b| a.frequency.get().total_cmp(&b.frequency.get()));
}

/// The first of the nearest pair within a ratio.
fn nearest(trackers: &[Tracker], merge: f64) -> Option<usize> {
    let ratio = |index: usize| trackers[index + 1].frequency.get() / trackers[index].frequency.get() - 1.0;
    let pairs = (0..trackers.len().saturating_sub(1)).filter(|&index| ratio(index) < merge);
    pairs.min_by(|&a, &b| ratio(a).total_cmp(&ratio(b)))
}

/// The bounds of each tracker (rad/s): its own, or from its frequency divided by `reach` to its frequency times `reach`, and
/// no further than the geometric mean with a neighbour, the neighbour's own bound, or what a period (s) of samples can tell
/// from its alias.
pub fn bounds(trackers: &[Tracker], reach: f64, period: f64) -> Vec<[f64; 2]> {
    let highest = SAMPLED * std::f64::consts::PI / period;
    let of = |tracker: &Tracker| {
        let frequency = tracker.frequency.get();
        if let Some(bounds) = tracker.bounds {
            return bounds.map(Frequency::get);
        }
        let [mut low, mut high] = [frequency / reach, (frequency * reach).min(highest)];
        for other in trackers {
            let theirs = other.frequency.get();
            let middle = libm::sqrt(frequency * theirs);
            if theirs < frequency {
                low = low.max(other.bounds.map_or(middle, |bounds| bounds[1].get()));
            } else if theirs > frequency {
                high = high.min(other.bounds.map_or(middle, |bounds| bounds[0].get()));
            }
        }
        [low, high]
    };
    trackers.iter().map(of).collect()
}

/// The first key of the trackers that does not fit so many inputs, this period of samples (s) or another tracker, and what is
/// wrong with it.
pub fn inconsistency(
    trackers: &[Tracker],
    reach: f64,
    inputs: usize,
    period: f64,
) -> Option<(String, String)> {
    if trackers.is_empty() {
        return Some(("trackers".to_owned(), "must have at least one mode to track, got none".to_owned()));
    }
    let nyquist = std::f64::consts::PI / period;
    let bounds = bounds(trackers, reach, period);
    for (index, (tracker, [low, high])) in trackers.iter().zip(&bounds).enumerate() {
        let at = |key: &str, why: String| Some((format!("trackers[{index}].{key}"), why));
        let (frequency, found) = (tracker.frequency.get(), tracker.influence.len());
        if found != inputs {
            return at("influence", format!("must be one number for each of {inputs} inputs, got {found}"));
        }
        if tracker.strength() == 0.0 {
            return at("influence", "must not be 0 for every input: nothing excites the mode".to_owned());
        }
        if frequency >= nyquist {
            let why = format!("must be below the Nyquist frequency of {nyquist} rad/s, got {frequency}");
            return at("frequency", why);
        }
        if low >= high {
            return at("bounds", format!("must be [low, high] in this order, got [{low}, {high}]"));
        }
        if *high >= nyquist {
            let why = format!("must end below the Nyquist frequency of {nyquist} rad/s, got {high}");
            return at("bounds", why);
        }
        if !(low..=high).contains(&&frequency) {
            return at("frequency", format!("must lie within the bounds [{low}, {high}], got {frequency}"));
        }
        let overlaps = |other: &[f64; 2]| low < &other[1] && &other[0] < high;
        if let Some(other) = bounds[..index].iter().position(overlaps) {
            let [from, to] = bounds[other];
            let why =
                format!("must not overlap those of trackers[{other}], [{from}, {to}], got [{low}, {high}]");
            return at("bounds", why);
        }
    }
    None
}
