//! Minimum of a signal over a window that slides: the least of its two edges and of the turns between them.

use std::collections::VecDeque;

use super::piece::{SignalPiece, Witnessed};

/// Minimum over the closed window from `after` to `after` + `width` seconds after each time.
///
/// A piece that only rises or falls is least at an end. Within a window the minimum is thus that of the values at its two
/// edges and of those where pieces meet; of the latter a queue keeps the ones that no later one undercuts.
#[derive(Clone, Debug)]
pub struct SlidingMinimum {
    after: f64,
    /// Width (s); infinite for a window to the end of the signal.
    width: f64,
    /// Monotone pieces from the left edge on.
    left: VecDeque<SignalPiece>,
    /// Values where pieces meet, with their times (s).
    turns: VecDeque<(f64, Witnessed)>,
    /// Time (s) of the left edge up to which the minimum is known.
    known: f64,
}

impl SlidingMinimum {
    /// Creates the minimum from `start` (s) on; the signal is given from `start` + `after` on.
    pub fn new(start: f64, after: f64, width: f64) -> Self {
        let (left, turns) = (VecDeque::new(), VecDeque::new());
        Self { after, width, left, turns, known: start + after }
    }

    /// Takes the next piece of the signal, and appends the minimum as far as it is known.
    pub fn push(&mut self, piece: &SignalPiece, into: &mut Vec<SignalPiece>) {
        if self.width == 0.0 {
            into.push(piece.part_earlier(piece.from, piece.to, self.after));
            return;
        }
        let mut monotone = Vec::new();
        piece.push_monotone(&mut monotone);
        for part in monotone {
            if let Some(before) = self.left.back() {
                let [ended, begun] = [before.at(part.from), part.at(part.from)];
                let least = if begun.value < ended.value { begun } else { ended };
                self.add_turn(part.from, least);
            }
            self.left.push_back(part.clone());
            if self.width.is_finite() {
                self.advance(&part, into);
            }
        }
    }

    fn add_turn(&mut self, at: f64, least: Witnessed) {
        while self.turns.back().is_some_and(|(_, last)| last.value >= least.value) {
            self.turns.pop_back();
        }
        self.turns.push_back((at, least));
    }

    /// Moves the right edge over a piece.
    fn advance(&mut self, right: &SignalPiece, into: &mut Vec<SignalPiece>) {
        let until = right.to - self.width;
        while self.known < until {
            let from = self.known;
            while self.left.front().is_some_and(|left| left.to <= from) {
                self.left.pop_front();
            }
            while self.turns.front().is_some_and(|(at, _)| *at <= from) {
                self.turns.pop_front();
            }
            let Some(left) = self.left.front() else { return };
            let turn = self.turns.front();
            let to = turn.map_or(until, |(at, _)| at.min(until)).min(left.to);
            let mut edges = Vec::new();
            let right = right.part_earlier(from + self.width, to + self.width, self.width);
            left.push_lesser(&right, from, to, &mut edges);
            for edge in edges {
                let mut parts = Vec::new();
                match turn {
                    Some((_, least)) => {
                        let turn = least.piece(edge.from, edge.to);
                        edge.push_lesser(&turn, edge.from, edge.to, &mut parts);
                    }
                    None => parts.push(edge),
                }
                into.extend(parts.iter().map(|part| part.part_earlier(part.from, part.to, self.after)));
            }
            self.known = to;
        }
    }

    /// Appends the minima over windows to the end of the signal, which a piece without an end may follow.
    pub fn finish(&mut self, into: &mut Vec<SignalPiece>) {
        if self.width.is_finite() {
            return;
        }
        let mut least: Option<Witnessed> = None;
        let mut reversed = Vec::new();
        for piece in std::mem::take(&mut self.left).into_iter().rev() {
            if piece.to.is_infinite() {
                reversed.push(piece);
                continue;
            }
            let end = piece.at(piece.to);
            let later = least.filter(|later| later.value <= end.value).unwrap_or(end);
            let mut parts = Vec::new();
            piece.push_lesser(&later.piece(piece.from, piece.to), piece.from, piece.to, &mut parts);
            reversed.extend(parts.into_iter().rev());
            let start = piece.at(piece.from);
            least = Some(if start.value < later.value { start } else { later });
        }
        into.extend(reversed.iter().rev().map(|part| part.part_earlier(part.from, part.to, self.after)));
    }
}
