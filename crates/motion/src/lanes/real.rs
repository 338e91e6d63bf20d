//! What numbers of the engine's kernels do, alone or in lanes.

use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// 1.5 * 2^52: beside it, a number has no digits after the point.
pub(super) const WHOLE: f64 = 6_755_399_441_055_744.0;

/// A number, or one in each lane. A number of the source, which all lanes share, may stand at the right of an operator.
pub trait Real:
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
    /// An answer for each lane.
    type Mask: Mask;
    /// How many lanes there are.
    const LANES: usize;

    /// The same number in every lane; `self` only says of which kind.
    #[must_use]
    fn of(self, value: f64) -> Self;

    /// Numbers from the beginning of a slice, one for each lane; `self` only says of which kind.
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

    /// The root.
    #[must_use]
    fn sqrt(self) -> Self;

    /// The absolute value.
    #[must_use]
    fn abs(self) -> Self;

    /// Where this is less; nowhere beside NaN.
    fn lt(self, other: Self) -> Self::Mask;

    /// Where this is less or equal; nowhere beside NaN.
    fn le(self, other: Self) -> Self::Mask;

    /// The first where the mask says so, else the second.
    #[must_use]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// The nearest integer, of two the even one, and where it is odd, and where its second binary digit is 1: quarter turns
    /// are told apart by these. Only below 2^51 in absolute value.
    fn quadrant(self) -> (Self, Self::Mask, Self::Mask);

    /// Runs some work as a function of its own, for what is too long to stand where it is called.
    fn apart<W: LaneWork>(self, work: W) -> W::Output;

    /// Where this is greater; nowhere beside NaN.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }

    /// Where this is greater or equal; nowhere beside NaN.
    #[inline(always)]
    fn ge(self, other: Self) -> Self::Mask {
        other.le(self)
    }

    /// This where it is less, else the other: the other beside NaN, and of two zeros.
    #[inline(always)]
    #[must_use]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }

    /// This where it is greater, else the other: the other beside NaN, and of two zeros.
    #[inline(always)]
    #[must_use]
    fn max(self, other: Self) -> Self {
        Self::select(other.lt(self), self, other)
    }

    /// The nearest integer, of two the even one. Only below 2^51 in absolute value.
    #[inline(always)]
    #[must_use]
    fn round(self) -> Self {
        self.quadrant().0
    }

    /// The number in a lane.
    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        let mut all = [0.0; 16];
        self.store(&mut all);
        all[..Self::LANES][lane]
    }

    /// Other than before in one lane.
    #[inline(always)]
    #[must_use]
    fn with_lane(self, lane: usize, value: f64) -> Self {
        let mut all = [0.0; 16];
        self.store(&mut all);
        all[..Self::LANES][lane] = value;
        self.load(&all)
    }
}

/// Yes or no, or one of them in each lane.
pub trait Mask: Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Whether it is yes in any lane.
    fn any(self) -> bool;

    /// Whether it is yes in every lane.
    #[inline(always)]
    fn all(self) -> bool {
        !(!self).any()
    }
}

/// Work over numbers of any kind.
pub trait LaneWork {
    /// What comes of it.
    type Output;

    /// Does it; `kind` is any number of the kind, NaN for one. It has to be `#[inline(always)]`.
    fn run<R: Real>(self, kind: R) -> Self::Output;
}

impl Real for f64 {
    type Mask = bool;
    const LANES: usize = 1;

    #[inline(always)]
    fn of(self, value: f64) -> Self {
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
        // IEEE's root, on every processor.
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
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn quadrant(self) -> (Self, bool, bool) {
        let shifted = self + WHOLE;
        let digits = shifted.to_bits();
        (shifted - WHOLE, digits & 1 != 0, digits & 2 != 0)
    }

    #[inline(never)]
    fn apart<W: LaneWork>(self, work: W) -> W::Output {
        work.run(self)
    }
}

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
}
