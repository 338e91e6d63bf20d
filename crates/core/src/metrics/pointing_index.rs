//! Values of a pointing index while its error is sampled, and the order statistic of them, with bounded memory.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

use flexsc_numerics::attitude::Vector;

use flexsc_numerics::order_statistics::order_rank;
use flexsc_scenario::IndexWindow;

/// Pointing index of an error that is sampled.
#[derive(Clone, Debug)]
pub struct IndexStream {
    index: IndexWindow,
    /// Errors of the current window, and their sum.
    recent: VecDeque<Vector>,
    sum: Vector,
    /// Number of samples since the sum was last computed from all errors of the window.
    since: u64,
    /// Means of the windows that begin up to a shift before the current one.
    means: VecDeque<Vector>,
}

impl IndexStream {
    /// Creates the index before the first sample.
    pub fn new(index: IndexWindow) -> Self {
        let (recent, means) = (VecDeque::new(), VecDeque::new());
        Self { index, recent, sum: Vector::zeros(), since: 0, means }
    }

    /// Takes a sample of the error, and hands the new values of the index to `give`.
    pub fn push(&mut self, error: Vector, mut give: impl FnMut(Vector)) {
        match self.index {
            IndexWindow::Absolute => give(error),
            IndexWindow::Mean { window } => {
                if let Some(mean) = self.slide(error, window) {
                    give(mean);
                }
            }
            IndexWindow::Relative { window, convention } => match convention.place(window) {
                None => {
                    self.recent.push_back(error);
                    if self.recent.len() as u64 == window {
                        let mean = self.recent.iter().sum::<Vector>() / window as f64;
                        self.recent.drain(..).for_each(|error| give(error - mean));
                    }
                }
                Some(place) => {
                    if let Some(mean) = self.slide(error, window) {
                        give(self.recent[place as usize] - mean);
                    }
                }
            },
            IndexWindow::Difference { window, shift, .. } => {
                if let Some(mean) = self.slide(error, window) {
                    self.means.push_back(mean);
                    if self.means.len() as u64 > shift
                        && let Some(before) = self.means.pop_front()
                    {
                        give(mean - before);
                    }
                }
            }
        }
    }

    /// Adds a sample to a window that slides, and returns its mean once it is whole.
    fn slide(&mut self, error: Vector, window: u64) -> Option<Vector> {
        self.recent.push_back(error);
        self.sum += error;
        if self.recent.len() as u64 > window
            && let Some(old) = self.recent.pop_front()
        {
            self.sum -= old;
        }
        self.since += 1;
        // Rounding errors of the running sum do not grow beyond a window.
        if self.since >= window {
            (self.sum, self.since) = (self.recent.iter().sum(), 0);
        }
        (self.recent.len() as u64 == window).then(|| self.sum / window as f64)
    }
}

/// Order statistic of values of 0 or more, of which only the largest are kept.
#[derive(Clone, Debug)]
pub struct LargestValues {
    level: f64,
    keep: usize,
    count: u64,
    /// The largest values as bits, which are ordered as the values are; the least on top.
    largest: BinaryHeap<Reverse<u64>>,
}

impl LargestValues {
    /// Creates the order statistic at a level of at most `values` values.
    pub fn new(level: f64, values: u64) -> Self {
        let keep = values.saturating_sub(order_rank(level, values)) + 1;
        Self { level, keep: keep as usize, count: 0, largest: BinaryHeap::new() }
    }

    /// Adds a value.
    pub fn add(&mut self, value: f64) {
        self.count += 1;
        let bits = value.abs().to_bits();
        if self.largest.len() < self.keep {
            self.largest.push(Reverse(bits));
        } else if let Some(mut least) = self.largest.peek_mut()
            && least.0 < bits
        {
            least.0 = bits;
        }
    }

    /// Returns the number of values.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Returns the order statistic; NaN without values.
    pub fn finish(self) -> f64 {
        let above = self.count - order_rank(self.level, self.count);
        // In the reverse order of the bits, the largest value comes first.
        let sorted = self.largest.into_sorted_vec();
        sorted.get(above as usize).map_or(f64::NAN, |Reverse(bits)| f64::from_bits(*bits))
    }
}

#[cfg(test)]
mod tests;
