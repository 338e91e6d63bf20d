//! Kalman filter of the motion about one axis: rigid angle and rate, then displacement and rate of each mode (\[BarShalom01\]).
//!
//! Matrices are lists of their columns. A model is one list: the transition matrix over a period, the change of the state by a unit
//! moment, and the covariance of the process noise in a period. Functions get a buffer as long as a state and two matrices.

/// Largest normalised squared innovation that is accepted: a million standard deviations.
const FARTHEST: f64 = 1e12;

/// Measurement of a sample.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct KalmanSample {
    /// True if there is a measurement.
    pub is_measured: bool,
    /// Measured angle (rad).
    pub angle: f64,
    /// Measured rate (rad/s).
    pub rate: f64,
    /// Standard deviation of the angle (rad).
    pub angle_noise: f64,
    /// True if the rate is measured.
    pub has_rate: bool,
    /// Standard deviation of the rate (rad/s).
    pub rate_noise: f64,
    /// Number of states of the motion, which come first.
    pub motion: usize,
    /// True if the other states are not corrected.
    pub is_gated: bool,
}

/// Innovation of a sample.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct KalmanInnovation {
    /// Measured angle minus the predicted one (rad); 0 without a measurement.
    pub angle: f64,
    /// True if the measurement is accepted.
    pub is_accepted: bool,
    /// Normalised squared innovation, summed over the measurements.
    pub square: f64,
}

/// Returns the sum of every other state of the motion: of the angles from 0 on, of the rates from 1 on.
pub fn total(state: &[f64], first: usize, motion: usize) -> f64 {
    let mut sum: f64 = state[first];
    let mut index: usize = first + 2;
    while index < motion {
        sum += state[index];
        index += 2;
    }
    sum
}

/// Returns true if mean and covariance are finite, and no variance is negative.
pub fn is_sound(mean: &[f64], covariance: &[f64]) -> bool {
    let order: usize = mean.len();
    let mut is_sound: bool = true;
    for index in 0..order {
        let variance: f64 = covariance[index * order + index];
        is_sound = is_sound && mean[index].is_finite() && variance >= 0.0;
    }
    for index in 0..covariance.len() {
        is_sound = is_sound && covariance[index].is_finite();
    }
    is_sound
}

/// Copies mean and covariance to the buffer.
fn keep(mean: &[f64], covariance: &[f64], buffer: &mut [f64]) {
    for index in 0..mean.len() {
        buffer[index] = mean[index];
    }
    for index in 0..covariance.len() {
        buffer[mean.len() + index] = covariance[index];
    }
}

/// Copies mean and covariance from the buffer.
fn restore(mean: &mut [f64], covariance: &mut [f64], buffer: &[f64]) {
    let order: usize = mean.len();
    for index in 0..order {
        mean[index] = buffer[index];
    }
    for index in 0..covariance.len() {
        covariance[index] = buffer[order + index];
    }
}

/// Predicts mean and covariance over a period with the mean reduced moment (rad/s²), 0 if it is not finite. Returns false, and
/// leaves them as they are, if they would not be sound.
pub fn predict(
    model: &[f64],
    moment: f64,
    mean: &mut [f64],
    covariance: &mut [f64],
    buffer: &mut [f64],
) -> bool {
    let order: usize = mean.len();
    let matrix: usize = order * order;
    let room: usize = order + matrix;
    let push: f64 = if moment.is_finite() { moment } else { 0.0 };
    keep(mean, covariance, buffer);
    for row in 0..order {
        let mut sum: f64 = model[row] * buffer[0];
        for k in 1..order {
            sum += model[k * order + row] * buffer[k];
        }
        mean[row] = sum + model[matrix + row] * push;
    }
    for column in 0..order {
        for row in 0..order {
            let mut sum: f64 = model[row] * covariance[column * order];
            for k in 1..order {
                sum += model[k * order + row] * covariance[column * order + k];
            }
            buffer[room + column * order + row] = sum;
        }
    }
    // The upper triangle; the lower one is its mirror image.
    for column in 0..order {
        for row in 0..column + 1 {
            let mut sum: f64 = buffer[room + row] * model[column];
            for k in 1..order {
                sum += buffer[room + k * order + row] * model[k * order + column];
            }
            let noise: f64 = model[matrix + order + column * order + row];
            covariance[column * order + row] = sum + noise;
            covariance[row * order + column] = sum + noise;
        }
    }
    if is_sound(mean, covariance) {
        return true;
    }
    restore(mean, covariance, buffer);
    false
}

/// Corrects by a measurement of the sum of every other state of the motion, from `first` on. Returns its normalised squared
/// innovation, or -1, with nothing corrected, if it is too far away or its variance is not positive.
fn correct(
    measured: f64,
    first: usize,
    sample: &KalmanSample,
    mean: &mut [f64],
    covariance: &mut [f64],
    buffer: &mut [f64],
) -> f64 {
    let order: usize = mean.len();
    let observation: usize = order + order * order;
    let gain: usize = observation + order;
    let noise: f64 = if first == 0 { sample.angle_noise } else { sample.rate_noise };
    let innovation: f64 = measured - total(mean, first, sample.motion);
    for row in 0..order {
        let mut sum: f64 = 0.0;
        let mut column: usize = first;
        while column < sample.motion {
            sum += covariance[column * order + row];
            column += 2;
        }
        buffer[observation + row] = sum;
    }
    let mut variance: f64 = buffer[observation + first];
    let mut index: usize = first + 2;
    while index < sample.motion {
        variance += buffer[observation + index];
        index += 2;
    }
    variance += noise * noise;
    let square: f64 = innovation * innovation / variance;
    // A variance that is not positive, or an innovation that is NaN, fails here too.
    if !(variance > 0.0 && square <= FARTHEST) {
        return -1.0;
    }
    for row in 0..order {
        let is_held: bool = sample.is_gated && row >= sample.motion;
        buffer[gain + row] = if is_held { 0.0 } else { buffer[observation + row] / variance };
        mean[row] += innovation * buffer[gain + row];
    }
    // Joseph's form, (1 - K H) P (1 - K H)' + K R K', valid for any gain, with its products written out.
    for column in 0..order {
        for row in 0..column + 1 {
            let value: f64 = covariance[column * order + row]
                - (buffer[gain + row] * buffer[observation + column]
                    + buffer[observation + row] * buffer[gain + column])
                + variance * buffer[gain + row] * buffer[gain + column];
            covariance[column * order + row] = value;
            covariance[row * order + column] = value;
        }
    }
    square
}

/// Corrects mean and covariance by a sample: by the angle, and then by the rate if it is measured. Without a measurement, or if
/// one is rejected, they stay as they are.
pub fn update(
    sample: &KalmanSample,
    mean: &mut [f64],
    covariance: &mut [f64],
    buffer: &mut [f64],
) -> KalmanInnovation {
    let mut innovation: KalmanInnovation = KalmanInnovation { angle: 0.0, is_accepted: false, square: 0.0 };
    if !sample.is_measured {
        return innovation;
    }
    keep(mean, covariance, buffer);
    innovation.angle = sample.angle - total(mean, 0, sample.motion);
    let first: f64 = correct(sample.angle, 0, sample, mean, covariance, buffer);
    innovation.square = first;
    innovation.is_accepted = first >= 0.0;
    if innovation.is_accepted && sample.has_rate {
        let second: f64 = correct(sample.rate, 1, sample, mean, covariance, buffer);
        innovation.square = first + second;
        innovation.is_accepted = second >= 0.0;
    }
    innovation.is_accepted = innovation.is_accepted && is_sound(mean, covariance);
    if !innovation.is_accepted {
        restore(mean, covariance, buffer);
    }
    innovation
}
