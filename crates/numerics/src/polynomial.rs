//! Polynomials on the interval from 0 to 1: extremes, roots and integrals, to rounding, without missing any.
//!
//! The sum of the coefficients of one sign bounds a polynomial on the interval. Intervals that the bounds cannot
//! decide are halved, until the polynomial or its derivative has one sign, or only rounding errors remain.

/// Number of coefficients of a polynomial.
pub const TERMS: usize = 22;
/// Taylor series: its coefficients, the constant first.
pub type Series = [f64; TERMS];

/// Number of halvings after which an interval is treated as a point.
const DEPTH: u32 = 48;
/// Rounding of a value, relative to the sum of the absolute coefficients.
pub const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Polynomial, the sum of `c[n] s^n`, for s from 0 to 1.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Polynomial([f64; TERMS]);

impl Polynomial {
    /// Creates a polynomial from its coefficients.
    pub fn new(terms: [f64; TERMS]) -> Self {
        Self(terms)
    }

    /// Creates the polynomial of a Taylor series in time, over the time from 0 to `length`.
    pub fn from_series(series: &Series, length: f64) -> Self {
        let mut power = 1.0;
        Self(series.map(|c| {
            let scaled = c * power;
            power *= length;
            scaled
        }))
    }

    /// Returns the value at s.
    pub fn at(&self, s: f64) -> f64 {
        self.0.iter().rev().fold(0.0, |sum, c| sum * s + c)
    }

    /// Returns the polynomial with the opposite sign.
    #[must_use]
    pub fn negative(&self) -> Self {
        Self(self.0.map(|c| -c))
    }

    /// Subtracts the straight line `start + slope s`.
    #[must_use]
    pub fn minus_line(&self, start: f64, slope: f64) -> Self {
        let mut less = *self;
        less.0[0] -= start;
        less.0[1] -= slope;
        less
    }

    /// Subtracts another polynomial.
    #[must_use]
    pub fn minus(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|n| self.0[n] - other.0[n]))
    }

    /// Multiplies the polynomial by a number.
    #[must_use]
    pub fn scaled(&self, by: f64) -> Self {
        Self(self.0.map(|c| c * by))
    }

    /// Returns the part between two points, mapped to the interval from 0 to 1.
    #[must_use]
    pub fn restrict(&self, from: f64, to: f64) -> Self {
        let mut part = self.0;
        for low in 0..TERMS {
            for n in (low..TERMS - 1).rev() {
                part[n] += from * part[n + 1];
            }
        }
        Self::from_series(&part, to - from)
    }

    /// Returns the largest value, or `floor` if that is larger.
    pub fn maximum(&self, floor: f64) -> f64 {
        self.peak(floor).map_or(floor, |(value, _)| value)
    }

    /// Returns the largest value and its point; `None` unless it is above `floor`.
    pub fn peak(&self, floor: f64) -> Option<(f64, f64)> {
        let mut best = (floor, f64::NAN);
        self.climb(&mut best, (0.0, 1.0), DEPTH);
        (!best.1.is_nan()).then_some(best)
    }

    /// Returns the largest absolute value, or `floor` if that is larger.
    pub fn magnitude(&self, floor: f64) -> f64 {
        self.negative().maximum(self.maximum(floor))
    }

    /// Appends to `roots` where the polynomial equals a level, in order. A pair of roots within rounding of a double
    /// root may be missing.
    pub fn roots(&self, level: f64, roots: &mut Vec<f64>) {
        let noise = ROUNDING * (self.size() + level.abs());
        let mut above = *self;
        above.0[0] -= level;
        above.find((0.0, 1.0), noise, roots, DEPTH);
    }

    /// Returns the integrals of the polynomial, and of s times it, over s between two points.
    pub fn integrals(&self, from: f64, to: f64) -> [f64; 2] {
        let (mut low, mut high) = (1.0, 1.0);
        let mut integrals = [0.0; 2];
        for (n, c) in self.0.iter().enumerate() {
            (low, high) = (low * from, high * to);
            integrals[0] += c * (high - low) / (n + 1) as f64;
            integrals[1] += c * (high * to - low * from) / (n + 2) as f64;
        }
        integrals
    }

    fn size(&self) -> f64 {
        self.0.iter().map(|c| c.abs()).sum()
    }

    /// Returns lower and upper bounds of the values.
    pub fn bounds(&self) -> (f64, f64) {
        let [first, rest @ ..] = &self.0;
        rest.iter().fold((*first, *first), |(low, high), c| (low + c.min(0.0), high + c.max(0.0)))
    }

    /// Returns the derivative.
    #[must_use]
    pub fn derivative(&self) -> Self {
        let mut derivative = [0.0; TERMS];
        for (n, c) in self.0.iter().enumerate().skip(1) {
            derivative[n - 1] = n as f64 * c;
        }
        Self(derivative)
    }

    /// Returns the first and the second half, each mapped to the interval from 0 to 1.
    fn halves(&self) -> [Self; 2] {
        let mut first = *self;
        let mut power = 1.0;
        for c in &mut first.0 {
            *c *= power;
            power *= 0.5;
        }
        let mut second = first;
        for low in 0..TERMS {
            for n in (low..TERMS - 1).rev() {
                second.0[n] += second.0[n + 1];
            }
        }
        [first, second]
    }

    /// Raises `best` to the largest value and its point, of this part between `ends` of the whole polynomial.
    fn climb(&self, best: &mut (f64, f64), ends: (f64, f64), depth: u32) {
        let (from, to) = ends;
        let mut raise = |value: f64, s: f64| {
            if value > best.0 {
                *best = (value, from + (to - from) * s);
            }
        };
        raise(self.0[0], 0.0);
        raise(self.at(1.0), 1.0);
        let size = self.size();
        if self.bounds().1 <= best.0 + ROUNDING * size || !size.is_finite() {
            return;
        }
        let slope = self.derivative();
        let (least, most) = slope.bounds();
        if least >= 0.0 || most <= 0.0 {
            return;
        }
        let (least, most) = slope.derivative().bounds();
        if most < 0.0 {
            if slope.0[0] > 0.0 && slope.at(1.0) < 0.0 {
                let s = slope.root();
                let value = self.at(s);
                if value > best.0 {
                    *best = (value, from + (to - from) * s);
                }
            }
        } else if least <= 0.0 && depth > 0 {
            let middle = 0.5 * (from + to);
            let [first, second] = self.halves();
            first.climb(best, (from, middle), depth - 1);
            second.climb(best, (middle, to), depth - 1);
        }
    }

    /// Appends the roots of this part, at the positions between `ends` of the whole polynomial.
    fn find(&self, ends: (f64, f64), noise: f64, roots: &mut Vec<f64>, depth: u32) {
        let (low, high) = self.bounds();
        let size = low.abs().max(high.abs());
        if low > 0.0 || high < 0.0 || size <= noise || !size.is_finite() || depth == 0 {
            return;
        }
        let (from, to) = ends;
        let (least, most) = self.derivative().bounds();
        if least > 0.0 || most < 0.0 {
            if self.0[0] * self.at(1.0) < 0.0 {
                roots.push(from + (to - from) * self.root());
            }
            return;
        }
        let middle = 0.5 * (from + to);
        let [first, second] = self.halves();
        first.find((from, middle), noise, roots, depth - 1);
        // A root exactly at the middle changes the sign of neither half.
        if second.0[0] == 0.0 {
            roots.push(middle);
        }
        second.find((middle, to), noise, roots, depth - 1);
    }

    /// Returns the root between 0 and 1 of a polynomial whose values there differ in sign: by Newton's method, and by
    /// halving where it leaves the bracket.
    fn root(&self) -> f64 {
        let slope = self.derivative();
        let (mut low, mut high) = (0.0, 1.0);
        let (start, end) = (self.0[0], self.at(1.0));
        let mut s = start / (start - end);
        for _ in 0..80 {
            let value = self.at(s);
            if (value > 0.0) == (start > 0.0) {
                low = s;
            } else {
                high = s;
            }
            let step = value / slope.at(s);
            let next = s - step;
            let next = if next >= low && next <= high { next } else { 0.5 * (low + high) };
            if next == s || high - low <= f64::EPSILON * high {
                break;
            }
            s = next;
        }
        s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polynomial(c: &[f64]) -> Polynomial {
        Polynomial(std::array::from_fn(|n| c.get(n).copied().unwrap_or(0.0)))
    }

    #[test]
    fn chebyshev_polynomials_have_all_their_crests_and_roots() {
        // Chebyshev T_9 on [0, 1], s = (1 + x)/2: nine roots, values of 1 at the crests.
        let (mut before, mut now) = (vec![1.0], vec![-1.0, 2.0]);
        for _ in 1..9 {
            let mut next = vec![0.0; now.len() + 1];
            for (n, c) in now.iter().enumerate() {
                next[n] -= 2.0 * c;
                next[n + 1] += 4.0 * c;
            }
            next.iter_mut().zip(&before).for_each(|(next, before)| *next -= before);
            (before, now) = (now, next);
        }
        let t9 = polynomial(&now);
        let mut roots = Vec::new();
        t9.roots(0.0, &mut roots);
        let exact = |k: i32| 0.5 - 0.5 * libm::cos((2.0 * f64::from(k) + 1.0) * std::f64::consts::PI / 18.0);
        assert_eq!(roots.len(), 9, "{roots:?}");
        for (k, root) in (0..9).zip(&roots) {
            assert!((root - exact(k)).abs() < 1e-10, "{root} {}", exact(k));
        }
        // The crests of 1 lie just above the level.
        roots.clear();
        t9.roots(0.999, &mut roots);
        assert_eq!(roots.len(), 9);
        assert!((t9.maximum(0.5) - 1.0).abs() < 1e-9 && (t9.magnitude(0.0) - 1.0).abs() < 1e-9);
        assert_eq!(t9.maximum(2.0), 2.0);
    }

    #[test]
    fn a_narrow_crest_between_two_valleys_is_found() {
        // Ends of -2e4 and -4e3, and a crest of 1e-6 at 0.7: 16 sample points would miss it.
        let s = 0.7;
        let p = polynomial(&[1e-6 - 4e4 * s * s, 8e4 * s, -4e4]);
        assert!((p.maximum(f64::NEG_INFINITY) - 1e-6).abs() < 1e-11);
        let mut roots = Vec::new();
        p.roots(0.0, &mut roots);
        assert_eq!(roots.len(), 2);
        let half = f64::sqrt(1e-6 / 4e4);
        assert!((roots[0] - (s - half)).abs() < 1e-9 && (roots[1] - (s + half)).abs() < 1e-9);
    }

    #[test]
    fn what_is_flat_ends() {
        for flat in [polynomial(&[]), polynomial(&[3.0]), polynomial(&[3.0, 1e-17, -1e-17, 1e-18])] {
            let mut roots = Vec::new();
            flat.roots(flat.at(0.0), &mut roots);
            assert!(roots.is_empty());
            assert_eq!(flat.maximum(f64::NEG_INFINITY), flat.at(0.0));
        }
        assert!(polynomial(&[f64::NAN, 1.0]).maximum(0.0) >= 0.0);
    }

    #[test]
    fn a_part_is_the_same_polynomial() {
        let p = polynomial(&[1.0, -2.0, 3.0, 0.25]);
        let part = p.restrict(0.25, 0.75).minus_line(1.0, 2.0);
        for s in [0.0, 0.3, 1.0] {
            assert!((part.at(s) + 1.0 + 2.0 * s - p.at(0.25 + 0.5 * s)).abs() < 1e-15);
        }
    }

    #[test]
    fn integrals_are_those_of_the_powers() {
        let p = polynomial(&[1.0, -2.0, 3.0]);
        // Exact integrals: s - s² + s³ and s²/2 - 2 s³/3 + 3 s⁴/4.
        let [plain, weighted] = p.integrals(0.5, 1.0);
        assert!((plain - (1.0 - 0.375)).abs() < 1e-15);
        assert!((weighted - (7.0 / 12.0 - (0.125 - 1.0 / 12.0 + 3.0 / 64.0))).abs() < 1e-15);
    }
}
