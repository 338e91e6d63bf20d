//! Operations of the engine's kernels on single numbers or SIMD lanes.

use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Constant 1.5 * 2^52: adding it to a number removes the fraction.
pub(super) const WHOLE: f64 = 6_755_399_441_055_744.0;

/// Floating-point number, or one number per lane. A plain `f64`, shared by all lanes, may stand on the right of an
/// operator.
pub trait LaneFloat:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// Boolean per lane.
    type Mask: Mask;
    /// Number of lanes.
    const LANES: usize;

    /// Returns the same number in every lane; `self` only determines the type.
    #[must_use]
    fn splat(self, value: f64) -> Self;

    /// Loads numbers from the beginning of a slice, one per lane; `self` only determines the type.
    ///
    /// # Panics
    /// If the slice is shorter than the lanes.
    #[must_use]
    fn load(self, from: &[f64]) -> Self;

    /// Writes the lanes to the beginning of a slice.
    ///
    /// # Panics
    /// If the slice is shorter than the lanes.
    fn store(self, to: &mut [f64]);

    /// Returns the square root.
    #[must_use]
    fn sqrt(self) -> Self;

    /// Returns the absolute value.
    #[must_use]
    fn abs(self) -> Self;

    /// Returns the lanes in which `self < other`; false for NaN.
    fn lt(self, other: Self) -> Self::Mask;

    /// Returns the lanes in which `self <= other`; false for NaN.
    fn le(self, other: Self) -> Self::Mask;

    /// Returns `yes` in the lanes where the mask is set, and `no` in the others.
    #[must_use]
    fn select(mask: Self::Mask, chosen: Self, otherwise: Self) -> Self;

    /// Returns the nearest integer (ties to even), whether it is odd, and whether its second binary digit is 1; these
    /// distinguish quarter turns. Valid below 2^51 in absolute value.
    fn quadrant(self) -> (Self, Self::Mask, Self::Mask);

    /// Runs a task as a separate function, for code that is too long to be inlined.
    fn run_outlined<W: SimdTask>(self, work: W) -> W::Output;

    /// Returns the lanes in which `self > other`; false for NaN.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }

    /// Returns the lanes in which `self >= other`; false for NaN.
    #[inline(always)]
    fn ge(self, other: Self) -> Self::Mask {
        other.le(self)
    }

    /// Returns the lane-wise minimum with the semantics of x86 `minpd`: `other` if either is NaN or both are zero.
    #[inline(always)]
    #[must_use]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }

    /// Returns the lane-wise maximum with the semantics of x86 `maxpd`: `other` if either is NaN or both are zero.
    #[inline(always)]
    #[must_use]
    fn max(self, other: Self) -> Self {
        Self::select(other.lt(self), self, other)
    }

    /// Returns the nearest integer (ties to even). Valid below 2^51 in absolute value.
    #[inline(always)]
    #[must_use]
    fn round(self) -> Self {
        self.quadrant().0
    }

    /// Returns the number in a lane.
    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        let mut all = [0.0; 16];
        self.store(&mut all);
        all[..Self::LANES][lane]
    }

    /// Replaces the number in one lane.
    #[inline(always)]
    #[must_use]
    fn with_lane(self, lane: usize, value: f64) -> Self {
        let mut all = [0.0; 16];
        self.store(&mut all);
        all[..Self::LANES][lane] = value;
        self.load(&all)
    }
}

/// Boolean, or one boolean per lane.
pub trait Mask: Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Returns true if any lane is true.
    fn any(self) -> bool;

    /// Returns true if every lane is true.
    #[inline(always)]
    fn all(self) -> bool {
        !(!self).any()
    }
}

/// Task that is generic over the number type, to be compiled for each instruction set.
pub trait SimdTask {
    /// Result of the task.
    type Output;

    /// Runs the task; `kind` is any number of the type, NaN for a single one. Implementations must be
    /// `#[inline(always)]`.
    fn run<R: LaneFloat>(self, kind: R) -> Self::Output;
}

impl LaneFloat for f64 {
    type Mask = bool;
    const LANES: usize = 1;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn load(self, from: &[f64]) -> Self {
        from[0]
    }

    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        to[0] = self;
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // Correctly rounded by IEEE 754 on every processor.
        f64::sqrt(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
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
    fn select(mask: bool, chosen: Self, otherwise: Self) -> Self {
        if mask { chosen } else { otherwise }
    }

    #[inline(always)]
    fn quadrant(self) -> (Self, bool, bool) {
        let shifted = self + WHOLE;
        let digits = shifted.to_bits();
        (shifted - WHOLE, digits & 1 != 0, digits & 2 != 0)
    }

    #[inline(never)]
    fn run_outlined<W: SimdTask>(self, work: W) -> W::Output {
        work.run(self)
    }
}

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
}
