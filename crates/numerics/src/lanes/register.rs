//! SIMD lanes in processor registers.

#![allow(clippy::manual_memcpy, reason = "so few numbers are loaded one by one: a copy would be a call")]

use std::fmt::{self, Debug, Formatter};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use pulp::{Simd, WithSimd};

use super::float::{LaneFloat, Mask, SimdTask, WHOLE};

/// Indices of the lanes.
const PLACES: [f64; 16] =
    [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0];
/// Sign bit of a number.
const SIGN: u64 = 1 << 63;

/// Numbers in the lanes of N registers of a processor. Aligned so that no register straddles two cache lines.
#[derive(Copy, Clone)]
#[repr(align(64))]
pub struct Lanes<S: Simd, const N: usize> {
    simd: S,
    registers: [S::f64s; N],
}

/// Boolean in each lane of N registers.
#[derive(Copy, Clone)]
pub struct LaneMask<S: Simd, const N: usize> {
    simd: S,
    registers: [S::m64s; N],
}

impl<S: Simd, const N: usize> Lanes<S, N> {
    /// Creates NaN in every lane.
    #[inline(always)]
    pub(super) fn new(simd: S) -> Self {
        Self { simd, registers: [simd.splat_f64s(f64::NAN); N] }
    }
}

/// Repeats a statement for each register, written out: LLVM takes minutes to unroll thousands of such loops.
macro_rules! each_register {
    ($index:ident => $body:expr) => {{
        const { assert!(N == 1 || N == 2, "so many are written out") };
        {
            let $index = 0;
            $body;
        }
        if N > 1 {
            let $index = 1;
            $body;
        }
    }};
}

/// Computes new registers from the corresponding ones of the operands. Not a closure, which would lack the
/// processor's instructions.
macro_rules! each {
    ($lanes:expr, $($operand:ident = $of:expr),+ => $result:expr) => {{
        let mut lanes = $lanes;
        each_register!(index => {
            $(let $operand = $of.registers[index];)+
            lanes.registers[index] = $result
        });
        lanes
    }};
}

/// Implements an operator between lanes, and between lanes and a number.
macro_rules! operator {
    ($trait:ident, $name:ident, $operation:ident) => {
        impl<S: Simd, const N: usize> $trait for Lanes<S, N> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                let simd = self.simd;
                each!(self, a = self, b = other => simd.$operation(a, b))
            }
        }

        impl<S: Simd, const N: usize> $trait<f64> for Lanes<S, N> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: f64) -> Self {
                $trait::$name(self, self.splat(other))
            }
        }
    };
}

operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

impl<S: Simd, const N: usize> Neg for Lanes<S, N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        let simd = self.simd;
        let sign = simd.splat_u64s(SIGN);
        each!(self, a = self => {
            simd.transmute_f64s_u64s(simd.xor_u64s(simd.transmute_u64s_f64s(a), sign))
        })
    }
}

impl<S: Simd, const N: usize> LaneFloat for Lanes<S, N> {
    type Mask = LaneMask<S, N>;
    const LANES: usize = N * S::F64_LANES;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        Self { simd: self.simd, registers: [self.simd.splat_f64s(value); N] }
    }

    #[inline(always)]
    fn load(self, from: &[f64]) -> Self {
        let all = S::as_simd_f64s(&from[..Self::LANES]).0;
        let mut lanes = self;
        each_register!(index => lanes.registers[index] = all[index]);
        lanes
    }

    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        let all = S::as_mut_simd_f64s(&mut to[..Self::LANES]).0;
        each_register!(index => all[index] = self.registers[index]);
    }

    #[inline(always)]
    fn with_lane(self, lane: usize, value: f64) -> Self {
        // Selected in the registers: a number written to memory would stall the load of the whole register.
        let (offset, half) = (self.load(&PLACES) - self.splat(lane as f64), self.splat(0.5));
        Self::select(offset.abs().lt(half), self.splat(value), self)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let simd = self.simd;
        each!(self, a = self => simd.sqrt_f64s(a))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let simd = self.simd;
        let rest = simd.splat_u64s(!SIGN);
        each!(self, a = self => {
            simd.transmute_f64s_u64s(simd.and_u64s(simd.transmute_u64s_f64s(a), rest))
        })
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Self::Mask {
        let simd = self.simd;
        each!(LaneMask::new(simd), a = self, b = other => simd.less_than_f64s(a, b))
    }

    #[inline(always)]
    fn le(self, other: Self) -> Self::Mask {
        let simd = self.simd;
        each!(LaneMask::new(simd), a = self, b = other => simd.less_than_or_equal_f64s(a, b))
    }

    #[inline(always)]
    fn select(mask: Self::Mask, chosen: Self, otherwise: Self) -> Self {
        let simd = chosen.simd;
        each!(chosen, is = mask, a = chosen, b = otherwise => {
            let (a, b) = (simd.transmute_u64s_f64s(a), simd.transmute_u64s_f64s(b));
            simd.transmute_f64s_u64s(simd.select_u64s(is, a, b))
        })
    }

    #[inline(always)]
    fn quadrant(self) -> (Self, Self::Mask, Self::Mask) {
        let simd = self.simd;
        let shifted = self + WHOLE;
        let (one, two) = (simd.splat_u64s(1), simd.splat_u64s(2));
        let odd = each!(LaneMask::new(simd), a = shifted => {
            simd.equal_u64s(simd.and_u64s(simd.transmute_u64s_f64s(a), one), one)
        });
        let second = each!(LaneMask::new(simd), a = shifted => {
            simd.equal_u64s(simd.and_u64s(simd.transmute_u64s_f64s(a), two), two)
        });
        (shifted - WHOLE, odd, second)
    }

    #[inline(always)]
    fn run_outlined<W: SimdTask>(self, work: W) -> W::Output {
        self.simd.vectorize(VectorTask::<W, N>(work))
    }
}

impl<S: Simd, const N: usize> LaneMask<S, N> {
    /// Creates a mask that is false in every lane.
    #[inline(always)]
    fn new(simd: S) -> Self {
        let zero = simd.splat_f64s(0.0);
        Self { simd, registers: [simd.less_than_f64s(zero, zero); N] }
    }
}

impl<S: Simd, const N: usize> BitAnd for LaneMask<S, N> {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        let simd = self.simd;
        each!(self, a = self, b = other => simd.and_m64s(a, b))
    }
}

impl<S: Simd, const N: usize> BitOr for LaneMask<S, N> {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        let simd = self.simd;
        each!(self, a = self, b = other => simd.or_m64s(a, b))
    }
}

impl<S: Simd, const N: usize> Not for LaneMask<S, N> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        let simd = self.simd;
        each!(self, a = self => simd.not_m64s(a))
    }
}

impl<S: Simd, const N: usize> Mask for LaneMask<S, N> {
    #[inline(always)]
    fn any(self) -> bool {
        let mut any = self.registers[0];
        if N > 1 {
            any = self.simd.or_m64s(any, self.registers[1]);
        }
        self.simd.first_true_m64s(any) < S::F64_LANES
    }
}

/// Task compiled for a processor's instruction set, on lanes of N registers.
pub(super) struct VectorTask<W, const N: usize>(pub W);

impl<W: SimdTask, const N: usize> WithSimd for VectorTask<W, N> {
    type Output = W::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> W::Output {
        self.0.run(Lanes::<S, N>::new(simd))
    }
}

/// Task compiled for a processor's instruction set, on single numbers.
pub(super) struct ScalarTask<W>(pub W);

impl<W: SimdTask> WithSimd for ScalarTask<W> {
    type Output = W::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> W::Output {
        self.0.run(f64::NAN)
    }
}

impl<S: Simd, const N: usize> Debug for Lanes<S, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.registers.fmt(f)
    }
}

impl<S: Simd, const N: usize> Debug for LaneMask<S, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.registers.fmt(f)
    }
}
