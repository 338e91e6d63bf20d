//! Sensors of angle, attitude, rates, vectors and accelerations, with their timing.

mod accelerometer;
mod custom_sensor;
mod direction_sensor;
mod earth_sensor;
mod exclusion;
mod exposure;
mod gauss_markov_bias;
mod gyro;
mod ideal;
mod latency_queue;
mod linear_measurement;
pub mod linear_noise;
mod magnetometer;
mod measured_quantity;
mod rate_integrator;
mod reference;
mod requirements;
mod sampled;
mod sensor_list;
mod star_tracker;
mod sun_cells;
mod sun_sensor;
mod tachometer;
mod vector;

use flexsc_formats::document;
use flexsc_numerics::attitude::{AXES, Vector, vector};
use flexsc_numerics::quantity::Positive;
use flexsc_numerics::random::{Seed, Stream};
use flexsc_numerics::time::{Instant, Span};
use flexsc_spacecraft::environment::EnvironmentObservation;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::custom::Custom;
use crate::part::Part;

pub use crate::orientation::Orientation;
pub use accelerometer::{Accelerometer, AccelerometerState, MeasuredAcceleration};
pub use custom_sensor::SensorSpec;
pub use earth_sensor::EarthSensor;
pub use exclusion::Exclusion;
pub use exposure::ExposureMean;
pub use gyro::{Gyro, GyroState};
pub use linear_measurement::LinearMeasurement;
pub use magnetometer::Magnetometer;
pub use measured_quantity::MeasuredQuantity;
pub use reference::ReferenceNoise;
pub use sampled::{Sampled, SampledState, SensorFailure};
pub use star_tracker::StarTracker;
pub use sun_cells::{SunCell, SunCells};
pub use sun_sensor::SunSensor;
pub use tachometer::{Tachometer, TachometerState};

/// The kinds of sensor.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Sensor")]
pub enum SensorKind {
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
    /// The direction to the Sun, from the currents of cells.
    SunCells(SunCells),
    /// The direction to the planet's centre.
    EarthSensor(EarthSensor),
    /// The speeds of the wheels, for their drives; it measures nothing of the body's motion.
    Tachometer(Tachometer),
    /// The specific force at a point of a spacecraft, for the log only.
    Accelerometer(Accelerometer),
    /// A sensor from another crate; a scenario file cannot name it.
    Own(Custom<dyn SensorSpec>),
}

/// Cone of the directions in which a sensor measures.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct FieldOfView {
    /// Unit vector of its axis, in the body's axes.
    pub boresight: Vector,
    /// Half angle (rad).
    pub half_angle: f64,
}

/// Run-time state of a sensor.
pub trait Sensor: Part {
    /// Returns the reading at `now`, given the last one; `None` if the sensor is silent or has no new reading.
    fn read(&mut self, now: Instant, truth: &Truth, last: Option<&Reading>) -> Option<Reading>;

    /// Returns the next time after `now` at which the sensor acts, for a sensor with this period.
    fn next_due(&mut self, now: Instant, period: Span) -> Instant {
        now + period
    }

    /// Replaces the last attitude of a sensor with an exposure time by the mean over the exposure that ends now.
    fn close_exposure(&mut self, _: &ExposureMean) {}

    /// Sets whether a bright body blinds the sensor from now on.
    fn set_blinded(&mut self, _: bool) {}

    /// Returns the true bias of the rates (rad/s), of a gyro.
    fn true_bias(&self) -> Option<[f64; 3]> {
        None
    }

    /// Returns a copy in the same state.
    fn copy(&self) -> Box<dyn Sensor>;
}

impl Clone for Box<dyn Sensor> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

/// True state that sensors measure at an instant.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Truth {
    /// Orientation of the body: one angle with its elastic part, or the attitude of its axes.
    pub orientation: Orientation,
    /// Elastic rotations at the sensor relative to the attitude (rad).
    pub elastic: [f64; 3],
    /// Rates at the sensor, elastic part included (rad/s).
    pub rate: [f64; 3],
    /// Rigid rates of the body (rad/s).
    pub rigid_rate: [f64; 3],
    /// Integral of `rate` (rad), up to a constant, which integrating gyros read.
    pub rate_integral: [f64; 3],
    /// Vectors of the environment: magnetic field, and directions to Sun and planet.
    pub environment: EnvironmentObservation,
}

impl Truth {
    /// Returns the angles of an angle sensor: the angle itself, or the elastic rotations of its mount (rad).
    #[inline]
    pub fn sensor_angles(&self) -> [f64; 3] {
        match self.orientation {
            Orientation::Angle(angle) => [angle, 0.0, 0.0],
            Orientation::Attitude(_) => self.elastic,
        }
    }
}

/// Reading of a sensor.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Reading {
    /// Measured orientation of the body.
    pub at: Orientation,
    /// Measured rates (rad/s), if the sensor measures them.
    pub rate: Option<[f64; 3]>,
    /// Measured vector, if the sensor measures one.
    pub sight: Option<VectorMeasurement>,
}

/// Measured vector, with its reference in inertial axes.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct VectorMeasurement {
    /// Vector in the body's axes, as measured.
    pub vector: Vector,
    /// Vector in inertial axes.
    pub inertial: Vector,
    /// True if only the direction is measured, as a unit vector.
    pub is_direction: bool,
}

impl SensorKind {
    /// Checks the settings against each other; returns the first inconsistent key and the reason.
    pub fn inconsistency(&self) -> Option<document::ConfigError> {
        match self {
            Self::Gyro(gyro) => gyro.inconsistency(),
            Self::StarTracker(tracker) => tracker.inconsistency(),
            Self::Magnetometer(magnetometer) => magnetometer.inconsistency(),
            Self::SunSensor(sensor) => sensor.inconsistency(),
            Self::SunCells(sensor) => sensor.inconsistency(),
            Self::EarthSensor(sensor) => sensor.inconsistency(),
            Self::Accelerometer(accelerometer) => accelerometer.inconsistency(),
            Self::Continuous | Self::Sampled(_) | Self::Tachometer(_) | Self::Own(_) => None,
        }
    }

    /// Creates the sensor's run-time state on a body with `axes` axes; `ordinal` counts earlier sensors of the same
    /// kind.
    pub fn start(&self, axes: usize, seed: Seed, ordinal: usize) -> Box<dyn Sensor> {
        match self {
            Self::Continuous => Box::new(ideal::IdealSensor),
            Self::Sampled(sampled) => Box::new(sampled.start(axes, seed, ordinal)),
            Self::Gyro(gyro) => Box::new(gyro.start(axes, seed, ordinal)),
            Self::StarTracker(tracker) => Box::new(tracker.start(seed, ordinal)),
            Self::Magnetometer(magnetometer) => magnetometer.start(seed, ordinal),
            Self::SunSensor(sensor) => sensor.start(seed, ordinal),
            Self::SunCells(sensor) => Box::new(sensor.start(seed, ordinal)),
            Self::EarthSensor(sensor) => sensor.start(seed, ordinal),
            Self::Tachometer(_) | Self::Accelerometer(_) => Box::new(tachometer::NoMeasurement),
            Self::Own(own) => own.start(axes, seed),
        }
    }

    /// Returns true if the sensor measures orientation or rates of the body.
    pub fn measures_motion(&self) -> bool {
        !matches!(self, Self::Tachometer(_) | Self::Accelerometer(_))
    }

    /// Returns true if the sensor measures the motion at every instant.
    pub fn is_continuous(&self) -> bool {
        matches!(self, Self::Continuous)
    }

    /// Returns the name of the kind, as in a scenario.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Continuous => "continuous",
            Self::Sampled(_) => "sampled",
            Self::Gyro(_) => "gyro",
            Self::StarTracker(_) => "star_tracker",
            Self::Magnetometer(_) => "magnetometer",
            Self::SunSensor(_) => "sun_sensor",
            Self::SunCells(_) => "sun_cells",
            Self::EarthSensor(_) => "earth_sensor",
            Self::Tachometer(_) => "tachometer",
            Self::Accelerometer(_) => "accelerometer",
            Self::Own(_) => "own",
        }
    }

    /// Returns the period of the samples of the body's motion, under a law with period `law`; `None` for a continuous
    /// sensor, a tachometer or an accelerometer.
    pub fn period(&self, law: Option<Span>) -> Option<Span> {
        match self {
            Self::Continuous | Self::Tachometer(_) | Self::Accelerometer(_) => None,
            Self::Sampled(sampled) => Some(sampled.period),
            Self::Gyro(gyro) => gyro.period.or(law),
            Self::StarTracker(tracker) => Some(tracker.period),
            Self::Magnetometer(magnetometer) => Some(magnetometer.period),
            Self::SunSensor(sensor) => Some(sensor.period),
            Self::SunCells(sensor) => Some(sensor.period),
            Self::EarthSensor(sensor) => Some(sensor.period),
            Self::Own(own) => Some(own.period()),
        }
    }

    /// Returns the latency of the rates.
    pub fn rate_latency(&self) -> Span {
        if let Self::Gyro(gyro) = self { gyro.latency() } else { Span::ZERO }
    }

    /// Returns true if the sensor measures the mean rate over each of its periods.
    pub fn integrates(&self) -> bool {
        matches!(self, Self::Gyro(gyro) if gyro.integrates())
    }

    /// Returns the point of the structure at which the sensor is mounted, if given.
    pub fn point(&self) -> Option<&str> {
        match self {
            Self::Continuous | Self::Tachometer(_) | Self::Own(_) => None,
            Self::Sampled(sampled) => sampled.point.as_deref(),
            Self::Gyro(gyro) => gyro.point.as_deref(),
            Self::StarTracker(tracker) => tracker.point.as_deref(),
            Self::Magnetometer(magnetometer) => magnetometer.point.as_deref(),
            Self::SunSensor(sensor) => sensor.point.as_deref(),
            Self::SunCells(sensor) => sensor.point.as_deref(),
            Self::EarthSensor(sensor) => sensor.point.as_deref(),
            Self::Accelerometer(accelerometer) => accelerometer.point.as_deref(),
        }
    }

    /// Returns the field of view, if the sensor has one that leaves out directions.
    pub fn field_of_view(&self) -> Option<FieldOfView> {
        let Self::SunSensor(sensor) = self else { return None };
        let half_angle = sensor.field_of_view.get();
        let boresight = vector(&sensor.boresight).normalize();
        (half_angle < std::f64::consts::PI).then_some(FieldOfView { boresight, half_angle })
    }

    /// Returns the standard deviation of a measured rate about an axis (rad/s), if rates are measured.
    pub fn rate_noise(&self, axis: usize) -> Option<f64> {
        match self {
            Self::Continuous
            | Self::StarTracker(_)
            | Self::Magnetometer(_)
            | Self::SunSensor(_)
            | Self::SunCells(_)
            | Self::EarthSensor(_)
            | Self::Tachometer(_)
            | Self::Accelerometer(_) => None,
            Self::Sampled(sampled) => sampled.rate_noise.map(Positive::get),
            Self::Gyro(gyro) => Some(gyro.rate_noise(axis)),
            Self::Own(own) => own.rate_noise(),
        }
    }

    /// Returns the standard deviation of the measured angle (rad), including quantisation.
    pub fn angle_noise(&self) -> f64 {
        match self {
            Self::Sampled(sampled) => sampled.angle_noise(),
            Self::StarTracker(tracker) => tracker.angle_noise(),
            Self::Own(own) => own.angle_noise(),
            Self::Continuous
            | Self::Gyro(_)
            | Self::Magnetometer(_)
            | Self::SunSensor(_)
            | Self::SunCells(_)
            | Self::EarthSensor(_)
            | Self::Tachometer(_)
            | Self::Accelerometer(_) => 0.0,
        }
    }

    /// Returns true if the sensor measures a vector, which alone does not determine the attitude.
    pub fn measures_vector(&self) -> bool {
        matches!(self, Self::Magnetometer(_) | Self::SunSensor(_) | Self::SunCells(_) | Self::EarthSensor(_))
    }

    /// Returns true if the sensor measures the magnetic field.
    pub fn measures_field(&self) -> bool {
        matches!(self, Self::Magnetometer(_))
    }

    /// Returns the sensor's failures.
    pub fn faults(&self) -> &[SensorFailure] {
        match self {
            Self::Sampled(sampled) => &sampled.faults,
            Self::StarTracker(tracker) => &tracker.faults,
            Self::Magnetometer(magnetometer) => &magnetometer.faults,
            Self::SunSensor(sensor) => &sensor.faults,
            Self::SunCells(sensor) => &sensor.faults,
            Self::EarthSensor(sensor) => &sensor.faults,
            Self::Tachometer(tachometer) => &tachometer.faults,
            Self::Accelerometer(accelerometer) => &accelerometer.faults,
            Self::Gyro(gyro) => &gyro.faults,
            Self::Continuous | Self::Own(_) => &[],
        }
    }
}

/// Returns the random stream of an axis, out of `axes`, of a sensor with index `ordinal` among those of its kind.
fn stream(name: &str, (axis, axes): (usize, usize), ordinal: usize, seed: Seed) -> Stream {
    let name = if ordinal == 0 { name.to_owned() } else { format!("{name} {ordinal}") };
    match axes {
        1 => seed.stream(&name),
        _ => seed.stream(&format!("{name} {}", AXES[axis])),
    }
}
