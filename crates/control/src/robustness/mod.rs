//! Robustness of requirements over time: by how much an expression holds or fails, on signals that are known piece by piece.
//!
//! The robustness of a comparison is the distance of the quantity from its limit divided by the size of the limit (by 1 if the
//! limit is 0), negative where the comparison does not hold; that of a flag is 1 or -1. `not` changes the sign; `and` and
//! `always` take the least, `or` and `eventually` the largest. Both are those of the signals at all times, not at samples.

mod point;
mod signal;

use flexsc_numerics::signal::{SignalPiece, Witnessed};

use crate::operation::{Comparison, Expression, ModeQuantity};
use point::PointRobustness;

/// Robustness of a requirement at the start of a run, found while the run goes on.
#[derive(Clone, Debug)]
pub struct RequirementMonitor {
    point: PointRobustness,
    /// Comparisons and flags, in the order of the expression.
    leaves: Vec<Leaf>,
}

/// Comparison or flag, as a multiple of its quantity plus an offset.
#[derive(Copy, Clone, Debug)]
struct Leaf {
    quantity: ModeQuantity,
    gain: f64,
    offset: f64,
}

/// Part of all signals between two times.
#[derive(Copy, Clone)]
enum Chunk<'a> {
    /// Pieces of each comparison and flag.
    Known(&'a [Vec<SignalPiece>]),
    /// End of the run (s), and the robustness that all comparisons and flags have after it: infinite, with the sign that the
    /// requirement is to get there.
    After(f64, f64),
}

/// Least and largest robustness that a requirement may have, whatever follows the run.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct RobustnessRange {
    /// Least.
    pub low: Witnessed,
    /// Largest.
    pub high: Witnessed,
}

impl RequirementMonitor {
    /// Creates the monitor of an expression for a run of this length (s).
    pub fn new(expression: &Expression, end: f64) -> Self {
        let leaves = expression.comparisons().into_iter().map(Leaf::new).collect();
        Self { point: PointRobustness::new(expression, [0.0, end], &mut 0), leaves }
    }

    /// Iterates over the quantities whose signals the monitor reads, in the order of their pieces.
    pub fn quantities(&self) -> impl Iterator<Item = ModeQuantity> {
        self.leaves.iter().map(|leaf| leaf.quantity)
    }

    /// Takes the pieces of each quantity between two times; they continue those before. A comparison with a value that is
    /// not known, NaN, does not hold.
    pub fn push(&mut self, pieces: &[&[SignalPiece]]) {
        let scaled = |(of, leaf): (&&[SignalPiece], &Leaf)| -> Vec<SignalPiece> {
            let scaled = |piece: &SignalPiece| {
                if piece.at(piece.from).value.is_nan() {
                    return SignalPiece::constant(piece.from, piece.to, f64::NEG_INFINITY);
                }
                piece.clone().scaled(leaf.gain, leaf.offset)
            };
            of.iter().map(scaled).collect()
        };
        let leaves: Vec<Vec<SignalPiece>> = pieces.iter().zip(&self.leaves).map(scaled).collect();
        self.point.push(Chunk::Known(&leaves));
    }

    /// Returns true if a part of the run up to `to` (s) cannot change the robustness while each quantity, in the order of
    /// [`Self::quantities`], stays within a range.
    pub fn ignores(&self, to: f64, ranges: impl Iterator<Item = [f64; 2]>) -> bool {
        let scaled = |(range, leaf): ([f64; 2], &Leaf)| {
            let [one, other] = range.map(|value| leaf.offset + leaf.gain * value);
            [one.min(other), one.max(other)]
        };
        let ranges: Vec<[f64; 2]> = ranges.zip(&self.leaves).map(scaled).collect();
        ranges.iter().flatten().all(|end| !end.is_nan()) && self.point.ignores(to, &ranges)
    }

    /// Returns the robustness of a run that has ended at `end` (s).
    pub fn finish(self, end: f64) -> RobustnessRange {
        let with = |mut point: PointRobustness, sign: f64| {
            point.push(Chunk::After(end, sign * f64::INFINITY));
            point.value()
        };
        RobustnessRange { low: with(self.point.clone(), -1.0), high: with(self.point, 1.0) }
    }
}

impl Leaf {
    /// Creates the flag of a quantity, or its comparison with a number.
    fn new((quantity, compared): (ModeQuantity, Option<(Comparison, f64)>)) -> Self {
        let Some((comparison, limit)) = compared else {
            return Self { quantity, gain: 2.0, offset: -1.0 };
        };
        let scale = limit_scale(limit);
        let sign = match comparison {
            Comparison::Below | Comparison::AtMost => -1.0,
            Comparison::Above | Comparison::AtLeast => 1.0,
        };
        Self { quantity, gain: sign / scale, offset: -sign * limit / scale }
    }
}

/// Returns the size by which the distance of a quantity from its limit is divided: that of the limit, or 1 if it is 0.
pub fn limit_scale(limit: f64) -> f64 {
    if limit == 0.0 { 1.0 } else { limit.abs() }
}

#[cfg(test)]
mod tests;
