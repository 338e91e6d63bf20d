//! Piece of a signal: a constant or a part of a polynomial.

use std::sync::Arc;

use crate::polynomial::Polynomial;

/// Part of a value by which rounding of a time may change one that is equal.
const TIE: f64 = 1e-12;
/// Number of straight lines that follow a curve between two turns.
const PARTS: u32 = 4;

/// Polynomial over a part of the time.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Start of the part (s).
    pub begin: f64,
    /// Length of the part (s).
    pub length: f64,
    /// Values, in the elapsed fraction of the part.
    pub polynomial: Polynomial,
}

/// Values of a piece.
#[derive(Clone, Debug, PartialEq)]
pub enum PieceValues {
    /// Constant, and the time (s) at which the signal that is observed has it.
    Constant {
        /// Value.
        value: f64,
        /// Time (s).
        at: f64,
    },
    /// Multiple of a curve plus an offset.
    Curve {
        /// Curve.
        curve: Arc<Curve>,
        /// Factor.
        gain: f64,
        /// Offset.
        offset: f64,
        /// Time (s) by which the curve is read ahead.
        ahead: f64,
    },
}

/// Piece of a signal from one time to another (s).
#[derive(Clone, Debug, PartialEq)]
pub struct SignalPiece {
    /// Start (s).
    pub from: f64,
    /// End (s), which is not part of the piece.
    pub to: f64,
    /// Values.
    pub shape: PieceValues,
}

/// Value with its origin.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Witnessed {
    /// Value.
    pub value: f64,
    /// Time (s) at which the observed signal has it.
    pub at: f64,
}

impl Witnessed {
    /// Returns the value as a piece between two times (s).
    pub fn piece(&self, from: f64, to: f64) -> SignalPiece {
        SignalPiece { from, to, shape: PieceValues::Constant { value: self.value, at: self.at } }
    }
}

impl SignalPiece {
    /// Creates a constant piece of an observed signal.
    pub fn constant(from: f64, to: f64, value: f64) -> Self {
        Self { from, to, shape: PieceValues::Constant { value, at: from } }
    }

    /// Returns the value at a time, its end included, with the time at which the observed signal has it.
    pub fn at(&self, t: f64) -> Witnessed {
        let (value, at) = match &self.shape {
            PieceValues::Constant { value, at } => (*value, *at),
            PieceValues::Curve { curve, gain, offset, ahead } => {
                let s = (t + ahead - curve.begin) / curve.length;
                (offset + gain * curve.polynomial.at(s), t + ahead)
            }
        };
        Witnessed { value, at }
    }

    /// Returns `factor` times the piece plus `shift`.
    #[must_use]
    pub fn scaled(mut self, factor: f64, shift: f64) -> Self {
        match &mut self.shape {
            PieceValues::Constant { value, .. } => *value = shift + factor * *value,
            PieceValues::Curve { gain, offset, .. } => {
                (*gain, *offset) = (factor * *gain, shift + factor * *offset);
            }
        }
        self
    }

    /// Returns the part between two times (s), moved to times that are `lead` seconds earlier.
    #[must_use]
    pub fn part_earlier(&self, from: f64, to: f64, lead: f64) -> Self {
        let mut part = self.part(from - lead, to - lead);
        if let PieceValues::Curve { ahead, .. } = &mut part.shape {
            *ahead += lead;
        }
        part
    }

    /// Returns the part between two times (s).
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Self {
        Self { from, to, ..self.clone() }
    }

    /// Makes the start of the piece the time at which the observed signal has the value of a constant.
    pub fn restart(&mut self) {
        if let PieceValues::Constant { at, .. } = &mut self.shape {
            *at = self.from;
        }
    }

    /// Returns lower and upper bounds of the values.
    pub fn bounds(&self) -> (f64, f64) {
        match &self.shape {
            PieceValues::Constant { value, .. } => (*value, *value),
            PieceValues::Curve { curve, gain, offset, .. } => {
                let (low, high) = curve.polynomial.bounds();
                let [one, other] = [offset + gain * low, offset + gain * high];
                (one.min(other), one.max(other))
            }
        }
    }

    /// Returns the values between two times as a polynomial in the elapsed fraction; `None` of a constant.
    fn polynomial(&self, from: f64, to: f64) -> Option<Polynomial> {
        let PieceValues::Curve { curve, gain, offset, ahead } = &self.shape else { return None };
        let s = |t: f64| (t + ahead - curve.begin) / curve.length;
        let (first, last) = (s(from), s(to));
        let part = if (first, last) == (0.0, 1.0) {
            curve.polynomial
        } else {
            curve.polynomial.restrict(first, last)
        };
        Some(part.scaled(*gain).minus_line(-offset, 0.0))
    }

    /// Returns the least value between two times (s), both included, if it is below `most`. Of values that differ by rounding
    /// alone, the first counts; a value that the observed signal has after `to`, within a window, counts before one at the edge.
    pub fn lowest(&self, from: f64, to: f64, most: f64) -> Option<Witnessed> {
        let tie = if most.is_finite() { TIE * most.abs() } else { 0.0 };
        let PieceValues::Curve { ahead, .. } = &self.shape else {
            let own = self.at(from);
            let is_turn = own.at > to && own.value <= most + tie;
            return (own.value < most - tie || is_turn).then_some(Witnessed { at: own.at.max(from), ..own });
        };
        if self.bounds().0 >= most - tie {
            return None;
        }
        let (depth, s) = self.polynomial(from, to)?.negative().peak(tie - most)?;
        Some(Witnessed { value: -depth, at: from + (to - from) * s + ahead })
    }

    /// Appends the parts of the piece on which it only rises or only falls.
    pub fn push_monotone(&self, into: &mut Vec<Self>) {
        let mut turns = Vec::new();
        if let Some(whole) = self.polynomial(self.from, self.to) {
            whole.derivative().roots(0.0, &mut turns);
        }
        self.push_parts(&turns, |part| part, into);
    }

    /// Appends the absolute values of the piece.
    pub fn push_magnitude(&self, into: &mut Vec<Self>) {
        let magnitude = |part: Self| {
            let is_negative = part.at(0.5 * (part.from + part.to)).value < 0.0;
            if is_negative { part.scaled(-1.0, 0.0) } else { part }
        };
        self.push_parts(&self.zeros(), magnitude, into);
    }

    /// Appends the signs of the piece: infinities, the positive one where the value is 0 or more.
    pub fn push_signs(&self, into: &mut Vec<Self>) {
        let sign = |part: Self| {
            let is_positive = part.at(0.5 * (part.from + part.to.min(f64::MAX))).value >= 0.0;
            let value = if is_positive { f64::INFINITY } else { f64::NEG_INFINITY };
            Self::constant(part.from, part.to, value)
        };
        self.push_parts(&self.zeros(), sign, into);
    }

    /// Appends points through which straight lines follow the piece: its ends, and of a curve parts of equal length and turns.
    pub fn push_points(&self, into: &mut Vec<(f64, f64)>) {
        let mut push = |at: f64| {
            let point = (at, self.at(at).value);
            match into[..] {
                // A constant goes on.
                [.., (_, before), (last, value)] if before == value && value == point.1 && last <= at => {
                    into.pop();
                }
                _ => {}
            }
            if into.last() != Some(&point) {
                into.push(point);
            }
        };
        if let PieceValues::Constant { .. } = self.shape {
            push(self.from);
            push(self.to);
            return;
        }
        let mut parts = Vec::new();
        self.push_monotone(&mut parts);
        for Self { from, to, .. } in parts {
            (0..PARTS).for_each(|part| push(from + (to - from) * f64::from(part) / f64::from(PARTS)));
            push(to);
        }
    }

    /// Returns the points of the elapsed fraction at which the piece changes its sign; none of a constant.
    fn zeros(&self) -> Vec<f64> {
        let mut zeros = Vec::new();
        if let Some(whole) = self.polynomial(self.from, self.to) {
            whole.roots(0.0, &mut zeros);
        }
        zeros
    }

    /// Appends the parts of the piece between points of its elapsed fraction.
    fn push_parts(&self, points: &[f64], change: impl Fn(Self) -> Self, into: &mut Vec<Self>) {
        let mut from = self.from;
        for s in points {
            let at = self.from + (self.to - self.from) * s;
            if at > from && at < self.to {
                into.push(change(self.part(from, at)));
                from = at;
            }
        }
        into.push(change(self.part(from, self.to)));
    }

    /// Appends the lesser of two pieces between two times.
    pub fn push_lesser(&self, other: &Self, from: f64, to: f64, into: &mut Vec<Self>) {
        let ((low, high), (other_low, other_high)) = (self.bounds(), other.bounds());
        let mut crossings = Vec::new();
        if low <= other_high && other_low <= high {
            match (self.polynomial(from, to), other.polynomial(from, to)) {
                (Some(one), Some(two)) => one.minus(&two).roots(0.0, &mut crossings),
                (Some(one), None) if other_low.is_finite() => one.roots(other_low, &mut crossings),
                (None, Some(two)) if low.is_finite() => two.roots(low, &mut crossings),
                _ => {}
            }
        }
        crossings.push(1.0);
        let mut begin = from;
        for s in crossings {
            let at = if s == 1.0 { to } else { from + (to - from) * s };
            if at > begin {
                let middle = if at.is_finite() { 0.5 * (begin + at) } else { begin };
                let lesser = if other.at(middle).value < self.at(middle).value { other } else { self };
                push_joined(into, lesser.part(begin, at));
                begin = at;
            }
        }
    }

    /// True if the next piece has the values of this one.
    fn continues_as(&self, next: &Self) -> bool {
        match (&self.shape, &next.shape) {
            (PieceValues::Constant { value, .. }, PieceValues::Constant { value: other, .. }) => {
                value == other
            }
            (PieceValues::Curve { curve, .. }, PieceValues::Curve { curve: other, .. }) => {
                Arc::ptr_eq(curve, other) && self.shape == next.shape
            }
            _ => false,
        }
    }
}

/// Appends a piece, to the last one if it continues it.
fn push_joined(into: &mut Vec<SignalPiece>, piece: SignalPiece) {
    match into.last_mut() {
        Some(last) if last.to == piece.from && last.continues_as(&piece) => last.to = piece.to,
        _ => into.push(piece),
    }
}
