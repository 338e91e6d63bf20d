//! Exact flow of one elastic mode, for any damping: three regimes, each in closed form.

use flexsc_numerics::exp_branch_free::exp;
use flexsc_numerics::phasor::Phasor;
use flexsc_numerics::trig::sincos_any;

use crate::AngleObservation;
use crate::axis_model::AxisMode;
use crate::damping::Damped;

/// Constants of a mode's flow.
#[derive(Copy, Clone, Debug)]
pub struct ModeFlow {
    /// Natural frequency (rad/s).
    pub frequency: f64,
    /// Modal gain.
    pub gain: f64,
    /// Static displacement for each unit of reduced moment (s²).
    pub excitability: f64,
    /// Upper bound of |x''| for a unit distance from equilibrium (1/s²).
    pub stiffness: f64,
    /// Upper bound of |x'''| for a unit distance from equilibrium (1/s³).
    pub jerk: f64,
    /// Twice the decay rate, 2 zeta w (1/s).
    drag: f64,
    regime: DampingRegime,
}

#[derive(Copy, Clone, Debug)]
enum DampingRegime {
    Undamped,
    Under(Damped<f64>),
    /// Critical or overdamped: decay rate, the slower of the two real rates, and half their difference (1/s).
    Over(f64, f64, f64),
}

impl ModeFlow {
    /// Creates the flow of a mode.
    pub fn new(mode: &AxisMode) -> Self {
        let (w, zeta) = (mode.frequency.get(), mode.damping.get());
        let regime = if zeta == 0.0 {
            DampingRegime::Undamped
        } else if zeta < 1.0 {
            DampingRegime::Under(Damped::new(w, zeta))
        } else {
            let root = f64::sqrt((zeta - 1.0) * (zeta + 1.0));
            DampingRegime::Over(zeta * w, w / (zeta + root), w * root)
        };
        let square = 4.0 * zeta * zeta;
        Self {
            frequency: w,
            gain: mode.gain.get(),
            excitability: mode.excitability(),
            // For a state (x, y) of length 1, x'' = -w² (x + 2 zeta y) and x''' = -w³ (y - 2 zeta x - 4 zeta² y).
            stiffness: w * w * f64::sqrt(1.0 + square),
            jerk: w * w * w * f64::sqrt(square + (1.0 - square) * (1.0 - square)),
            drag: 2.0 * zeta * w,
            regime,
        }
    }

    /// Returns the pole with a positive imaginary part, -zeta w + i w_d (1/s); `None` at critical damping and above.
    pub fn pole(&self) -> Option<Phasor> {
        match self.regime {
            DampingRegime::Undamped => Some(Phasor { re: 0.0, im: self.frequency }),
            DampingRegime::Under(damped) => Some(Phasor { re: -damped.decay, im: damped.frequency }),
            DampingRegime::Over(..) => None,
        }
    }

    /// Returns an upper bound of the rate of change of the motion (rad/s).
    pub fn fastest(&self) -> f64 {
        self.frequency + self.drag
    }

    /// Adds the mode's part to the motion at a sensor, for a deviation from equilibrium.
    #[inline]
    pub fn add_to(
        &self,
        equilibrium: f64,
        displacement: f64,
        quadrature: f64,
        sensed: &mut AngleObservation,
    ) {
        let [rate, quadrature_rate] = self.velocity(displacement, quadrature);
        sensed.angle += equilibrium + displacement;
        sensed.rate += rate;
        sensed.acceleration += self.frequency * quadrature_rate;
    }

    /// Returns the time derivative of the deviation from equilibrium (displacement, rate / w).
    #[inline]
    pub fn velocity(&self, displacement: f64, quadrature: f64) -> [f64; 2] {
        [self.frequency * quadrature, -self.frequency * displacement - self.drag * quadrature]
    }

    /// Returns the 2 x 2 transition matrix over `h` seconds, row by row, of the deviation from equilibrium
    /// (displacement, rate / w).
    #[inline]
    pub fn transition(&self, h: f64) -> [f64; 4] {
        let (decay, (c, s)) = match self.regime {
            DampingRegime::Undamped => {
                let (sin, cos) = sincos_any(self.frequency * h);
                return [cos, sin, -sin, cos];
            }
            DampingRegime::Under(Damped { decay, frequency, .. }) => (decay, spiral(decay, frequency, h)),
            DampingRegime::Over(decay, slow, split) => (decay, creep(slow, split, h)),
        };
        let cross = self.frequency * s;
        [c + decay * s, cross, -cross, c - decay * s]
    }

    /// Returns the transition matrix over `h` seconds, bit-identical to the computation in lanes.
    #[inline]
    pub fn evaluate(&self, h: f64) -> [f64; 4] {
        match &self.regime {
            DampingRegime::Under(damped) => evaluate(damped, h),
            DampingRegime::Undamped | DampingRegime::Over(..) => self.transition(h),
        }
    }
}

/// Returns the transition below critical damping, computed as in lanes.
#[inline(never)]
fn evaluate(damped: &Damped<f64>, h: f64) -> [f64; 4] {
    damped.transition(sincos_any(damped.frequency * h), exp(-(damped.decay * h)))
}

// With the decay rate d and damped frequency v, the functions exp(-d h) cos(v h) and exp(-d h) sin(v h) / v make the
// transition. They are separate so that the undamped one, which needs neither, is small enough to be inlined.

/// Returns both functions below critical damping.
#[inline(never)]
fn spiral(decay: f64, damped: f64, h: f64) -> (f64, f64) {
    let (sin, cos) = libm::sincos(damped * h);
    let shrink = libm::exp(-decay * h);
    (shrink * cos, shrink * sin / damped)
}

/// Returns both functions at critical damping and above, from the slower rate and half the rates' difference.
#[inline(never)]
fn creep(slow: f64, split: f64, h: f64) -> (f64, f64) {
    let shrink = libm::exp(-slow * h);
    // The factor (1 - exp(-2 split h)) / (2 split), and its limit h at critical damping.
    let spread = -libm::expm1(-2.0 * split * h);
    let s = if split > 0.0 { spread / (2.0 * split) } else { h };
    (shrink * (1.0 - 0.5 * spread), shrink * s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_numerics::quantity::{Finite, Frequency, NonNegative};

    fn mode(frequency: f64, damping: f64) -> AxisMode {
        let frequency = Frequency::new(frequency).expect("in range");
        AxisMode::at_rest(frequency, Finite::default(), NonNegative::new(damping).expect("in range"))
    }

    /// Returns exp(A h) by scaling and squaring of its Taylor series, independent of the closed form.
    fn exponential(frequency: f64, damping: f64, h: f64) -> [f64; 4] {
        let squarings = 24;
        let step = h / f64::from(1 << squarings);
        let a = [0.0, frequency * step, -frequency * step, -2.0 * damping * frequency * step];
        let times = |p: [f64; 4], q: [f64; 4]| {
            [
                p[0] * q[0] + p[1] * q[2],
                p[0] * q[1] + p[1] * q[3],
                p[2] * q[0] + p[3] * q[2],
                p[2] * q[1] + p[3] * q[3],
            ]
        };
        let mut term = [1.0, 0.0, 0.0, 1.0];
        let mut sum = term;
        for n in 1..12 {
            term = times(term, a).map(|v| v / f64::from(n));
            sum = std::array::from_fn(|i| sum[i] + term[i]);
        }
        for _ in 0..squarings {
            sum = times(sum, sum);
        }
        sum
    }

    #[test]
    fn transition_is_the_matrix_exponential_in_every_regime() {
        for frequency in [1e-4, 0.44, 37.0, 1e3] {
            for damping in [0.0, 1e-6, 0.005, 0.5, 0.999_999, 1.0, 1.000_001, 3.0] {
                for turns in [1e-3, 0.7, 5.0] {
                    let h = turns / frequency;
                    let exact = exponential(frequency, damping, h);
                    let flow = ModeFlow::new(&mode(frequency, damping)).transition(h);
                    for (a, b) in flow.iter().zip(exact) {
                        // The reference itself loses 2^24 roundings.
                        assert!((a - b).abs() < 2e-8, "w {frequency}, zeta {damping}: {a} {b}");
                    }
                }
            }
        }
    }
}
