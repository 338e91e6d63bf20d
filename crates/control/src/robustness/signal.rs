//! Robustness at every time of an interval, as a signal.

use std::collections::VecDeque;

use flexsc_numerics::signal::{SignalPiece, SlidingMinimum};

use super::Chunk;
use crate::operation::{Expression, TimeWindow, Timed};

/// Robustness of an expression from a start on.
#[derive(Clone, Debug)]
pub(super) enum RobustnessSignal {
    /// Comparison or flag with this number, between two times (s).
    Leaf {
        /// Number.
        source: usize,
        /// Start and end (s).
        span: [f64; 2],
        /// True within an odd number of negations.
        is_negated: bool,
        /// Last piece.
        last: Option<SignalPiece>,
    },
    /// Opposite.
    Not(Box<RobustnessSignal>),
    /// Least, with the pieces of each that wait for the others.
    Least(Vec<(RobustnessSignal, VecDeque<SignalPiece>)>),
    /// Least over a window that slides.
    Sliding(Box<RobustnessSignal>, SlidingMinimum),
    /// Infinite with the sign of another.
    Sign(Box<RobustnessSignal>),
}

impl RobustnessSignal {
    /// Creates the robustness between two times (s); `source` is the number of its first comparison, and then that after its
    /// last one.
    pub fn new(expression: &Expression, span: [f64; 2], is_negated: bool, source: &mut usize) -> Self {
        let mut new = |inner: &Expression, span, is_negated| Self::new(inner, span, is_negated, source);
        let waiting = |signal| (signal, VecDeque::new());
        match expression {
            Expression::Compared { .. } | Expression::Flag(_) => {
                *source += 1;
                Self::Leaf { source: *source - 1, span, is_negated, last: None }
            }
            Expression::Not(inner) => Self::Not(Box::new(new(inner, span, !is_negated))),
            Expression::All(all) => {
                Self::Least(all.iter().map(|inner| waiting(new(inner, span, is_negated))).collect())
            }
            Expression::Any(any) => {
                let opposite = |inner: &Expression| Self::Not(Box::new(new(inner, span, is_negated)));
                Self::Not(Box::new(Self::Least(any.iter().map(opposite).map(waiting).collect())))
            }
            Expression::Timed(timed) => match &**timed {
                Timed::Always(TimeWindow { from, to }, inner) => {
                    let width = to.map_or(f64::INFINITY, |to| to - from);
                    let [start, end] = span;
                    let inner = new(inner, [start + from, end + from + width], is_negated);
                    Self::Sliding(Box::new(inner), SlidingMinimum::new(start, *from, width))
                }
                Timed::While(condition, inner) => {
                    let condition = Self::Sign(Box::new(new(condition, span, !is_negated)));
                    let opposite = Self::Not(Box::new(new(inner, span, is_negated)));
                    Self::Not(Box::new(Self::Least(vec![waiting(condition), waiting(opposite)])))
                }
                // A requirement with one of them within a window is refused.
                Timed::Until(_, _, other) | Timed::When(_, other) => new(other, span, is_negated),
            },
        }
    }

    /// Returns bounds of the robustness while each comparison stays within a range; `None` if other times count as well.
    pub fn range(&self, ranges: &[[f64; 2]]) -> Option<[f64; 2]> {
        let sign = |value: f64| if value >= 0.0 { f64::INFINITY } else { f64::NEG_INFINITY };
        match self {
            Self::Leaf { source, .. } => Some(ranges[*source]),
            Self::Not(inner) => inner.range(ranges).map(|[low, high]| [-high, -low]),
            Self::Least(all) => all.iter().try_fold([f64::INFINITY; 2], |[low, high], (inner, _)| {
                let [own_low, own_high] = inner.range(ranges)?;
                Some([low.min(own_low), high.min(own_high)])
            }),
            Self::Sliding(..) => None,
            Self::Sign(inner) => inner.range(ranges).map(|range| range.map(sign)),
        }
    }

    /// Takes a part of the signals, and appends the robustness as far as it is known.
    pub fn push(&mut self, chunk: Chunk<'_>, into: &mut Vec<SignalPiece>) {
        match self {
            Self::Leaf { source, span: [start, end], is_negated, last } => match chunk {
                Chunk::Known(pieces) => {
                    let within =
                        pieces[*source].iter().filter(|piece| piece.to > *start && piece.from <= *end);
                    for piece in within {
                        let mut part = piece.part(piece.from.max(*start), piece.to);
                        part.restart();
                        into.push(part);
                    }
                    *last = pieces[*source].last().cloned().or(last.take());
                }
                Chunk::After(at, sign) => {
                    // The last instant belongs to the run.
                    let from = at.next_up().max(*start);
                    into.extend(last.take().filter(|_| *start <= at).map(|piece| piece.part(at, from)));
                    let value = if *is_negated { -sign } else { sign };
                    into.push(SignalPiece::constant(from, f64::INFINITY, value));
                }
            },
            Self::Not(inner) => {
                let first = into.len();
                inner.push(chunk, into);
                for piece in &mut into[first..] {
                    *piece = piece.clone().scaled(-1.0, 0.0);
                }
            }
            Self::Least(all) => {
                for (inner, waiting) in all.iter_mut() {
                    let mut new = Vec::new();
                    inner.push(chunk, &mut new);
                    waiting.extend(new);
                }
                while let Some(pieces) = aligned(all.iter_mut().map(|(_, waiting)| waiting)) {
                    let mut least = vec![pieces[0].clone()];
                    for piece in &pieces[1..] {
                        let mut next = Vec::new();
                        for part in &least {
                            part.push_lesser(piece, part.from, part.to, &mut next);
                        }
                        least = next;
                    }
                    into.extend(least);
                }
            }
            Self::Sliding(inner, minimum) => {
                let mut new = Vec::new();
                inner.push(chunk, &mut new);
                for piece in &new {
                    minimum.push(piece, into);
                }
                if matches!(chunk, Chunk::After(..)) {
                    minimum.finish(into);
                }
            }
            Self::Sign(inner) => {
                let mut new = Vec::new();
                inner.push(chunk, &mut new);
                for piece in &new {
                    piece.push_signs(into);
                }
            }
        }
    }
}

/// Removes the next part that all queues have, cut to one length; `None` if one of them is empty.
pub(super) fn aligned<'a>(
    queues: impl Iterator<Item = &'a mut VecDeque<SignalPiece>>,
) -> Option<Vec<SignalPiece>> {
    let mut queues: Vec<&mut VecDeque<SignalPiece>> = queues.collect();
    let ends = queues.iter().map(|queue| queue.front().map(|piece| [piece.from, piece.to]));
    let ends = ends.collect::<Option<Vec<[f64; 2]>>>()?;
    let from = ends.iter().map(|[from, _]| *from).fold(f64::NEG_INFINITY, f64::max);
    let to = ends.iter().map(|[_, to]| *to).fold(f64::INFINITY, f64::min);
    let mut parts = Vec::new();
    for queue in &mut queues {
        let front = queue.front_mut()?;
        parts.push(front.part(from, to));
        if front.to <= to {
            queue.pop_front();
        } else {
            front.from = to;
        }
    }
    Some(parts)
}
