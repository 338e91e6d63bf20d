//! Sensors of a run: when each samples, and the latest measurements about each axis.

use super::Simulation;
use super::plant::Plant;
use crate::attitude::Vector;
use crate::environment::into;
use crate::own::Halt;
use crate::random::Seed;
use crate::scenario::Scenario;
use crate::sensor::{Exposure, Orientation, Reading, Sense, Sensor, Truth};
use crate::time::{Instant, Span};

/// Run-time state of the sensors.
#[derive(Clone, Debug)]
pub struct Sensing {
    sensors: Vec<Due>,
    /// New reading of each sensor; `None` if it was not due or gives no measurement.
    pub fresh: Vec<Option<Reading>>,
    /// Latest measurements of all sensors together: the last orientation, and the last rates.
    pub reading: Option<Reading>,
    /// Latest measured angle (rad) and rate (rad/s) about each axis.
    pub measured: Vec<[f64; 2]>,
    /// Instant and value of the last measured magnetic field in body axes (T); `field_rate` is its rate of change
    /// (T/s).
    pub field: Option<(Instant, Vector)>,
    /// Rate of change of `field` (T/s); `None` before the second sample.
    pub field_rate: Option<Vector>,
    /// Next sampling instant of all sensors; `None` with a continuous sensor.
    pub next: Option<Instant>,
}

/// Sensor with its sampling schedule.
#[derive(Clone, Debug)]
struct Due {
    sensor: Box<dyn Sense>,
    /// True if the sensor measures the attitude or angle, not only rates.
    orients: bool,
    period: Option<Span>,
    next: Option<Instant>,
    /// Reading before the newest one.
    last: Option<Reading>,
    /// True for the magnetometer that provides the field.
    feels: bool,
    /// True if rates are derived from differences of the sensor's angles.
    differs: bool,
}

impl Sensing {
    /// Creates the sensors of a scenario, before its start.
    pub fn new(scenario: &Scenario, seed: Seed) -> Self {
        let (study, axes) = (&scenario.study, scenario.study.axes.len());
        let all = &scenario.sensor;
        let rates = all.iter().any(|sensor| sensor.rate_noise(0).is_some());
        let feels = all.iter().position(Sensor::measures_field);
        let due = |(index, sensor): (usize, &Sensor)| {
            let period = if all.of_body() == 1 && sensor.sees_body() {
                study.sampling
            } else {
                sensor.period(study.cycle)
            };
            Due {
                sensor: sensor.start(axes, seed, all.ordinal(index)),
                orients: all.orients(index),
                period,
                next: period.map(|period| Instant::START + period),
                last: None,
                feels: feels == Some(index),
                differs: all.orients(index) && !rates,
            }
        };
        let sensors: Vec<Due> = all.iter().enumerate().map(due).collect();
        Self {
            fresh: vec![None; sensors.len()],
            reading: None,
            measured: vec![[0.0; 2]; axes],
            field: None,
            field_rate: None,
            next: sensors.iter().filter_map(|due| due.next).min(),
            sensors,
        }
    }

    /// Reads the sensors that are due at `now`, with angles counted from `origin`; returns true if anything was
    /// measured. The plant has to be evaluated at `now`.
    pub fn read(&mut self, now: Instant, plant: &Plant, origin: &Orientation) -> bool {
        let mut any = false;
        for (index, due) in self.sensors.iter_mut().enumerate() {
            let fresh = &mut self.fresh[index];
            if fresh.is_some() {
                due.last = fresh.take();
            }
            if now > Instant::START && due.next.is_some_and(|next| next != now) {
                continue;
            }
            let truth = plant.at_sensor(index);
            *fresh = due.sensor.read(now, &truth, due.last.as_ref());
            if let Some(period) = due.period.filter(|_| now > Instant::START) {
                due.next = Some(due.sensor.after(now, period));
            }
            let Some(reading) = fresh else { continue };
            any = true;
            if let Some(sight) = reading.sight.filter(|_| due.feels) {
                let before = self.field.replace((now, sight.vector)).filter(|(then, _)| *then < now);
                self.field_rate =
                    before.map(|(then, field)| (sight.vector - field) / now.since(then).seconds());
            }
            let rates = reading.rate.or_else(|| due.differences(now, reading, &truth));
            if due.orients {
                let angles = reading.at.beyond(origin);
                self.measured.iter_mut().zip(angles).for_each(|(measured, angle)| measured[0] = angle);
            }
            if let Some(rates) = rates {
                self.measured.iter_mut().zip(rates).for_each(|(measured, rate)| measured[1] = rate);
            }
            let all = self.reading.get_or_insert(Reading { sight: None, ..*reading });
            if due.orients {
                all.at = reading.at;
            }
            all.rate = reading.rate.or(all.rate);
        }
        self.next = self.sensors.iter().filter_map(|due| due.next).min();
        any
    }

    /// Hands the mean of the exposure that ends now to a sensor.
    pub fn gather(&mut self, sensor: usize, exposure: &Exposure) {
        self.sensors[sensor].sensor.gather(exposure);
    }

    /// Returns the error of a custom sensor that cannot go on.
    pub fn halted(&self) -> Option<Halt> {
        self.sensors.iter().find_map(|due| due.sensor.halted())
    }

    /// Returns the current true bias of the first gyro (rad/s); 0 without a gyro.
    pub fn bias(&self) -> [f64; 3] {
        self.sensors.iter().find_map(|due| due.sensor.bias()).unwrap_or_default()
    }
}

impl Simulation {
    /// Sets the magnetic field in the actuator: the last measured one, or the true one if no sensor measures it.
    pub(super) fn feel(&mut self) {
        let truth = self.plant.viewed();
        let measured = self.sensing.field.map(|(_, field)| field);
        let here = || match (truth.orientation, truth.sky.field) {
            (Orientation::Attitude(attitude), Some(field)) => Some(into(&attitude, &field)),
            _ => None,
        };
        if let Some(field) = measured.or_else(here) {
            self.drive.actuator.feel(field);
        }
    }
}

impl Due {
    /// Returns the rates (rad/s) of a sensor that measures angles only: differences over the period, and the true rates
    /// at first.
    fn differences(&self, now: Instant, reading: &Reading, truth: &Truth) -> Option<[f64; 3]> {
        if !self.differs {
            return None;
        }
        let (Some(period), true) = (self.period, now > Instant::START) else { return Some(truth.rate) };
        let nowhere = match reading.at {
            Orientation::Angle(_) => Orientation::Angle(0.0),
            attitude @ Orientation::Attitude(_) => attitude,
        };
        let last = self.last.map_or(nowhere, |last| last.at);
        Some(reading.at.beyond(&last).map(|difference| difference / period.seconds()))
    }
}
