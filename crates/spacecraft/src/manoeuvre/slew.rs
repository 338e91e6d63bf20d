//! Slew from one attitude to another about one axis, in closed form (\[Wie08\], eigenaxis rotation).

use flexsc_dynamics::waveform::{Term, TermShape, Waveform};
use flexsc_numerics::attitude::{Vector, rotation};
use nalgebra::Quaternion;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::environment::to_body;

/// How the rate of a slew rises to its limit and falls.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Profile")]
pub enum SlewProfile {
    /// Constant acceleration: the shortest slew.
    #[default]
    Trapezoid,
    /// Acceleration that rises and falls as 1 - cos: twice as long, without jumps.
    Versine,
}

/// Attitude, rate and acceleration of a reference motion at an instant.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AttitudeMotion {
    /// Attitude as a unit quaternion.
    pub attitude: Quaternion<f64>,
    /// Angular rate in the axes of that attitude (rad/s).
    pub rate: Vector,
    /// Angular acceleration in the same axes (rad/s²).
    pub acceleration: Vector,
}

impl AttitudeMotion {
    /// Returns the motion at rest in an attitude.
    pub fn at_rest(attitude: Quaternion<f64>) -> Self {
        Self { attitude, rate: Vector::zeros(), acceleration: Vector::zeros() }
    }

    /// Composes this motion, which is relative to moving axes, with the motion of those axes.
    #[must_use]
    pub fn compose(&self, axes: &Self) -> Self {
        let [carried, pushed] = [axes.rate, axes.acceleration].map(|vector| to_body(&self.attitude, &vector));
        Self {
            attitude: axes.attitude * self.attitude,
            rate: carried + self.rate,
            acceleration: pushed - self.rate.cross(&carried) + self.acceleration,
        }
    }

    /// Rate and acceleration in the axes of a body that is beyond it by this rotation vector (rad).
    pub fn in_body_axes(&self, beyond: &Vector) -> [Vector; 2] {
        let turn = rotation(beyond);
        let rotate = |vector: &Vector| -> Vector {
            (turn.conjugate() * Quaternion::from_imag(*vector) * turn).vector().into_owned()
        };
        [rotate(&self.rate), rotate(&self.acceleration)]
    }
}

/// Slew from rest to rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Slew {
    from: Quaternion<f64>,
    to: Quaternion<f64>,
    /// Rotation axis, with the same components in both attitudes; `angle` is the angle about it, at most pi (rad).
    axis: Vector,
    angle: f64,
    profile: SlewProfile,
    /// Largest acceleration of this slew (rad/s²); `rate` is its largest rate (rad/s).
    acceleration: f64,
    rate: f64,
    /// Time for which the rate rises (s); `coast` is the time for which it is constant (s).
    rise: f64,
    coast: f64,
}

/// Returns the axis of the shorter rotation between two attitudes, the same in both, and the angle about it, at most pi
/// (rad).
pub(super) fn eigenaxis(from: &Quaternion<f64>, to: &Quaternion<f64>) -> (Vector, f64) {
    let turn = from.conjugate() * to;
    let sine = turn.vector().norm();
    let angle = 2.0 * libm::atan2(sine, turn.w.abs());
    let axis = if sine > 0.0 { turn.vector() * (libm::copysign(1.0, turn.w) / sine) } else { Vector::x() };
    (axis, angle)
}

impl Slew {
    /// Plans the shorter rotation within the limits of acceleration (rad/s²) and rate (rad/s, may be infinite).
    pub fn new(
        [from, to]: [Quaternion<f64>; 2],
        acceleration: f64,
        rate_limit: f64,
        profile: SlewProfile,
    ) -> Self {
        let (axis, angle) = eigenaxis(&from, &to);
        // Mean of the acceleration while the rate rises.
        let mean = if profile == SlewProfile::Versine { 0.5 * acceleration } else { acceleration };
        let rate = rate_limit.min(f64::sqrt(angle * mean));
        let rise = rate / mean;
        let coast = if rate > 0.0 { (angle / rate - rise).max(0.0) } else { 0.0 };
        Self { from, to, axis, angle, profile, acceleration, rate, rise, coast }
    }

    /// Returns a slew of zero duration to an attitude.
    pub fn instantaneous(to: Quaternion<f64>) -> Self {
        Self {
            from: to,
            to,
            axis: Vector::x(),
            angle: 0.0,
            profile: SlewProfile::Trapezoid,
            acceleration: 0.0,
            rate: 0.0,
            rise: 0.0,
            coast: 0.0,
        }
    }

    /// Returns the acceleration about the axis as a waveform (rad/s²).
    pub fn command(&self) -> Waveform {
        let one = |from: f64, sign: f64| {
            let (to, most) = (from + self.rise, sign * self.acceleration);
            let term = |shape| Term { from, to, shape };
            match self.profile {
                SlewProfile::Trapezoid => vec![term(TermShape::Polynomial(vec![most]))],
                SlewProfile::Versine => {
                    let frequency = 2.0 * std::f64::consts::PI / self.rise;
                    let falling = TermShape::Harmonic { frequency, cosine: -0.5 * most, sine: 0.0 };
                    vec![term(TermShape::Polynomial(vec![0.5 * most])), term(falling)]
                }
            }
        };
        if self.rise == 0.0 {
            return Waveform::default();
        }
        Waveform { terms: [one(0.0, 1.0), one(self.rise + self.coast, -1.0)].concat() }
    }

    /// Returns the final attitude.
    pub fn final_attitude(&self) -> Quaternion<f64> {
        self.to
    }

    /// Returns the duration (s).
    pub fn duration(&self) -> f64 {
        2.0 * self.rise + self.coast
    }

    /// Returns attitude, rate and acceleration at `t` seconds after the start of the slew.
    pub fn at(&self, t: f64) -> AttitudeMotion {
        if t >= self.duration() {
            return AttitudeMotion::at_rest(self.to);
        }
        let [angle, rate, acceleration] = self.along(t.max(0.0));
        AttitudeMotion {
            attitude: self.from * rotation(&(self.axis * angle)),
            rate: self.axis * rate,
            acceleration: self.axis * acceleration,
        }
    }

    /// Returns angle (rad), rate (rad/s) and acceleration (rad/s²) about the axis at time `t` (s).
    fn along(&self, t: f64) -> [f64; 3] {
        if t < self.rise {
            self.rising(t)
        } else if t < self.rise + self.coast {
            [0.5 * self.rate * self.rise + self.rate * (t - self.rise), self.rate, 0.0]
        } else {
            let [angle, rate, acceleration] = self.rising(self.duration() - t);
            [self.angle - angle, rate, -acceleration]
        }
    }

    /// Returns angle (rad), rate (rad/s) and acceleration (rad/s²) about the axis at time `t` (s) while the rate rises.
    fn rising(&self, t: f64) -> [f64; 3] {
        let most = self.acceleration;
        match self.profile {
            SlewProfile::Trapezoid => [0.5 * most * t * t, most * t, most],
            SlewProfile::Versine => {
                let w = 2.0 * std::f64::consts::PI / self.rise;
                let (sin, half) = (libm::sin(w * t), libm::sin(0.5 * w * t));
                let versine = 2.0 * half * half;
                [
                    0.5 * most * (0.5 * t * t - versine / (w * w)),
                    0.5 * most * (t - sin / w),
                    0.5 * most * versine,
                ]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIXTY: f64 = std::f64::consts::FRAC_PI_3;

    fn rotation_by(by: f64) -> Quaternion<f64> {
        rotation(&(Vector::new(1.0, 2.0, 2.0) * (by / 3.0)))
    }

    fn slew(angle: f64, rate: f64, profile: SlewProfile) -> Slew {
        let from = rotation(&Vector::new(0.3, -0.2, 0.5));
        Slew::new([from, from * rotation_by(angle)], 2e-4, rate, profile)
    }

    #[test]
    fn sixty_degrees_take_as_long_as_by_hand() {
        // Expected duration: 2 r/a + (A - r²/a)/r.
        let slew = slew(SIXTY, 8e-3, SlewProfile::Trapezoid);
        assert!((slew.duration() - 170.899_693_899_574_71).abs() < 1e-12, "{}", slew.duration());
        // Expected angle: a t²/2 while the rate rises, and symmetric at the end.
        let from = rotation(&Vector::zeros());
        let plain = Slew::new([from, rotation_by(SIXTY)], 2e-4, 8e-3, SlewProfile::Trapezoid);
        let attitude_at = |t: f64| plain.at(t).attitude;
        assert!((attitude_at(10.0) - rotation_by(0.01)).norm() < 1e-15);
        assert!((attitude_at(60.0) - rotation_by(0.16 + 8e-3 * 20.0)).norm() < 1e-15);
        let coast = plain.duration() - 140.0;
        assert!((attitude_at(140.0) - rotation_by(SIXTY - 1e-4 * coast * coast)).norm() < 1e-15);
        assert_eq!(plain.at(60.0).acceleration, Vector::zeros());
    }

    #[test]
    fn a_short_turn_does_not_reach_the_rate() {
        for profile in [SlewProfile::Trapezoid, SlewProfile::Versine] {
            for rate in [8e-3, f64::INFINITY] {
                let slew = slew(0.1, rate, profile);
                let mean = if profile == SlewProfile::Versine { 1e-4 } else { 2e-4 };
                assert!((slew.duration() - 2.0 * f64::sqrt(0.1 / mean)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn rate_and_acceleration_are_derivatives() {
        for profile in [SlewProfile::Trapezoid, SlewProfile::Versine] {
            for (angle, rate) in [(SIXTY, 8e-3), (-0.1, 8e-3), (3.1, 0.02)] {
                let slew = slew(angle, rate, profile);
                let h = 1e-3;
                for part in [0.01, 0.1, 0.2, 0.3, 0.45, 0.7, 0.9, 0.99] {
                    let t = part * slew.duration();
                    let [before, now, after] = [t - h, t, t + h].map(|t| slew.at(t));
                    let turn = (before.attitude.conjugate() * after.attitude).vector() * 2.0;
                    assert!((turn / (2.0 * h) - now.rate).norm() < 1e-10, "{profile:?} {t}");
                    let change = (after.rate - before.rate) / (2.0 * h);
                    assert!((change - now.acceleration).norm() < 1e-9, "{profile:?} {t}");
                    assert!(
                        now.rate.norm() <= rate * (1.0 + 1e-12)
                            && now.acceleration.norm() <= 2e-4 * (1.0 + 1e-12)
                    );
                }
                let end = slew.at(slew.duration() + 1.0);
                let target = rotation(&Vector::new(0.3, -0.2, 0.5)) * rotation_by(angle);
                assert!((end.attitude - target).norm() < 1e-15 && end.rate.norm() == 0.0);
            }
        }
    }

    #[test]
    fn no_turn_takes_no_time_and_the_way_is_the_shorter() {
        let nowhere = slew(0.0, 8e-3, SlewProfile::Versine);
        assert_eq!(nowhere.duration(), 0.0);
        assert!(nowhere.at(0.0).attitude.norm().is_finite() && nowhere.at(0.0).acceleration.norm() == 0.0);
        // A rotation by 300 degrees is one by 60 the other way, whichever sign the quaternion has.
        for sign in [1.0, -1.0] {
            let slew = Slew::new(
                [rotation_by(0.0), rotation_by(5.0 * SIXTY) * sign],
                2e-4,
                8e-3,
                SlewProfile::Trapezoid,
            );
            assert!((slew.duration() - 170.899_693_899_574_71).abs() < 1e-11, "{}", slew.duration());
            assert!(slew.at(1.0).rate.x < 0.0);
        }
    }
}
