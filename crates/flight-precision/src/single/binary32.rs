//! Numbers of 32 bits: their bits, infinity and NaN.

/// Bits of the fraction.
pub const FRACTION_MASK: u32 = 0x007f_ffff;

/// Bit of the significand before the point, which normal numbers do not store.
pub const IMPLICIT_BIT: u32 = 0x0080_0000;

/// Biased exponent of 1.
pub const ONE_EXPONENT: u32 = 127;

/// Biased exponent from which on every number is an integer.
pub const INTEGER_EXPONENT: u32 = 127 + 23;

/// Greatest number below 1/2.
pub const BELOW_HALF: f32 = 0.499_999_97;

/// Bits of infinity and, as the least ones, of NaN.
pub const INFINITY_BITS: u32 = 0x7f80_0000;

/// Returns the bits of |x|.
#[inline]
#[must_use]
pub fn magnitude_bits(x: f32) -> u32 {
    x.to_bits() & 0x7fff_ffff
}

/// True if the sign bit of x is set: for -0 as well.
#[inline]
#[must_use]
pub fn is_negative(x: f32) -> bool {
    (x.to_bits() >> 31) != 0
}

/// Returns the exponent of x, biased by 127.
#[inline]
#[must_use]
pub fn biased_exponent(x: f32) -> u32 {
    (x.to_bits() >> 23) & 0xff
}

/// Returns x, or -x if the sign is to be changed.
#[inline]
#[must_use]
pub fn negated_if(is_negated: bool, x: f32) -> f32 {
    if is_negated {
        return -x;
    }
    x
}

/// Returns the number nearest to an integer.
#[inline]
#[must_use]
pub fn single(x: u32) -> f32 {
    x as f32
}

/// Returns positive infinity.
#[inline]
#[must_use]
pub fn infinity() -> f32 {
    f32::from_bits(0x7f80_0000)
}

/// Returns the NaN that all functions of mathematics return: quiet, positive, without payload.
#[inline]
#[must_use]
pub fn nan() -> f32 {
    f32::from_bits(0x7fc0_0000)
}
