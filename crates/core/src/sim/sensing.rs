//! The sensors of a run: when each is due, and what their readings come to about each axis.

use super::Simulation;
use super::plant::Plant;
use crate::attitude::Vector;
use crate::environment::into;
use crate::own::Halt;
use crate::random::Seed;
use crate::scenario::Scenario;
use crate::sensor::{Exposure, Orientation, Reading, Sense, Sensor, Truth};
use crate::time::{Instant, Span};

/// The sensors at work.
#[derive(Clone, Debug)]
pub struct Sensing {
    sensors: Vec<Due>,
    /// What was read at the last samples, of each sensor; nothing of one that was not due, or silent.
    pub fresh: Vec<Option<Reading>>,
    /// What all readings so far come to: the last orientation, and the last rates.
    pub reading: Option<Reading>,
    /// The same about each axis: angle (rad) and rate (rad/s).
    pub measured: Vec<[f64; 2]>,
    /// The magnetic field in the body's axes as it was measured last (T), when, and how fast it changed (T/s).
    pub field: Option<(Instant, Vector)>,
    /// See `field`.
    pub field_rate: Option<Vector>,
    /// When the next is due; none of a continuous sensor.
    pub next: Option<Instant>,
}

/// A sensor, and when it is due.
#[derive(Clone, Debug)]
struct Due {
    sensor: Box<dyn Sense>,
    /// Whether it tells where the body points, or the rates alone.
    orients: bool,
    period: Option<Span>,
    next: Option<Instant>,
    /// What it read before what is fresh.
    last: Option<Reading>,
    /// Whether it is the magnetometer whose field counts.
    feels: bool,
    /// Whether rates are the differences of its angles.
    differs: bool,
}

impl Sensing {
    /// The sensors of a scenario, before its start.
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

    /// Reads what is due now, of a body that was viewed now, with angles beyond an origin; tells whether anything was measured.
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

    /// A sensor takes what it gathered over the exposure that ends now.
    pub fn gather(&mut self, sensor: usize, exposure: &Exposure) {
        self.sensors[sensor].sensor.gather(exposure);
    }

    /// Why a sensor from outside cannot go on.
    pub fn halted(&self) -> Option<Halt> {
        self.sensors.iter().find_map(|due| due.sensor.halted())
    }

    /// The true bias of the first gyro now (rad/s).
    pub fn bias(&self) -> [f64; 3] {
        self.sensors.iter().find_map(|due| due.sensor.bias()).unwrap_or_default()
    }
}

impl Simulation {
    /// Lets the actuator have the magnetic field as it was measured last, or as it is where nothing measures it.
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
    /// Rates of a sensor of angles alone: their differences over the period, and at first the true ones.
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
