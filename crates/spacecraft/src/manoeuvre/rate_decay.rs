//! Decay of a rate to rest about one axis, at the start of a slew to a target that moves otherwise than the reference before it.

use std::f64::consts::TAU;

use flexsc_dynamics::waveform::{Term, TermShape, Waveform};
use flexsc_numerics::attitude::{Vector, rotation};
use nalgebra::Quaternion;

use super::{AttitudeMotion, SlewProfile};

/// Rate (rad/s) below which a reference is at rest: the rounding of rates that agree.
pub(super) const REST: f64 = 1e-10;

/// Decay of a rate to rest about its axis.
#[derive(Clone, Debug, PartialEq)]
pub struct RateDecay {
    from: Quaternion<f64>,
    axis: Vector,
    /// Rate at the start (rad/s).
    rate: f64,
    /// Largest acceleration (rad/s²).
    acceleration: f64,
    profile: SlewProfile,
}

impl RateDecay {
    /// Creates the decay of a rate (rad/s, in the axes of `from`) within an acceleration (rad/s²); `None` at rest.
    pub fn new(
        from: Quaternion<f64>,
        rate: &Vector,
        acceleration: f64,
        profile: SlewProfile,
    ) -> Option<Self> {
        let size = rate.norm();
        (size > REST).then(|| Self { from, axis: rate / size, rate: size, acceleration, profile })
    }

    /// Returns the duration (s).
    pub fn duration(&self) -> f64 {
        let mean = if self.profile == SlewProfile::Versine { 0.5 } else { 1.0 } * self.acceleration;
        self.rate / mean
    }

    /// Returns the acceleration about the axis of the rate as a waveform (rad/s²).
    pub fn command(&self) -> Waveform {
        let (to, most) = (self.duration(), self.acceleration);
        let term = |shape| Term { from: 0.0, to, shape };
        let terms = match self.profile {
            SlewProfile::Trapezoid => vec![term(TermShape::Polynomial(vec![-most]))],
            SlewProfile::Versine => {
                let rising = TermShape::Harmonic { frequency: TAU / to, cosine: 0.5 * most, sine: 0.0 };
                vec![term(TermShape::Polynomial(vec![-0.5 * most])), term(rising)]
            }
        };
        Waveform { terms }
    }

    /// Returns the attitude at the end.
    pub fn final_attitude(&self) -> Quaternion<f64> {
        self.from * rotation(&(self.axis * (0.5 * self.rate * self.duration())))
    }

    /// Returns attitude, rate and acceleration at `t` seconds after the start, of at most the duration.
    pub fn at(&self, t: f64) -> AttitudeMotion {
        let most = self.acceleration;
        // Angle, rate and acceleration that the decay has taken away.
        let [angle, rate, acceleration] = match self.profile {
            SlewProfile::Trapezoid => [0.5 * most * t * t, most * t, most],
            SlewProfile::Versine => {
                let w = TAU / self.duration();
                let (sin, half) = (libm::sin(w * t), libm::sin(0.5 * w * t));
                let versine = 2.0 * half * half;
                [
                    0.5 * most * (0.5 * t * t - versine / (w * w)),
                    0.5 * most * (t - sin / w),
                    0.5 * most * versine,
                ]
            }
        };
        AttitudeMotion {
            attitude: self.from * rotation(&(self.axis * (self.rate * t - angle))),
            rate: self.axis * (self.rate - rate),
            acceleration: self.axis * -acceleration,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_decays_within_the_acceleration() {
        let from = rotation(&Vector::new(0.3, -0.2, 0.5));
        let rate = Vector::new(1e-3, -2e-3, 2e-3);
        for (profile, duration) in [(SlewProfile::Trapezoid, 15.0), (SlewProfile::Versine, 30.0)] {
            let decay = RateDecay::new(from, &rate, 2e-4, profile).expect("a rate");
            assert!((decay.duration() - duration).abs() < 1e-12);
            let [start, end] = [0.0, duration].map(|t| decay.at(t));
            assert!((start.attitude - from).norm() == 0.0 && (start.rate - rate).norm() < 1e-18);
            assert!(end.rate.norm() < 1e-17 && (end.attitude - decay.final_attitude()).norm() < 1e-15);
            let h = 1e-3;
            for part in [0.1, 0.3, 0.5, 0.8] {
                let t = part * duration;
                let [before, now, after] = [t - h, t, t + h].map(|t| decay.at(t));
                let turn = (before.attitude.conjugate() * after.attitude).vector() * 2.0;
                assert!((turn / (2.0 * h) - now.rate).norm() < 1e-11);
                let change = (after.rate - before.rate) / (2.0 * h);
                assert!((change - now.acceleration).norm() < 1e-11);
                assert!(now.acceleration.norm() <= 2e-4 * (1.0 + 1e-12));
                let commanded = decay.command().at(t) * rate / rate.norm();
                assert!((now.acceleration - commanded).norm() < 1e-18);
            }
        }
        assert_eq!(RateDecay::new(from, &Vector::new(0.0, 1e-12, 0.0), 2e-4, SlewProfile::Trapezoid), None);
    }
}
