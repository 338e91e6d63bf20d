//! Sine, cosine and tangent.
//!
//! Angles are reduced by integers: a product with as many digits of 2/pi as matter. Coefficients: FreeBSD's msun. Copyright (C) 1993
//! by Sun Microsystems, Inc. All rights reserved. Permission to use, copy, modify, and distribute this software is freely granted,
//! provided that this notice is preserved.

use crate::binary32::{FRACTION_MASK, IMPLICIT_BIT, INFINITY_BITS, biased_exponent, is_negative, magnitude_bits, nan};

/// Bits of pi/4: up to it an angle needs no reduction.
const QUARTER_PI_BITS: u32 = 0x3f49_0fdb;

/// Bits of 2^-12: below it sin x rounds to x, and cos x to 1.
const TINY_BITS: u32 = 0x3980_0000;

/// Digits of 2/pi to the base 2^32, after one zero that stands for the digits before the point.
const TWO_OVER_PI: [u32; 8] = [
    0x0000_0000,
    0xa2f9_836e,
    0x4e44_1529,
    0xfc27_57d1,
    0xf534_ddc0,
    0xdb62_9599,
    0x3c43_9041,
    0xfe51_63ab,
];

/// Number pi/2 2^-64, which makes an angle of a fraction of pi/2 in units of 2^-64.
const UNIT: f32 = 8.515_304e-20;

/// Coefficients of x^3, x^5, x^7 and x^9 of the sine.
const SINE: [f32; 4] = [-1.666_666_7e-1, 8.333_329e-3, -1.983_933_5e-4, 2.718_311_4e-6];

/// Coefficients of x^4, x^6 and x^8 of the cosine.
const COSINE: [f32; 3] = [4.166_662_4e-2, -1.388_676_4e-3, 2.439_044_9e-5];

/// Sine and cosine of one angle.
pub struct SinCos {
    /// Sine
    pub sin: f32,
    /// Cosine
    pub cos: f32,
}

/// Angle x as a multiple of pi/2 plus a rest of pi/4 at most.
struct ReducedAngle {
    /// Multiple of pi/2, to which a multiple of 4 may have been added.
    quadrant: u32,
    /// Rest (rad).
    angle: f32,
}

/// Returns the sine of an angle x (rad).
#[must_use]
pub fn sin(x: f32) -> f32 {
    let both = sincos(x);
    both.sin
}

/// Returns the cosine of an angle x (rad).
#[must_use]
pub fn cos(x: f32) -> f32 {
    let both = sincos(x);
    both.cos
}

/// Returns the tangent of an angle x (rad).
#[must_use]
pub fn tan(x: f32) -> f32 {
    let both = sincos(x);
    both.sin / both.cos
}

/// Returns the sine and the cosine of an angle x (rad).
#[must_use]
pub fn sincos(x: f32) -> SinCos {
    let bits = magnitude_bits(x);
    if bits <= QUARTER_PI_BITS {
        if bits < TINY_BITS {
            return SinCos { sin: x, cos: 1.0 };
        }
        return SinCos { sin: near_sine(x), cos: near_cosine(x) };
    }
    if bits >= INFINITY_BITS {
        return SinCos { sin: nan(), cos: nan() };
    }
    let reduced = reduce(x);
    let sine = near_sine(reduced.angle);
    let cosine = near_cosine(reduced.angle);
    match reduced.quadrant & 3 {
        0 => SinCos { sin: sine, cos: cosine },
        1 => SinCos { sin: cosine, cos: -sine },
        2 => SinCos { sin: -sine, cos: -cosine },
        _ => SinCos { sin: -cosine, cos: sine },
    }
}

/// Returns the remainder of a finite angle x (rad) above pi/4 in magnitude after division by pi/2.
fn reduce(x: f32) -> ReducedAngle {
    let significand = u64::from((x.to_bits() & FRACTION_MASK) | IMPLICIT_BIT);
    // The digits of 2/pi above bit number `skipped` of the table give multiples of 4.
    let skipped = biased_exponent(x) - 120;
    let first = (skipped >> 5) as usize;
    let shift = 32 - (skipped & 31);
    let upper = digits(first, shift);
    let middle = digits(first + 1, shift);
    let lower = digits(first + 2, shift);

    let low = significand * lower;
    let mid = significand * middle + (low >> 32);
    let high = significand * upper + (mid >> 32);
    // Product modulo 4, in units of 2^-62 and, of the rest, 2^-94.
    let product = (high << 32) | (mid & 0xffff_ffff);
    let rest = (low & 0xffff_ffff) >> 30;
    let rounded = product.wrapping_add(0x2000_0000_0000_0000);
    let quadrant = (rounded >> 62) as u32;
    let fraction = ((product << 2) | rest) as i64;
    let angle = fraction as f32 * UNIT;
    if is_negative(x) {
        return ReducedAngle { quadrant: 4 - quadrant, angle: -angle };
    }
    ReducedAngle { quadrant, angle }
}

/// Returns 32 bits of 2/pi: those of the digit at `index` and of the next one, without the lower `shift` bits of both.
fn digits(index: usize, shift: u32) -> u64 {
    let both = (u64::from(TWO_OVER_PI[index & 7]) << 32) | u64::from(TWO_OVER_PI[(index + 1) & 7]);
    (both >> shift) & 0xffff_ffff
}

/// Returns the sine of an angle x (rad) of at most pi/4.
fn near_sine(x: f32) -> f32 {
    let z = x * x;
    x + z * x * (SINE[0] + z * (SINE[1] + z * (SINE[2] + z * SINE[3])))
}

/// Returns the cosine of an angle x (rad) of at most pi/4.
fn near_cosine(x: f32) -> f32 {
    let z = x * x;
    let half = 0.5 * z;
    let first_terms = 1.0 - half;
    // The rounding error of the first terms is added back.
    first_terms + (((1.0 - first_terms) - half) + z * z * (COSINE[0] + z * (COSINE[1] + z * COSINE[2])))
}
