//! Polynomials through smooth motions that have no series: interpolation at Chebyshev points, in parts that are halved until
//! the last coefficients are negligible.

use crate::polynomial::{Polynomial, TERMS};

/// Number of points of a part, less one.
const DEGREE: usize = 8;
/// Cosines of k pi/8 for k from 0 to 4.
const COSINES: [f64; 5] =
    [1.0, 0.923_879_532_511_286_7, std::f64::consts::FRAC_1_SQRT_2, 0.382_683_432_365_089_8, 0.0];
/// Length (s) of a part that is not halved.
const SHORTEST: f64 = 1e-7;

/// Evaluation of several functions at increasing times (s), with the values of each time together; `None` where there are none.
pub type FitValues<'a> = dyn FnMut(&[f64]) -> Option<Vec<Vec<f64>>> + 'a;

/// Fits several functions of time (s) on an interval, each to within its tolerance or, if that is larger, the rounding of its
/// values and times. Passes the start and length of each part (s) and the polynomials of all functions there to `take`;
/// returns false if there were no values.
///
/// The functions may not change faster than the parts of a ninth of the interval show.
pub fn fit(
    [from, to]: [f64; 2],
    tolerances: &[f64],
    evaluate: &mut FitValues<'_>,
    take: &mut dyn FnMut(f64, f64, &[Polynomial]),
) -> bool {
    let length = to - from;
    let times: Vec<f64> = (0..=DEGREE)
        .map(|point| if point == DEGREE { to } else { from + length * 0.5 * (1.0 - cosine(point)) })
        .collect();
    let Some(values) = evaluate(&times) else { return false };
    let mut all = Vec::new();
    for (function, tolerance) in tolerances.iter().enumerate() {
        let samples: [f64; DEGREE + 1] = std::array::from_fn(|point| values[point][function]);
        let coefficients = chebyshev(&samples);
        let [.., before, last] = coefficients;
        let tolerance = tolerance.max(rounding(&samples, [from, to]));
        // Halving does not help where a value is not a number.
        if before.abs() + last.abs() > tolerance && length > SHORTEST {
            let middle = 0.5 * (from + to);
            return fit([from, middle], tolerances, evaluate, take)
                && fit([middle, to], tolerances, evaluate, take);
        }
        all.push(monomials(&coefficients, tolerance));
    }
    take(from, length, &all);
    true
}

/// Returns a bound of the error of values between two times (s) by rounding, of themselves and of the times.
fn rounding(values: &[f64], [from, to]: [f64; 2]) -> f64 {
    let (low, high) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
    let late = from.abs().max(to.abs());
    8.0 * f64::EPSILON * (low.abs().max(high.abs()) + (high - low) / (to - from) * late)
}

/// Returns the cosine of `k` pi/8.
fn cosine(k: usize) -> f64 {
    match k % 16 {
        k @ 0..=4 => COSINES[k],
        k @ 5..=8 => -COSINES[8 - k],
        k @ 9..=12 => -COSINES[k - 8],
        k => COSINES[16 - k],
    }
}

/// Returns the coefficients of Chebyshev polynomials through values at Chebyshev points.
fn chebyshev(values: &[f64; DEGREE + 1]) -> [f64; DEGREE + 1] {
    let half = |index: usize| if index == 0 || index == DEGREE { 0.5 } else { 1.0 };
    std::array::from_fn(|k| {
        // The points run from -1 to 1: T_k there is (-1)^k cos(k j pi/8).
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        let sum: f64 =
            values.iter().enumerate().map(|(point, value)| half(point) * value * cosine(k * point)).sum();
        sign * half(k) * sum * 2.0 / DEGREE as f64
    })
}

/// Returns the polynomial in the elapsed fraction, without the last coefficients that are negligible.
fn monomials(coefficients: &[f64; DEGREE + 1], tolerance: f64) -> Polynomial {
    let mut kept = DEGREE + 1;
    while kept > 1 && coefficients[kept - 1].abs() <= 0.01 * tolerance {
        kept -= 1;
    }
    // T_0 = 1, T_1 = 2 s - 1, T_(k+1) = 2 (2 s - 1) T_k - T_(k-1).
    let mut sum = [0.0; TERMS];
    let (mut before, mut now) = ([0.0; TERMS], [0.0; TERMS]);
    now[0] = 1.0;
    for (k, coefficient) in coefficients[..kept].iter().enumerate() {
        sum.iter_mut().zip(now).for_each(|(sum, term)| *sum += coefficient * term);
        let factor = if k == 0 { 1.0 } else { 2.0 };
        let next = std::array::from_fn(|n| {
            let shifted = if n > 0 { now[n - 1] } else { 0.0 };
            factor * (2.0 * shifted - now[n]) - if k == 0 { 0.0 } else { before[n] }
        });
        (before, now) = (now, next);
    }
    Polynomial::new(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_follow_a_wave_and_a_corner() {
        let wave = |t: f64| libm::cos(3.0 * t);
        let corner = |t: f64| libm::fabs(t - 0.3);
        let mut evaluate =
            |times: &[f64]| Some(times.iter().map(|t| vec![wave(*t), corner(*t)]).collect::<Vec<_>>());
        let (mut worst, mut end, mut parts) = (0.0_f64, 0.0, 0);
        let mut take = |begin: f64, length: f64, all: &[Polynomial]| {
            assert!((begin - end).abs() < 1e-15);
            (end, parts) = (begin + length, parts + 1);
            for s in [0.0, 0.1, 0.37, 0.8, 1.0] {
                let t = begin + length * s;
                worst = worst.max((all[0].at(s) - wave(t)).abs()).max((all[1].at(s) - corner(t)).abs());
            }
        };
        assert!(fit([0.0, 2.0], &[1e-12, 1e-9], &mut evaluate, &mut take));
        assert!(worst < 1e-7 && end == 2.0 && parts < 60, "{worst:e} {end} {parts}");
        assert!(!fit([0.0, 2.0], &[1e-12], &mut |_| None, &mut |_, _, _| {}));
    }
}
