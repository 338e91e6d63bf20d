//! Enclosure of a real number between two doubles: sums and products are rounded outwards, so that they contain every
//! exact result.
//!
//! Sums, products, quotients and roots are rounded correctly by the processor, so the next double outwards is a bound.
//! Exponentials and sines of libm have an error below one unit in the last place; their bounds are two doubles
//! outwards.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::{Add, Mul, Neg, Sub};

/// Phase (rad) by which an extremum of a sine may be missed, and is assumed to be within.
const PHASE_SLACK: f64 = 1e-9;

/// Interval that contains a real number.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Enclosure {
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl Enclosure {
    /// Creates the enclosure of a double itself.
    pub const fn exact(value: f64) -> Self {
        Self { low: value, high: value }
    }

    /// Creates an enclosure from its bounds, low first.
    pub const fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// Returns the enclosure one double wider on both sides.
    #[must_use]
    pub const fn widened(self) -> Self {
        Self { low: self.low.next_down(), high: self.high.next_up() }
    }

    /// Returns the largest magnitude.
    pub const fn magnitude(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Returns the quotient by positive numbers.
    #[must_use]
    pub fn over_positive(self, divisor: Self) -> Self {
        let low = if self.low < 0.0 { self.low / divisor.low } else { self.low / divisor.high };
        let high = if self.high < 0.0 { self.high / divisor.high } else { self.high / divisor.low };
        Self { low, high }.widened()
    }

    /// Returns the square root of numbers of 0 or more.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let Self { low, high } = Self { low: self.low.max(0.0).sqrt(), high: self.high.sqrt() }.widened();
        Self { low: low.max(0.0), high }
    }

    /// Returns the exponential.
    #[must_use]
    pub fn exp(self) -> Self {
        let Self { low, high } =
            Self { low: libm::exp(self.low), high: libm::exp(self.high) }.widened().widened();
        Self { low: low.max(0.0), high }
    }

    /// Returns the arc sine of numbers between -1 and 1.
    #[must_use]
    pub fn asin(self) -> Self {
        Self { low: libm::asin(self.low), high: libm::asin(self.high) }.widened().widened()
    }

    /// Returns the sine of phases (rad) below 1e9.
    #[must_use]
    pub fn sin(self) -> Self {
        let (low, high) = (libm::sin(self.low), libm::sin(self.high));
        let ends = Self { low: low.min(high), high: low.max(high) }.widened().widened();
        Self {
            low: if self.contains_phase(-FRAC_PI_2) { -1.0 } else { ends.low.max(-1.0) },
            high: if self.contains_phase(FRAC_PI_2) { 1.0 } else { ends.high.min(1.0) },
        }
    }

    /// Returns the cosine of phases (rad) below 1e9.
    #[must_use]
    pub fn cos(self) -> Self {
        let (low, high) = (libm::cos(self.low), libm::cos(self.high));
        let ends = Self { low: low.min(high), high: low.max(high) }.widened().widened();
        Self {
            low: if self.contains_phase(PI) { -1.0 } else { ends.low.max(-1.0) },
            high: if self.contains_phase(0.0) { 1.0 } else { ends.high.min(1.0) },
        }
    }

    /// Returns true if a phase, or one that differs from it by whole turns, may be within.
    fn contains_phase(self, phase: f64) -> bool {
        let first = ((self.low - phase - PHASE_SLACK) / TAU).ceil();
        first * TAU + phase <= self.high + PHASE_SLACK
    }
}

impl Add for Enclosure {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { low: self.low + other.low, high: self.high + other.high }.widened()
    }
}

impl Sub for Enclosure {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Enclosure {
    type Output = Self;

    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl Mul for Enclosure {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let products =
            [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        let low = products.iter().fold(f64::INFINITY, |least, product| least.min(*product));
        let high = products.iter().fold(f64::NEG_INFINITY, |most, product| most.max(*product));
        Self { low, high }.widened()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Asserts that an enclosure contains a number and is wider than it by at most 1e-15 of 1.
    fn encloses(found: Enclosure, value: f64) {
        assert!(found.low < value && value < found.high, "{found:?} of {value:e}");
        assert!(found.high - found.low < 2e-15, "{found:?}");
    }

    #[test]
    fn elementary_functions_contain_their_values() {
        let tenth = Enclosure::exact(0.1);
        encloses(tenth.sin(), 0.099_833_416_646_828_15);
        encloses(tenth.cos(), 0.995_004_165_278_025_8);
        encloses(tenth.exp(), 1.105_170_918_075_647_7);
        encloses(tenth.asin(), 0.100_167_421_161_559_8);
        encloses(tenth.sqrt(), 0.316_227_766_016_837_94);
        // Of the doubles nearest to 0.1, 0.2 and 0.3, by rational numbers.
        encloses(tenth * tenth, 0.010_000_000_000_000_002);
        encloses(tenth + Enclosure::exact(0.2), 0.300_000_000_000_000_04);
        encloses(tenth.over_positive(Enclosure::exact(0.3)), 0.333_333_333_333_333_37);
    }

    #[test]
    fn a_sine_reaches_the_extrema_within() {
        let sine = Enclosure::new(1.0, 2.0).sin();
        assert_eq!(sine.high, 1.0);
        encloses(
            Enclosure::new(sine.low, sine.low.next_up().next_up().next_up().next_up()),
            0.841_470_984_807_896_5,
        );
        assert_eq!(Enclosure::new(4.0, 5.0).sin().low, -1.0);
        assert_eq!(Enclosure::new(100.0, 107.0).sin(), Enclosure::new(-1.0, 1.0));
        assert_eq!(Enclosure::new(6.0, 6.5).cos().high, 1.0);
        assert!(Enclosure::new(0.1, 0.2).cos().high < 0.9951);
        assert_eq!(Enclosure::new(-4.0, -3.0).cos().low, -1.0);
    }

    #[test]
    fn products_have_their_extrema_at_corners() {
        let found = Enclosure::new(-2.0, 3.0) * Enclosure::new(-5.0, 1.0);
        assert!(found.low < -15.0 && found.low > -15.1 && found.high > 10.0 && found.high < 10.1);
        let found = Enclosure::new(-2.0, 3.0).over_positive(Enclosure::new(0.5, 4.0));
        assert!(found.low < -4.0 && found.low > -4.1 && found.high > 6.0 && found.high < 6.1);
    }
}
