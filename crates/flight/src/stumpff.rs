//! Stumpff functions c_k(x²) = sum over j of (-x²)^j/(k + 2j)!, by which rotations are exact without division by an
//! axis (\[Hughes86\] writes them as sines and versines).

use crate::square_root::sqrt;
use crate::trigonometry::sin;

/// Stumpff functions c_1 to c_5 at the square of an angle.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Stumpff {
    /// Function c_1.
    pub c1: f64,
    /// Function c_2.
    pub c2: f64,
    /// Function c_3.
    pub c3: f64,
    /// Function c_4.
    pub c4: f64,
    /// Function c_5.
    pub c5: f64,
}

impl Stumpff {
    /// Returns the functions at the square of an angle (rad²).
    #[inline]
    pub fn at(square: f64) -> Self {
        if square < 10.0 {
            let c4: f64 = series(4, square) / 24.0;
            let c5: f64 = series(5, square) / 120.0;
            let c2: f64 = 0.5 - square * c4;
            let c3: f64 = 1.0 / 6.0 - square * c5;
            return Self { c1: 1.0 - square * c3, c2, c3, c4, c5 };
        }
        let x: f64 = sqrt(square);
        let half: f64 = sin(0.5 * x);
        let c1: f64 = sin(x) / x;
        let c2: f64 = 2.0 * half * half / square;
        let c3: f64 = (1.0 - c1) / square;
        Self { c1, c2, c3, c4: (0.5 - c2) / square, c5: (1.0 / 6.0 - c3) / square }
    }
}

/// Returns the series of c_k below 10, scaled to a first term of 1: 20 terms are exact to rounding, and five for small
/// angles.
#[inline]
fn series(k: u32, square: f64) -> f64 {
    if square < 1e-2 {
        return sum(k, 5, square);
    }
    sum(k, 20, square)
}

/// Sums terms of the series. The number is a constant, so that few terms are unrolled.
#[inline]
fn sum(k: u32, terms: u32, square: f64) -> f64 {
    let mut sum: f64 = 1.0;
    for step in 1..terms {
        let j: u32 = terms - step;
        sum = 1.0 - square / f64::from((k + 2 * j - 1) * (k + 2 * j)) * sum;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_branches_agree_with_forty_digits() {
        // Reference by mpmath, 40 digits: sum of (-x²)^j/(k + 2j)!.
        let cases = [
            (0.0, [1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0]),
            (
                0.25,
                [
                    0.958_851_077_208_406,
                    0.489_669_752_438_509_13,
                    0.164_595_691_166_376,
                    0.041_320_990_245_963_46,
                    0.008_283_902_001_162_675,
                ],
            ),
            (
                40.0,
                [
                    0.006_539_307_734_329_603,
                    0.000_021_390_423_826_761_247,
                    0.024_836_517_306_641_76,
                    0.012_499_465_239_404_331,
                    0.003_545_753_734_000_623,
                ],
            ),
            (
                9.0,
                [
                    0.047_040_002_686_622_41,
                    0.221_110_277_400_049_5,
                    0.105_884_444_145_930_83,
                    0.030_987_746_955_550_056,
                    0.006_753_580_280_081_758_5,
                ],
            ),
        ];
        for (square, exact) in cases {
            let found = Stumpff::at(square);
            for (found, exact) in [found.c1, found.c2, found.c3, found.c4, found.c5].into_iter().zip(exact) {
                assert!((found - exact).abs() <= 4e-16, "{square} {found} {exact}");
            }
        }
    }

    /// Returns c_1 to c_5 below 10 by iterators.
    fn by_iterators(square: f64) -> [f64; 5] {
        let series = |order: u32| {
            let term = |j: u32| f64::from((order + 2 * j - 1) * (order + 2 * j));
            let terms = if square < 1e-2 { 5 } else { 20 };
            let sum = (1..terms).rev().fold(1.0, |sum, j| 1.0 - square / term(j) * sum);
            sum / (1..=order).map(f64::from).product::<f64>()
        };
        let (c4, c5) = (series(4), series(5));
        let (c2, c3) = (0.5 - square * c4, 1.0 / 6.0 - square * c5);
        [1.0 - square * c3, c2, c3, c4, c5]
    }

    #[test]
    fn series_have_the_bits_of_a_sum_by_iterators() {
        for step in 0..4000 {
            let square = 9.99 * libm::exp(-0.01 * f64::from(step));
            let found = Stumpff::at(square);
            assert_eq!([found.c1, found.c2, found.c3, found.c4, found.c5], by_iterators(square), "{square}");
        }
    }
}
