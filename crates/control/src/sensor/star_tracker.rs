//! A star tracker: the attitude at its exposures, with noise in its own axes, told some time later.

use nalgebra::{Matrix3, Quaternion};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::late::{Late, failing};
use super::{Fault, Orientation, Reading, Sense, Truth, stream};
use crate::attitude::{Attitude, Vector, rotation};
use crate::quantity::{NonNegative, Positive, Time};
use crate::random::{Seed, Stream};
use crate::time::{Instant, Span};

/// A star tracker on a body with three axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StarTracker {
    /// Point of the structure at which it is mounted; default: the first of the body's points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<String>,
    /// Period of its exposures (s).
    pub period: Span,
    /// Standard deviation of the white noise about each of its axes (rad): x and y across the boresight, z about it.
    #[serde(default)]
    pub noise: [NonNegative; 3],
    /// Orientation of its axes in the body, a unit quaternion \[w, x, y, z\] that turns vectors of its axes into the body's;
    /// default: its axes are the body's.
    #[serde(default)]
    pub axes: Attitude,
    /// Time from an exposure to its output (s).
    #[serde(default)]
    pub latency: Time,
    /// Rate of the body at the tracker at and above which it gives no measurement (rad/s); default: no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blackout_rate: Option<Positive>,
    /// Intervals in which it fails.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<Fault>,
}

impl StarTracker {
    /// The tracker in a run, after so many others.
    pub fn start(&self, seed: Seed, ordinal: usize) -> Exposing {
        let draws = |axis: usize| stream("star tracker", (axis, 3), ordinal, seed);
        Exposing {
            tracker: self.clone(),
            noise: [0, 1, 2].map(draws),
            late: Late::new(self.period, self.latency()),
        }
    }

    /// How late a reading is told.
    pub fn latency(&self) -> Span {
        Span::from_seconds(self.latency.get())
    }

    /// Standard deviation of the worst angle (rad).
    pub fn angle_noise(&self) -> f64 {
        self.noise.map(NonNegative::get).into_iter().fold(0.0, f64::max)
    }

    /// Covariance of the error in the body's axes, of these standard deviations in its own (rad).
    pub fn covariance(&self, deviations: [f64; 3]) -> Matrix3<f64> {
        let axes = [Vector::x(), Vector::y(), Vector::z()].map(|axis| self.turned_to_body(&axis));
        axes.iter().zip(deviations).fold(Matrix3::zeros(), |sum, (axis, deviation)| {
            sum + axis * axis.transpose() * (deviation * deviation)
        })
    }

    /// A vector in the tracker's axes, in the body's.
    fn turned_to_body(&self, vector: &Vector) -> Vector {
        let turn = self.axes.get();
        (turn * Quaternion::from_imag(*vector) * turn.conjugate()).vector().into_owned()
    }
}

/// A tracker at work.
#[derive(Clone, Debug)]
pub struct Exposing {
    tracker: StarTracker,
    /// Draws about each of its axes.
    noise: [Stream; 3],
    late: Late,
}

impl Exposing {
    /// What is seen now.
    fn expose(&mut self, now: Instant, truth: &Truth, last: Option<&Reading>) -> Option<Reading> {
        // Draws are made in a failure too: those after it do not depend on it.
        let deviations = self.tracker.noise.map(NonNegative::get);
        let draws: [f64; 3] = std::array::from_fn(|axis| deviations[axis] * self.noise[axis].normal());
        let Orientation::Attitude(attitude) = truth.orientation.at(truth.seen()) else { return None };
        let error = self.tracker.turned_to_body(&draws.into());
        let seen =
            Reading { at: Orientation::Attitude(attitude * rotation(&error)), rate: None, sight: None };
        let rate = Vector::from(truth.rate).norm();
        if self.tracker.blackout_rate.is_some_and(|limit| rate >= limit.get()) {
            return None;
        }
        failing(&self.tracker.faults, now, Some(seen), last)
    }
}

impl Sense for Exposing {
    /// What is told now. At the start that is what is seen then, as if it had been exposed before.
    fn read(&mut self, now: Instant, truth: &Truth, last: Option<&Reading>) -> Option<Reading> {
        if self.late.exposes(now) {
            let seen = self.expose(now, truth, last);
            self.late.take(now, seen);
        }
        self.late.told(now)
    }

    fn after(&mut self, _: Instant, _: Span) -> Instant {
        self.late.next()
    }

    fn copy(&self) -> Box<dyn Sense> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(attitude: Quaternion<f64>, elastic: [f64; 3], rate: [f64; 3]) -> Truth {
        let orientation = Orientation::Attitude(attitude);
        let sky = crate::environment::SkySight::default();
        Truth { orientation, elastic, rate, rigid: rate, turned: [0.0; 3], sky }
    }

    fn start(keys: &str) -> Exposing {
        let tracker: StarTracker = crate::document::from_text(&format!("period = 1.0\n{keys}")).unwrap();
        tracker.start(Seed { scenario: 3, run: 0 }, 0)
    }

    fn attitude(reading: Reading) -> Quaternion<f64> {
        let Orientation::Attitude(attitude) = reading.at else { panic!("{reading:?}") };
        attitude
    }

    #[test]
    fn an_exposure_is_told_after_its_latency() {
        let mut tracker = start("latency = 2.5");
        let turned = |t: f64| rotation(&Vector::new(0.0, 0.01 * t, 0.0));
        let mut now = Instant::START;
        let mut told = Vec::new();
        while now.seconds() < 6.0 {
            let t = now.seconds();
            if let Some(reading) = tracker.read(now, &truth(turned(t), [0.0; 3], [0.0; 3]), None) {
                told.push((t, attitude(reading)));
            }
            now = tracker.after(now, Span::from_seconds(1.0));
        }
        let exposed = [(0.0, 0.0), (3.5, 1.0), (4.5, 2.0), (5.5, 3.0)];
        assert_eq!(told.len(), exposed.len(), "{told:?}");
        for ((at, seen), (exact, exposed)) in told.into_iter().zip(exposed) {
            assert!(at == exact && (seen - turned(exposed)).norm() < 1e-15, "{at}");
        }
    }

    #[test]
    fn noise_is_in_its_own_axes_and_elastic_rotation_is_seen() {
        // Its boresight z is the body's x.
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let keys = format!("noise = [1e-5, 2e-5, 1e-3]\naxes = [{half}, 0.0, {half}, 0.0]");
        let mut tracker = start(&keys);
        let at = rotation(&Vector::new(0.4, 0.1, -0.3));
        let elastic = [0.0, 1e-2, 0.0];
        let count = 20_000;
        let mut sums = Matrix3::zeros();
        for k in 0..count {
            let now = Instant::START + Span::from_seconds(f64::from(k));
            let seen = attitude(tracker.read(now, &truth(at, elastic, [0.0; 3]), None).unwrap());
            let error = crate::attitude::beyond(&(at * rotation(&elastic.into())), &seen);
            sums += error * error.transpose() / f64::from(count);
        }
        let exact = tracker.tracker.covariance([1e-5, 2e-5, 1e-3]);
        for (axis, variance) in [(0, 1e-6), (1, 4e-10), (2, 1e-10)] {
            assert!((exact[(axis, axis)] / variance - 1.0).abs() < 1e-9, "{exact}");
            // Three standard errors: 3 sqrt(2/n).
            assert!((sums[(axis, axis)] / variance - 1.0).abs() < 0.03, "{sums}");
        }
    }

    #[test]
    fn it_sees_nothing_at_a_high_rate_or_in_a_failure() {
        let mut tracker = start("blackout_rate = 0.02\nfaults = [{ silent = { from = 2.0, to = 3.0 } }]");
        let still = Quaternion::new(1.0, 0.0, 0.0, 0.0);
        let mut seen = |t: f64, rate: f64| {
            let now = Instant::START + Span::from_seconds(t);
            tracker.read(now, &truth(still, [0.0; 3], [0.0, rate, 0.0]), None).is_some()
        };
        assert_eq!(
            [seen(0.0, 0.0), seen(1.0, 0.02), seen(2.0, 0.0), seen(3.0, 0.019)],
            [true, false, false, true]
        );
    }
}
