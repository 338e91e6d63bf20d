//! Arguments for comparisons: special numbers, random ones over all exponents, and those close to multiples of pi/2.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, LN_2, PI, SQRT_2};

/// Numbers at which functions have other branches, or special values; the tests take both signs and the neighbours.
pub const SPECIAL: [f64; 69] = [
    0.0,
    f64::from_bits(1),
    f64::MIN_POSITIVE,
    f64::MAX,
    f64::INFINITY,
    f64::NAN,
    // Powers of two from 2^-57 to 2^70, at which functions become x, 1 + x or a constant.
    f64::from_bits(0x3c60_0000_0000_0000),
    f64::from_bits(0x3c90_0000_0000_0000),
    f64::from_bits(0x3e30_0000_0000_0000),
    f64::from_bits(0x3e40_0000_0000_0000),
    f64::from_bits(0x3e46_a09e_0000_0000),
    f64::from_bits(0x3e50_0000_0000_0000),
    f64::from_bits(0x4330_0000_0000_0000),
    f64::from_bits(0x43f0_0000_0000_0000),
    f64::from_bits(0x4400_0000_0000_0000),
    f64::from_bits(0x4410_0000_0000_0000),
    f64::from_bits(0x4450_0000_0000_0000),
    // Ends of the intervals of arc functions.
    0.4375,
    0.5,
    0.6875,
    0.975,
    1.0,
    1.1875,
    1.5,
    2.0,
    2.4375,
    // Multiples of pi/4, of ln 2 and of sqrt(1/2).
    FRAC_PI_4,
    FRAC_PI_2,
    3.0 * FRAC_PI_4,
    PI,
    5.0 * FRAC_PI_4,
    3.0 * FRAC_PI_2,
    7.0 * FRAC_PI_4,
    2.0 * PI,
    9.0 * FRAC_PI_4,
    11.0 * FRAC_PI_4,
    1_048_576.0 * FRAC_PI_2,
    0.5 * LN_2,
    LN_2,
    1.5 * LN_2,
    2.5 * LN_2,
    56.0 * LN_2,
    708.396_418_532_264_1,
    709.782_712_893_384,
    745.133_219_101_941_1,
    SQRT_2,
    0.5 * SQRT_2,
    0.6744,
    0.25,
    10.0,
    19.5 * LN_2,
    20.5 * LN_2,
    // Numbers closest to a multiple of pi/2 for their exponent, the first of all numbers.
    f64::from_bits(0x7506_ac5b_262c_a1ff),
    f64::from_bits(0x416b_951f_1572_eba5),
    f64::from_bits(0x4825_04ca_c51f_1eaf),
    f64::from_bits(0x7dee_009c_5314_8be1),
    f64::from_bits(0x6404_c96c_1113_4d36),
    f64::from_bits(0x75bc_fe48_2285_f8ed),
    f64::from_bits(0x6a7d_b41f_3cb7_1d7b),
    f64::from_bits(0x4c4e_7e44_a78a_c18c),
    f64::from_bits(0x526c_45cd_1115_4dfd),
    f64::from_bits(0x6658_3009_e2e9_e2eb),
    f64::from_bits(0x4fcb_2196_364d_750b),
    f64::from_bits(0x7fc6_1a3d_b8c8_d129),
    1e22,
    // Sides whose squares over- or underflow.
    1e154,
    1e160,
    1e-136,
    1e-160,
];

/// Random numbers by splitmix64, the same in each run.
pub struct Arguments {
    state: u64,
}

impl Arguments {
    pub fn new() -> Self {
        Self { state: 20_260_101 }
    }

    fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = self.state;
        let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number of any sign, exponent and fraction: subnormal ones, infinities and NaN included.
    pub fn any(&mut self) -> f64 {
        f64::from_bits(self.bits())
    }

    /// Returns a number within a range.
    pub fn within(&mut self, range: [f64; 2]) -> f64 {
        let unit = (self.bits() >> 11) as f64 / 9_007_199_254_740_992.0;
        range[0] + unit * (range[1] - range[0])
    }

    /// Returns a number whose upper word is that of another number, or one of the two words next to it.
    pub fn near(&mut self, x: f64) -> f64 {
        let word = (x.to_bits() >> 32).wrapping_add(self.bits() % 3).wrapping_sub(1);
        f64::from_bits((word << 32) | (self.bits() & 0xffff_ffff))
    }

    /// Returns a number close to a multiple of pi/4: some units in the last place, or at most 2^-21 of itself, away.
    pub fn near_multiple(&mut self) -> f64 {
        let bits = self.bits();
        let multiple = ((bits >> 40) >> (bits & 15)) as f64 * FRAC_PI_4;
        let offset = ((bits >> 8) & 0xffff_ffff) >> ((bits >> 4) & 31);
        let x = f64::from_bits(multiple.to_bits().wrapping_add(offset.wrapping_sub(offset / 2)));
        if bits & 128 == 0 { x } else { -x }
    }
}

/// Returns a positive number and those within a few units in the last place of it, and of its upper word.
pub fn neighbours(x: f64) -> impl Iterator<Item = f64> {
    const OFFSETS: [i64; 11] =
        [0, 1, 2, 3, -1, -2, 1 << 31, 1 << 32, (1 << 32) - 1, -(1 << 32), -(1 << 32) - 1];
    OFFSETS.into_iter().map(move |offset| f64::from_bits(x.to_bits().wrapping_add(offset as u64)))
}
