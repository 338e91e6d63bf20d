//! Sensors of a run: when each samples, and the latest measurements about each axis.

use flexsc_control::custom::PartError;
use flexsc_control::part::{Part, ReportContext};
use flexsc_control::sensor::{Orientation, Reading, SensorKind, Truth};
use flexsc_flight::b_dot::FieldRate;
use flexsc_flight::ticks::Ticks;
use flexsc_flight::vector3::Vector3;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::flight_types::{from_vector3, to_vector3};
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::{Instant, Span, earlier};
use flexsc_record::{Record, Report};
use flexsc_spacecraft::environment::to_body;

use super::SimulationError;
use super::blinding::{Blinding, BlindingState};
use super::exposures::Exposures;
use super::loads::Loads;
use super::plant::Plant;
use super::sensor_schedule::SensorSchedule;
use flexsc_scenario::Scenario;

/// Run-time state of the sensors.
#[derive(Clone, Debug)]
pub struct Sensors {
    schedules: Vec<SensorSchedule>,
    /// New reading of each sensor; `None` if it was not due or gives no measurement.
    pub new_readings: Vec<Option<Reading>>,
    /// Latest measurements of all sensors together: the last orientation, and the last rates.
    pub reading: Option<Reading>,
    /// Latest measured angle (rad) and rate (rad/s) about each axis.
    pub measured: Vec<[f64; 2]>,
    /// Last measured attitude and the origin of its angles, with these angles (rad).
    last_angles: Option<(Orientation, Orientation, [f64; 3])>,
    /// Last measured magnetic field with its rate of change.
    field: FieldRate,
    /// Rate of change of the measured magnetic field in body axes (T/s); `None` before the second sample.
    pub field_rate: Option<Vector>,
    /// Next sampling instant of all sensors; `None` with a continuous sensor.
    next: Option<Instant>,
    exposures: Exposures,
    /// Instant of the last reading of each sensor, or at which it came into use.
    last_readings: Vec<Instant>,
    /// True for sensors that are in use.
    in_use: Vec<bool>,
    blinding: Blinding,
    /// True if the sample that was read ahead for the current instant has a measurement; `None` if none was read ahead.
    sample_read_ahead: Option<bool>,
}

impl Sensors {
    /// Creates the sensors of a scenario, before its start.
    pub fn new(scenario: &Scenario, seed: Seed) -> Self {
        let (study, axes) = (&scenario.study, scenario.study.axes.len());
        let all = &scenario.sensor;
        let rates = all.iter().any(|sensor| sensor.rate_noise(0).is_some());
        let field_source = all.field_source(study.law_period);
        let due = |(index, sensor): (usize, &SensorKind)| {
            let period = if all.motion_sensors() == 1 && sensor.measures_motion() {
                study.sample_period
            } else {
                sensor.period(study.law_period)
            };
            SensorSchedule {
                sensor: sensor.start(axes, seed, all.index_in_kind(index)),
                provides_attitude: all.provides_attitude(index),
                period,
                next: period.map(|period| Instant::START + period),
                last: None,
                is_field_source: field_source.is_some_and(|(source, _)| source == index),
                derives_rates: all.provides_attitude(index) && !rates,
            }
        };
        let sensors: Vec<SensorSchedule> = all.iter().enumerate().map(due).collect();
        Self {
            new_readings: vec![None; sensors.len()],
            reading: None,
            measured: vec![[0.0; 2]; axes],
            last_angles: None,
            field: FieldRate::new(field_source.map_or(Ticks::default(), |(_, most_age)| most_age)),
            field_rate: None,
            next: sensors.iter().filter_map(|due| due.next).min(),
            schedules: sensors,
            exposures: Exposures::new(scenario),
            last_readings: vec![Instant::START; all.len()],
            in_use: scenario.sensors_in_use(0),
            blinding: Blinding::new(scenario),
            sample_read_ahead: None,
        }
    }

    /// Returns true if the sensor measures at every instant and not at samples.
    #[inline]
    pub fn is_continuous(&self) -> bool {
        self.next.is_none()
    }

    /// Returns the next instant at which a sensor samples, or an exposure opens or closes.
    #[inline]
    pub fn next_event(&self) -> Option<Instant> {
        earlier(self.next, self.exposures.due())
    }

    /// Returns true if a sensor in use gave a reading at `now`.
    #[inline]
    pub fn has_sampled(&self, now: Instant) -> bool {
        self.last_readings.contains(&now)
    }

    /// Returns true if a sample is due at `now`, or was read ahead for it.
    #[inline]
    pub fn sample_is_due(&self, now: Instant) -> bool {
        self.next == Some(now) || self.sample_read_ahead.is_some()
    }

    /// Finds the star trackers that are blinded at the start, at which the plant is evaluated.
    pub fn begin_blinding(&mut self, plant: &Plant) {
        self.blinding.begin(plant);
        for (index, due) in self.schedules.iter_mut().enumerate() {
            due.sensor.set_blinded(self.blinding.is_blinded(index));
        }
    }

    /// Returns the first instant of an interval, which begins at the current instant, at which a bright body begins or
    /// ceases to blind a star tracker.
    #[inline]
    pub fn next_blinding(&mut self, span: [Instant; 2], plant: &Plant, loads: &Loads) -> Option<Instant> {
        if self.blinding.is_empty() {
            return None;
        }
        self.blinding.first_crossing(span, plant, loads.torque_bound())
    }

    /// Sets whether a star tracker is blinded, if that changes at `now`.
    #[inline]
    pub fn update_blinding(&mut self, now: Instant) {
        if let Some(index) = self.blinding.update(now) {
            self.schedules[index].sensor.set_blinded(self.blinding.is_blinded(index));
        }
    }

    /// Returns true if no star tracker has an exclusion angle.
    #[inline]
    pub fn has_no_exclusion(&self) -> bool {
        self.blinding.is_empty()
    }

    /// Iterates over the exclusion angles of the star trackers, with their states.
    pub fn blinding_states(&self) -> impl Iterator<Item = BlindingState> {
        self.blinding.states()
    }

    /// Copies the plant before it advances from `now`, if an exposure is open.
    #[inline]
    pub fn copy_plant(&mut self, now: Instant, plant: &Plant) {
        self.exposures.copy_plant(now, plant);
    }

    /// Closes and opens the exposures that are due at `now`.
    pub fn update_exposures(
        &mut self,
        now: Instant,
        plant: &Plant,
        record: &mut dyn Record,
    ) -> Result<(), SimulationError> {
        self.exposures.update(now, plant, &mut self.schedules, record)
    }

    /// Ends the motion segment of open exposures at `now`, before the body begins its next segment.
    pub fn end_segment(
        &mut self,
        now: Instant,
        plant: &Plant,
        record: &mut dyn Record,
    ) -> Result<(), SimulationError> {
        self.exposures.end_segment(now, plant, record)
    }

    /// Reads the sample at `now` before the estimator uses it; returns true if anything was measured.
    pub fn read_ahead(&mut self, now: Instant, plant: &Plant, origin: &Orientation) -> bool {
        let measured = self.read(now, plant, origin);
        self.sample_read_ahead = Some(measured);
        measured
    }

    /// Takes the sample of `now`, which may have been read ahead; returns true if anything was measured.
    #[inline]
    pub fn sample(&mut self, now: Instant, plant: &Plant, origin: &Orientation) -> bool {
        self.sample_read_ahead.take().unwrap_or_else(|| self.read(now, plant, origin))
    }

    /// Reads the sensors that are due at `now`, with angles counted from `origin`; returns true if anything was
    /// measured. The plant has to be evaluated at `now`.
    fn read(&mut self, now: Instant, plant: &Plant, origin: &Orientation) -> bool {
        let mut any = false;
        for (index, due) in self.schedules.iter_mut().enumerate() {
            if self.new_readings[index].is_some() {
                due.last = self.new_readings[index].take();
            }
            if now > Instant::START && due.next.is_some_and(|next| next != now) {
                continue;
            }
            let truth = plant.truth_at_sensor(index);
            // The state of a sensor that is not in use goes on, such as the bias of a gyro.
            let fresh = due.sensor.read(now, &truth, due.last.as_ref());
            if let Some(period) = due.period.filter(|_| now > Instant::START) {
                due.next = Some(due.sensor.next_due(now, period));
            }
            let Some(reading) = fresh.as_ref().filter(|_| self.in_use[index]) else { continue };
            any = true;
            self.last_readings[index] = now;
            if let Some(sight) = reading.sight.filter(|_| due.is_field_source) {
                self.field.take(now.ticks(), &to_vector3(&sight.vector));
                self.field_rate = self.field.has_rate.then(|| from_vector3(&self.field.rate));
            }
            let rates = reading.rate.or_else(|| due.differentiated_rates(now, reading, &truth));
            if due.provides_attitude {
                let angles = reading.at.error_from(origin);
                if self.measured.len() > 1 {
                    self.last_angles = Some((reading.at, *origin, angles));
                }
                self.measured.iter_mut().zip(angles).for_each(|(measured, angle)| measured[0] = angle);
            }
            if let Some(rates) = rates {
                self.measured.iter_mut().zip(rates).for_each(|(measured, rate)| measured[1] = rate);
            }
            let all = self.reading.get_or_insert(Reading { sight: None, ..*reading });
            if due.provides_attitude {
                all.at = reading.at;
            }
            all.rate = reading.rate.or(all.rate);
            // At the end: a copy of the reading sooner would wait for its parts to be stored.
            self.new_readings[index] = fresh;
        }
        self.next = self.schedules.iter().filter_map(|due| due.next).min();
        any
    }

    /// Returns the angles of an orientation from an origin (rad), which a perfect sensor may have measured before.
    pub fn angles_of(&self, orientation: &Orientation, origin: &Orientation) -> [f64; 3] {
        match &self.last_angles {
            Some((last, from, angles)) if last == orientation && from == origin => *angles,
            _ => orientation.error_from(origin),
        }
    }

    /// Puts the sensors of a mode into use that begins at `now`.
    pub fn set_in_use(&mut self, now: Instant, in_use: &[bool]) {
        for ((last, was), is) in self.last_readings.iter_mut().zip(&mut self.in_use).zip(in_use) {
            if *is && !*was {
                *last = now;
            }
            *was = *is;
        }
    }

    /// Returns the time since the last reading of a sensor, or since it came into use.
    pub fn silence(&self, now: Instant, sensor: usize) -> Span {
        now.since(self.last_readings[sensor])
    }

    /// Returns the last reading of a sensor and the instant at which it became available; a continuous sensor is read at
    /// `now`, at which the plant has to be evaluated.
    pub fn latest(&self, index: usize, now: Instant, plant: &Plant) -> Option<(Instant, Reading)> {
        let due = self.schedules.get(index)?;
        if due.period.is_none() {
            let reading = due.sensor.copy().read(now, &plant.truth_at_sensor(index), None)?;
            return Some((now, reading));
        }
        let reading = self.new_readings[index].or(due.last)?;
        Some((self.last_readings[index], reading))
    }

    /// Returns the rate of change of the measured field after its last reading (T/s); `None` before the first.
    pub fn last_field_rate(&self) -> Option<Vector3> {
        self.field.has_field.then_some(self.field.rate)
    }

    /// Returns true if the rate of change of the measured field is unknown, because the last reading is too old.
    #[inline]
    pub fn field_is_stale(&self, now: Instant) -> bool {
        self.field.has_field && self.field.is_stale(now.ticks())
    }

    /// Returns the last measured magnetic field in body axes (T).
    #[inline]
    pub fn measured_field(&self) -> Option<Vector> {
        self.field.has_field.then(|| from_vector3(&self.field.field))
    }

    /// Returns the current true bias of the first gyro (rad/s); 0 without a gyro.
    pub fn gyro_bias(&self) -> [f64; 3] {
        self.schedules.iter().find_map(|due| due.sensor.true_bias()).unwrap_or_default()
    }

    /// Returns the magnetic field in body axes for the actuator (T): the last measured one, or the true one if no sensor
    /// measures it; `None` without a field.
    #[inline]
    pub fn magnetic_field(&self, truth: &Truth) -> Option<Vector> {
        self.measured_field()
            .or_else(|| Some(to_body(&truth.orientation.attitude()?, &truth.environment.field?)))
    }
}

impl Part for Sensors {
    fn due(&self) -> Option<Instant> {
        self.next
    }

    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        self.schedules.iter().for_each(|due| due.sensor.report(at, report));
    }

    fn failure(&self) -> Option<PartError> {
        self.schedules.iter().find_map(|due| due.sensor.failure())
    }
}
