//! Stumpff functions c_k(x²) = sum over j of (-x²)^j/(k + 2j)!, by which rotations are exact without division by an
//! axis (\[Hughes86\] writes them as sines and versines).

/// Returns c_1 to c_5 at the square of an angle (rad²).
pub fn stumpff(square: f64) -> [f64; 5] {
    if square < 10.0 {
        let (c4, c5) = (series::<4>(square), series::<5>(square));
        let (c2, c3) = (0.5 - square * c4, 1.0 / 6.0 - square * c5);
        return [1.0 - square * c3, c2, c3, c4, c5];
    }
    let x = f64::sqrt(square);
    let half = libm::sin(0.5 * x);
    let (c1, c2) = (libm::sin(x) / x, 2.0 * half * half / square);
    let c3 = (1.0 - c1) / square;
    [c1, c2, c3, (0.5 - c2) / square, (1.0 / 6.0 - c3) / square]
}

/// Returns c_K below 10 by its series: 20 terms are exact to rounding, and five for small angles.
fn series<const K: u32>(square: f64) -> f64 {
    let sum = if square < 1e-2 { sum::<K, 5>(square) } else { sum::<K, 20>(square) };
    sum / (1..=K).map(f64::from).product::<f64>()
}

/// Sums `TERMS` terms of the series, scaled to a first term of 1. The number is a constant, so that few terms are
/// unrolled.
#[inline]
fn sum<const K: u32, const TERMS: u32>(square: f64) -> f64 {
    let term = |j: u32| f64::from((K + 2 * j - 1) * (K + 2 * j));
    (1..TERMS).rev().fold(1.0, |sum, j| 1.0 - square / term(j) * sum)
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
            for (found, exact) in stumpff(square).into_iter().zip(exact) {
                assert!((found - exact).abs() <= 4e-16, "{square} {found} {exact}");
            }
        }
    }
}
