//! Numbers of 64 bits: words of their bits, powers of two, infinity and NaN.

/// Bits of the fraction.
pub const FRACTION_MASK: u64 = 0x000f_ffff_ffff_ffff;

/// Bit of the significand before the point, which normal numbers do not store.
pub const IMPLICIT_BIT: u64 = 0x0010_0000_0000_0000;

/// Biased exponent of 1.
pub const ONE_EXPONENT: u32 = 1023;

/// Biased exponent from which on every number is an integer.
pub const INTEGER_EXPONENT: u32 = 1023 + 52;

/// Greatest number below 1/2.
pub const BELOW_HALF: f64 = 0.499_999_999_999_999_94;

/// Upper word of infinity and, as the least one, of NaN.
pub const INFINITY_WORD: u32 = 0x7ff0_0000;

/// Upper word of 1.
pub const ONE_WORD: u32 = 0x3ff0_0000;

/// Upper word of the least normal number.
pub const NORMAL_WORD: u32 = 0x0010_0000;

/// Returns the upper word of |x|: 11 bits of the exponent, biased by 1023, and 20 bits of the fraction.
#[inline]
#[must_use]
pub fn magnitude_word(x: f64) -> u32 {
    ((x.to_bits() >> 32) as u32) & 0x7fff_ffff
}

/// True if the sign bit of x is set: for -0 as well.
#[inline]
#[must_use]
pub fn is_negative(x: f64) -> bool {
    (x.to_bits() >> 63) != 0
}

/// Returns the exponent of x, biased by 1023.
#[inline]
#[must_use]
pub fn biased_exponent(x: f64) -> u32 {
    ((x.to_bits() >> 52) as u32) & 0x7ff
}

/// Returns x with the lower 32 bits of its fraction set to zero.
#[inline]
#[must_use]
pub fn upper_half(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & 0xffff_ffff_0000_0000)
}

/// Returns x, or -x if the sign is to be changed.
#[inline]
#[must_use]
pub fn negated_if(is_negated: bool, x: f64) -> f64 {
    if is_negated {
        return -x;
    }
    x
}

/// Returns 2^exponent for an exponent from -1022 to 1023.
#[inline]
#[must_use]
pub fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

/// Returns x 2^exponent, rounded once, for x from 1/4 to 4 and an exponent from -1990 to 2046.
#[inline]
#[must_use]
pub fn scaled(x: f64, exponent: i32) -> f64 {
    if exponent > 1023 {
        return x * power_of_two(1023) * power_of_two(exponent - 1023);
    }
    if exponent < -1022 {
        return x * power_of_two(-969) * power_of_two(exponent + 969);
    }
    x * power_of_two(exponent)
}

/// Returns positive infinity.
#[inline]
#[must_use]
pub fn infinity() -> f64 {
    f64::from_bits(0x7ff0_0000_0000_0000)
}

/// Returns the NaN that all functions of this crate return: quiet, positive, without payload.
#[inline]
#[must_use]
pub fn nan() -> f64 {
    f64::from_bits(0x7ff8_0000_0000_0000)
}
