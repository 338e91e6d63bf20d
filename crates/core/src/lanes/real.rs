//! The arithmetic that one run and many in lanes share: IEEE's operations, comparisons and selects, nothing else.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// A number, or several side by side.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// What a comparison tells.
    type Mask: Copy + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask> + Not<Output = Self::Mask>;

    /// A constant, as many times as there are lanes here.
    fn splat(self, value: f64) -> Self;
    /// Whether it is less.
    fn lt(self, other: Self) -> Self::Mask;
    /// Whether it is less or the same.
    fn le(self, other: Self) -> Self::Mask;
    /// One or the other.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Whether it holds in any lane.
    fn any(mask: Self::Mask) -> bool;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
}

#[allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
impl Real for f64 {
    type Mask = bool;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self <= other
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn any(mask: bool) -> bool {
        mask
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self::abs(self)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }
}
