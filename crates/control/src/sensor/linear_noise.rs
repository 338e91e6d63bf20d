//! Noise of a sensor in a linear loop: each of its keys that draws random numbers, or rounds.

use flexsc_numerics::quantity::Positive;
use flexsc_numerics::time::Span;
use nalgebra::DMatrix;

use super::{Gyro, Sampled, SensorKind, StarTracker};

/// Noise of a sensor. Matrices have a row for each axis and a column for each draw of an instant, in standard deviations.
#[derive(Clone, Debug, PartialEq)]
pub enum SensorNoise {
    /// Measured angle (rad), or attitude as a rotation vector.
    Angle(DMatrix<f64>),
    /// Measured rate (rad/s).
    Rate(DMatrix<f64>),
    /// Bias that walks: its change from reading to reading, and white noise of the reading (rad/s).
    Walk {
        /// Change of the bias from reading to reading.
        change: DMatrix<f64>,
        /// White noise of the reading.
        white: DMatrix<f64>,
    },
    /// Remainder of a rounded angle, which the next reading adds (rad/s).
    Remainder(DMatrix<f64>),
    /// Exponentially correlated part of the bias (rad/s).
    Wander {
        /// Decay between readings.
        decay: f64,
        /// Change from reading to reading.
        change: DMatrix<f64>,
        /// Share of the bias at the start of an interval in its reading.
        own_share: f64,
        /// White noise of the reading.
        white: DMatrix<f64>,
    },
}

/// Noise of a key of a sensor: the key within the sensor's table, and the noise.
pub type KeyNoise = (&'static str, SensorNoise);

/// Returns the diagonal matrix of deviations about each axis; `None` if all are 0.
pub fn diagonal(axes: usize, deviation: impl Fn(usize) -> f64) -> Option<DMatrix<f64>> {
    let matrix = DMatrix::from_fn(axes, axes, |row, column| if row == column { deviation(row) } else { 0.0 });
    (matrix.amax() > 0.0).then_some(matrix)
}

/// Returns the standard deviation of a rounding to a quantum.
pub fn rounding(quantum: f64) -> f64 {
    quantum / f64::sqrt(12.0)
}

impl SensorKind {
    /// Returns the noise of the sensor's keys about `axes` axes, with `period` (s) from reading to reading; `None` for a
    /// sensor whose noise has no linear model.
    pub fn linear_noise(&self, axes: usize, period: f64) -> Option<Vec<KeyNoise>> {
        match self {
            Self::Continuous => Some(Vec::new()),
            Self::Sampled(sampled) => Some(sampled_noise(sampled, axes)),
            Self::Gyro(gyro) => Some(gyro_noise(gyro, axes, period)),
            Self::StarTracker(tracker) => Some(tracker_noise(tracker)),
            Self::Magnetometer(_)
            | Self::SunSensor(_)
            | Self::SunCells(_)
            | Self::EarthSensor(_)
            | Self::Tachometer(_)
            | Self::Accelerometer(_)
            | Self::Own(_) => None,
        }
    }

    /// Returns the key and the reason for which the noise of the only sensor of a loop with a period has no linear model.
    pub fn noise_fault(&self, period: Span) -> Option<(&'static str, &'static str)> {
        let Self::Gyro(gyro) = self else { return None };
        if gyro.integrates() {
            let why = "is that of a gyro that integrates the rate: its noise has a linear model only with an attitude filter";
            return Some(("period", why));
        }
        let differs = gyro.period.is_some_and(|own| own != period);
        differs.then_some(("period", "is not that of the law: the noise of a linear loop has one period"))
    }
}

/// Returns the noise that is not 0.
fn existing<const N: usize>(all: [(&'static str, Option<SensorNoise>); N]) -> Vec<KeyNoise> {
    all.into_iter().filter_map(|(key, noise)| Some((key, noise?))).collect()
}

fn sampled_noise(sampled: &Sampled, axes: usize) -> Vec<KeyNoise> {
    let angle = |deviation: f64| diagonal(axes, |_| deviation).map(SensorNoise::Angle);
    let rate = sampled.rate_noise.map_or(0.0, Positive::get);
    existing([
        ("noise", angle(sampled.noise.get())),
        ("resolution", angle(rounding(sampled.resolution.get()))),
        ("rate_noise", diagonal(axes, |_| rate).map(SensorNoise::Rate)),
    ])
}

fn tracker_noise(tracker: &StarTracker) -> Vec<KeyNoise> {
    let mut matrix = DMatrix::zeros(3, 3);
    for (axis, noise) in tracker.noise.iter().enumerate() {
        let direction = tracker.body_direction(axis);
        (0..3).for_each(|row| matrix[(row, axis)] = direction[row] * noise.get());
    }
    existing([("noise", (matrix.amax() > 0.0).then_some(SensorNoise::Angle(matrix)))])
}

fn gyro_noise(gyro: &Gyro, axes: usize, period: f64) -> Vec<KeyNoise> {
    let rate = |deviation: &dyn Fn(usize) -> f64| diagonal(axes, deviation).map(SensorNoise::Rate);
    let walk = diagonal(axes, |axis| gyro.rate_random_walk.about(axis).get()).map(|walk| {
        let (change, white) = (&walk * f64::sqrt(period), walk * f64::sqrt(period / 12.0));
        SensorNoise::Walk { change: padded(&change, Side::Left), white: padded(&white, Side::Right) }
    });
    let quantum = diagonal(axes, |axis| rounding(gyro.quantum.about(axis).get()) / period);
    let wander = diagonal(axes, |axis| gyro.bias_instability(axis).map_or(0.0, |(deviation, _)| deviation));
    let wander = wander.zip(gyro.correlation_time).map(|(deviation, correlation)| {
        wander_noise(&deviation, period / correlation.get(), gyro.integrates())
    });
    existing([
        ("noise", rate(&|axis| gyro.noise.about(axis).get())),
        ("resolution", rate(&|axis| rounding(gyro.resolution.about(axis).get()))),
        ("angle_random_walk", rate(&|axis| gyro.angle_random_walk.about(axis).get() / f64::sqrt(period))),
        ("rate_random_walk", walk),
        ("quantum", quantum.map(SensorNoise::Remainder)),
        ("bias_instability", wander),
    ])
}

/// Place of a matrix beside zeros.
#[derive(Copy, Clone, PartialEq)]
enum Side {
    Left,
    Right,
}

/// Returns a matrix with as many columns of zeros beside it.
fn padded(matrix: &DMatrix<f64>, side: Side) -> DMatrix<f64> {
    let (rows, columns) = matrix.shape();
    let mut whole = DMatrix::zeros(rows, 2 * columns);
    let first = if side == Side::Right { columns } else { 0 };
    whole.view_mut((0, first), (rows, columns)).copy_from(matrix);
    whole
}

/// Returns the exponentially correlated part of a bias, for periods of `ratio` correlation times: \[Gelb74\], as the gyro
/// of a run has it.
fn wander_noise(deviation: &DMatrix<f64>, ratio: f64, integrates: bool) -> SensorNoise {
    let change = deviation * f64::sqrt(-libm::expm1(-2.0 * ratio));
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
        (tanh / z, f64::sqrt(rest) / z)
    } else {
        (1.0, 0.0)
    };
    let white = deviation * white;
    SensorNoise::Wander {
        decay,
        change: padded(&change, Side::Left),
        own_share,
        white: padded(&white, Side::Right),
    }
}
