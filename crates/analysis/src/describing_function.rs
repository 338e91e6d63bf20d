//! Describing function of the relay law, and the limit cycle that it predicts on a rigid body.
//!
//! The torque that answers x = A sin phi has the first harmonic N x, with N = m_1/x_1. With a = asin(eps/A), g =
//! asin((eps - gamma)/A), the strong push ends at b = pi - g, the brake at c = b + k_t (b - a), and N does not depend on
//! the frequency. On a rigid body the harmonics balance where N is real and negative: w² = -N. The motion of a cycle is
//! nearer to a triangle than to a sine: the exact cycle ([`rigid_cycle`](super::rigid_cycle)) differs by a sixth, and
//! exists where the prediction does not.

use std::f64::consts::{PI, TAU};

use flexsc_control::law::{Relay, RelaySides};
use flexsc_dynamics::axis_model::AxisModel;
use flexsc_numerics::scalar_search::root;
use nalgebra::Complex;
use schemars::JsonSchema;
use serde::Serialize;

/// Number of amplitudes between which the sign of the imaginary part is looked up.
const STEPS: u32 = 2000;

/// Limit cycle that the describing function predicts.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct DescribedCycle {
    /// Amplitude of the angle (rad).
    pub amplitude_rad: f64,
    /// Period (s).
    pub period_s: f64,
    /// True if the amplitude returns after a small deviation.
    pub stable: bool,
}

/// Describing function of a relay law on a body, per unit of its inertia.
#[derive(Copy, Clone, Debug)]
pub struct RelayDescribingFunction {
    strong: f64,
    weak: f64,
    eps: f64,
    gamma: f64,
    k_t: f64,
}

impl RelayDescribingFunction {
    /// Creates the describing function of a law with the gain `k_t`; `None` for a law with one side, whose mean torque is
    /// not zero.
    pub fn new(law: &Relay, body: &AxisModel, k_t: f64) -> Option<Self> {
        let inertia = body.inertia.get();
        (law.sides == RelaySides::Two).then(|| Self {
            strong: law.strong.get() / inertia,
            weak: law.weak.get() / inertia,
            eps: law.dead_zone.get(),
            gamma: law.hysteresis.get(),
            k_t,
        })
    }

    /// Returns N (1/s²) at an amplitude (rad) above the dead zone. A negative imaginary part is damping.
    pub fn value(&self, amplitude: f64) -> Complex<f64> {
        let Self { strong, weak, eps, gamma, k_t } = *self;
        let a = libm::asin(eps / amplitude);
        let g = libm::asin((eps - gamma) / amplitude);
        let turn = |angle: f64| Complex::new(libm::cos(angle), -libm::sin(angle));
        if a + g < self.least_sum() {
            // The next push waits for the timer of the brake.
            return turn(-g) * (-4.0 * strong / (PI * amplitude));
        }
        let b = PI - g;
        let c = b + k_t * (b - a);
        // Integral of exp(-j phi) from p to q.
        let part = |p: f64, q: f64| Complex::new(0.0, -1.0) * (turn(p) - turn(q));
        let torque = part(b, c) * strong - part(a, b) * strong + part(c, PI + a) * weak;
        torque * Complex::new(0.0, 2.0 / (PI * amplitude))
    }

    /// Returns the sum a + g below which the brake outlasts the coast.
    fn least_sum(&self) -> f64 {
        PI * self.k_t / (1.0 + self.k_t)
    }

    /// Returns the cycles on the rigid body, by amplitude: N is real and negative there.
    pub fn cycles(&self) -> Vec<DescribedCycle> {
        // a + g < 2 asin(eps/A): beyond this amplitude there is no coast, and the imaginary part has one sign.
        let most = self.eps / libm::sin(0.5 * self.least_sum());
        if !(most > self.eps && most.is_finite()) {
            return Vec::new();
        }
        let amplitude = |step: u32| {
            let part = f64::from(step) / f64::from(STEPS);
            self.eps * (1.0 - part) + most * part
        };
        let imaginary = |amplitude: f64| self.value(amplitude).im;
        let crossing = |step: u32| {
            let (low, high) = (amplitude(step), amplitude(step + 1));
            let (first, last) = (imaginary(low), imaginary(high));
            if first.signum() == last.signum() {
                return None;
            }
            let amplitude = root(imaginary, low, high);
            let real = self.value(amplitude).re;
            // A jump through zero is no balance.
            let is_balance = real < 0.0 && imaginary(amplitude).abs() < 1e-6 * real.abs();
            is_balance.then(|| DescribedCycle {
                amplitude_rad: amplitude,
                period_s: TAU / f64::sqrt(-real),
                stable: first > last,
            })
        };
        (0..STEPS).filter_map(crossing).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn relay(k_t: f64) -> RelayDescribingFunction {
        RelayDescribingFunction { strong: 4e-5, weak: 1e-6, eps: 5e-4, gamma: 1e-4, k_t }
    }

    /// Against integrals of the torque over a turn of the phase, by stepping its states (4 digits), and in closed form.
    #[test]
    fn values_at_four_amplitudes() {
        for (amplitude, re, im) in [
            (5.1e-4, -0.031_573_763_914_77, -0.002_803_172_885_11),
            (6e-4, -0.046_009_115_680_31, -0.012_019_610_866_37),
            (1e-3, -0.044_741_867_954_05, -0.016_149_980_614_48),
            (2e-3, -0.024_950_297_639_48, -0.005_092_958_178_94),
        ] {
            let found = relay(0.3389).value(amplitude);
            let off = found - Complex::new(re, im);
            assert!(libm::hypot(off.re, off.im) < 1e-13, "{amplitude}: {found}");
        }
    }

    /// The exact cycles have periods of 41.0387 and 47.4496 s, and one exists up to 0.4507.
    #[test]
    fn predicted_cycles() {
        for (k_t, amplitude, period) in [(0.28, 5.056_10e-4, 35.727), (0.3389, 5.003_48e-4, 39.82)] {
            let found = relay(k_t).cycles();
            assert_eq!(found.len(), 1, "{found:?}");
            assert!((found[0].amplitude_rad / amplitude - 1.0).abs() < 1e-5, "{found:?}");
            assert!((found[0].period_s - period).abs() < 0.01 && found[0].stable, "{found:?}");
        }
        assert!(relay(0.36).cycles().is_empty());
    }
}
