//! Robustness at one instant, for which a running least value suffices.

use std::collections::VecDeque;

use flexsc_numerics::signal::{SignalPiece, Witnessed};

use super::Chunk;
use super::signal::{RobustnessSignal, aligned};
use crate::operation::{Expression, TimeWindow, Timed};

/// Robustness of an expression at an instant.
#[derive(Clone, Debug)]
pub(super) enum PointRobustness {
    /// Least value of a signal between two times (s), both included.
    Least {
        /// Signal.
        inner: RobustnessSignal,
        /// Start and end (s).
        span: [f64; 2],
        /// Least value of what is known.
        least: Witnessed,
        /// True once the signal is known up to the end.
        is_known: bool,
    },
    /// Opposite.
    Not(Box<PointRobustness>),
    /// Least of all.
    All(Vec<PointRobustness>),
    /// Value of `until`.
    Until(Box<UntilRobustness>),
    /// Least value at the instants of an event.
    When(Box<EventRobustness>),
}

/// Largest value of the least of one signal at a time and another one up to then.
#[derive(Clone, Debug)]
pub(super) struct UntilRobustness {
    held: (RobustnessSignal, VecDeque<SignalPiece>),
    reached: (RobustnessSignal, VecDeque<SignalPiece>),
    /// Start and end of the window (s).
    span: [f64; 2],
    /// Least known value of the first signal, and the largest value of `until`, negative.
    least: Witnessed,
    opposite: Witnessed,
    is_known: bool,
}

/// Least value of an expression at the instants at which an event occurs.
#[derive(Clone, Debug)]
pub(super) struct EventRobustness {
    event: RobustnessSignal,
    is_on: bool,
    then: Expression,
    /// Number of the first comparison of `then`.
    source: usize,
    /// End of the run (s).
    end: f64,
    /// Values that are not yet known, and the least one of the others.
    open: Vec<PointRobustness>,
    least: Witnessed,
}

/// Value of nothing: larger than all.
const NONE: Witnessed = Witnessed { value: f64::INFINITY, at: f64::NAN };

impl PointRobustness {
    /// Creates the robustness at an instant of a run with an end (s); `source` is the number of its first comparison, and then
    /// that after its last one.
    pub fn new(expression: &Expression, at: [f64; 2], source: &mut usize) -> Self {
        Self::signed(expression, at, false, source)
    }

    fn signed(expression: &Expression, [at, end]: [f64; 2], is_negated: bool, source: &mut usize) -> Self {
        let span = |window: &TimeWindow| {
            let from = at + window.from;
            [from, window.to.map_or(end, |to| at + to).max(from)]
        };
        let least = |inner: &Expression, span, source: &mut usize| Self::Least {
            inner: RobustnessSignal::new(inner, span, is_negated, source),
            span,
            least: NONE,
            is_known: false,
        };
        let mut new = |inner: &Expression, negated| Self::signed(inner, [at, end], negated, source);
        match expression {
            Expression::Compared { .. } | Expression::Flag(_) => least(expression, [at, at], source),
            Expression::Not(inner) => Self::Not(Box::new(new(inner, !is_negated))),
            Expression::All(all) => Self::All(all.iter().map(|inner| new(inner, is_negated)).collect()),
            Expression::Any(any) => {
                let opposite = |inner| Self::Not(Box::new(new(inner, is_negated)));
                Self::Not(Box::new(Self::All(any.iter().map(opposite).collect())))
            }
            Expression::Timed(timed) => match &**timed {
                Timed::Always(window, inner) => least(inner, span(window), source),
                Timed::While(..) => least(expression, [at, at], source),
                Timed::Until(held, window, reached) => {
                    let span = span(window);
                    let mut signal = |inner, from| {
                        (RobustnessSignal::new(inner, [from, span[1]], is_negated, source), VecDeque::new())
                    };
                    let (held, reached) = (signal(held, at), signal(reached, at));
                    Self::Until(Box::new(UntilRobustness {
                        held,
                        reached,
                        span,
                        least: NONE,
                        opposite: NONE,
                        is_known: false,
                    }))
                }
                Timed::When(event, then) => {
                    let event = RobustnessSignal::Sign(Box::new(RobustnessSignal::new(
                        event,
                        [at, f64::INFINITY],
                        false,
                        source,
                    )));
                    let first = *source;
                    *source += then.leaves().len();
                    Self::When(Box::new(EventRobustness {
                        event,
                        is_on: false,
                        then: then.clone(),
                        source: first,
                        end,
                        open: Vec::new(),
                        least: NONE,
                    }))
                }
            },
        }
    }

    /// Takes a part of the signals.
    pub fn push(&mut self, chunk: Chunk<'_>) {
        match self {
            Self::Least { inner, span: [from, to], least, is_known } => {
                if *is_known {
                    return;
                }
                let mut pieces = Vec::new();
                inner.push(chunk, &mut pieces);
                for piece in pieces.iter().filter(|piece| piece.to > *from && piece.from <= *to) {
                    let [from, last] = [piece.from.max(*from), piece.to.min(*to)];
                    *least = piece.lowest(from, last, least.value).unwrap_or(*least);
                }
                *is_known = pieces.last().is_some_and(|piece| piece.to > *to);
            }
            Self::Not(inner) => inner.push(chunk),
            Self::All(all) => all.iter_mut().for_each(|inner| inner.push(chunk)),
            Self::Until(until) => until.push(chunk),
            Self::When(when) => when.push(chunk),
        }
    }

    /// Returns true for the least value of a signal up to the end of the run (s).
    fn lasts_to(&self, end: f64) -> bool {
        matches!(self, Self::Least { span, .. } if span[1] >= end)
    }

    /// Returns true if no later part changes the value.
    fn is_known(&self) -> bool {
        match self {
            Self::Least { is_known, .. } => *is_known,
            Self::Not(inner) => inner.is_known(),
            Self::All(all) => all.iter().all(Self::is_known),
            Self::Until(until) => until.is_known,
            Self::When(_) => false,
        }
    }

    /// Returns true if a part of the run up to `to` (s) cannot change the value while each comparison stays within a range.
    pub fn ignores(&self, to: f64, ranges: &[[f64; 2]]) -> bool {
        match self {
            Self::Least { inner, span, least, is_known } => {
                *is_known || to <= span[0] || inner.range(ranges).is_some_and(|[low, _]| low >= least.value)
            }
            Self::Not(inner) => inner.ignores(to, ranges),
            Self::All(all) => all.iter().all(|inner| inner.ignores(to, ranges)),
            Self::Until(until) => until.is_known,
            Self::When(when) => {
                let stays = |[low, high]: [f64; 2]| low == high && (low > 0.0) == when.is_on;
                when.event.range(ranges).is_some_and(stays)
                    && when.open.iter().all(|open| open.ignores(to, ranges))
            }
        }
    }

    /// Returns the value, of what is known.
    pub fn value(&self) -> Witnessed {
        match self {
            Self::Least { least, .. } => *least,
            Self::Not(inner) => opposite(inner.value()),
            Self::All(all) => all.iter().map(Self::value).fold(NONE, lesser),
            Self::Until(until) => opposite(until.opposite),
            Self::When(when) => when.open.iter().map(Self::value).fold(when.least, lesser),
        }
    }
}

impl UntilRobustness {
    fn push(&mut self, chunk: Chunk<'_>) {
        if self.is_known {
            return;
        }
        for (signal, waiting) in [&mut self.held, &mut self.reached] {
            let mut new = Vec::new();
            signal.push(chunk, &mut new);
            waiting.extend(new);
        }
        while let Some(pair) = aligned([&mut self.held.1, &mut self.reached.1].into_iter()) {
            let (mut parts, reached) = (Vec::new(), &pair[1]);
            pair[0].push_monotone(&mut parts);
            for held in parts {
                self.add(&held, reached);
            }
            self.is_known = pair[0].to > self.span[1];
        }
    }

    /// Takes a part on which the first signal only rises or falls.
    fn add(&mut self, held: &SignalPiece, reached: &SignalPiece) {
        let before = lesser(self.least, held.at(held.from));
        let [from, to] = self.span;
        if held.from <= to && held.to > from {
            // The least known value: that before, or the signal itself where it falls below.
            let mut lowest = Vec::new();
            held.push_lesser(&before.piece(held.from, held.to), held.from, held.to, &mut lowest);
            let mut both = Vec::new();
            for part in &lowest {
                part.push_lesser(reached, part.from, part.to, &mut both);
            }
            for part in both.iter().filter(|part| part.to > from && part.from <= to) {
                let negative = part.clone().scaled(-1.0, 0.0);
                let [from, to] = [part.from.max(from), part.to.min(to)];
                self.opposite = negative.lowest(from, to, self.opposite.value).unwrap_or(self.opposite);
            }
        }
        self.least = if held.to.is_finite() { lesser(before, held.at(held.to)) } else { before };
    }
}

impl EventRobustness {
    fn push(&mut self, chunk: Chunk<'_>) {
        for open in &mut self.open {
            open.push(chunk);
        }
        if let Chunk::Known(_) = chunk {
            let mut signs = Vec::new();
            self.event.push(chunk, &mut signs);
            for sign in signs {
                let is_on = sign.at(sign.from).value > 0.0;
                if is_on && !self.is_on {
                    let mut open =
                        PointRobustness::new(&self.then, [sign.from, self.end], &mut self.source.clone());
                    open.push(chunk);
                    // To the end of the run, `always` after the first event is the least, `eventually` after the last one.
                    let is_always = |own: &PointRobustness| own.lasts_to(self.end);
                    let is_eventually = |own: &PointRobustness| matches!(own, PointRobustness::Not(inner) if inner.lasts_to(self.end));
                    if is_eventually(&open) {
                        self.open.retain(|own| !is_eventually(own));
                    }
                    if !(is_always(&open) && self.open.iter().any(is_always)) {
                        self.open.push(open);
                    }
                }
                self.is_on = is_on;
            }
        }
        let (known, open): (Vec<_>, Vec<_>) =
            std::mem::take(&mut self.open).into_iter().partition(PointRobustness::is_known);
        self.least = known.iter().map(PointRobustness::value).fold(self.least, lesser);
        self.open = open;
    }
}

fn lesser(one: Witnessed, other: Witnessed) -> Witnessed {
    if other.value < one.value { other } else { one }
}

fn opposite(of: Witnessed) -> Witnessed {
    Witnessed { value: -of.value, ..of }
}
