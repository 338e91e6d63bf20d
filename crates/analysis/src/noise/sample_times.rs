//! Times of the samples of an output, as places in the period of a loop.

use flexsc_numerics::time::{Instant, Span};

use crate::open_loop::multi_rate::common_multiple;

/// Largest number of starts at which a set of samples is examined.
const MOST_STARTS: u64 = 1000;
/// Largest number of samples of all sets that are examined: a set of more than a hundredth of it has fewer starts.
const MOST_SAMPLES: u64 = 200_000;

/// Times of consecutive samples of an output.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SampleTimes {
    /// Time of the first sample (fs).
    pub first: u128,
    /// Time from sample to sample.
    pub apart: Span,
}

/// Sets of samples that begin at different times of a loop's period.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SampleSets {
    /// Number of samples of a set.
    pub length: u64,
    /// Number of samples from the start of one set to that of the next.
    pub stride: u64,
    /// Number of sets.
    pub count: u64,
}

/// Place of a sample: the number of whole periods before it, and the time since (fs).
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SamplePlace {
    /// Whole periods since the start of the period in which the first sample of a set lies.
    pub period: usize,
    /// Time since the start of the sample's period (fs).
    pub time: i64,
}

impl SampleTimes {
    /// Returns the starts of sets, as numbers of their first samples: one for each time of the loop's `period` (fs) at
    /// which a set begins. Where these are very many, they are spread evenly over the sets.
    pub fn starts(&self, sets: SampleSets, period: i64) -> Vec<u64> {
        let (apart, whole) = ((Instant::START + self.apart).femtoseconds(), period.unsigned_abs());
        let step = ((apart * u128::from(sets.stride)) % u128::from(whole.max(1))) as i64;
        let cycle = if step == 0 {
            1
        } else {
            common_multiple(step, period).map_or(u64::MAX, |all| (all / step) as u64)
        };
        let all = sets.count.clamp(1, cycle.max(1));
        let most = (MOST_SAMPLES / sets.length.max(1)).clamp(1, MOST_STARTS);
        let chosen = all.min(most);
        (0..chosen)
            .map(|index| sets.stride * (u128::from(index) * u128::from(all) / u128::from(chosen)) as u64)
            .collect()
    }

    /// Returns the places of the samples of a set that begins at sample `start`, in periods of the loop (fs).
    pub fn places(&self, start: u64, length: u64, period: i64) -> impl Iterator<Item = SamplePlace> + use<> {
        let apart = (Instant::START + self.apart).femtoseconds();
        let whole = u128::from(period.unsigned_abs().max(1));
        let begin = (self.first + apart * u128::from(start)) % whole;
        (0..length).map(move |sample| {
            let time = begin + apart * u128::from(sample);
            SamplePlace { period: (time / whole) as usize, time: (time % whole) as i64 }
        })
    }
}
