//! A star tracker: the attitude at its exposures or the mean over each, with noise in its own axes and a latency.

use flexsc_formats::document;
use flexsc_numerics::attitude::{Attitude, Vector, rotation, vector};
use flexsc_numerics::quantity::{Finite, NonNegative, Positive, Time};
use flexsc_numerics::random::{Seed, Stream};
use flexsc_numerics::time::{Instant, Span};
use nalgebra::{DMatrix, Matrix3, Quaternion};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::exclusion::Exclusion;
use super::failure::with_failures;
use super::latency_queue::LatencyQueue;
use super::linear_noise::{KeyNoise, SensorNoise, existing};
use super::{
    ExposureMean, Orientation, Reading, ReferenceNoise, Sensor, SensorFailure, SensorSpec, Truth, stream,
};
use crate::offers::Offers;
use crate::part::Part;
use crate::requirement::Requirements;

/// Length of the quaternion to a boresight below which that is opposite to the body's z axis.
const OPPOSITE: f64 = 1e-9;

/// A star tracker on a body with three axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StarTracker {
    /// Point of the structure at which the star tracker is mounted; default: the first of the body's points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<String>,
    /// Period of the exposures (s).
    pub period: Span,
    /// Standard deviation of the white noise about the star tracker's axes (rad): x and y across the boresight, z about it.
    #[serde(default)]
    pub noise: [NonNegative; 3],
    /// Orientation of the star tracker's axes in the body: a unit quaternion \[w, x, y, z\] that transforms vectors from its axes
    /// to the body's; default: the identity.
    #[serde(default)]
    pub axes: Attitude,
    /// Direction of the boresight, its z axis, in the body, of any length, in place of `axes`: x and y are those of the body,
    /// turned by the smallest angle that takes z to the boresight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub boresight: Option<[Finite; 3]>,
    /// Time from the middle of an exposure to its output (s).
    #[serde(default)]
    pub latency: Time,
    /// Exposure time (s), at most `period` and twice `latency`: a reading is the mean attitude over the exposure;
    /// default: 0, the attitude at an instant.
    #[serde(default, skip_serializing_if = "is_instant")]
    pub exposure: Time,
    /// Rate at the star tracker from which on it gives no measurement (rad/s); default: no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blackout_rate: Option<Positive>,
    /// Angles between the boresight, its z axis, and bright bodies below which it gives no measurement; default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exclusion: Option<Exclusion>,
    /// Intervals in which the star tracker fails.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<SensorFailure>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn is_instant(exposure: &Time) -> bool {
    *exposure == Time::default()
}

impl SensorSpec for StarTracker {
    fn start(&self, _: usize, seed: Seed, ordinal: usize) -> Box<dyn Sensor> {
        Box::new(StarTrackerState::new(self, seed, ordinal))
    }

    fn period(&self, _: Option<Span>) -> Option<Span> {
        Some(self.period)
    }

    fn point(&self) -> Option<&str> {
        self.point.as_deref()
    }

    fn boresight(&self) -> Option<Vector> {
        Some(self.body_direction(2))
    }

    fn faults(&self) -> &[SensorFailure] {
        &self.faults
    }

    fn validate(&self) -> Option<document::ConfigError> {
        if let Some(fault) = self.exclusion.as_ref().and_then(Exclusion::validate) {
            return Some(fault);
        }
        if let Some(boresight) = &self.boresight {
            if boresight.iter().all(|part| part.get() == 0.0) {
                return Some(document::ConfigError::new("boresight", "must not be zero, got [0, 0, 0]"));
            }
            if self.axes != Attitude::default() {
                let why = "is the z axis of `axes`, and both are given: leave one out";
                return Some(document::ConfigError::new("boresight", why));
            }
        }
        let (exposure, latency) = (self.exposure.get(), self.latency.get());
        if self.exposure() > self.period {
            let why =
                format!("must be at most the `period` of {} s, got {exposure} s", self.period.seconds());
            return Some(document::ConfigError::new("exposure", why));
        }
        let why = || {
            format!(
                "must be at most twice the `latency` of {latency} s, which counts from its middle, got {exposure} s"
            )
        };
        (self.half_exposure() > self.latency()).then(|| document::ConfigError::new("exposure", why()))
    }

    fn requires(&self, _: usize, offers: &Offers, needs: &mut Requirements) {
        super::requirements::require_attitude(offers, needs);
        if let Some(exclusion) = &self.exclusion {
            exclusion.requires(offers, needs);
        }
    }

    fn exposure(&self) -> Span {
        Span::from_seconds(self.exposure.get())
    }

    fn angle_noise(&self) -> f64 {
        self.noise.map(NonNegative::get).into_iter().fold(0.0, f64::max)
    }

    fn reference(&self) -> Option<(Span, ReferenceNoise)> {
        Some((self.latency(), ReferenceNoise::Attitude(self.noise.map(NonNegative::get))))
    }

    fn attitude_covariance(&self, deviations: [f64; 3]) -> Matrix3<f64> {
        let axes = [Vector::x(), Vector::y(), Vector::z()].map(|axis| self.to_body_axes(&axis));
        axes.iter().zip(deviations).fold(Matrix3::zeros(), |sum, (axis, deviation)| {
            sum + axis * axis.transpose() * (deviation * deviation)
        })
    }

    fn linear_noise(&self, _: usize, _: f64) -> Option<Vec<KeyNoise>> {
        let matrix =
            DMatrix::from_fn(3, 3, |row, axis| self.body_direction(axis)[row] * self.noise[axis].get());
        Some(existing([("noise", (matrix.amax() > 0.0).then_some(SensorNoise::Angle(matrix)))]))
    }
}

impl StarTracker {
    /// Returns the latency of a reading.
    pub fn latency(&self) -> Span {
        Span::from_seconds(self.latency.get())
    }

    /// Returns half the exposure time.
    pub fn half_exposure(&self) -> Span {
        Span::from_seconds(0.5 * self.exposure.get())
    }

    /// Returns true if the exposure time is not 0.
    pub fn has_exposure(&self) -> bool {
        self.half_exposure() > Span::ZERO
    }

    /// Returns the direction of one of the tracker's axes in the body's axes, as a unit vector.
    pub fn body_direction(&self, axis: usize) -> Vector {
        self.to_body_axes(&Vector::ith(axis, 1.0))
    }

    /// Rotates a vector from the tracker's axes to the body's.
    fn to_body_axes(&self, vector: &Vector) -> Vector {
        let turn = self.turn();
        (turn * Quaternion::from_imag(*vector) * turn.conjugate()).vector().into_owned()
    }

    /// Returns the unit quaternion that transforms vectors from the tracker's axes to the body's.
    fn turn(&self) -> Quaternion<f64> {
        let Some(boresight) = &self.boresight else { return self.axes.get() };
        let along = vector(boresight).normalize();
        let turn = Quaternion::new(1.0 + along.z, -along.y, along.x, 0.0);
        // Opposite to z, it is half a turn about x.
        if turn.norm() < OPPOSITE { Quaternion::new(0.0, 1.0, 0.0, 0.0) } else { turn.normalize() }
    }
}

/// Run-time state of a star tracker.
#[derive(Clone, Debug)]
pub struct StarTrackerState {
    tracker: StarTracker,
    /// Random stream about each of the tracker's axes.
    noise: [Stream; 3],
    queue: LatencyQueue,
    /// True attitude in the middle of the exposure that is open, and the error of the reading (rad).
    open_exposure: Option<(Quaternion<f64>, Vector)>,
    /// True while a bright body is within its exclusion angle.
    is_blinded: bool,
}

impl StarTrackerState {
    /// Creates the run-time state; `ordinal` counts earlier star trackers.
    fn new(tracker: &StarTracker, seed: Seed, ordinal: usize) -> Self {
        let draws = |axis: usize| stream("star tracker", (axis, 3), ordinal, seed);
        Self {
            tracker: tracker.clone(),
            noise: [0, 1, 2].map(draws),
            queue: LatencyQueue::new(tracker.period, tracker.latency()),
            open_exposure: None,
            is_blinded: false,
        }
    }

    /// Returns the reading of an exposure at `now`.
    fn expose(&mut self, now: Instant, truth: &Truth, last: Option<&Reading>) -> Option<Reading> {
        // Random numbers are drawn during a failure too, so that later ones do not depend on it.
        let deviations = self.tracker.noise.map(NonNegative::get);
        let draws: [f64; 3] = std::array::from_fn(|axis| deviations[axis] * self.noise[axis].normal());
        self.open_exposure = None;
        let Orientation::Attitude(attitude) = truth.orientation.rotated_by(truth.sensor_angles()) else {
            return None;
        };
        let error = self.tracker.to_body_axes(&draws.into());
        let reading =
            Reading { at: Orientation::Attitude(attitude * rotation(&error)), rate: None, sight: None };
        let rate = Vector::from(truth.rate).norm();
        if self.is_blinded || self.tracker.blackout_rate.is_some_and(|limit| rate >= limit.get()) {
            return None;
        }
        let faults = &self.tracker.faults;
        let reported = with_failures(faults, now, Some(reading), last);
        // A repeated reading, and the reading at the start, already have their exposure.
        let again = with_failures(faults, now, None, last).is_some() || now == Instant::START;
        let is_altered = faults.iter().any(|fault| fault.alters_readings() && fault.interval().contains(now));
        let opens = reported.is_some() && !again && !is_altered && self.tracker.has_exposure();
        self.open_exposure = opens.then_some((attitude, error));
        reported
    }
}

impl Part for StarTrackerState {}

impl Sensor for StarTrackerState {
    /// Returns the reading whose latency has elapsed; the reading at the start is available at once, as if exposed
    /// before.
    fn read(&mut self, now: Instant, truth: &Truth, last: Option<&Reading>) -> Option<Reading> {
        if self.queue.samples_now(now) {
            let reading = self.expose(now, truth, last);
            self.queue.push(now, reading);
        }
        self.queue.take_due(now)
    }

    fn next_due(&mut self, _: Instant, _: Span) -> Instant {
        self.queue.next_due()
    }

    fn close_exposure(&mut self, exposure: &ExposureMean) {
        if let Some((middle, error)) = self.open_exposure.take() {
            self.queue.replace_last(Orientation::Attitude(exposure.mean(&middle) * rotation(&error)));
        }
    }

    fn set_blinded(&mut self, is_blinded: bool) {
        self.is_blinded = is_blinded;
    }

    fn copy(&self) -> Box<dyn Sensor> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(attitude: Quaternion<f64>, elastic: [f64; 3], rate: [f64; 3]) -> Truth {
        let orientation = Orientation::Attitude(attitude);
        let sky = flexsc_spacecraft::environment::EnvironmentObservation::default();
        Truth { orientation, elastic, rate, rigid_rate: rate, rate_integral: [0.0; 3], environment: sky }
    }

    fn start(keys: &str) -> StarTrackerState {
        let tracker: StarTracker =
            flexsc_formats::document::from_text(&format!("period = 1.0\n{keys}")).unwrap();
        StarTrackerState::new(&tracker, Seed { scenario: 3, run: 0 }, 0)
    }

    fn attitude(reading: Reading) -> Quaternion<f64> {
        let Orientation::Attitude(attitude) = reading.at else { panic!("{reading:?}") };
        attitude
    }

    #[test]
    fn an_exposure_is_available_after_its_latency() {
        let mut tracker = start("latency = 2.5");
        let attitude_at = |t: f64| rotation(&Vector::new(0.0, 0.01 * t, 0.0));
        let mut now = Instant::START;
        let mut reported = Vec::new();
        while now.seconds() < 6.0 {
            let t = now.seconds();
            if let Some(reading) = tracker.read(now, &truth(attitude_at(t), [0.0; 3], [0.0; 3]), None) {
                reported.push((t, attitude(reading)));
            }
            now = tracker.next_due(now, Span::from_seconds(1.0));
        }
        let exposed = [(0.0, 0.0), (3.5, 1.0), (4.5, 2.0), (5.5, 3.0)];
        assert_eq!(reported.len(), exposed.len(), "{reported:?}");
        for ((time, attitude), (exact, exposed)) in reported.into_iter().zip(exposed) {
            assert!(time == exact && (attitude - attitude_at(exposed)).norm() < 1e-15, "{time}");
        }
    }

    /// Checks an exposure that ends before its reading is available, and one that ends at that time.
    #[test]
    fn a_reading_is_the_mean_over_its_exposure() {
        let attitude_at = |t: f64| rotation(&Vector::new(0.0, 0.01 * t, 0.0));
        let smear = Vector::new(2e-4, 0.0, -1e-4);
        for (latency, exposure) in [(1.8, 0.5), (0.25, 0.5)] {
            let keys = format!("latency = {latency}\nexposure = {exposure}\nnoise = [1e-5, 1e-5, 1e-5]");
            let (mut tracker, mut plain) =
                (start(&keys), start(&format!("latency = {latency}\nnoise = [1e-5, 1e-5, 1e-5]")));
            let (mut now, mut gathered, mut reported) = (Instant::START, Instant::START, 0);
            while now.seconds() < 6.0 {
                if gathered > Instant::START && gathered <= now {
                    let mut mean = ExposureMean::default();
                    let middle = gathered.before(tracker.tracker.half_exposure()).seconds();
                    for duration in [0.2, 0.3] {
                        mean.add(attitude_at(middle) * rotation(&smear), duration);
                    }
                    tracker.close_exposure(&mean);
                    // The mean is already set: further attitudes have no effect.
                    mean.add(attitude_at(9.0), 100.0);
                    tracker.close_exposure(&mean);
                    gathered = Instant::START;
                }
                let reading = truth(attitude_at(now.seconds()), [0.0; 3], [0.0; 3]);
                let exposes = tracker.queue.samples_now(now) && now > Instant::START;
                let (one, other) = (tracker.read(now, &reading, None), plain.read(now, &reading, None));
                if exposes {
                    gathered = now + tracker.tracker.half_exposure();
                }
                assert_eq!(one.is_some(), other.is_some());
                if let (Some(one), Some(other)) = (one, other) {
                    // Both have the same noise; only the mean over the exposure differs, except at the start.
                    let by = flexsc_numerics::attitude::rotation_vector(&attitude(other), &attitude(one));
                    let exact = if now == Instant::START { Vector::zeros() } else { smear };
                    assert!((by - exact).norm() < 1e-8, "{by}");
                    reported += 1;
                }
                let next = tracker.next_due(now, Span::from_seconds(1.0));
                assert_eq!(next, plain.next_due(now, Span::from_seconds(1.0)));
                now = if gathered > now { next.min(gathered) } else { next };
            }
            assert_eq!(reported, if latency > 1.0 { 5 } else { 6 });
        }
    }

    #[test]
    fn a_repeated_reading_was_exposed_before() {
        let still = Quaternion::new(1.0, 0.0, 0.0, 0.0);
        let faults = "faults = [{ stuck = { from = 2.0, to = 3.0 } }, { silent = { from = 3.0, to = 4.0 } }]";
        let mut tracker = start(&format!("latency = 1.5\nexposure = 1.0\nblackout_rate = 0.1\n{faults}"));
        let last = Reading { at: Orientation::Attitude(still), rate: None, sight: None };
        let mut open_exposure = |t: f64, rate: f64| {
            let now = Instant::START + Span::from_seconds(t);
            tracker.read(now, &truth(still, [0.0; 3], [rate, 0.0, 0.0]), Some(&last));
            tracker.open_exposure.is_some()
        };
        let found = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0), (4.0, 0.2), (5.0, 0.0)];
        assert_eq!(found.map(|(t, rate)| open_exposure(t, rate)), [false, true, false, false, false, true]);
    }

    #[test]
    fn a_boresight_is_the_z_axis_of_the_smallest_turn() {
        let tracker = |keys: &str| -> StarTracker {
            document::from_text(&format!("period = 1.0\n{keys}\n")).expect(keys)
        };
        // The axes of a boresight along (0, -0.6, -0.8) by hand: a turn of 143 degrees about x.
        let by_hand = tracker("axes = [0.31622776601683794, 0.9486832980505138, 0.0, 0.0]");
        let by_boresight = tracker("boresight = [0, -3, -4]");
        for axis in 0..3 {
            let difference = by_hand.body_direction(axis) - by_boresight.body_direction(axis);
            assert!(difference.amax() < 1e-15, "{axis}: {difference}");
        }
        assert_eq!(tracker("boresight = [0, 0, 2]").body_direction(0), Vector::x());
        assert_eq!(tracker("boresight = [0, 0, -1]").body_direction(2), -Vector::z());
        let fault = |keys: &str| tracker(keys).validate().map(|fault| fault.key);
        assert_eq!(fault("boresight = [0, 0, 0]"), Some("boresight".to_owned()));
        assert_eq!(fault("boresight = [1, 0, 0]\naxes = [0, 1, 0, 0]"), Some("boresight".to_owned()));
        assert_eq!(fault("boresight = [1, 0, 0]"), None);
    }

    #[test]
    fn noise_is_in_its_own_axes_and_elastic_rotation_is_seen() {
        // The boresight z is the body's x.
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let keys = format!("noise = [1e-5, 2e-5, 1e-3]\naxes = [{half}, 0.0, {half}, 0.0]");
        let mut tracker = start(&keys);
        let orientation = rotation(&Vector::new(0.4, 0.1, -0.3));
        let elastic = [0.0, 1e-2, 0.0];
        let count = 20_000;
        let mut sums = Matrix3::zeros();
        for k in 0..count {
            let now = Instant::START + Span::from_seconds(f64::from(k));
            let attitude = attitude(tracker.read(now, &truth(orientation, elastic, [0.0; 3]), None).unwrap());
            let error = flexsc_numerics::attitude::rotation_vector(
                &(orientation * rotation(&elastic.into())),
                &attitude,
            );
            sums += error * error.transpose() / f64::from(count);
        }
        let exact = tracker.tracker.attitude_covariance([1e-5, 2e-5, 1e-3]);
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
        let mut mean_error = |t: f64, rate: f64| {
            let now = Instant::START + Span::from_seconds(t);
            tracker.read(now, &truth(still, [0.0; 3], [0.0, rate, 0.0]), None).is_some()
        };
        assert_eq!(
            [mean_error(0.0, 0.0), mean_error(1.0, 0.02), mean_error(2.0, 0.0), mean_error(3.0, 0.019)],
            [true, false, false, true]
        );
        let mut tracker = start("exclusion = { sun = 0.7 }");
        let mut measures = |t: f64, is_blinded: bool| {
            tracker.set_blinded(is_blinded);
            tracker
                .read(Instant::START + Span::from_seconds(t), &truth(still, [0.0; 3], [0.0; 3]), None)
                .is_some()
        };
        assert_eq!([measures(0.0, true), measures(1.0, false), measures(2.0, true)], [false, true, false]);
    }
}
