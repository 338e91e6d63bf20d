//! Sources of noise in a loop: each key of a scenario that draws random numbers, or rounds.
//!
//! A quantum D is taken as white noise of the variance D²/12, independent from sample to sample. That holds where the
//! signal moves over several quanta between samples; it does not describe a limit cycle within a quantum.

use flexsc_control::actuator::{ActuatorKind, ActuatorTask};
use flexsc_control::estimator::attitude::SensorRole;
use flexsc_control::sensor::{Gyro, Sampled, SensorKind, StarTracker};
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Positive;
use flexsc_spacecraft::axes::Axis;
use nalgebra::DMatrix;

use crate::analysis::open_loop::LoopParts;
use crate::analysis::open_loop::attitude_rows::{seconds, ticks};
use crate::scenario::Scenario;

/// Point at which the draws of a source enter the loop. Matrices have a row for each axis and a column for each draw of
/// an instant, in standard deviations.
#[derive(Clone, Debug, PartialEq)]
pub enum NoiseEntry {
    /// Measured angle, or attitude.
    Angle(DMatrix<f64>),
    /// Measured rate.
    Rate(DMatrix<f64>),
    /// Bias of the gyro that walks: its change from reading to reading, and white noise of the reading.
    Walk { change: DMatrix<f64>, white: DMatrix<f64> },
    /// Remainder of a rounded angle of the gyro, which its next reading adds.
    Remainder(DMatrix<f64>),
    /// Exponentially correlated part of the gyro's bias, with its decay between readings.
    Wander { decay: f64, change: DMatrix<f64>, own_share: f64, white: DMatrix<f64> },
    /// Command of the law.
    Command(DMatrix<f64>),
    /// Torque about an axis, held from draw to draw.
    Torque { axis: usize, deviation: f64 },
}

/// Source of noise.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseSource {
    /// Key of the scenario.
    pub key: String,
    /// Point of entry.
    pub entry: NoiseEntry,
    /// Time from draw to draw (fs), and the time of the first.
    pub period: i64,
    pub phase: i64,
}

impl NoiseEntry {
    /// Returns the number of draws at an instant.
    pub fn draws(&self) -> usize {
        match self {
            Self::Angle(matrix) | Self::Rate(matrix) | Self::Remainder(matrix) | Self::Command(matrix) => {
                matrix.ncols()
            }
            Self::Walk { change, .. } | Self::Wander { change, .. } => change.ncols(),
            Self::Torque { .. } => 1,
        }
    }

    /// Returns the number of states that remember earlier draws.
    pub fn memory(&self) -> usize {
        match self {
            Self::Remainder(matrix) => matrix.nrows(),
            Self::Wander { change, .. } => change.nrows(),
            Self::Torque { .. } => 1,
            Self::Angle(_) | Self::Rate(_) | Self::Walk { .. } | Self::Command(_) => 0,
        }
    }
}

/// Returns the diagonal matrix of deviations about each axis; `None` if all are 0.
fn diagonal(axes: usize, deviation: impl Fn(usize) -> f64) -> Option<DMatrix<f64>> {
    let matrix = DMatrix::from_fn(axes, axes, |row, column| if row == column { deviation(row) } else { 0.0 });
    (matrix.amax() > 0.0).then_some(matrix)
}

/// Standard deviation of a rounding to a quantum.
fn rounding(quantum: f64) -> f64 {
    quantum / libm::sqrt(12.0)
}

/// Returns the sources of noise of a scenario's loop.
///
/// # Errors
/// A sensor whose noise has no linear model in this loop: its key, and the reason.
pub fn sources(parts: &LoopParts<'_>) -> Result<Vec<NoiseSource>, ConfigError> {
    let scenario = parts.scenario;
    let mut list = SourceList { axes: parts.body.inputs.len(), found: Vec::new() };
    if parts.parts.attitude.is_some() {
        list.add_fused_sensors(scenario)?;
    } else {
        list.add_only_sensor(scenario, parts.law.period.leading_femtoseconds())?;
    }
    list.add_quanta_of_wheels(scenario, parts.law.period.leading_femtoseconds());
    list.add_disturbances(scenario);
    Ok(list.found)
}

/// Sources found so far.
struct SourceList {
    axes: usize,
    found: Vec<NoiseSource>,
}

impl SourceList {
    fn add(&mut self, key: String, period: i64, entry: Option<NoiseEntry>) {
        self.found.extend(entry.map(|entry| NoiseSource { key, entry, period, phase: 0 }));
    }

    /// Adds the only sensor of a loop with one period.
    fn add_only_sensor(&mut self, scenario: &Scenario, period: i64) -> Result<(), ConfigError> {
        let key = scenario.sensor_key(0);
        match scenario.sensor.first() {
            SensorKind::Sampled(sampled) => self.add_sampled(&key, sampled, period),
            SensorKind::Gyro(gyro) => {
                let refused = |within: &str, why: &str| Err(ConfigError::new(format!("{key}.{within}"), why));
                if gyro.integrates() {
                    let why = "is that of a gyro that integrates the rate: its noise has a linear model only with an \
                               attitude filter";
                    return refused("period", why);
                }
                if gyro.period.is_some_and(|own| own.leading_femtoseconds() != period) {
                    return refused(
                        "period",
                        "is not that of the law: the noise of a linear loop has one period",
                    );
                }
                self.add_gyro(&key, gyro, period);
            }
            _ => {}
        }
        Ok(())
    }

    /// Adds the sensors that an attitude filter reads.
    fn add_fused_sensors(&mut self, scenario: &Scenario) -> Result<(), ConfigError> {
        let Some(setting) = &scenario.study.attitude else { return Ok(()) };
        for (index, role) in setting.roles.iter().enumerate() {
            let (key, sensor) = (scenario.sensor_key(index), &scenario.sensor[index]);
            let own = sensor.period(scenario.study.law_period).or(scenario.study.sample_period);
            let period = own.map_or(0, |own| ticks(own.seconds()));
            match (role, sensor) {
                (SensorRole::None, _) => {}
                (SensorRole::Gyro { .. }, SensorKind::Gyro(gyro)) => self.add_gyro(&key, gyro, period),
                (SensorRole::Corrects { .. }, SensorKind::StarTracker(tracker)) => {
                    self.add_star_tracker(&key, tracker, period);
                }
                (SensorRole::Corrects { .. }, SensorKind::Sampled(sampled)) => {
                    self.add_sampled(&key, sampled, period);
                }
                _ => return Err(ConfigError::new(key, "has noise without a linear model in this loop")),
            }
        }
        Ok(())
    }

    fn add_sampled(&mut self, key: &str, sampled: &Sampled, period: i64) {
        let axes = self.axes;
        let angle = |deviation: f64| diagonal(axes, |_| deviation).map(NoiseEntry::Angle);
        let rate = sampled.rate_noise.map_or(0.0, Positive::get);
        self.add(format!("{key}.noise"), period, angle(sampled.noise.get()));
        self.add(format!("{key}.resolution"), period, angle(rounding(sampled.resolution.get())));
        self.add(format!("{key}.rate_noise"), period, diagonal(axes, |_| rate).map(NoiseEntry::Rate));
    }

    fn add_star_tracker(&mut self, key: &str, tracker: &StarTracker, period: i64) {
        let mut matrix = DMatrix::zeros(3, 3);
        for (axis, noise) in tracker.noise.iter().enumerate() {
            let direction = tracker.body_direction(axis);
            (0..3).for_each(|row| matrix[(row, axis)] = direction[row] * noise.get());
        }
        let entry = (matrix.amax() > 0.0).then_some(NoiseEntry::Angle(matrix));
        self.add(format!("{key}.noise"), period, entry);
    }

    fn add_gyro(&mut self, key: &str, gyro: &Gyro, period: i64) {
        let (axes, time) = (self.axes, seconds(period));
        let rate = |deviation: &dyn Fn(usize) -> f64| diagonal(axes, deviation).map(NoiseEntry::Rate);
        self.add(format!("{key}.noise"), period, rate(&|axis| gyro.noise.about(axis).get()));
        let resolution = rate(&|axis| rounding(gyro.resolution.about(axis).get()));
        self.add(format!("{key}.resolution"), period, resolution);
        let white = rate(&|axis| gyro.angle_random_walk.about(axis).get() / libm::sqrt(time));
        self.add(format!("{key}.angle_random_walk"), period, white);
        let walk = diagonal(axes, |axis| gyro.rate_random_walk.about(axis).get()).map(|walk| {
            let (change, white) = (&walk * libm::sqrt(time), walk * libm::sqrt(time / 12.0));
            NoiseEntry::Walk { change: beside(&change, false), white: beside(&white, true) }
        });
        self.add(format!("{key}.rate_random_walk"), period, walk);
        let quantum = diagonal(axes, |axis| rounding(gyro.quantum.about(axis).get()) / time);
        self.add(format!("{key}.quantum"), period, quantum.map(NoiseEntry::Remainder));
        let wander =
            diagonal(axes, |axis| gyro.bias_instability(axis).map_or(0.0, |(deviation, _)| deviation));
        let wander = wander.zip(gyro.correlation_time).map(|(deviation, correlation)| {
            wander_entry(&deviation, time / correlation.get(), gyro.integrates())
        });
        self.add(format!("{key}.bias_instability"), period, wander);
    }

    fn add_quanta_of_wheels(&mut self, scenario: &Scenario, period: i64) {
        for member in scenario.actuator.members() {
            let (ActuatorTask::Executes(_), ActuatorKind::Wheel(wheel)) = (&member.task, &*member.kind)
            else {
                continue;
            };
            let entry = diagonal(self.axes, |_| rounding(wheel.quantum.get())).map(NoiseEntry::Command);
            self.add(format!("{}.quantum", member.key), period, entry);
        }
    }

    fn add_disturbances(&mut self, scenario: &Scenario) {
        for (index, disturbance) in scenario.disturbance.iter().enumerate() {
            let (noise, Some(period)) = (disturbance.noise.get(), disturbance.period) else { continue };
            if noise > 0.0 {
                let axis = disturbance.about.map_or(0, Axis::index);
                let deviation = libm::sqrt(noise / period.seconds());
                let period = period.leading_femtoseconds();
                self.found.push(NoiseSource {
                    key: format!("disturbance[{index}].noise"),
                    entry: NoiseEntry::Torque { axis, deviation },
                    period,
                    phase: ticks(disturbance.from.get()) % period,
                });
            }
        }
    }
}

/// Returns a matrix beside zeros of its own shape, on the right or on the left.
fn beside(matrix: &DMatrix<f64>, is_right: bool) -> DMatrix<f64> {
    let (rows, columns) = matrix.shape();
    let mut whole = DMatrix::zeros(rows, 2 * columns);
    whole.view_mut((0, if is_right { columns } else { 0 }), (rows, columns)).copy_from(matrix);
    whole
}

/// Returns the exponentially correlated part of a bias, for periods of `ratio` correlation times: \[Gelb74\], as the gyro
/// of a run has it.
fn wander_entry(deviation: &DMatrix<f64>, ratio: f64, integrates: bool) -> NoiseEntry {
    let change = deviation * libm::sqrt(-libm::expm1(-2.0 * ratio));
    let decay = libm::exp(-ratio);
    let (own_share, white) = if integrates {
        let z = 0.5 * ratio;
        let tanh = libm::tanh(z);
        // The series of z - tanh z, where the difference loses its digits.
        let rest = if z > 0.02 {
            z - tanh
        } else {
            z * z * z * (1.0 / 3.0 - z * z * (2.0 / 15.0 - z * z * (17.0 / 315.0)))
        };
        (tanh / z, libm::sqrt(rest) / z)
    } else {
        (1.0, 0.0)
    };
    let white = deviation * white;
    NoiseEntry::Wander { decay, change: beside(&change, false), own_share, white: beside(&white, true) }
}
