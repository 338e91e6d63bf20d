//! Sensors of a scenario: the first, those of a kind, and what they measure together.

use flexsc_flight::ticks::Ticks;
use flexsc_numerics::time::Span;

use super::{Accelerometer, SensorKind, Tachometer};
use crate::one_or_many::OneOrMany;

impl OneOrMany<SensorKind> {
    /// Returns the first sensor, the only one in most scenarios.
    pub fn first(&self) -> &SensorKind {
        &self[0]
    }

    /// Returns the number of sensors that measure the body's motion.
    pub fn motion_sensors(&self) -> usize {
        self.iter().filter(|sensor| sensor.measures_motion()).count()
    }

    /// Returns the index of the magnetometer whose field laws read, and the age of its last reading above which the rate of change of
    /// the field is unknown: three of its periods, for a law with the period `cycle`.
    pub fn field_source(&self, cycle: Option<Span>) -> Option<(usize, Ticks)> {
        let index = self.iter().position(|sensor| sensor.measures_field())?;
        let period = self[index].period(cycle)?.ticks();
        Some((index, period.plus(period).plus(period)))
    }

    /// Returns the tachometer and its index among the sensors, if there is one.
    pub fn tachometer(&self) -> Option<(usize, &Tachometer)> {
        self.iter().enumerate().find_map(|(index, sensor)| match sensor {
            SensorKind::Tachometer(tachometer) => Some((index, tachometer)),
            _ => None,
        })
    }

    /// Iterates over the accelerometers, each with its index among the sensors.
    pub fn accelerometers(&self) -> impl Iterator<Item = (usize, &Accelerometer)> {
        self.iter().enumerate().filter_map(|(index, sensor)| match sensor {
            SensorKind::Accelerometer(accelerometer) => Some((index, accelerometer)),
            _ => None,
        })
    }

    /// Returns the number of sensors of the same kind before a sensor.
    pub fn index_in_kind(&self, index: usize) -> usize {
        let kind = self[index].kind();
        self[..index].iter().filter(|sensor| sensor.kind() == kind).count()
    }

    /// Returns true if a sensor provides the attitude: a gyro only without another such sensor, and then exactly.
    pub fn provides_attitude(&self, index: usize) -> bool {
        let rates = |sensor: &SensorKind| sensor.gyro().is_some();
        let of_body = |sensor: &SensorKind| sensor.measures_motion() && !sensor.measures_vector();
        let alone = self.iter().filter(|sensor| of_body(sensor)).all(rates);
        let is_first = !self[..index].iter().any(of_body);
        of_body(&self[index]) && (!rates(&self[index]) || alone && is_first)
    }

    /// Returns the shortest sampling period, under a law with period `law`; `None` if all sensors are continuous.
    pub fn period(&self, law: Option<Span>) -> Option<Span> {
        self.iter().filter_map(|sensor| sensor.period(law)).min()
    }

    /// Returns the standard deviation of a measured rate about an axis (rad/s), if rates are measured.
    pub fn rate_noise(&self, axis: usize) -> Option<f64> {
        self.iter().find_map(|sensor| sensor.rate_noise(axis))
    }

    /// Returns the standard deviation of the measured angle (rad), including quantisation.
    pub fn angle_noise(&self) -> f64 {
        (0..self.len())
            .find(|index| self.provides_attitude(*index))
            .map_or(0.0, |index| self[index].angle_noise())
    }
}
