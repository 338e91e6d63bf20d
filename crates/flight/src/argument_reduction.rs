//! Remainder of an angle after division by pi/2.
//!
//! Algorithm and coefficients: fdlibm and FreeBSD's msun. Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
//! Permission to use, copy, modify, and distribute this software is freely granted, provided that this notice is preserved.

use crate::binary64::{biased_exponent, magnitude_word};
use crate::payne_hanek::{ReducedAngle, reduce_huge};

/// First 33 bits of pi/2.
const FIRST_PART: f64 = 1.570_796_326_734_125_6;
/// Difference between pi/2 and its first part.
const FIRST_REST: f64 = 6.077_100_506_506_192e-11;
/// Next 33 bits of pi/2.
const SECOND_PART: f64 = 6.077_100_506_303_966e-11;
/// Difference between pi/2 and its first two parts.
const SECOND_REST: f64 = 2.022_266_248_795_950_6e-21;
/// Third 33 bits of pi/2.
const THIRD_PART: f64 = 2.022_266_248_711_166_5e-21;
/// Difference between pi/2 and its first three parts.
const THIRD_REST: f64 = 8.478_427_660_368_9e-32;

/// Number 1.5 2^52, to which a sum is rounded to an integer, in the last bits of the sum.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// Upper word of 9 pi/4, up to which comparisons give the multiple of pi/2.
const COMPARED_WORD: u32 = 0x401c_463b;
/// Upper words of 3 pi/4, 5 pi/4 and 7 pi/4, where the multiple changes.
const CHANGES: [u32; 3] = [0x4002_d97c, 0x400f_6a7a, 0x4015_fdbc];
/// Upper 20 bits of the fraction of pi/2, pi and 2 pi.
const POWER_FRACTION: u32 = 0x9_21fb;
/// Upper word of 3 pi/2.
const TRIPLE_WORD: u32 = 0x4012_d97c;
/// Upper word of 2^20 pi/2, from which on three parts of pi/2 do not suffice.
const HUGE_WORD: u32 = 0x4139_21fb;

/// Returns the remainder of a finite angle x (rad) above pi/4 in magnitude after division by pi/2.
#[inline]
#[must_use]
pub fn reduce(x: f64) -> ReducedAngle {
    let word = magnitude_word(x);
    if word <= COMPARED_WORD && (word & 0xf_ffff) != POWER_FRACTION && word != TRIPLE_WORD {
        return reduce_near(x, word);
    }
    if word < HUGE_WORD {
        return reduce_medium(x);
    }
    reduce_huge(x)
}

/// Returns the remainder of an angle x (rad) up to 9 pi/4 that is not close to a multiple of pi/2.
#[inline]
fn reduce_near(x: f64, word: u32) -> ReducedAngle {
    if word <= CHANGES[1] {
        if word <= CHANGES[0] {
            return subtract_multiple(x, 1, FIRST_PART, FIRST_REST);
        }
        return subtract_multiple(x, 2, 2.0 * FIRST_PART, 2.0 * FIRST_REST);
    }
    if word <= CHANGES[2] {
        return subtract_multiple(x, 3, 3.0 * FIRST_PART, 3.0 * FIRST_REST);
    }
    subtract_multiple(x, 4, 4.0 * FIRST_PART, 4.0 * FIRST_REST)
}

/// Returns the remainder of an angle x (rad) after a multiple of pi/2 with the sign of x, in two parts.
#[inline(always)]
fn subtract_multiple(x: f64, quadrant: u32, part: f64, rest: f64) -> ReducedAngle {
    if x < 0.0 {
        let sum = x + part;
        let angle = sum + rest;
        return ReducedAngle { quadrant: 4 - quadrant, angle, tail: (sum - angle) + rest };
    }
    let difference = x - part;
    let angle = difference - rest;
    ReducedAngle { quadrant, angle, tail: (difference - angle) - rest }
}

/// Returns the remainder of an angle x (rad) below 2^20 pi/2; each cancellation of digits takes further digits of pi/2.
fn reduce_medium(x: f64) -> ReducedAngle {
    let shifted = x * core::f64::consts::FRAC_2_PI + ROUNDER;
    let multiple = shifted - ROUNDER;
    let quadrant = (shifted.to_bits() as u32) & 3;
    let exponent = biased_exponent(x);
    let mut difference = x - multiple * FIRST_PART;
    let mut product = multiple * FIRST_REST;
    let mut angle = difference - product;
    if exponent > biased_exponent(angle) + 16 {
        let before = difference;
        let part = multiple * SECOND_PART;
        difference = before - part;
        product = multiple * SECOND_REST - ((before - difference) - part);
        angle = difference - product;
        if exponent > biased_exponent(angle) + 49 {
            let next_before = difference;
            let next_part = multiple * THIRD_PART;
            difference = next_before - next_part;
            product = multiple * THIRD_REST - ((next_before - difference) - next_part);
            angle = difference - product;
        }
    }
    ReducedAngle { quadrant, angle, tail: (difference - angle) - product }
}
