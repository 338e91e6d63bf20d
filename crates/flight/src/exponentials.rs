//! Exponential function and natural logarithm.
//!
//! Algorithm and coefficients: fdlibm and FreeBSD's msun. Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
//! Permission to use, copy, modify, and distribute this software is freely granted, provided that this notice is preserved.

use crate::binary64::{
    INFINITY_WORD, NORMAL_WORD, infinity, is_negative, magnitude_word, nan, power_of_two, scaled,
};

/// First 32 bits of ln 2.
const LN_2_FIRST: f64 = 6.931_471_803_691_238e-1;
/// Difference between ln 2 and its first bits.
const LN_2_REST: f64 = 1.908_214_929_270_587_7e-10;

/// Greatest argument of a finite exponential.
const GREATEST: f64 = 709.782_712_893_384;
/// Least argument of an exponential that does not round to zero.
const LEAST: f64 = -745.133_219_101_941_1;
/// Upper word of 708.39: below it no exponential over- or underflows.
const EXTREME_WORD: u32 = 0x4086_232b;
/// Upper word of 56 ln 2: from it on exp(x) - 1 is exp(x), or -1.
const LARGE_WORD: u32 = 0x4043_687a;
/// Upper word of ln(2)/2: up to it an exponential needs no reduction.
const HALF_LN_2_WORD: u32 = 0x3fd6_2e42;
/// Upper word of 3 ln(2)/2: below it the multiple of ln 2 is 1.
const THREE_HALVES_LN_2_WORD: u32 = 0x3ff0_a2b2;
/// Upper word of 2^-28: up to it exp x rounds to 1 + x.
const TINY_WORD: u32 = 0x3e30_0000;
/// Upper word of 2^-54: below it exp(x) - 1 rounds to x.
const TINY_MINUS_ONE_WORD: u32 = 0x3c90_0000;

/// Coefficients of x^2, x^4, .. x^10 in x - 2 (exp(x) - 1)/(exp(x) + 1), roughly.
const EXPONENTIAL: [f64; 5] = [
    1.666_666_666_666_660_2e-1,
    -2.777_777_777_701_559_3e-3,
    6.613_756_321_437_934e-5,
    -1.653_390_220_546_525_2e-6,
    4.138_136_797_057_238_5e-8,
];

/// Coefficients of h, h^2, .. h^5 for h = x²/2 in the series of exp(x) - 1.
const MINUS_ONE: [f64; 5] = [
    -3.333_333_333_333_313e-2,
    1.587_301_587_254_814_6e-3,
    -7.936_507_578_674_88e-5,
    4.008_217_827_329_362e-6,
    -2.010_992_181_836_243_7e-7,
];

/// Upper word of sqrt(1/2): a logarithm is of a number from it to twice it, and of a power of two.
const ROOT_HALF_WORD: u32 = 0x3fe6_a09e;
/// Number 2^54.
const TWO_TO_54: f64 = 18_014_398_509_481_984.0;

/// Coefficients of s^2, s^4, .. s^14 in the series of the logarithm.
const LOGARITHM: [f64; 7] = [
    6.666_666_666_666_735e-1,
    3.999_999_999_940_942e-1,
    2.857_142_874_366_239e-1,
    2.222_219_843_214_978_4e-1,
    1.818_357_216_161_805e-1,
    1.531_383_769_920_937_3e-1,
    1.479_819_860_511_658_6e-1,
];

/// Returns the multiple of ln 2 that is nearest to x, for x above ln(2)/2 in magnitude.
#[inline]
fn nearest_multiple(x: f64, word: u32) -> i32 {
    if word < THREE_HALVES_LN_2_WORD {
        if x < 0.0 {
            return -1;
        }
        return 1;
    }
    (core::f64::consts::LOG2_E * x + 0.5_f64.copysign(x)) as i32
}

/// Returns e^x.
#[must_use]
pub fn exp(x: f64) -> f64 {
    let word = magnitude_word(x);
    if word >= EXTREME_WORD {
        if x.is_nan() {
            return nan();
        }
        if x > GREATEST {
            return infinity();
        }
        if x < LEAST {
            return 0.0;
        }
    }
    if word <= HALF_LN_2_WORD {
        if word <= TINY_WORD {
            return 1.0 + x;
        }
        return reduced_exponential(x, x, 0.0);
    }
    let multiple = nearest_multiple(x, word);
    let first = x - f64::from(multiple) * LN_2_FIRST;
    let rest = f64::from(multiple) * LN_2_REST;
    scaled(reduced_exponential(first - rest, first, rest), multiple)
}

/// Returns e^x of x = first - rest, of at most ln(2)/2 in magnitude.
#[inline]
fn reduced_exponential(x: f64, first: f64, rest: f64) -> f64 {
    let z = x * x;
    let series = x - z
        * (EXPONENTIAL[0]
            + z * (EXPONENTIAL[1] + z * (EXPONENTIAL[2] + z * (EXPONENTIAL[3] + z * EXPONENTIAL[4]))));
    1.0 + (x * series / (2.0 - series) - rest + first)
}

/// Returns e^x - 1, to full precision for small x.
#[must_use]
pub fn expm1(x: f64) -> f64 {
    let word = magnitude_word(x);
    if word >= LARGE_WORD {
        if x.is_nan() {
            return nan();
        }
        if x < 0.0 {
            return -1.0;
        }
        if x > GREATEST {
            return infinity();
        }
    }
    let mut multiple: i32 = 0;
    let mut reduced = x;
    let mut tail = 0.0;
    if word > HALF_LN_2_WORD {
        multiple = nearest_multiple(x, word);
        let first = x - f64::from(multiple) * LN_2_FIRST;
        let rest = f64::from(multiple) * LN_2_REST;
        reduced = first - rest;
        tail = (first - reduced) - rest;
    } else if word < TINY_MINUS_ONE_WORD {
        return x;
    }

    let half = 0.5 * reduced;
    let h = reduced * half;
    let series = 1.0
        + h * (MINUS_ONE[0]
            + h * (MINUS_ONE[1] + h * (MINUS_ONE[2] + h * (MINUS_ONE[3] + h * MINUS_ONE[4]))));
    let t = 3.0 - series * half;
    let quotient = h * ((series - t) / (6.0 - reduced * t));
    if multiple == 0 {
        return reduced - (reduced * quotient - h);
    }
    // e^reduced = 1 + reduced - excess
    let excess = (reduced * (quotient - tail) - tail) - h;
    scaled_minus_one(reduced, excess, multiple)
}

/// Returns 2^multiple (1 + reduced - excess) - 1 for a multiple other than 0.
#[inline]
fn scaled_minus_one(reduced: f64, excess: f64, multiple: i32) -> f64 {
    if multiple == -1 {
        return 0.5 * (reduced - excess) - 0.5;
    }
    if multiple == 1 {
        if reduced < -0.25 {
            return -2.0 * (excess - (reduced + 0.5));
        }
        return 1.0 + 2.0 * (reduced - excess);
    }
    if multiple > 0 {
        if multiple < 20 {
            return (reduced - excess + (1.0 - power_of_two(-multiple))) * power_of_two(multiple);
        }
        if multiple <= 56 {
            return (reduced - (excess + power_of_two(-multiple)) + 1.0) * power_of_two(multiple);
        }
    }
    scaled(reduced - excess + 1.0, multiple) - 1.0
}

/// Returns the natural logarithm of x; NaN below zero, and negative infinity for zero.
#[must_use]
pub fn log(x: f64) -> f64 {
    let mut bits = x.to_bits();
    let mut word = (bits >> 32) as u32;
    let mut exponent: i32 = -1023;
    // Negative numbers have the greatest words.
    if word.wrapping_sub(NORMAL_WORD) >= INFINITY_WORD - NORMAL_WORD {
        if x == 0.0 {
            return -infinity();
        }
        if x.is_nan() || is_negative(x) {
            return nan();
        }
        if word == INFINITY_WORD {
            return x;
        }
        bits = (x * TWO_TO_54).to_bits();
        word = (bits >> 32) as u32;
        exponent -= 54;
    }
    // x = 2^exponent (1 + f), with 1 + f from sqrt(1/2) to sqrt(2)
    word += 0x3ff0_0000 - ROOT_HALF_WORD;
    exponent += (word >> 20) as i32;
    let upper = u64::from((word & 0x000f_ffff) + ROOT_HALF_WORD);
    let f = f64::from_bits((upper << 32) | (bits & 0xffff_ffff)) - 1.0;
    let half_square = 0.5 * f * f;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let odd_terms = w * (LOGARITHM[1] + w * (LOGARITHM[3] + w * LOGARITHM[5]));
    let even_terms = z * (LOGARITHM[0] + w * (LOGARITHM[2] + w * (LOGARITHM[4] + w * LOGARITHM[6])));
    let series = even_terms + odd_terms;
    let multiple = f64::from(exponent);
    s * (half_square + series) + multiple * LN_2_REST - half_square + f + multiple * LN_2_FIRST
}
