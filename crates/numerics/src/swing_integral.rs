//! Integral over time of an undamped mode's envelope under a constant torque.
//!
//! The mode's phasor is Z(h) = c + W exp(-i w h), and the integrand abs(Z).

use super::elliptic::second_kind;
use super::swing_series::{Circle, LARGE, MIDDLE, SMALL};
use crate::lanes::{LaneFloat, Mask};
use crate::phasor::{Phasor, abs, arg};

/// Returns the integral over [0, h] of abs(c + W exp(-i w t)) for an undamped mode, in closed form (the envelope's
/// mean of \[Silaev\], section 2); `centre` is c, and W is given at both ends.
///
/// The ratio of the smaller to the larger of |c| and |W| is the modulus of a series ([`super::swing_series`]); within
/// 0.002 of 1 the integral is computed by Carlson's duplication. The error is 1e-13 of h times the larger of both.
#[allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#[inline(always)]
pub fn undamped<R: LaneFloat>(centre: R, [from, to]: [[R; 2]; 2], frequency: R, h: R) -> R {
    let angle = frequency * h;
    let circle = Circle::new(centre, [from, to], angle);
    let below = circle.modulus.lt(angle.splat(SMALL));
    let mut swept = angle;
    if below.any() {
        swept = circle.integrate_small();
    }
    if !below.all() {
        let mut smaller = circle;
        let is_wide = angle.splat(MIDDLE).le(circle.modulus);
        if is_wide.any() {
            smaller = Circle::select(is_wide, &circle.landen_step(), &circle);
        }
        swept = R::select(below, swept, smaller.two_landen_steps().integrate_after());
        if !circle.modulus.lt(angle.splat(LARGE)).all() {
            for lane in 0..R::LANES {
                if circle.modulus.lane(lane) >= LARGE {
                    let deviation = Phasor { re: from[0].lane(lane), im: from[1].lane(lane) };
                    let value = elliptic(centre.lane(lane), deviation, angle.lane(lane));
                    swept = swept.with_lane(lane, value);
                }
            }
        }
    }
    swept / frequency
}

/// Returns the integral over an angle (rad), with frequency 1, by an elliptic integral.
///
/// With R = abs(W) and the angle psi between c and the phasor, abs(Z)² = (c + R)² - 4 c R sin²(psi/2), which
/// integrates to the incomplete elliptic integral of the second kind.
#[inline(never)]
fn elliptic(centre: f64, deviation: Phasor, angle: f64) -> f64 {
    let radius = abs(deviation);
    let largest = centre.abs() + radius;
    let phase = arg(deviation * centre.signum());
    let smallest = (centre.abs() - radius) / largest;
    2.0 * largest * second_kind(0.5 * (phase - angle), 0.5 * phase, smallest * smallest)
}

#[cfg(test)]
#[allow(clippy::excessive_precision)]
mod tests {
    use super::*;
    use crate::phasor::{Complex, polar};

    /// Reference values by `tests/golden/swing_oracle.py`.
    const ORACLE: &str = include_str!("../../../tests/golden/swing.csv");

    /// Returns the integral, with W rotated to its other end.
    fn over(c: f64, from: Phasor, w: f64, h: f64) -> f64 {
        let to = from * polar(1.0, -w * h);
        undamped(c, [[from.re, from.im], [to.re, to.im]], w, h)
    }

    #[test]
    fn closed_form_agrees_with_quadrature() {
        let mut branch_counts = [0; 4];
        for row in ORACLE.lines().skip(1) {
            let numbers: Vec<f64> = row.split(',').map(|cell| cell.parse().expect("a number")).collect();
            let [c, re, im, w, h, exact] = numbers[..] else { panic!("{row}") };
            let deviation = Complex { re, im };
            let value = over(c, deviation, w, h);
            let (large, small) = (c.abs().max(abs(deviation)), c.abs().min(abs(deviation)));
            assert!((value - exact).abs() < 1e-13 * large * h.max(1.0 / w), "{row}: {value}");
            branch_counts[[SMALL, MIDDLE, LARGE].iter().filter(|limit| small / large >= **limit).count()] +=
                1;
        }
        assert!(branch_counts.iter().all(|count| *count > 5), "{branch_counts:?}");
        assert_eq!(over(0.0, Complex { re: 0.0, im: 0.0 }, 2.0, 5.0), 0.0);
    }

    #[test]
    fn many_pieces_make_the_whole() {
        let from = Complex { re: 0.3, im: -0.7 };
        for c in [0.01, 0.3, 0.7, 0.755, 0.76, -1.5] {
            let pieces = (0..100).map(|i| over(c, from * polar(1.0, -0.044 * f64::from(i)), 0.44, 0.1));
            let (sum, whole) = (pieces.sum::<f64>(), over(c, from, 0.44, 10.0));
            assert!((sum - whole).abs() < 4e-13 * whole, "{c}: {sum} {whole}");
        }
    }
}
