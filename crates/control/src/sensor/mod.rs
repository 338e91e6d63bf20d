//! Sensors of angle, attitude, rates, vectors and accelerations, with their timing.

mod accelerometer;
mod direction_sensor;
mod earth_sensor;
mod exclusion;
mod exposure;
mod failure;
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
mod sensor_spec;
mod star_tracker;
mod sun_cells;
mod sun_sensor;
mod tachometer;
mod vector;

use flexsc_numerics::attitude::{AXES, Vector};
use flexsc_numerics::random::{Seed, Stream};
use flexsc_numerics::time::{Instant, Span};
use flexsc_spacecraft::environment::EnvironmentObservation;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::kinds::kinds;
use crate::part::Part;

pub use crate::orientation::Orientation;
pub use accelerometer::{Accelerometer, AccelerometerState, MeasuredAcceleration};
pub use earth_sensor::EarthSensor;
pub use exclusion::Exclusion;
pub use exposure::ExposureMean;
pub use failure::{Outlier, SensorFailure};
pub use gyro::{Gyro, GyroState};
pub use linear_measurement::LinearMeasurement;
pub use magnetometer::Magnetometer;
pub use measured_quantity::MeasuredQuantity;
pub use reference::ReferenceNoise;
pub use sampled::{Sampled, SampledState};
pub use sensor_spec::{SensorSpec, Subject};
pub use star_tracker::StarTracker;
pub use sun_cells::{SunCell, SunCells};
pub use sun_sensor::SunSensor;
pub use tachometer::{Tachometer, TachometerState};

kinds! {
    /// The kinds of sensor.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[schemars(rename = "Sensor")]
    pub enum SensorKind: dyn SensorSpec {
        /// The true angle at every instant: guards trip at the exact crossing.
        #[default]
        "continuous" Continuous = ideal::Continuous,
        /// A sample at each period, held until the next: guards are tested at samples.
        "sampled" Sampled(Sampled),
        /// A rate gyro, read in each cycle of the law; the angle, or the attitude, is known exactly.
        "gyro" Gyro(Gyro),
        /// The attitude at the exposures, available after a latency.
        "star_tracker" StarTracker(StarTracker),
        /// The magnetic field.
        "magnetometer" Magnetometer(Magnetometer),
        /// The direction to the Sun.
        "sun_sensor" SunSensor(SunSensor),
        /// The direction to the Sun, from the currents of cells.
        "sun_cells" SunCells(SunCells),
        /// The direction to the planet's centre.
        "earth_sensor" EarthSensor(EarthSensor),
        /// The speeds of the wheels, for their drives; it measures nothing of the body's motion.
        "tachometer" Tachometer(Tachometer),
        /// The specific force at a point of a spacecraft, for the log only.
        "accelerometer" Accelerometer(Accelerometer),
    }
    own "A sensor from another crate; a scenario file cannot name it."
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

/// Returns the random stream of an axis, out of `axes`, of a sensor with index `ordinal` among those of its kind.
fn stream(name: &str, (axis, axes): (usize, usize), ordinal: usize, seed: Seed) -> Stream {
    let name = if ordinal == 0 { name.to_owned() } else { format!("{name} {ordinal}") };
    match axes {
        1 => seed.stream(&name),
        _ => seed.stream(&format!("{name} {}", AXES[axis])),
    }
}
