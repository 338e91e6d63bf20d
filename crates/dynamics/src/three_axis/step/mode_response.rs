//! Exact response of a mode over parts of a step to its initial state and to forcing by parabolas through the nodes.
//!
//! In x = (q, P/W) a mode follows x' = A x + b g + c s with A = W \[\[0, 1\], \[-1, -2 zeta\]\], b = (1, -2 zeta) and
//! c = (0, 1/W): g = phi' Gt is the rate imposed by the momentum, s the modal force. A function of A is a + b B with
//! B = A/W + zeta, B² = zeta² - 1; below critical damping such pairs are complex numbers.

use flexsc_numerics::gauss_legendre::{NODES, PARABOLAS};
use flexsc_numerics::phasor::Phasor;
use flexsc_numerics::phi;
use nalgebra::Vector2;

/// Damping ratio from which the two poles are too close for functions of them to be evaluated separately.
const NEAR_CRITICAL: f64 = 0.99;

/// Responses of a mode at the three nodes and at the end of a step.
#[derive(Clone, Debug)]
#[repr(align(32))]
pub struct ModeResponse {
    /// Transition matrix of (q, P/W), row by row, each entry at the nodes and the end.
    pub free: [[f64; 4]; 4],
    /// Half of the excess of the squared column norms of the transition matrix at the end over 1, by rounding; 0 with
    /// damping.
    pub excess: f64,
    /// Responses of q and of P/W to g: for a unit at each node (s), at the nodes and the end.
    pub of_rate: [[[f64; 4]; 3]; 2],
    /// Responses of q and of P/W to s: for a unit at each node (s², s), at the nodes and the end.
    pub of_force: [[[f64; 4]; 3]; 2],
    /// Responses of q and of P/W to s = 1 throughout (s², s), at the nodes and the end.
    pub of_constant: [[f64; 4]; 2],
    /// Responses of (q, P/W) at the end only.
    pub end: EndResponse,
}

/// Responses of the vector (q, P/W) at the end of a step.
#[derive(Clone, Debug, Default)]
pub struct EndResponse {
    /// Responses to the initial q, and to the initial P/W.
    pub free: [Vector2<f64>; 2],
    /// Responses to g, for a unit at each node (s).
    pub of_rate: [Vector2<f64>; 3],
    /// Responses to s, for a unit at each node (s², s).
    pub of_force: [Vector2<f64>; 3],
}

impl ModeResponse {
    /// Computes the responses of a mode with the frequency W (rad/s) and damping ratio over a step of `h` (s).
    pub fn new(frequency: f64, damping: f64, h: f64) -> Self {
        let mut response = Self {
            free: [[0.0; 4]; 4],
            excess: 0.0,
            of_rate: [[[0.0; 4]; 3]; 2],
            of_force: [[[0.0; 4]; 3]; 2],
            of_constant: [[0.0; 4]; 2],
            end: EndResponse::default(),
        };
        for (stage, part) in NODES.into_iter().chain([1.0]).enumerate() {
            let phis = phis(frequency * part * h, damping);
            for (entry, value) in response.free.iter_mut().zip(phis[0].matrix(damping)) {
                entry[stage] = value;
            }
            // Responses to 1, x and x², where x is the fraction of the step.
            let powers = [part * h, part * part * h, 2.0 * part * part * part * h];
            let moments = [1, 2, 3].map(|n| phis[n].matrix(damping).map(|entry| entry * powers[n - 1]));
            for (node, parabola) in PARABOLAS.iter().enumerate() {
                let [m00, m01, m10, m11]: [f64; 4] =
                    std::array::from_fn(|at| (0..3).map(|n| parabola[n] * moments[n][at]).sum());
                response.of_rate[0][node][stage] = m00 - 2.0 * damping * m01;
                response.of_rate[1][node][stage] = m10 - 2.0 * damping * m11;
                response.of_force[0][node][stage] = m01 / frequency;
                response.of_force[1][node][stage] = m11 / frequency;
            }
            response.of_constant[0][stage] = moments[0][1] / frequency;
            response.of_constant[1][stage] = moments[0][3] / frequency;
        }
        let [a, b, c, d] = response.free.map(|entry| entry[3]);
        let ends =
            |of: &[[[f64; 4]; 3]; 2]| [0, 1, 2].map(|node| Vector2::new(of[0][node][3], of[1][node][3]));
        response.end = EndResponse {
            free: [Vector2::new(a, c), Vector2::new(b, d)],
            of_rate: ends(&response.of_rate),
            of_force: ends(&response.of_force),
        };
        if damping == 0.0 {
            let (cos, sin) = (response.free[0][3], response.free[1][3]);
            // cos² + sin² - 1 to twice the digits.
            let (c, s) = (cos * cos, sin * sin);
            let lost = libm::fma(cos, cos, -c) + libm::fma(sin, sin, -s);
            let (large, little) = if c > s { (c, s) } else { (s, c) };
            response.excess = 0.5 * (((large - 1.0) + little) + lost);
        }
        response
    }
}

/// Function a + b B of the matrix A.
#[derive(Copy, Clone, Debug)]
struct ComplexPair(f64, f64);

impl ComplexPair {
    /// Returns the matrix row by row.
    fn matrix(self, damping: f64) -> [f64; 4] {
        let Self(a, b) = self;
        [a + b * damping, b, -b, a - b * damping]
    }
}

/// Returns exp(A t) and phi_1 to phi_3 of A t, where `angle` is W t (rad).
fn phis(angle: f64, damping: f64) -> [ComplexPair; 4] {
    if damping < NEAR_CRITICAL {
        let root = f64::sqrt((1.0 - damping) * (1.0 + damping));
        let z = Phasor::new(-damping * angle, root * angle);
        phi::phi_1_to_3(z).map(|value| ComplexPair(value.re, value.im / root))
    } else {
        doubled(angle, damping)
    }
}

/// Returns exp(A t) and phi_1 to phi_3 of A t at and above critical damping: by series at a small fraction of the
/// angle, followed by doublings.
fn doubled(angle: f64, damping: f64) -> [ComplexPair; 4] {
    let square = (damping - 1.0) * (damping + 1.0);
    let times = |ComplexPair(a, b): ComplexPair, ComplexPair(c, d): ComplexPair| {
        ComplexPair(a * c + b * d * square, a * d + b * c)
    };
    let sum = |ComplexPair(a, b): ComplexPair, ComplexPair(c, d): ComplexPair| ComplexPair(a + c, b + d);
    let scaled = |ComplexPair(a, b): ComplexPair, by: f64| ComplexPair(a * by, b * by);
    let mut doublings = 0;
    let mut small = angle;
    while small * (1.0 + 2.0 * damping) > 0.5 && doublings < 60 {
        small *= 0.5;
        doublings += 1;
    }
    let z = ComplexPair(-damping * small, small);
    let one = ComplexPair(1.0, 0.0);
    // phi_3 from its series, the others from z phi_(n + 1) = phi_n - 1/n!.
    let third = (0..16)
        .rev()
        .fold(one, |sum_so_far, k| sum(one, scaled(times(z, sum_so_far), 1.0 / f64::from(k + 4))));
    let third = scaled(third, 1.0 / 6.0);
    let second = sum(times(z, third), ComplexPair(0.5, 0.0));
    let first = sum(times(z, second), one);
    let mut phis = [sum(times(z, first), one), first, second, third];
    for _ in 0..doublings {
        let [whole, first, second, third] = phis;
        let half_third = sum(sum(times(first, second), second), scaled(third, 2.0));
        phis = [
            times(whole, whole),
            scaled(sum(times(whole, first), first), 0.5),
            scaled(sum(times(first, first), scaled(second, 2.0)), 0.25),
            scaled(half_third, 0.125),
        ];
    }
    phis
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares the phi functions by poles and by doubling, in every damping regime.
    #[test]
    fn doubling_agrees_with_poles_and_with_the_equation_of_motion() {
        for angle in [1e-6, 0.3, 3.0, 20.0] {
            for damping in [0.0, 0.005, 0.5, 0.98] {
                let (poles, series) = (phis(angle, damping), doubled(angle, damping));
                for (n, (ComplexPair(a, b), ComplexPair(c, d))) in poles.into_iter().zip(series).enumerate() {
                    assert!((a - c).abs() + (b - d).abs() < 2e-14, "{angle} {damping} {n}: {a} {c}, {b} {d}");
                }
            }
        }
        // Critical: exp(-a) (1 + a B) with B² = 0, and above it exp(-2 a) (cosh + B sinh/sqrt(3), of sqrt(3) a).
        let ComplexPair(a, b) = phis(1.5, 1.0)[0];
        assert!((a - libm::exp(-1.5)).abs() < 1e-15 && (b - 1.5 * libm::exp(-1.5)).abs() < 1e-15);
        let (ComplexPair(a, b), root) = (phis(1.5, 2.0)[0], f64::sqrt(3.0));
        assert!((a - libm::exp(-3.0) * libm::cosh(1.5 * root)).abs() < 1e-14);
        assert!((b - libm::exp(-3.0) * libm::sinh(1.5 * root) / root).abs() < 1e-14);
    }

    /// Compares the response to parabolas g and s (an exact solution) with small Runge-Kutta steps.
    #[test]
    fn parabolas_are_answered_exactly() {
        let (w, zeta, h) = (3.0, 0.2, 0.7);
        let response = ModeResponse::new(w, zeta, h);
        let (g, s) = (|t: f64| 0.3 - t + 2.0 * t * t, |t: f64| -1.0 + 0.5 * t + t * t);
        let rate = |t: f64, [q, p]: [f64; 2]| {
            let v = w * p + g(t);
            [v, (-w * w * q - 2.0 * zeta * w * v + s(t)) / w]
        };
        let mut x = [0.4, -0.6];
        let steps = 4000;
        let d = h / f64::from(steps);
        for n in 0..steps {
            let t = d * f64::from(n);
            let along = |x: [f64; 2], k: [f64; 2], by: f64| [x[0] + k[0] * by, x[1] + k[1] * by];
            let k1 = rate(t, x);
            let k2 = rate(t + d / 2.0, along(x, k1, d / 2.0));
            let k3 = rate(t + d / 2.0, along(x, k2, d / 2.0));
            let k4 = rate(t + d, along(x, k3, d));
            x = [0, 1].map(|i| x[i] + d / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        }
        for part in 0..2 {
            let free = response.free.map(|entry| entry[3]);
            let mut found = free[2 * part] * 0.4 - free[2 * part + 1] * 0.6;
            for (node, at) in NODES.into_iter().enumerate() {
                found += response.of_rate[part][node][3] * g(at * h);
                found += response.of_force[part][node][3] * s(at * h);
            }
            assert!((found - x[part]).abs() < 1e-12, "{found} {}", x[part]);
            let all: f64 = response.of_force[part].iter().map(|of| of[3]).sum();
            assert!((all - response.of_constant[part][3]).abs() < 1e-15);
        }
    }
}
