//! Branch-free exponential function for decays, for single numbers and SIMD lanes.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#![allow(clippy::excessive_precision, reason = "as fdlibm has them")]

use std::f64::consts::LOG2_E;

use super::trig::nearest;
use crate::lanes::{LaneFloat, Mask};

/// Argument below which the result is set to zero, because it is near the smallest number with full precision.
const LEAST: f64 = -708.0;

/// Constant ln 2: its first 32 bits, and the rest.
const LN_2: [f64; 2] = [6.931_471_803_691_238_164_90e-1, 1.908_214_929_270_587_700_02e-10];

/// Coefficients 1/n! from n = 2 on.
const TERMS: [f64; 12] = {
    let mut coefficients = [0.5; 12];
    let mut n = 1;
    while n < 12 {
        coefficients[n] = coefficients[n - 1] / (n + 2) as f64;
        n += 1;
    }
    coefficients
};

/// Returns exp(x) for x up to 1; within 1 unit in the last place, and 0 below -708.
#[inline(always)]
pub fn exp<R: LaneFloat>(x: R) -> R {
    let (mut size, mut twos) = parts(x);
    // Large decays are rare.
    if !twos.splat(-15.5).lt(twos).all() {
        for power in [512, 256, 128, 64, 32, 16] {
            (size, twos) = halved(size, twos, power);
        }
    }
    for power in [8, 4, 2, 1] {
        (size, twos) = halved(size, twos, power);
    }
    let size = R::select(twos.splat(0.5).lt(twos), size + size, size);
    R::select(x.lt(x.splat(LEAST)), x.splat(0.0), size)
}

/// Returns exp(x) for |x| up to 1.
#[inline(always)]
pub fn exp_short<R: LaneFloat>(x: R) -> R {
    let (size, twos) = parts(x);
    // Factor 2^-1, 1 or 2.
    size * (x.splat(1.0) + twos * (x.splat(0.75) + twos * 0.25))
}

/// Splits exp(x) = size 2^twos, with a size between 1/sqrt(2) and sqrt(2).
#[inline(always)]
fn parts<R: LaneFloat>(x: R) -> (R, R) {
    let twos = nearest(x * LOG2_E);
    let high = x - twos * LN_2[0];
    let low = twos * LN_2[1];
    let r = high - low;
    let (z, one) = (r * r, x.splat(1.0));
    let w = z * z;
    // The truncation error is 0.35^14/14!, 4e-18.
    let first = (x.splat(TERMS[0]) + r * TERMS[1]) + z * (x.splat(TERMS[2]) + r * TERMS[3]);
    let second = (x.splat(TERMS[4]) + r * TERMS[5]) + z * (x.splat(TERMS[6]) + r * TERMS[7]);
    let third = (x.splat(TERMS[8]) + r * TERMS[9]) + z * (x.splat(TERMS[10]) + r * TERMS[11]);
    let rest = first + w * (second + w * third);
    (one + (high + (z * rest - low)), twos)
}

/// Divides by 2^power in the lanes where `twos` still requires it, and updates `twos`.
#[inline(always)]
fn halved<R: LaneFloat>(size: R, twos: R, power: i32) -> (R, R) {
    let halves = twos.le(twos.splat(-f64::from(power)));
    // Value 2^-power, assembled from its exponent bits.
    let part = f64::from_bits(((1023 - power) as u64) << 52);
    (R::select(halves, size * part, size), R::select(halves, twos + f64::from(power), twos))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Arguments and the nearest doubles of their exponentials, by mpmath.
    const ORACLE: &str = include_str!("../../../tests/golden/decay.csv");

    #[test]
    fn exponentials_are_within_a_unit_in_the_last_place() {
        let (mut count, mut worst) = (0, 0.0_f64);
        for row in ORACLE.lines().skip(1) {
            let numbers: Vec<f64> = row.split(',').map(|cell| cell.parse().expect("a number")).collect();
            let [x, nearest, rest] = numbers[..] else { panic!("{row}") };
            let unit = nearest.next_up() - nearest;
            let mut check = |value: f64| {
                let error = ((value - nearest) / unit - rest).abs();
                worst = worst.max(error);
                assert!(error < 1.0, "{row}: {value}, {error} units");
            };
            check(exp(x));
            if x.abs() <= 1.0 {
                check(exp_short(x));
            }
            count += 1;
        }
        assert!(count > 1400 && worst > 0.5, "{count} {worst}");
        assert_eq!((exp(0.0), exp(-0.0), exp_short(-0.0)), (1.0, 1.0, 1.0));
        assert_eq!((exp(-709.0), exp(-1e9), exp(f64::NEG_INFINITY)), (0.0, 0.0, 0.0));
        assert!(exp(f64::NAN).is_nan());
    }
}
