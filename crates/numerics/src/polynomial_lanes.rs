//! Polynomials on the interval from 0 to 1 in SIMD lanes: results that follow from bounds, for all of them at once.

use super::polynomial::{Polynomial, ROUNDING, TERMS};
use crate::lanes::LaneFloat;

/// Polynomial per lane, with bounds.
#[derive(Copy, Clone, Debug)]
pub struct Polynomials<R> {
    terms: [R; TERMS],
    low: R,
    high: R,
    size: R,
    end: R,
}

impl<R: LaneFloat> Polynomials<R> {
    /// Creates the polynomials of Taylor series in time, each over the time from 0 to its length, with their bounds.
    #[inline(always)]
    pub fn new(series: &[R; TERMS], length: R) -> Self {
        let mut terms = *series;
        let mut power = length.splat(1.0);
        for n in 0..TERMS {
            terms[n] = terms[n] * power;
            power = power * length;
        }
        let zero = length.splat(0.0);
        let (mut low, mut high, mut size) = (terms[0], terms[0], terms[0].abs());
        for n in 1..TERMS {
            low = low + terms[n].min(zero);
            high = high + terms[n].max(zero);
            size = size + terms[n].abs();
        }
        let mut end = zero;
        for n in (0..TERMS).rev() {
            end = end + terms[n];
        }
        Self { terms, low, high, size, end }
    }

    /// Returns lower and upper bounds of the values.
    #[inline(always)]
    pub fn bounds(&self) -> (R, R) {
        (self.low, self.high)
    }

    /// Returns the values at s.
    #[inline(always)]
    pub fn at(&self, s: f64) -> R {
        let mut sum = self.low.splat(0.0);
        for n in (0..TERMS).rev() {
            sum = sum * s + self.terms[n];
        }
        sum
    }

    /// Returns the largest absolute values, or `floor` if that is larger, and the lanes in which they are certain.
    #[inline(always)]
    pub fn magnitude(&self, floor: R) -> (R, R::Mask) {
        let slack = self.size * ROUNDING;
        let best = self.end.max(self.terms[0].max(floor));
        let above = self.high.le(best + slack);
        let best = (-self.end).max((-self.terms[0]).max(best));
        (best, above & (-self.low).le(best + slack))
    }

    /// Returns the integrals of the polynomials, and of s times them, over the whole interval.
    #[inline(always)]
    pub fn integrals(&self) -> [R; 2] {
        let zero = self.low.splat(0.0);
        let mut integrals = [zero, zero];
        for n in 0..TERMS {
            integrals[0] = integrals[0] + self.terms[n] / zero.splat((n + 1) as f64);
            integrals[1] = integrals[1] + self.terms[n] / zero.splat((n + 2) as f64);
        }
        integrals
    }

    /// Returns the polynomial in a lane.
    pub fn lane(&self, lane: usize) -> Polynomial {
        let mut terms = [0.0; TERMS];
        for n in 0..TERMS {
            terms[n] = self.terms[n].lane(lane);
        }
        Polynomial::new(terms)
    }
}
