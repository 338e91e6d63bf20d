//! Inverse sine, cosine and tangent.
//!
//! Algorithm and coefficients: fdlibm and FreeBSD's msun. Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
//! Permission to use, copy, modify, and distribute this software is freely granted, provided that this notice is preserved.

use crate::binary64::{INFINITY_WORD, ONE_WORD, is_negative, magnitude_word, nan, negated_if, upper_half};
use crate::square_root::sqrt;

/// Difference between pi/2 and its nearest number.
const HALF_PI_TAIL: f64 = 6.123_233_995_736_766e-17;
/// Difference between pi and its nearest number.
const PI_TAIL: f64 = 1.224_646_799_147_353_2e-16;

/// Upper word of 2^66: from it on atan x rounds to pi/2.
const HUGE_TANGENT_WORD: u32 = 0x4410_0000;
/// Upper word of 2^-27: below it atan x rounds to x.
const TINY_TANGENT_WORD: u32 = 0x3e40_0000;
/// Upper words of 7/16, 11/16, 19/16 and 39/16, between the intervals of the arc tangent.
const TANGENT_INTERVALS: [u32; 4] = [0x3fdc_0000, 0x3fe6_0000, 0x3ff3_0000, 0x4003_8000];
/// Exponent 64 in an upper word.
const SIXTY_FOUR_POWERS: u32 = 64 << 20;

/// Upper word of 1/2.
const HALF_WORD: u32 = 0x3fe0_0000;
/// Upper word of 2^-26: below it asin x rounds to x.
const TINY_SINE_WORD: u32 = 0x3e50_0000;
/// Upper word of 0.975, near which the arc sine has no digits to lose.
const NEAR_ONE_WORD: u32 = 0x3fef_3333;
/// Upper word of 2^-57: up to it acos x rounds to pi/2.
const TINY_COSINE_WORD: u32 = 0x3c60_0000;

/// Arc tangents (rad) of 1/2, 1 and 3/2, each with the difference to the exact one.
const ARC_HALF: [f64; 2] = [4.636_476_090_008_061e-1, 2.269_877_745_296_168_7e-17];
const ARC_ONE: [f64; 2] = [core::f64::consts::FRAC_PI_4, 3.061_616_997_868_383e-17];
const ARC_THREE_HALVES: [f64; 2] = [9.827_937_232_473_29e-1, 1.390_331_103_123_099_8e-17];

/// Coefficients of x^3, x^5, .. x^23 of the arc tangent, with the other sign.
const ARC_TANGENT: [f64; 11] = [
    3.333_333_333_333_293e-1,
    -1.999_999_999_987_648_3e-1,
    1.428_571_427_250_346_6e-1,
    -1.111_111_040_546_235_6e-1,
    9.090_887_133_436_507e-2,
    -7.691_876_205_044_83e-2,
    6.661_073_137_387_531e-2,
    -5.833_570_133_790_573_5e-2,
    4.976_877_994_615_932_4e-2,
    -3.653_157_274_421_691_6e-2,
    1.628_582_011_536_578_2e-2,
];

/// Coefficients of z, z^2, .. z^6 in the numerator of the arc sine.
const NUMERATOR: [f64; 6] = [
    1.666_666_666_666_666_6e-1,
    -3.255_658_186_224_009e-1,
    2.012_125_321_348_629_3e-1,
    -4.005_553_450_067_941e-2,
    7.915_349_942_898_145e-4,
    3.479_331_075_960_212e-5,
];
/// Coefficients of z, z^2, .. z^4 in the denominator of the arc sine.
const DENOMINATOR: [f64; 4] =
    [-2.403_394_911_734_414, 2.020_945_760_233_505_7, -6.882_839_716_054_533e-1, 7.703_815_055_590_194e-2];

/// Returns the arc tangent of x (rad), from -pi/2 to pi/2.
#[must_use]
pub fn atan(x: f64) -> f64 {
    let word = magnitude_word(x);
    if word >= HUGE_TANGENT_WORD {
        if x.is_nan() {
            return nan();
        }
        return core::f64::consts::FRAC_PI_2.copysign(x);
    }
    if word < TINY_TANGENT_WORD {
        return x;
    }
    // atan |x| = atan c + atan((|x| - c)/(1 + c |x|))
    let mut t = x;
    let mut base = 0.0;
    let mut tail = 0.0;
    if word >= TANGENT_INTERVALS[0] {
        t = x.abs();
        if word < TANGENT_INTERVALS[1] {
            t = (2.0 * t - 1.0) / (2.0 + t);
            base = ARC_HALF[0];
            tail = ARC_HALF[1];
        } else if word < TANGENT_INTERVALS[2] {
            t = (t - 1.0) / (t + 1.0);
            base = ARC_ONE[0];
            tail = ARC_ONE[1];
        } else if word < TANGENT_INTERVALS[3] {
            t = (t - 1.5) / (1.0 + 1.5 * t);
            base = ARC_THREE_HALVES[0];
            tail = ARC_THREE_HALVES[1];
        } else {
            t = -1.0 / t;
            base = core::f64::consts::FRAC_PI_2;
            tail = HALF_PI_TAIL;
        }
    }
    let difference = t * arc_tangent_series(t);
    if word < TANGENT_INTERVALS[0] {
        return x - difference;
    }
    negated_if(is_negative(x), base - (difference - tail - t))
}

/// Returns 1 - atan(t)/t for t of at most 7/16.
#[inline]
fn arc_tangent_series(t: f64) -> f64 {
    let z = t * t;
    let w = z * z;
    let even_terms = z
        * (ARC_TANGENT[0]
            + w * (ARC_TANGENT[2]
                + w * (ARC_TANGENT[4] + w * (ARC_TANGENT[6] + w * (ARC_TANGENT[8] + w * ARC_TANGENT[10])))));
    let odd_terms = w
        * (ARC_TANGENT[1]
            + w * (ARC_TANGENT[3] + w * (ARC_TANGENT[5] + w * (ARC_TANGENT[7] + w * ARC_TANGENT[9]))));
    even_terms + odd_terms
}

/// Returns the angle (rad) of the point (x, y) from the x axis, from -pi to pi.
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    if x.is_nan() || y.is_nan() {
        return nan();
    }
    let x_word = magnitude_word(x);
    let y_word = magnitude_word(y);
    let is_behind = is_negative(x);
    if y == 0.0 {
        if is_behind {
            return core::f64::consts::PI.copysign(y);
        }
        return y;
    }
    if x_word == INFINITY_WORD {
        return from_infinity(is_behind, y_word == INFINITY_WORD).copysign(y);
    }
    if x == 0.0 || y_word == INFINITY_WORD || x_word + SIXTY_FOUR_POWERS < y_word {
        return core::f64::consts::FRAC_PI_2.copysign(y);
    }
    if !is_behind {
        return atan((y / x).abs()).copysign(y);
    }
    let mut acute = 0.0;
    if y_word + SIXTY_FOUR_POWERS >= x_word {
        acute = atan((y / x).abs());
    }
    (core::f64::consts::PI - (acute - PI_TAIL)).copysign(y)
}

/// Returns the magnitude of the angle (rad) of a point whose x is infinite.
fn from_infinity(is_behind: bool, is_diagonal: bool) -> f64 {
    if is_diagonal {
        if is_behind {
            return 3.0 * core::f64::consts::PI / 4.0;
        }
        return core::f64::consts::FRAC_PI_4;
    }
    if is_behind {
        return core::f64::consts::PI;
    }
    0.0
}

/// Returns (asin(x) - x)/x for z = x² of at most 1/4.
#[inline]
fn arc_sine_series(z: f64) -> f64 {
    let numerator = z
        * (NUMERATOR[0]
            + z * (NUMERATOR[1]
                + z * (NUMERATOR[2] + z * (NUMERATOR[3] + z * (NUMERATOR[4] + z * NUMERATOR[5])))));
    let denominator =
        1.0 + z * (DENOMINATOR[0] + z * (DENOMINATOR[1] + z * (DENOMINATOR[2] + z * DENOMINATOR[3])));
    numerator / denominator
}

/// Returns the arc sine of x (rad), from -pi/2 to pi/2; NaN beyond 1.
#[must_use]
pub fn asin(x: f64) -> f64 {
    let word = magnitude_word(x);
    if word >= ONE_WORD {
        if x.abs() == 1.0 {
            return core::f64::consts::FRAC_PI_2.copysign(x);
        }
        return nan();
    }
    if word < HALF_WORD {
        if word < TINY_SINE_WORD {
            return x;
        }
        return x + x * arc_sine_series(x * x);
    }
    // asin x = pi/2 - 2 asin sqrt((1 - x)/2)
    let z = (1.0 - x.abs()) * 0.5;
    let root = sqrt(z);
    let series = arc_sine_series(z);
    if word >= NEAR_ONE_WORD {
        let angle = core::f64::consts::FRAC_PI_2 - (2.0 * (root + root * series) - HALF_PI_TAIL);
        return negated_if(x < 0.0, angle);
    }
    let upper = upper_half(root);
    let lower = (z - upper * upper) / (root + upper);
    let angle = core::f64::consts::FRAC_PI_4
        - (2.0 * root * series - (HALF_PI_TAIL - 2.0 * lower) - (core::f64::consts::FRAC_PI_4 - 2.0 * upper));
    negated_if(x < 0.0, angle)
}

/// Returns the arc cosine of x (rad), from 0 to pi; NaN beyond 1.
#[must_use]
pub fn acos(x: f64) -> f64 {
    let word = magnitude_word(x);
    if word >= ONE_WORD {
        if x == 1.0 {
            return 0.0;
        }
        if x == -1.0 {
            return core::f64::consts::PI;
        }
        return nan();
    }
    if word < HALF_WORD {
        if word <= TINY_COSINE_WORD {
            return core::f64::consts::FRAC_PI_2;
        }
        return core::f64::consts::FRAC_PI_2 - (x - (HALF_PI_TAIL - x * arc_sine_series(x * x)));
    }
    if x < 0.0 {
        let z = (1.0 + x) * 0.5;
        let root = sqrt(z);
        let correction = arc_sine_series(z) * root - HALF_PI_TAIL;
        return 2.0 * (core::f64::consts::FRAC_PI_2 - (root + correction));
    }
    let z = (1.0 - x) * 0.5;
    let root = sqrt(z);
    let upper = upper_half(root);
    let lower = (z - upper * upper) / (root + upper);
    2.0 * (upper + (arc_sine_series(z) * root + lower))
}
