//! Inverse tangent.
//!
//! Algorithm and coefficients: fdlibm and FreeBSD's msun. Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
//! Permission to use, copy, modify, and distribute this software is freely granted, provided that this notice is preserved.

use crate::binary32::{INFINITY_BITS, is_negative, magnitude_bits, nan, negated_if};

/// Difference between pi and its nearest number.
const PI_TAIL: f32 = -8.742_277_7e-8;

/// Bits of 2^26: from it on atan x rounds to pi/2.
const HUGE_TANGENT_BITS: u32 = 0x4c80_0000;
/// Bits of 2^-12: below it atan x rounds to x.
const TINY_TANGENT_BITS: u32 = 0x3980_0000;
/// Bits of 7/16, 11/16, 19/16 and 39/16, between the intervals of the arc tangent.
const TANGENT_INTERVALS: [u32; 4] = [0x3ee0_0000, 0x3f30_0000, 0x3f98_0000, 0x401c_0000];
/// Exponent 26 in the bits of a number.
const TWENTY_SIX_POWERS: u32 = 26 << 23;

/// Arc tangents (rad) of 1/2, 1, 3/2 and infinity, each with the difference to the exact one.
const ARC_HALF: [f32; 2] = [4.636_476e-1, 5.012_158_2e-9];
const ARC_ONE: [f32; 2] = [7.853_981_3e-1, 3.774_895e-8];
const ARC_THREE_HALVES: [f32; 2] = [9.827_937e-1, 3.447_321_7e-8];
const ARC_INFINITY: [f32; 2] = [1.570_796_3, 7.549_79e-8];

/// Coefficients of x^3, x^5, .. x^11 of the arc tangent, with the other sign.
const ARC_TANGENT: [f32; 5] =
    [3.333_332_8e-1, -1.999_915_8e-1, 1.425_363_6e-1, -1.064_801_7e-1, 6.168_760_8e-2];

/// Returns the arc tangent of x (rad), from -pi/2 to pi/2.
#[must_use]
pub fn atan(x: f32) -> f32 {
    let bits = magnitude_bits(x);
    if bits >= HUGE_TANGENT_BITS {
        if x.is_nan() {
            return nan();
        }
        return core::f32::consts::FRAC_PI_2.copysign(x);
    }
    if bits < TINY_TANGENT_BITS {
        return x;
    }
    // atan |x| = atan c + atan((|x| - c)/(1 + c |x|))
    let mut t = x;
    let mut base = 0.0;
    let mut tail = 0.0;
    if bits >= TANGENT_INTERVALS[0] {
        t = x.abs();
        if bits < TANGENT_INTERVALS[1] {
            t = (2.0 * t - 1.0) / (2.0 + t);
            base = ARC_HALF[0];
            tail = ARC_HALF[1];
        } else if bits < TANGENT_INTERVALS[2] {
            t = (t - 1.0) / (t + 1.0);
            base = ARC_ONE[0];
            tail = ARC_ONE[1];
        } else if bits < TANGENT_INTERVALS[3] {
            t = (t - 1.5) / (1.0 + 1.5 * t);
            base = ARC_THREE_HALVES[0];
            tail = ARC_THREE_HALVES[1];
        } else {
            t = -1.0 / t;
            base = ARC_INFINITY[0];
            tail = ARC_INFINITY[1];
        }
    }
    let z = t * t;
    let w = z * z;
    let even_terms = z * (ARC_TANGENT[0] + w * (ARC_TANGENT[2] + w * ARC_TANGENT[4]));
    let odd_terms = w * (ARC_TANGENT[1] + w * ARC_TANGENT[3]);
    let difference = t * (even_terms + odd_terms);
    if bits < TANGENT_INTERVALS[0] {
        return x - difference;
    }
    negated_if(is_negative(x), base - ((difference - tail) - t))
}

/// Returns the angle (rad) of the point (x, y) from the x axis, from -pi to pi.
#[must_use]
pub fn atan2(y: f32, x: f32) -> f32 {
    if x.is_nan() || y.is_nan() {
        return nan();
    }
    let x_bits = magnitude_bits(x);
    let y_bits = magnitude_bits(y);
    let is_behind = is_negative(x);
    if y == 0.0 {
        if is_behind {
            return core::f32::consts::PI.copysign(y);
        }
        return y;
    }
    if x_bits == INFINITY_BITS {
        return from_infinity(is_behind, y_bits == INFINITY_BITS).copysign(y);
    }
    if x == 0.0 || y_bits == INFINITY_BITS || x_bits + TWENTY_SIX_POWERS < y_bits {
        return core::f32::consts::FRAC_PI_2.copysign(y);
    }
    if !is_behind {
        return atan((y / x).abs()).copysign(y);
    }
    let mut acute = 0.0;
    if y_bits + TWENTY_SIX_POWERS >= x_bits {
        acute = atan((y / x).abs());
    }
    (core::f32::consts::PI - (acute - PI_TAIL)).copysign(y)
}

/// Returns the magnitude of the angle (rad) of a point whose x is infinite.
fn from_infinity(is_behind: bool, is_diagonal: bool) -> f32 {
    if is_diagonal {
        if is_behind {
            return 3.0 * core::f32::consts::PI / 4.0;
        }
        return core::f32::consts::FRAC_PI_4;
    }
    if is_behind {
        return core::f32::consts::PI;
    }
    0.0
}
