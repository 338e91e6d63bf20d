//! The integral over time of one mode's envelope while the torque is constant.
//!
//! There the mode's phasor is Z(h) = c + W exp(-(s + i w) h), and the integrand abs(Z).

use super::elliptic::second_kind;
use super::swing_series::{Circle, LARGE, MIDDLE, SMALL};
use crate::lanes::{Mask, Real};
use crate::numerics::phasor::{Phasor, abs, arg, polar};

/// Integral over [0, h] of abs(c + W exp(-i w t)): an undamped mode, in closed form (the envelope's mean of
/// \[Silaev\], section 2). Takes W at both ends.
///
/// What is smaller of |c| and |W|, relative to the other, is the modulus of a series ([`super::swing_series`]); within 0.002 of 1 the
/// integral is left to Carlson's duplication. Error 1e-13 of h times the larger of both.
#[allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#[inline(always)]
pub fn undamped<R: Real>(centre: R, [from, to]: [[R; 2]; 2], frequency: R, h: R) -> R {
    let angle = frequency * h;
    let circle = Circle::new(centre, [from, to], angle);
    let below = circle.modulus.lt(angle.of(SMALL));
    let mut swept = angle;
    if below.any() {
        swept = circle.alone();
    }
    if !below.all() {
        let mut once = circle.landen::<true>();
        let is_wide = angle.of(MIDDLE).le(circle.modulus);
        if is_wide.any() {
            once = Circle::select(is_wide, &once.landen::<true>(), &once);
        }
        swept = R::select(below, swept, once.landen::<false>().after());
        if !circle.modulus.lt(angle.of(LARGE)).all() {
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

/// The same for an angle, with frequency 1.
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

/// Abscissae and weights of the 8-point Gauss-Legendre rule on [0, 1].
const NODES: [(f64, f64); 8] = [
    (0.019_855_071_751_231_884, 0.050_614_268_145_188_13),
    (0.101_666_761_293_186_63, 0.111_190_517_226_687_24),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_64),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
    (0.591_717_321_247_825, 0.181_341_891_689_181),
    (0.762_766_204_958_164_5, 0.156_853_322_938_943_64),
    (0.898_333_238_706_813_4, 0.111_190_517_226_687_24),
    (0.980_144_928_248_768_1, 0.050_614_268_145_188_13),
];

/// Integral over [0, h] of abs(c + W exp(-(s + i w) t)): a damped mode, which has no closed form.
///
/// Composite Gauss-Legendre, 8 nodes in panels of at most half a radian: 1e-10 relative, less accurate where
/// the envelope nearly vanishes.
pub fn damped(centre: Phasor, deviation: Phasor, decay: f64, frequency: f64, h: f64) -> f64 {
    let panels = libm::ceil(2.0 * (frequency + decay) * h).max(1.0);
    let width = h / panels;
    let turn = |t: f64| polar(libm::exp(-decay * t), -frequency * t);
    let nodes = NODES.map(|(x, weight)| (turn(x * width), weight));
    let across = turn(width);
    let mut phasor = deviation;
    let mut sum = 0.0;
    for _ in 0..panels as u64 {
        for (node, weight) in nodes {
            sum += weight * abs(centre + phasor * node);
        }
        phasor *= across;
    }
    sum * width
}

#[cfg(test)]
#[allow(clippy::excessive_precision)]
mod tests {
    use super::*;
    use crate::numerics::phasor::Complex;

    /// By `tests/golden/swing_oracle.py`.
    const ORACLE: &str = include_str!("../../../../tests/golden/swing.csv");

    /// The integral, with W turned to its other end.
    fn over(c: f64, from: Phasor, w: f64, h: f64) -> f64 {
        let to = from * polar(1.0, -w * h);
        undamped(c, [[from.re, from.im], [to.re, to.im]], w, h)
    }

    #[test]
    fn closed_form_agrees_with_quadrature() {
        let mut seen = [0; 4];
        for row in ORACLE.lines().skip(1) {
            let numbers: Vec<f64> = row.split(',').map(|cell| cell.parse().expect("a number")).collect();
            let [c, re, im, w, h, exact] = numbers[..] else { panic!("{row}") };
            let deviation = Complex { re, im };
            let value = over(c, deviation, w, h);
            let (large, small) = (c.abs().max(abs(deviation)), c.abs().min(abs(deviation)));
            assert!((value - exact).abs() < 1e-13 * large * h.max(1.0 / w), "{row}: {value}");
            seen[[SMALL, MIDDLE, LARGE].iter().filter(|limit| small / large >= **limit).count()] += 1;
        }
        assert!(seen.iter().all(|count| *count > 5), "{seen:?}");
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

    #[test]
    fn damped_integral_agrees_with_quadrature_and_its_undamped_limit() {
        let deviation = Complex { re: 0.5, im: 0.2 };
        let centre = Complex { re: 1.0, im: 0.05 };
        let value = damped(centre, deviation, 0.02, 0.44, 37.0);
        let exact = 38.726_802_273_600_299_2; // mpmath
        assert!((value - exact).abs() < 1e-12 * exact, "{value} {exact}");
        let limit = damped(Complex { re: 1.0, im: 0.0 }, deviation, 0.0, 0.44, 37.0);
        assert!((limit - over(1.0, deviation, 0.44, 37.0)).abs() < 1e-11);
    }
}
