//! The integral over time of one mode's envelope while the torque is constant.
//!
//! There the mode's phasor is Z(h) = c + W exp(-(s + i w) h), and the integrand abs(Z).

use super::elliptic::second_kind;
use crate::numerics::phasor::{Phasor, abs, arg, polar};

/// Integral over [0, h] of abs(c + W exp(-i w t)): an undamped mode, in closed form (the envelope's mean of
/// \[Silaev\], section 2).
///
/// With R = abs(W) and the angle psi between c and the phasor, abs(Z)² = (c + R)² - 4 c R sin²(psi/2), which
/// integrates to the incomplete elliptic integral of the second kind.
pub fn undamped(centre: f64, deviation: Phasor, frequency: f64, h: f64) -> f64 {
    let radius = abs(deviation);
    let largest = centre.abs() + radius;
    if largest == 0.0 {
        return 0.0;
    }
    let phase = arg(deviation * centre.signum());
    let smallest = (centre.abs() - radius) / largest;
    let complement = smallest * smallest;
    let half_end = 0.5 * (phase - frequency * h);
    let swept = second_kind(half_end, 0.5 * phase, complement);
    2.0 * largest / frequency * swept
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

    /// mpmath 1.3, quad over panels, 20 digits: (c, W, w, h, integral).
    type Case = (f64, (f64, f64), f64, f64, f64);
    const ORACLE: [Case; 4] = [
        (1.0, (0.5, 0.2), 0.44, 37.0, 39.866_066_679_208_229),
        (-0.7, (0.1, -0.69), 0.755, 20.0, 19.077_112_596_230_503_2),
        (0.0, (0.3, 0.4), 2.0, 5.0, 2.5),
        (0.25, (0.0, 0.0), 2.0, 5.0, 1.25),
    ];

    #[test]
    fn closed_form_agrees_with_quadrature() {
        for (c, (re, im), w, h, exact) in ORACLE {
            let value = undamped(c, Complex { re, im }, w, h);
            assert!((value - exact).abs() < 4e-15 * exact, "{value} {exact}");
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
        assert!((limit - undamped(1.0, deviation, 0.44, 37.0)).abs() < 1e-11);
    }
}
