//! How far rows of positions are from the orbit that their neighbours describe.
//!
//! Of nine successive rows, the divided difference D of order eight is that of the polynomial through all of them. A row
//! that is left out is |D| times the product of its times to the others from the polynomial through these; and between two rows the
//! polynomial through the eight rows about them errs by about |D| times the product of the times to these.

use std::ops::Range;

use flexsc_numerics::attitude::Vector;

use super::SampledOrbit;
use super::sampled_orbit::ROWS;

/// Departure (m) above which rows are no orbit.
pub(super) const MOST: f64 = 1e3;

/// Departure (m) above which rows are remarked.
const REMARKABLE: f64 = 10.0;

/// Ratio of successive divided differences above which the first or last row of one is taken for wrong.
const STEEP: f64 = 10.0;

/// Largest departure of rows from the orbit of their neighbours.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub(super) struct Departure {
    /// Distance (m).
    pub distance: f64,
    /// Index of the row, or of the row before it.
    pub row: usize,
    /// Time since the start (s).
    pub time: f64,
    /// Time to the next row (s), if the departure is one between both.
    pub gap: Option<f64>,
}

impl Departure {
    /// Returns true if the rows are no orbit.
    pub fn is_refused(&self) -> bool {
        self.distance.is_nan() || self.distance > MOST
    }

    /// Returns true if it is worth a remark.
    pub fn is_remarkable(&self) -> bool {
        self.distance > REMARKABLE
    }
}

impl SampledOrbit {
    /// Returns the largest departure of the rows from which the orbit follows between two times since the start (s). A wrong row
    /// makes the polynomials beside it wrong, so one that departs too far comes before any between rows.
    pub(super) fn departure(&self, [from, to]: [f64; 2]) -> Departure {
        let used = self.first_row(from)..self.first_row(to) + ROWS;
        let width = (ROWS + 1).min(used.len());
        let starts = used.start..used.end - width + 1;
        let differences: Vec<f64> =
            starts.clone().map(|first| self.difference(first..first + width)).collect();
        let difference = |first: usize| differences[first - starts.start];
        let larger = |worst: Departure, other: Departure| {
            if worst.distance >= other.distance { worst } else { other }
        };
        let left_out = |row: usize, first: usize| {
            let nodes = (first..first + width).filter(|node| *node != row);
            let distance = difference(first) * self.spread(self.times[row], nodes);
            Departure { distance, row, time: self.times[row], gap: None }
        };
        let last = starts.end - 1;
        let wrong = used.clone().filter_map(|row| {
            let centred = row.checked_sub(width / 2).filter(|first| starts.contains(first));
            // Rows near an end have no neighbours on one side; a wrong one shows where the differences that have it end.
            let beside = || {
                if row < last && difference(row.max(starts.start)) > STEEP * difference(row + 1) {
                    return Some(row);
                }
                let first = (row + 1).checked_sub(width).filter(|first| *first > starts.start)?;
                (difference(first) > STEEP * difference(first - 1)).then_some(first)
            };
            Some(left_out(row, centred.or_else(beside)?))
        });
        let worst = wrong.fold(Departure::default(), larger);
        if worst.is_refused() {
            return worst;
        }
        let between = (used.start..used.end - 1).filter_map(|row| {
            let [before, after] = [self.times[row], self.times[row + 1]];
            if after <= from || before >= to {
                return None;
            }
            let time = 0.5 * (before + after);
            let first = self.first_row(time);
            let windows = [first.max(starts.start + 1) - 1, first.min(last)];
            let difference = windows.into_iter().map(difference).fold(0.0, f64::max);
            let distance = difference * self.spread(time, first..first + ROWS);
            Some(Departure { distance, row, time, gap: Some(after - before) })
        });
        between.fold(worst, larger)
    }

    /// Returns the length of the divided difference of the positions of some rows.
    fn difference(&self, rows: Range<usize>) -> f64 {
        let times = &self.times[rows.clone()];
        let mut divided: [Vector; ROWS + 1] = Default::default();
        divided[..times.len()].copy_from_slice(&self.positions[rows]);
        for order in 1..times.len() {
            for row in (order..times.len()).rev() {
                divided[row] = (divided[row] - divided[row - 1]) / (times[row] - times[row - order]);
            }
        }
        divided[times.len() - 1].norm()
    }

    /// Returns the product of the times from an instant to some rows.
    fn spread(&self, t: f64, rows: impl Iterator<Item = usize>) -> f64 {
        rows.map(|row| (t - self.times[row]).abs()).product()
    }
}
