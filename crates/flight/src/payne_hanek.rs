//! Remainder of a huge angle after division by pi/2, by the digits of 2/pi that matter: the method of Payne and Hanek.
//!
//! Algorithm and coefficients: fdlibm and FreeBSD's msun. Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
//! Permission to use, copy, modify, and distribute this software is freely granted, provided that this notice is preserved.

use crate::binary64::{FRACTION_MASK, IMPLICIT_BIT, biased_exponent, is_negative, power_of_two};

/// Digits of 2/pi to the base 2^24, after two zeros that stand for the digits before the point.
#[rustfmt::skip]
const TWO_OVER_PI: [u32; 64] = [
    0x000_000, 0x000_000, 0xa2f_983, 0x6e4_e44, 0x152_9fc, 0x275_7d1, 0xf53_4dd, 0xc0d_b62,
    0x959_93c, 0x439_041, 0xfe5_163, 0xabd_ebb, 0xc56_1b7, 0x246_e3a, 0x424_dd2, 0xe00_649,
    0x2ee_a09, 0xd19_21c, 0xfe1_deb, 0x1cb_129, 0xa73_ee8, 0x823_5f5, 0x2eb_b44, 0x84e_99c,
    0x702_6b4, 0x5f7_e41, 0x399_1d6, 0x398_353, 0x39f_49c, 0x845_f8b, 0xbdf_928, 0x3b1_ff8,
    0x97f_fde, 0x059_80f, 0xef2_f11, 0x8b5_a0a, 0x6d1_f6d, 0x367_ecf, 0x27c_b09, 0xb74_f46,
    0x3f6_69e, 0x5fe_a2d, 0x752_7ba, 0xc7e_be5, 0xf17_b3d, 0x073_9f7, 0x8a5_292, 0xea6_bfb,
    0x5fb_11f, 0x8d5_d08, 0x560_330, 0x46f_c7b, 0x6ba_bf0, 0xcfb_c20, 0x9af_436, 0x1da_9e3,
    0x916_15e, 0xe61_b08, 0x659_985, 0x5f1_4a0, 0x684_08d, 0xffd_880, 0x4d7_327, 0x310_606,
];

/// Parts of pi/2 of 24 bits each.
const HALF_PI: [f64; 5] = [
    1.570_796_251_296_997,
    7.549_789_415_861_596e-8,
    5.390_302_529_957_765e-15,
    3.282_003_415_807_913e-22,
    1.270_655_753_080_676e-29,
];

/// Greatest digit to the base 2^24.
const DIGIT_MASK: u64 = 0xff_ffff;

/// Unit 2^-24 of a digit relative to the one before it.
const DIGIT_UNIT: f64 = 5.960_464_477_539_063e-8;

/// Position of the last digit of the product at first: the digits above it give 53 bits unless they cancel.
const FIRST_LAST: usize = 4;
/// Position of the last digit, at most. No number of 64 bits is so close to a multiple of pi/2 that it is reached.
const FARTHEST_LAST: usize = 12;

/// Angle x as a multiple of pi/2 plus a rest of about pi/4 at most.
pub struct ReducedAngle {
    /// Multiple of pi/2, to which a multiple of 4 may have been added.
    pub quadrant: u32,
    /// Rest (rad), rounded.
    pub angle: f64,
    /// Difference (rad) between the rest and the rounded one.
    pub tail: f64,
}

/// Product x 2/pi modulo 8, in digits to the base 2^24.
struct Product {
    /// Digits, the most significant first. The first two are the part of the leading term after the point.
    digits: [u64; 16],
    /// Integer nearest to the product.
    multiple: u32,
    /// True if that integer is above the product; then the digits are of the difference to it.
    is_above: bool,
}

/// Angle in pieces of 24 bits, and the digits of 2/pi to multiply.
struct Factors {
    /// Significand's bits 52 to 29.
    upper: u64,
    /// Significand's bits 28 to 5.
    middle: u64,
    /// Significand's bits 4 to 0, with 19 zeros.
    lower: u64,
    /// Position in 2/pi of the first digit that matters: those above give multiples of 8.
    first: usize,
    /// Exponent of 2 of the leading term, from -27 to 2.
    exponent: i32,
}

/// Returns the remainder of a finite angle x (rad) of at least 2^20 pi/2 in magnitude after division by pi/2.
#[must_use]
pub fn reduce_huge(x: f64) -> ReducedAngle {
    let factors = split(x);
    let mut last = FIRST_LAST;
    let mut product = multiply(&factors, last);
    let mut zeros = cancelled_digits(&product, last);
    while zeros != 0 && last + zeros <= FARTHEST_LAST {
        last += zeros;
        product = multiply(&factors, last);
        zeros = cancelled_digits(&product, last);
    }
    let rest = convert(&product, factors.exponent, last);
    if is_negative(x) {
        return ReducedAngle {
            quadrant: product.multiple.wrapping_mul(3) & 3,
            angle: -rest.angle,
            tail: -rest.tail,
        };
    }
    ReducedAngle { quadrant: product.multiple & 3, angle: rest.angle, tail: rest.tail }
}

/// Returns the pieces of |x|, and the position of the digits of 2/pi to multiply them with.
fn split(x: f64) -> Factors {
    let significand = (x.to_bits() & FRACTION_MASK) | IMPLICIT_BIT;
    let exponent = biased_exponent(x);
    // The first piece is an integer times 2^(exponent - 1046).
    let first: u32 = if exponent < 1049 { 0 } else { (exponent - 1049) / 24 };
    Factors {
        upper: significand >> 29,
        middle: (significand >> 5) & DIGIT_MASK,
        lower: (significand << 19) & DIGIT_MASK,
        first: first as usize,
        exponent: exponent as i32 - 1046 - 24 * (first as i32 + 1),
    }
}

/// Returns the terms of the product from the leading one to that at the position `last`, and its nearest integer.
fn multiply(factors: &Factors, last: usize) -> Product {
    let mut product = Product { digits: [0; 16], multiple: 0, is_above: false };
    let mut carry: u64 = 0;
    let mut position = last;
    while position > 0 {
        let sum = carry + term(factors, position);
        product.digits[(position + 1) & 15] = sum & DIGIT_MASK;
        carry = sum >> 24;
        position -= 1;
    }
    let leading = carry + term(factors, 0);

    // The point is within the leading term, at its end, or one or two bits into the next digit.
    let mut fraction: u64 = 0;
    let mut fraction_unit: u64 = 0;
    let mut next_mask = DIGIT_MASK;
    if factors.exponent < 0 {
        let bits = (-factors.exponent) as u32;
        fraction_unit = 1_u64 << bits;
        fraction = leading & (fraction_unit - 1);
        product.multiple = (leading >> bits) as u32;
        product.is_above = (fraction >> (bits - 1)) != 0;
    } else {
        let bits = factors.exponent as u32;
        next_mask = DIGIT_MASK >> bits;
        product.multiple = ((leading << bits) | (product.digits[2] >> (24 - bits))) as u32;
        product.digits[2] &= next_mask;
        product.is_above = (product.digits[2] >> (23 - bits)) != 0;
    }

    if product.is_above {
        // The integer above is nearer: the complement of all digits.
        product.multiple = product.multiple.wrapping_add(1);
        let mut borrow: u64 = 0;
        position = last + 1;
        while position > 1 {
            let digit = product.digits[position & 15];
            product.digits[position & 15] = 0_u64.wrapping_sub(digit + borrow) & DIGIT_MASK;
            if (digit | borrow) != 0 {
                borrow = 1;
            }
            position -= 1;
        }
        product.digits[2] &= next_mask;
        if factors.exponent < 0 {
            fraction = fraction_unit - fraction - borrow;
        }
    }
    product.digits[0] = fraction >> 24;
    product.digits[1] = fraction & DIGIT_MASK;
    product
}

/// Returns the sum of the products of digits that belong to a position: below 2^50.
#[inline]
fn term(factors: &Factors, position: usize) -> u64 {
    let digit = factors.first + position + 2;
    factors.upper * u64::from(TWO_OVER_PI[digit & 63])
        + factors.middle * u64::from(TWO_OVER_PI[digit.wrapping_sub(1) & 63])
        + factors.lower * u64::from(TWO_OVER_PI[digit.wrapping_sub(2) & 63])
}

/// Returns the number of digits that the product needs beyond `last`, for those that cancelled: 0 if it has enough.
fn cancelled_digits(product: &Product, last: usize) -> usize {
    if (product.digits[0] | product.digits[1]) != 0 {
        return 0;
    }
    let extra = last - FIRST_LAST;
    for i in 0..extra {
        if product.digits[(i + 2) & 15] != 0 {
            return 0;
        }
    }
    let mut zeros: usize = 1;
    while zeros < FIRST_LAST && product.digits[(extra + zeros + 1) & 15] == 0 {
        zeros += 1;
    }
    zeros
}

/// Returns the digits times pi/2, as a rounded angle and its tail (rad).
fn convert(product: &Product, exponent: i32, last: usize) -> ReducedAngle {
    let mut leading: usize = 0;
    while leading <= last && product.digits[leading & 15] == 0 {
        leading += 1;
    }
    let count = last + 2 - leading;
    let mut unit = power_of_two(exponent + 24 - 24 * (leading as i32));
    let mut terms = [0.0; 16];
    for i in 0..count {
        terms[i & 15] = unit * product.digits[(leading + i) & 15] as f64;
        unit *= DIGIT_UNIT;
    }

    let mut sums = [0.0; 16];
    for i in 0..count {
        let mut sum = 0.0;
        let mut part: usize = 0;
        while part < 5 && part <= i {
            sum += HALF_PI[part] * terms[(i - part) & 15];
            part += 1;
        }
        sums[i & 15] = sum;
    }

    // From the least: another order has other bits.
    let mut angle = 0.0;
    let mut position = count;
    while position > 0 {
        position -= 1;
        angle += sums[position & 15];
    }
    let mut tail = sums[0] - angle;
    for i in 1..count {
        tail += sums[i & 15];
    }
    let mut rest = ReducedAngle { quadrant: 0, angle, tail };
    if product.is_above {
        rest.angle = -angle;
        rest.tail = -tail;
    }
    rest
}
