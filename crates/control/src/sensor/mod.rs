//! Sensors: what is measured of the angle or of the attitude, and of the rates, and when.

mod accelerometer;
mod counter;
mod exact;
mod exposure;
mod gyro;
mod instrument;
mod late;
mod magnetometer;
mod sampled;
mod star_tracker;
mod sun_sensor;
mod tachometer;
mod vector;
mod wander;

use std::fmt;

use nalgebra::Quaternion;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::attitude::{AXES, Vector, rotation, rotation_vector};
use crate::document;
use crate::environment::SkySight;
use crate::own::{Halt, Own};
use crate::parts::Parts;
use crate::quantity::Positive;
use crate::random::{Seed, Stream};
use crate::time::{Instant, Span};

pub use accelerometer::{Accelerating, Accelerometer, MeasuredAcceleration};
pub use exposure::Exposure;
pub use gyro::{AtCycles, Gyro};
pub use instrument::Instrument;
pub use magnetometer::Magnetometer;
pub use sampled::{Fault, Sampled, SampledSensor};
pub use star_tracker::StarTracker;
pub use sun_sensor::SunSensor;
pub use tachometer::{Counting, Tachometer};

/// The kinds of sensor.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sensor {
    /// The true angle at every instant: guards trip at the exact crossing.
    #[default]
    Continuous,
    /// A sample at each period, held until the next: guards are tested at samples.
    Sampled(Sampled),
    /// A rate gyro, read in each cycle of the law; the angle, or the attitude, is known exactly.
    Gyro(Gyro),
    /// The attitude at the exposures, available after a latency.
    StarTracker(StarTracker),
    /// The magnetic field.
    Magnetometer(Magnetometer),
    /// The direction to the Sun.
    SunSensor(SunSensor),
    /// The speeds of the wheels, for their drives; it measures nothing of the body's motion.
    Tachometer(Tachometer),
    /// The specific force at a point of a spacecraft, for the log only.
    Accelerometer(Accelerometer),
    /// A sensor from another crate; a scenario file cannot name it.
    Own(Own<dyn Instrument>),
}

/// A sensor at work.
pub trait Sense: fmt::Debug + Send + Sync {
    /// What is measured now, after the last reading; nothing of a sensor that is silent.
    fn read(&mut self, now: Instant, truth: &Truth, last: Option<&Reading>) -> Option<Reading>;

    /// When it acts next after now, of a sensor with this period.
    fn after(&mut self, now: Instant, period: Span) -> Instant {
        now + period
    }

    /// Takes what was seen over the exposure that ends now, of a sensor that gathers light.
    fn gather(&mut self, _: &Exposure) {}

    /// The true bias of its rates now (rad/s), of a gyro.
    fn bias(&self) -> Option<[f64; 3]> {
        None
    }

    /// Why it cannot go on, of one from outside that cannot: the run ends there.
    fn halted(&self) -> Option<Halt> {
        None
    }

    /// A copy in the same state.
    fn copy(&self) -> Box<dyn Sense>;
}

impl Clone for Box<dyn Sense> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

/// Where a body points.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Orientation {
    /// Its one angle (rad).
    Angle(f64),
    /// The attitude of its axes: it turns their vectors into inertial ones.
    Attitude(Quaternion<f64>),
}

impl Orientation {
    /// Returns the rotation vector from another orientation to this one (rad); for one angle, the difference about the first axis.
    #[inline]
    pub fn beyond(&self, other: &Self) -> [f64; 3] {
        match (self, other) {
            (Self::Attitude(q), Self::Attitude(goal)) => rotation_vector(goal, q).into(),
            (Self::Angle(angle), Self::Angle(goal)) => [angle - goal, 0.0, 0.0],
            // A run has one kind.
            _ => [f64::NAN; 3],
        }
    }

    /// The orientation that is seen as these angles: one angle itself, or small rotations of this attitude (rad).
    #[must_use]
    #[inline]
    pub fn at(&self, angles: [f64; 3]) -> Self {
        match self {
            Self::Angle(_) => Self::Angle(angles[0]),
            Self::Attitude(q) => Self::Attitude(q * rotation(&Vector::from(angles))),
        }
    }
}

/// What there is to measure at an instant.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Truth {
    /// Where the body points: one angle with its elastic part, or the attitude of its axes.
    pub orientation: Orientation,
    /// The elastic rotations at the sensor beside an attitude (rad).
    pub elastic: [f64; 3],
    /// Rates at the sensor, elastic part included (rad/s).
    pub rate: [f64; 3],
    /// Rates of the body as if it were rigid (rad/s).
    pub rigid: [f64; 3],
    /// The integral of `rate` (rad), but for a constant: what a gyro that counts angles has counted.
    pub turned: [f64; 3],
    /// What there is of the sky.
    pub sky: SkySight,
}

impl Truth {
    /// What a sensor of angles sees: one angle, or the small rotations by which its place differs from the attitude (rad).
    #[inline]
    pub fn seen(&self) -> [f64; 3] {
        match self.orientation {
            Orientation::Angle(angle) => [angle, 0.0, 0.0],
            Orientation::Attitude(_) => self.elastic,
        }
    }
}

/// A reading.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Reading {
    /// Where the body points.
    pub at: Orientation,
    /// Rates (rad/s), of a sensor that measures them.
    pub rate: Option<[f64; 3]>,
    /// A vector, of a sensor that measures one.
    pub sight: Option<VectorSight>,
}

/// A vector that was measured.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct VectorSight {
    /// In the body's axes, as measured.
    pub vector: Vector,
    /// What it is in inertial axes.
    pub inertial: Vector,
    /// Whether its direction alone was measured, and it has length 1.
    pub is_direction: bool,
}

impl Sensor {
    /// What single values cannot show to be wrong: a key within the sensor, and why.
    pub fn inconsistency(&self) -> Option<document::Fault> {
        match self {
            Self::Gyro(gyro) => gyro.inconsistency(),
            Self::StarTracker(tracker) => tracker.inconsistency(),
            Self::Magnetometer(magnetometer) => magnetometer.inconsistency(),
            Self::SunSensor(sensor) => sensor.inconsistency(),
            Self::Accelerometer(accelerometer) => accelerometer.inconsistency(),
            Self::Continuous | Self::Sampled(_) | Self::Tachometer(_) | Self::Own(_) => None,
        }
    }

    /// The sensor in a run of a body with so many axes, after so many others of its kind.
    pub fn start(&self, axes: usize, seed: Seed, ordinal: usize) -> Box<dyn Sense> {
        match self {
            Self::Continuous => Box::new(exact::Exact),
            Self::Sampled(sampled) => Box::new(sampled.start(axes, seed, ordinal)),
            Self::Gyro(gyro) => Box::new(gyro.start(axes, seed, ordinal)),
            Self::StarTracker(tracker) => Box::new(tracker.start(seed, ordinal)),
            Self::Magnetometer(magnetometer) => magnetometer.start(seed, ordinal),
            Self::SunSensor(sensor) => sensor.start(seed, ordinal),
            Self::Tachometer(_) | Self::Accelerometer(_) => Box::new(tachometer::Blind),
            Self::Own(own) => own.start(axes, seed),
        }
    }

    /// Whether it measures how the body points or turns.
    pub fn sees_body(&self) -> bool {
        !matches!(self, Self::Tachometer(_) | Self::Accelerometer(_))
    }

    /// Whether it knows the motion at every instant.
    pub fn is_continuous(&self) -> bool {
        matches!(self, Self::Continuous)
    }

    /// The kind, as a scenario names it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Continuous => "continuous",
            Self::Sampled(_) => "sampled",
            Self::Gyro(_) => "gyro",
            Self::StarTracker(_) => "star_tracker",
            Self::Magnetometer(_) => "magnetometer",
            Self::SunSensor(_) => "sun_sensor",
            Self::Tachometer(_) => "tachometer",
            Self::Accelerometer(_) => "accelerometer",
            Self::Own(_) => "own",
        }
    }

    /// The period of its samples of the body under a law with a period of its own or none; none of a continuous sensor, and of
    /// a tachometer or an accelerometer, which tell nothing of how the body turns.
    pub fn period(&self, law: Option<Span>) -> Option<Span> {
        match self {
            Self::Continuous | Self::Tachometer(_) | Self::Accelerometer(_) => None,
            Self::Sampled(sampled) => Some(sampled.period),
            Self::Gyro(gyro) => gyro.period.or(law),
            Self::StarTracker(tracker) => Some(tracker.period),
            Self::Magnetometer(magnetometer) => Some(magnetometer.period),
            Self::SunSensor(sensor) => Some(sensor.period),
            Self::Own(own) => Some(own.period()),
        }
    }

    /// How late it reports rates.
    pub fn rate_latency(&self) -> Span {
        if let Self::Gyro(gyro) = self { gyro.latency() } else { Span::ZERO }
    }

    /// Whether it measures the mean rate over each of its periods.
    pub fn integrates(&self) -> bool {
        matches!(self, Self::Gyro(gyro) if gyro.integrates())
    }

    /// The point of the structure at which it is, if it names one.
    pub fn point(&self) -> Option<&str> {
        match self {
            Self::Continuous | Self::Tachometer(_) | Self::Own(_) => None,
            Self::Sampled(sampled) => sampled.point.as_deref(),
            Self::Gyro(gyro) => gyro.point.as_deref(),
            Self::StarTracker(tracker) => tracker.point.as_deref(),
            Self::Magnetometer(magnetometer) => magnetometer.point.as_deref(),
            Self::SunSensor(sensor) => sensor.point.as_deref(),
            Self::Accelerometer(accelerometer) => accelerometer.point.as_deref(),
        }
    }

    /// Standard deviation of a measured rate about an axis (rad/s), if rates are measured.
    pub fn rate_noise(&self, axis: usize) -> Option<f64> {
        match self {
            Self::Continuous
            | Self::StarTracker(_)
            | Self::Magnetometer(_)
            | Self::SunSensor(_)
            | Self::Tachometer(_)
            | Self::Accelerometer(_) => None,
            Self::Sampled(sampled) => sampled.rate_noise.map(Positive::get),
            Self::Gyro(gyro) => Some(gyro.rate_noise(axis)),
            Self::Own(own) => own.rate_noise(),
        }
    }

    /// Standard deviation of the measured angle (rad), that of its quantisation included.
    pub fn angle_noise(&self) -> f64 {
        match self {
            Self::Sampled(sampled) => sampled.angle_noise(),
            Self::StarTracker(tracker) => tracker.angle_noise(),
            Self::Own(own) => own.angle_noise(),
            Self::Continuous
            | Self::Gyro(_)
            | Self::Magnetometer(_)
            | Self::SunSensor(_)
            | Self::Tachometer(_)
            | Self::Accelerometer(_) => 0.0,
        }
    }

    /// Whether it measures a vector, which tells the attitude only beside another.
    pub fn is_of_a_vector(&self) -> bool {
        matches!(self, Self::Magnetometer(_) | Self::SunSensor(_))
    }

    /// Whether it measures the magnetic field.
    pub fn measures_field(&self) -> bool {
        matches!(self, Self::Magnetometer(_))
    }

    /// Its failures.
    pub fn faults(&self) -> &[Fault] {
        match self {
            Self::Sampled(sampled) => &sampled.faults,
            Self::StarTracker(tracker) => &tracker.faults,
            Self::Magnetometer(magnetometer) => &magnetometer.faults,
            Self::SunSensor(sensor) => &sensor.faults,
            Self::Tachometer(tachometer) => &tachometer.faults,
            Self::Accelerometer(accelerometer) => &accelerometer.faults,
            Self::Gyro(gyro) => &gyro.faults,
            Self::Continuous | Self::Own(_) => &[],
        }
    }
}

/// The stream of draws about an axis of a body with so many, of a sensor after so many others of its kind.
fn stream(name: &str, (axis, axes): (usize, usize), ordinal: usize, seed: Seed) -> Stream {
    let name = if ordinal == 0 { name.to_owned() } else { format!("{name} {ordinal}") };
    match axes {
        1 => seed.stream(&name),
        _ => seed.stream(&format!("{name} {}", AXES[axis])),
    }
}

impl Parts<Sensor> {
    /// The first: the only one, in most scenarios.
    pub fn first(&self) -> &Sensor {
        &self[0]
    }

    /// How many measure the body.
    pub fn of_body(&self) -> usize {
        self.iter().filter(|sensor| sensor.sees_body()).count()
    }

    /// The tachometer, and its place among the sensors, if there is one.
    pub fn tachometer(&self) -> Option<(usize, &Tachometer)> {
        self.iter().enumerate().find_map(|(index, sensor)| match sensor {
            Sensor::Tachometer(tachometer) => Some((index, tachometer)),
            _ => None,
        })
    }

    /// The accelerometers, each with its place among the sensors.
    pub fn accelerometers(&self) -> impl Iterator<Item = (usize, &Accelerometer)> {
        self.iter().enumerate().filter_map(|(index, sensor)| match sensor {
            Sensor::Accelerometer(accelerometer) => Some((index, accelerometer)),
            _ => None,
        })
    }

    /// How many of its kind come before a sensor.
    pub fn ordinal(&self, index: usize) -> usize {
        let kind = self[index].kind();
        self[..index].iter().filter(|sensor| sensor.kind() == kind).count()
    }

    /// Whether a sensor tells where the body points: a gyro only where no other does, which then is known exactly.
    pub fn orients(&self, index: usize) -> bool {
        let rates = |sensor: &Sensor| matches!(sensor, Sensor::Gyro(_));
        let of_body = |sensor: &Sensor| sensor.sees_body() && !sensor.is_of_a_vector();
        let alone = self.iter().filter(|sensor| of_body(sensor)).all(rates);
        let is_first = !self[..index].iter().any(of_body);
        of_body(&self[index]) && (!rates(&self[index]) || alone && is_first)
    }

    /// The shortest period of their samples under a law with a period of its own or none; none of a continuous sensor.
    pub fn period(&self, law: Option<Span>) -> Option<Span> {
        self.iter().filter_map(|sensor| sensor.period(law)).min()
    }

    /// Standard deviation of a measured rate about an axis (rad/s), if rates are measured.
    pub fn rate_noise(&self, axis: usize) -> Option<f64> {
        self.iter().find_map(|sensor| sensor.rate_noise(axis))
    }

    /// Standard deviation of the measured angle (rad), that of its quantisation included.
    pub fn angle_noise(&self) -> f64 {
        (0..self.len()).find(|index| self.orients(*index)).map_or(0.0, |index| self[index].angle_noise())
    }
}
