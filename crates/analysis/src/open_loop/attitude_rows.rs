//! Attitude filter in a loop of several rates: each quantity as rows over the states at the start of a period and the
//! commands since.

use std::collections::BTreeSet;

use nalgebra::DMatrix;

use super::repeated_instants::repeated;
use crate::linear_attitude_filter::{LinearAttitudeFilter, MountedSensor};

/// Femtoseconds in a second: times are whole numbers of femtoseconds, as in a run.
pub const TICKS: f64 = 1e15;

/// Returns a time in femtoseconds.
pub fn ticks(seconds: f64) -> i64 {
    libm::round(seconds * TICKS) as i64
}

/// Returns a time in seconds.
pub fn seconds(ticks: i64) -> f64 {
    ticks as f64 / TICKS
}

/// Sensor with its times (fs), and the angle and rate of its mount as rows over the states of the body.
struct SensorRows {
    period: i64,
    latency: i64,
    /// Half the time over which a sample is the mean.
    half: i64,
    /// First of the three states of the body that are integrals of the mount's angle since an exposure began.
    integral: usize,
    integrates: bool,
    angle: DMatrix<f64>,
    rate: DMatrix<f64>,
}

impl SensorRows {
    fn new(sensor: &MountedSensor, order: usize) -> Self {
        let (mut angle, mut rate) = (DMatrix::zeros(3, order), DMatrix::zeros(3, order));
        for axis in 0..3 {
            (angle[(axis, axis)], rate[(axis, 3 + axis)]) = (1.0, 1.0);
            for (mode, turned) in sensor.turned.iter().enumerate() {
                (angle[(axis, 6 + 2 * mode)], rate[(axis, 7 + 2 * mode)]) = (turned[axis], turned[axis]);
            }
        }
        let [period, latency, half] = [sensor.period, sensor.latency, 0.5 * sensor.exposure].map(ticks);
        let integral = first_integral(sensor);
        Self { period, latency, half, integral, integrates: sensor.integrates, angle, rate }
    }
}

/// Returns the number of states of a body with this many modes.
fn first_integral(sensor: &MountedSensor) -> usize {
    6 + 2 * sensor.turned.len()
}

/// Returns how the integrals of the angle of a sensor's mount over its exposures change, as three rows over the states of the
/// body; none for a sensor that measures instants.
pub fn exposure_rates(filter: &LinearAttitudeFilter) -> Option<DMatrix<f64>> {
    let sensor = &filter.sensor;
    (sensor.exposure > 0.0).then(|| SensorRows::new(sensor, first_integral(sensor)).angle)
}

/// Exposure of the attitude sensor that may still correct the filter.
struct Exposure {
    /// Time of the exposure (fs).
    time: i64,
    /// Measured less expected angle.
    innovation: DMatrix<f64>,
}

/// Errors of the sensors at an instant, as rows; none for sensors without errors.
#[derive(Default)]
pub struct SensorErrors {
    /// Error of the rate that the gyro reads, less its bias at the reading.
    pub rate: Option<DMatrix<f64>>,
    /// Change of the gyro's bias since the last reading.
    pub walk: Option<DMatrix<f64>>,
    /// Error of the attitude that the other sensor measures.
    pub attitude: Option<DMatrix<f64>>,
}

/// State of the filter as rows.
///
/// With errors of the sensors, the bias is the estimate less the true bias, which would grow without limit.
pub struct AttitudeRows {
    gyro: SensorRows,
    sensor: SensorRows,
    /// Gain of the angle, and of the bias.
    gain: [DMatrix<f64>; 2],
    angle: DMatrix<f64>,
    bias: DMatrix<f64>,
    /// Rate that the gyro read last, and the angle of its mount then.
    rate: DMatrix<f64>,
    mount: DMatrix<f64>,
    /// Rates that the gyro has read and that are not yet available, the newest first.
    late: Vec<DMatrix<f64>>,
    /// Exposures, the newest first.
    exposures: Vec<Exposure>,
}

impl AttitudeRows {
    /// Creates the filter for a body of this order, without a state yet.
    pub fn new(filter: &LinearAttitudeFilter, order: usize) -> Self {
        let (gyro, sensor) = (SensorRows::new(&filter.gyro, order), SensorRows::new(&filter.sensor, order));
        let gain = |first: usize| DMatrix::from_fn(3, 3, |row, column| filter.gain[first + row][column]);
        let gain = [gain(0), gain(3)];
        let count = (sensor.latency + gyro.latency + gyro.period) / sensor.period + 2;
        let none = DMatrix::zeros(3, 0);
        let exposure = |k: i64| Exposure { time: -(k + 1) * sensor.period, innovation: none.clone() };
        Self {
            exposures: (0..count).map(exposure).collect(),
            late: vec![none.clone(); usize::try_from(gyro.latency / gyro.period).unwrap_or(0)],
            gyro,
            sensor,
            gain,
            angle: none.clone(),
            bias: none.clone(),
            rate: none.clone(),
            mount: none,
        }
    }

    /// Returns the periods of gyro and attitude sensor (fs).
    pub fn periods(&self) -> [i64; 2] {
        [self.gyro.period, self.sensor.period]
    }

    /// Returns the patterns of the names of the states, and their units: `{}` stands for the axis.
    pub fn state_patterns(&self) -> Vec<(String, &'static str)> {
        let fixed = [
            ("expected_{}", "rad"),
            ("expected_{}_bias", "rad/s"),
            ("gyro_{}", "rad/s"),
            ("gyro_{}_angle", "rad"),
        ];
        let late = (0..self.late.len()).map(|k| (format!("gyro{k}_{{}}"), "rad/s"));
        let exposures = (0..self.exposures.len()).map(|k| (format!("exposure{k}_{{}}"), "rad"));
        let fixed = fixed.into_iter().map(|(name, unit)| (name.to_owned(), unit));
        fixed.chain(late).chain(exposures).collect()
    }

    /// Starts from these rows, three for each pattern of a state.
    pub fn start(&mut self, rows: &DMatrix<f64>) {
        let three = |index: usize| rows.rows(3 * index, 3).into_owned();
        (self.angle, self.bias, self.rate, self.mount) = (three(0), three(1), three(2), three(3));
        let innovations = self.exposures.iter_mut().map(|exposure| &mut exposure.innovation);
        for (k, rows) in self.late.iter_mut().chain(innovations).enumerate() {
            *rows = three(4 + k);
        }
    }

    /// Returns the rows of the state.
    pub fn rows(&self) -> Vec<&DMatrix<f64>> {
        let exposures = self.exposures.iter().map(|exposure| &exposure.innovation);
        [&self.angle, &self.bias, &self.rate, &self.mount]
            .into_iter()
            .chain(&self.late)
            .chain(exposures)
            .collect()
    }

    /// Returns the times (fs) at which the filter acts, up to the end of a period that begins at 0.
    pub fn events(&self, whole: i64) -> BTreeSet<i64> {
        let first = self.exposures.last().map_or(0, |oldest| oldest.time);
        let half = self.sensor.half;
        // An exposure about the end of the period begins before it.
        let exposures = || repeated(first, self.sensor.period, whole + half + 1);
        repeated(0, self.gyro.period, whole)
            .chain(exposures().flat_map(|time| [time - half, time, time + half, self.use_time(time)]))
            .collect()
    }

    /// Does what is due at a time (fs), at which the states of the body are the rows `x`.
    pub fn act(&mut self, now: i64, x: &mut DMatrix<f64>, errors: &SensorErrors) {
        let reads = now % self.gyro.period == 0;
        if reads {
            self.read(now, x, errors);
        }
        if now % self.sensor.period == 0 {
            let of_instant = f64::from(u8::from(self.sensor.half == 0));
            let mut shown = &self.sensor.angle * &*x * of_instant;
            if let Some(error) = &errors.attitude {
                shown += error;
            }
            let innovation = if reads && self.gyro.latency == 0 { shown - &self.angle } else { shown };
            self.exposures.pop();
            self.exposures.insert(0, Exposure { time: now, innovation });
        }
        self.close_and_open(now, x);
        let latency = self.sensor.latency;
        self.correct(now, |exposure| exposure + latency == now);
    }

    /// Ends the exposure that ends at a time (fs), and begins the one that begins then.
    fn close_and_open(&mut self, now: i64, x: &mut DMatrix<f64>) {
        let SensorRows { period, half, integral, .. } = self.sensor;
        if half == 0 {
            return;
        }
        if let Some(closed) = self.exposures.iter_mut().find(|exposure| exposure.time + half == now) {
            closed.innovation += x.rows(integral, 3) / seconds(2 * half);
        }
        if (now + half) % period == 0 {
            x.rows_mut(integral, 3).fill(0.0);
        }
    }

    /// Returns the angle and the rate that a law reads at a time (fs).
    pub fn estimates(&self, now: i64) -> [DMatrix<f64>; 2] {
        let rate = &self.rate - &self.bias;
        [&self.angle + &rate * seconds(now % self.gyro.period + self.gyro.latency), rate]
    }

    /// Returns the time at which the gyro reading is available up to which the filter needs its prediction at an exposure.
    fn covering_reading(&self, exposure: i64) -> i64 {
        -(-exposure).div_euclid(self.gyro.period) * self.gyro.period + self.gyro.latency
    }

    /// Returns the time at which an exposure corrects the filter.
    fn use_time(&self, exposure: i64) -> i64 {
        (exposure + self.sensor.latency).max(self.covering_reading(exposure))
    }

    /// Reads the gyro and propagates the angle over its last period.
    fn read(&mut self, now: i64, x: &DMatrix<f64>, errors: &SensorErrors) {
        let period = seconds(self.gyro.period);
        let measured = if self.gyro.integrates {
            let mount = &self.gyro.angle * x;
            (&mount - std::mem::replace(&mut self.mount, mount.clone())) / period
        } else {
            &self.gyro.rate * x
        };
        // What the gyro measures now is available after its latency; its errors, which are alike at all times, count from then on.
        self.late.insert(0, measured);
        self.rate = self.late.pop().unwrap_or_default();
        let covered = now - self.gyro.latency;
        if let Some(error) = &errors.rate {
            self.rate += error;
        }
        if let Some(walk) = &errors.walk {
            self.bias -= walk;
        }
        let turning = &self.rate - &self.bias;
        for slot in 0..self.exposures.len() {
            let time = self.exposures[slot].time;
            if time < now && now == self.covering_reading(time) {
                let since = seconds(time - covered) + period;
                self.exposures[slot].innovation -= &self.angle + &turning * since;
            }
        }
        self.angle += turning * period;
        // Exposures that were reported before this reading waited for it.
        let latency = self.sensor.latency;
        self.correct(now, |exposure| exposure + latency < now);
    }

    /// Corrects the state by the exposures that are due and that `includes`, the oldest first.
    fn correct(&mut self, now: i64, includes: impl Fn(i64) -> bool) {
        let last = now.div_euclid(self.gyro.period) * self.gyro.period - self.gyro.latency;
        for slot in (0..self.exposures.len()).rev() {
            let time = self.exposures[slot].time;
            if !includes(time) || self.use_time(time) != now {
                continue;
            }
            let [angle, bias] = [0, 1].map(|part| &self.gain[part] * &self.exposures[slot].innovation);
            self.angle += &angle - &bias * seconds(last - time);
            self.bias += &bias;
            for other in 0..slot {
                let later = self.exposures[other].time;
                if self.covering_reading(later) <= now {
                    self.exposures[other].innovation -= &angle - &bias * seconds(later - time);
                }
            }
        }
    }
}
