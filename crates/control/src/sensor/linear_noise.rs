//! Noise of a sensor in a linear loop: each of its keys that draws random numbers, or rounds.

use nalgebra::DMatrix;

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

/// Returns the noise that is not 0.
pub(super) fn existing<const N: usize>(all: [(&'static str, Option<SensorNoise>); N]) -> Vec<KeyNoise> {
    all.into_iter().filter_map(|(key, noise)| Some((key, noise?))).collect()
}

/// Place of a matrix beside zeros.
#[derive(Copy, Clone, PartialEq)]
pub(super) enum Side {
    Left,
    Right,
}

/// Returns a matrix with as many columns of zeros beside it.
pub(super) fn padded(matrix: &DMatrix<f64>, side: Side) -> DMatrix<f64> {
    let (rows, columns) = matrix.shape();
    let mut whole = DMatrix::zeros(rows, 2 * columns);
    let first = if side == Side::Right { columns } else { 0 };
    whole.view_mut((0, first), (rows, columns)).copy_from(matrix);
    whole
}

/// Returns the exponentially correlated part of a bias, for periods of `ratio` correlation times: \[Gelb74\], as the gyro
/// of a run has it.
pub(super) fn wander_noise(deviation: &DMatrix<f64>, ratio: f64, integrates: bool) -> SensorNoise {
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
