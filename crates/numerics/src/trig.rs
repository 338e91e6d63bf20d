//! Branch-free sine, cosine and arc tangent, for single numbers and SIMD lanes: the polynomials of fdlibm.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#![allow(clippy::excessive_precision, reason = "as fdlibm has them")]

use std::f64::consts::FRAC_2_PI;

use crate::lanes::LaneFloat;

/// Angle (rad) up to which the reduction by pi/2 in three parts is exact.
pub const FARTHEST: f64 = 1e6;

/// Constant pi/2: its first 33 bits, the next 33, and the rest.
const HALF_PI: [f64; 3] =
    [1.570_796_326_734_125_614_17, 6.077_100_506_303_965_976_60e-11, 2.022_266_248_795_950_631_54e-21];
/// Constant 1.5 2^52: adding and subtracting it rounds to an integer.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

const SINE: [f64; 6] = [
    -1.666_666_666_666_663_243_48e-1,
    8.333_333_333_322_489_461_24e-3,
    -1.984_126_982_985_794_931_34e-4,
    2.755_731_370_707_006_767_89e-6,
    -2.505_076_025_340_686_341_95e-8,
    1.589_690_995_211_550_102_21e-10,
];
const COSINE: [f64; 6] = [
    4.166_666_666_666_660_190_37e-2,
    -1.388_888_888_887_410_957_49e-3,
    2.480_158_728_947_672_941_78e-5,
    -2.755_731_435_139_066_330_35e-7,
    2.087_572_321_298_174_827_90e-9,
    -1.135_964_755_778_819_482_65e-11,
];
/// Coefficients of the arc tangent.
const ARC: [f64; 11] = [
    3.333_333_333_333_293_180_27e-1,
    -1.999_999_999_987_648_324_76e-1,
    1.428_571_427_250_346_637_11e-1,
    -1.111_111_040_546_235_578_80e-1,
    9.090_887_133_436_506_561_96e-2,
    -7.691_876_205_044_829_994_95e-2,
    6.661_073_137_387_531_206_69e-2,
    -5.833_570_133_790_573_486_45e-2,
    4.976_877_994_615_932_360_17e-2,
    -3.653_157_274_421_691_552_70e-2,
    1.628_582_011_536_578_236_23e-2,
];

/// Returns the integer nearest to a number below 2^51.
#[inline(always)]
pub fn nearest<R: LaneFloat>(x: R) -> R {
    let rounder = x.splat(ROUNDER);
    (x + rounder) - rounder
}

/// Returns sine and cosine of an angle (rad) up to [`FARTHEST`]; within 1 unit in the last place.
#[inline(always)]
pub fn sincos<R: LaneFloat>(x: R) -> (R, R) {
    let turns = nearest(x * x.splat(FRAC_2_PI));
    // The products of the first two parts, and the first difference, are exact.
    let first = x - turns * x.splat(HALF_PI[0]);
    let second = turns * x.splat(HALF_PI[1]);
    let high = first - second;
    let back = first - high;
    let low = (first - (high + back)) + (back - second);
    let rest = turns * x.splat(HALF_PI[2]) - low;
    let angle = high - rest;
    let (sin, cos) = within(angle, (high - angle) - rest);
    // Quarter turns modulo 4, -2 to 2, rotate the pair: by products with 1, 0 or -1 only, which are exact.
    let quarters = turns - x.splat(4.0) * nearest(turns * x.splat(0.25));
    let size = quarters.abs();
    let (along, across) = (x.splat(1.0) - size, quarters * (x.splat(2.0) - size));
    (along * sin + across * cos, along * cos - across * sin)
}

/// Returns sine and cosine of any angle (rad): those of [`sincos`] up to [`FARTHEST`].
#[inline]
pub fn sincos_any(x: f64) -> (f64, f64) {
    if x.abs() < FARTHEST { sincos(x) } else { libm::sincos(x) }
}

/// Returns sine and cosine of an angle (rad) of at most pi/4.
#[inline(always)]
pub fn sincos_short<R: LaneFloat>(x: R) -> (R, R) {
    let z = x * x;
    let w = z * z;
    let sines = x.splat(SINE[1])
        + z * (x.splat(SINE[2]) + z * x.splat(SINE[3]))
        + z * w * (x.splat(SINE[4]) + z * x.splat(SINE[5]));
    let sin = x + z * x * (x.splat(SINE[0]) + z * sines);
    let cosines = z * (x.splat(COSINE[0]) + z * (x.splat(COSINE[1]) + z * x.splat(COSINE[2])))
        + w * w * (x.splat(COSINE[3]) + z * (x.splat(COSINE[4]) + z * x.splat(COSINE[5])));
    let one = x.splat(1.0);
    let half = x.splat(0.5) * z;
    let near = one - half;
    (sin, near + (((one - near) - half) + z * cosines))
}

/// Returns sine and cosine of an angle (rad) of at most pi/4, given as a sum of two parts.
#[inline(always)]
fn within<R: LaneFloat>(x: R, y: R) -> (R, R) {
    let z = x * x;
    let w = z * z;
    let (one, half) = (x.splat(1.0), x.splat(0.5));
    let sines = x.splat(SINE[1])
        + z * (x.splat(SINE[2]) + z * x.splat(SINE[3]))
        + z * w * (x.splat(SINE[4]) + z * x.splat(SINE[5]));
    let v = z * x;
    let sin = x - ((z * (half * y - v * sines) - y) - v * x.splat(SINE[0]));
    let cosines = z * (x.splat(COSINE[0]) + z * (x.splat(COSINE[1]) + z * x.splat(COSINE[2])))
        + w * w * (x.splat(COSINE[3]) + z * (x.splat(COSINE[4]) + z * x.splat(COSINE[5])));
    let hz = half * z;
    let near = one - hz;
    (sin, near + (((one - near) - hz) + (z * cosines - x * y)))
}

/// Returns the arc tangent of a number up to 0.4375; within 1 unit in the last place.
#[inline(always)]
pub fn arc<R: LaneFloat>(t: R) -> R {
    let z = t * t;
    let w = z * z;
    let (mut odd, mut even) = (t.splat(ARC[10]), t.splat(ARC[9]));
    for i in [8, 6, 4, 2, 0] {
        odd = t.splat(ARC[i]) + w * odd;
    }
    for i in [7, 5, 3, 1] {
        even = t.splat(ARC[i]) + w * even;
    }
    t - t * (z * odd + w * even)
}

/// Returns the argument of a non-zero complex number, from -pi to pi (rad); within 1e-15.
#[inline(always)]
pub fn argument<R: LaneFloat>([re, im]: [R; 2]) -> R {
    let zero = re.splat(0.0);
    let (along, across) = (re.abs(), im.abs());
    let is_steep = along.lt(across);
    let (large, small) = (R::select(is_steep, across, along), R::select(is_steep, along, across));
    // Beyond pi/8, the angle to pi/4 is smaller.
    let is_near = (large * std::f64::consts::SQRT_2 - large).lt(small);
    let above = R::select(is_near, small - large, small);
    let below = R::select(is_near, small + large, large);
    let angle = R::select(is_near, re.splat(std::f64::consts::FRAC_PI_4), zero) + arc(above / below);
    let angle = R::select(is_steep, re.splat(std::f64::consts::FRAC_PI_2) - angle, angle);
    let angle = R::select(re.lt(zero), re.splat(std::f64::consts::PI) - angle, angle);
    R::select(im.lt(zero), -angle, angle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_of_all_sizes_agree_with_libm() {
        let mut worst = 0.0_f64;
        let mut check = |x: f64| {
            let ((sin, cos), (a, b)) = (sincos(x), libm::sincos(x));
            worst = worst.max((sin - a).abs()).max((cos - b).abs());
        };
        for i in 0..100_000 {
            let part = f64::from(i) / 100_000.0;
            for size in [1e-9, 0.7, 3.0, 40.0, 2e4, FARTHEST] {
                check(size * part);
                check(-size * part);
            }
            // Near multiples of pi/2, where most digits cancel.
            let quarter = f64::from(6 * i) * std::f64::consts::FRAC_PI_2;
            check(quarter);
            check(quarter.next_up());
        }
        assert!(worst < 1.2e-16, "{worst:e}");
    }

    #[test]
    fn arguments_agree_with_libm_in_every_quadrant() {
        for i in -4000..=4000 {
            let angle = std::f64::consts::PI * f64::from(i) / 4000.0;
            for size in [1e-200, 0.3, 4e100] {
                let (im, re) = (size * libm::sin(angle), size * libm::cos(angle));
                assert!((argument([re, im]) - libm::atan2(im, re)).abs() < 1e-15, "{angle}");
            }
        }
    }

    #[test]
    fn short_angles_and_arcs_agree_with_libm() {
        for i in -1000..=1000 {
            let part = f64::from(i) / 1000.0;
            let ((sin, cos), (a, b)) = (sincos_short(0.78 * part), libm::sincos(0.78 * part));
            assert!((sin - a).abs() < 1.2e-16 && (cos - b).abs() < 1.2e-16, "{part}");
            let t = 0.4375 * part;
            assert!((arc(t) - libm::atan(t)).abs() <= 1e-16 * t.abs(), "{part}");
        }
        assert_eq!(nearest(2.5), 2.0);
    }
}
