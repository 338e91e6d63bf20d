//! Sine, cosine and tangent.
//!
//! Algorithm and coefficients: fdlibm and FreeBSD's msun. Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
//! Permission to use, copy, modify, and distribute this software is freely granted, provided that this notice is preserved.

use crate::argument_reduction::reduce;
use crate::binary64::{INFINITY_WORD, magnitude_word, nan, negated_if, upper_half};

/// Upper word of pi/4: up to it an angle needs no reduction.
const QUARTER_PI_WORD: u32 = 0x3fe9_21fb;

/// Upper word of 2^-26: below it sin x rounds to x.
const TINY_SINE_WORD: u32 = 0x3e50_0000;

/// Upper word of 2^-27 sqrt(2): below it cos x rounds to 1.
const TINY_COSINE_WORD: u32 = 0x3e46_a09e;

/// Upper word of 2^-27: below it tan x rounds to x.
const TINY_TANGENT_WORD: u32 = 0x3e40_0000;

/// Upper word of 0.6744: from it on the tangent comes from the angle to pi/4.
const LARGE_TANGENT_WORD: u32 = 0x3fe5_9428;

/// Difference between pi/4 and its nearest number.
const QUARTER_PI_TAIL: f64 = 3.061_616_997_868_383e-17;

/// Coefficients of x^3, x^5, .. x^13 of the sine.
const SINE: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];

/// Coefficients of x^4, x^6, .. x^14 of the cosine.
const COSINE: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// Coefficients of x^3, x^5, .. x^27 of the tangent.
const TANGENT: [f64; 13] = [
    3.333_333_333_333_341e-1,
    1.333_333_333_332_012_4e-1,
    5.396_825_397_622_605e-2,
    2.186_948_829_485_954_2e-2,
    8.863_239_823_599_3e-3,
    3.592_079_107_591_312_4e-3,
    1.456_209_454_325_290_3e-3,
    5.880_412_408_202_641e-4,
    2.464_631_348_184_699e-4,
    7.817_944_429_395_571e-5,
    7.140_724_913_826_082e-5,
    -1.855_863_748_552_754_6e-5,
    2.590_730_518_636_337e-5,
];

/// Sine and cosine of one angle.
pub struct SinCos {
    /// Sine
    pub sin: f64,
    /// Cosine
    pub cos: f64,
}

/// Returns the sine of an angle x (rad).
#[must_use]
pub fn sin(x: f64) -> f64 {
    let word = magnitude_word(x);
    if word <= QUARTER_PI_WORD {
        if word < TINY_SINE_WORD {
            return x;
        }
        return sine_without_tail(x);
    }
    if word >= INFINITY_WORD {
        return nan();
    }
    let reduced = reduce(x);
    let value = if (reduced.quadrant & 1) == 0 {
        sine_with_tail(reduced.angle, reduced.tail)
    } else {
        cosine_with_tail(reduced.angle, reduced.tail)
    };
    negated_if((reduced.quadrant & 2) != 0, value)
}

/// Returns the cosine of an angle x (rad).
#[must_use]
pub fn cos(x: f64) -> f64 {
    let word = magnitude_word(x);
    if word <= QUARTER_PI_WORD {
        if word < TINY_COSINE_WORD {
            return 1.0;
        }
        return cosine_with_tail(x, 0.0);
    }
    if word >= INFINITY_WORD {
        return nan();
    }
    let reduced = reduce(x);
    let value = if (reduced.quadrant & 1) == 0 {
        cosine_with_tail(reduced.angle, reduced.tail)
    } else {
        sine_with_tail(reduced.angle, reduced.tail)
    };
    negated_if(((reduced.quadrant + 1) & 2) != 0, value)
}

/// Returns the sine and the cosine of an angle x (rad), with the bits of `sin` and `cos`.
#[must_use]
pub fn sincos(x: f64) -> SinCos {
    let word = magnitude_word(x);
    if word <= QUARTER_PI_WORD {
        if word < TINY_COSINE_WORD {
            return SinCos { sin: x, cos: 1.0 };
        }
        return SinCos { sin: sine_without_tail(x), cos: cosine_with_tail(x, 0.0) };
    }
    if word >= INFINITY_WORD {
        return SinCos { sin: nan(), cos: nan() };
    }
    let reduced = reduce(x);
    let sine = sine_with_tail(reduced.angle, reduced.tail);
    let cosine = cosine_with_tail(reduced.angle, reduced.tail);
    match reduced.quadrant & 3 {
        0 => SinCos { sin: sine, cos: cosine },
        1 => SinCos { sin: cosine, cos: -sine },
        2 => SinCos { sin: -sine, cos: -cosine },
        _ => SinCos { sin: -cosine, cos: sine },
    }
}

/// Returns the tangent of an angle x (rad).
#[must_use]
pub fn tan(x: f64) -> f64 {
    let word = magnitude_word(x);
    if word <= QUARTER_PI_WORD {
        if word < TINY_TANGENT_WORD {
            return x;
        }
        return tangent(x, 0.0, false);
    }
    if word >= INFINITY_WORD {
        return nan();
    }
    let reduced = reduce(x);
    tangent(reduced.angle, reduced.tail, (reduced.quadrant & 1) != 0)
}

/// Returns the terms of the sine after the second, divided by x^5, for the square z of the angle.
#[inline]
fn sine_series(z: f64) -> f64 {
    SINE[1] + z * (SINE[2] + z * SINE[3]) + z * (z * z) * (SINE[4] + z * SINE[5])
}

/// Returns the sine of an angle x (rad) of at most pi/4.
#[inline]
fn sine_without_tail(x: f64) -> f64 {
    let z = x * x;
    x + z * x * (SINE[0] + z * sine_series(z))
}

/// Returns the sine of the sum of an angle x (rad) of at most pi/4 and its tail.
#[inline]
fn sine_with_tail(x: f64, tail: f64) -> f64 {
    let z = x * x;
    let cube = z * x;
    x - ((z * (0.5 * tail - cube * sine_series(z)) - tail) - cube * SINE[0])
}

/// Returns the cosine of the sum of an angle x (rad) of at most pi/4 and its tail.
#[inline]
fn cosine_with_tail(x: f64, tail: f64) -> f64 {
    let z = x * x;
    let z_squared = z * z;
    let series = z * (COSINE[0] + z * (COSINE[1] + z * COSINE[2]))
        + z_squared * z_squared * (COSINE[3] + z * (COSINE[4] + z * COSINE[5]));
    let half = 0.5 * z;
    let first_terms = 1.0 - half;
    // The rounding error of the first terms is added back.
    first_terms + (((1.0 - first_terms) - half) + (z * series - x * tail))
}

/// Returns the tangent of the sum of an angle x (rad) of at most pi/4 and its tail, or -1 over it if the quadrant is odd.
fn tangent(x: f64, tail: f64, is_odd: bool) -> f64 {
    let is_large = magnitude_word(x) >= LARGE_TANGENT_WORD;
    let is_negated = is_large && x < 0.0;
    let mut angle = x;
    let mut rest = tail;
    if is_large {
        // pi/4 - |x|
        angle = (core::f64::consts::FRAC_PI_4 - negated_if(is_negated, x))
            + (QUARTER_PI_TAIL - negated_if(is_negated, tail));
        rest = 0.0;
    }
    let z = angle * angle;
    let w = z * z;
    let odd_terms = TANGENT[1]
        + w * (TANGENT[3] + w * (TANGENT[5] + w * (TANGENT[7] + w * (TANGENT[9] + w * TANGENT[11]))));
    let even_terms = z
        * (TANGENT[2]
            + w * (TANGENT[4] + w * (TANGENT[6] + w * (TANGENT[8] + w * (TANGENT[10] + w * TANGENT[12])))));
    let cube = z * angle;
    let correction = rest + z * (cube * (odd_terms + even_terms) + rest) + cube * TANGENT[0];
    let value = angle + correction;
    if is_large {
        // tan(pi/4 - a) = 1 - 2 (tan a - tan² a / (1 + tan a)), and -1 over it with the other sign.
        let sign = if is_odd { -1.0 } else { 1.0 };
        let complement = sign - 2.0 * (angle + (correction - value * value / (value + sign)));
        return negated_if(is_negated, complement);
    }
    if !is_odd {
        return value;
    }
    // -1/value to the last digit: upper halves multiply exactly.
    let upper = upper_half(value);
    let lower = correction - (upper - angle);
    let reciprocal = -1.0 / value;
    let upper_reciprocal = upper_half(reciprocal);
    upper_reciprocal + reciprocal * (1.0 + upper_reciprocal * upper + upper_reciprocal * lower)
}
