//! States of the modes in an attitude filter, with the covariance of the whole filter.
//!
//! Errors are theta, beta, and of each mode those of q and q'/W. Through an interval theta' = -w^ x theta - beta - g
//! dq' - n_v, beta' = n_u, and the modes oscillate; transition and added covariance are Van Loan's for constant w^,
//! exact. If the filter identifies frequencies, the errors of each ln W follow; their effect on attitude and modes is
//! the exact derivative of the estimate at the end of the interval, and their random walk is added there.

use std::sync::Arc;

use flexsc_flight::attitude_filter::GyroNoise;
use flexsc_flight::stumpff::Stumpff;
use flexsc_numerics::attitude::{Vector, rotation, rotation_vector};
use flexsc_numerics::exponential::exponential;
use flexsc_spacecraft::environment::to_body;
use nalgebra::{Cholesky, DMatrix, DVector, Matrix6, Quaternion};

use super::elastic::FilterModes;
use super::measurement::perpendicular_pair;
use crate::sensor::VectorMeasurement;

/// States of the elastic modes of a filter at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct ElasticFilterStates {
    /// Parameters of the modes.
    pub known: Arc<FilterModes>,
    /// Natural frequency W of each mode, as currently identified (rad/s).
    pub frequencies: Vec<f64>,
    /// q and q'/W of each mode (m sqrt(kg)).
    pub state: Vec<[f64; 2]>,
    /// Derivatives of q and q'/W of each mode over the last interval with respect to ln W.
    grown: Vec<[f64; 2]>,
    /// Mean rate of each mode over the last interval (m sqrt(kg)/s).
    pub mean: Vec<f64>,
    /// Covariance of the errors of attitude, bias and modes, and of the logarithms of identified frequencies.
    pub covariance: DMatrix<f64>,
}

/// Result of a correction.
pub struct ElasticInnovation {
    /// Estimated error of attitude and bias (rad, rad/s).
    pub error: [Vector; 2],
    /// Normalised innovation squared.
    pub nis: f64,
}

impl ElasticFilterStates {
    /// Creates modes at rest, with the covariance of attitude and bias.
    pub fn new(known: Arc<FilterModes>, covariance: &Matrix6<f64>) -> Self {
        let count = known.each.len();
        let order = 6 + 2 * count + if known.identified.is_some() { count } else { 0 };
        let mut whole = DMatrix::zeros(order, order);
        whole.view_mut((0, 0), (6, 6)).copy_from(covariance);
        for (index, mode) in known.each.iter().enumerate() {
            for (part, deviation) in mode.initial.iter().enumerate() {
                let index = 6 + 2 * index + part;
                whole[(index, index)] = deviation * deviation;
            }
        }
        if let Some(identified) = known.identified {
            for index in 6 + 2 * count..order {
                whole[(index, index)] = identified.deviation * identified.deviation;
            }
        }
        let frequencies = known.each.iter().map(|mode| mode.frequency).collect();
        let (state, grown) = (vec![[0.0; 2]; count], vec![[0.0; 2]; count]);
        Self { frequencies, state, grown, mean: vec![0.0; count], covariance: whole, known }
    }

    /// Returns the standard deviations of the frequencies (rad/s); 0 of frequencies that are not identified.
    pub fn deviations(&self) -> Vec<f64> {
        let first = 6 + 2 * self.frequencies.len();
        let relative = |index: usize| {
            if self.known.identified.is_some() { self.covariance[(index, index)] } else { 0.0 }
        };
        let each = self.frequencies.iter().enumerate();
        each.map(|(index, frequency)| frequency * f64::sqrt(relative(first + index))).collect()
    }

    /// Returns the covariance of attitude and bias.
    pub fn attitude_block(&self) -> Matrix6<f64> {
        self.covariance.fixed_view::<6, 6>(0, 0).into_owned()
    }

    /// Returns the rotation of a sensor's mount relative to the hub by the modes (rad).
    pub fn mount_rotation(&self, sensor: usize) -> Vector {
        self.known.rotation_at(|mode| mode.mounts[sensor], self.state.iter().map(|[q, _]| *q))
    }

    /// Returns the rotation of the hub by the modes (rad).
    pub fn hub_rotation(&self) -> Vector {
        self.known.rotation_at(|mode| mode.hub, self.state.iter().map(|[q, _]| *q))
    }

    /// Returns the elastic part of the last gyro reading (rad/s): that of the hub, and that of its mount relative to
    /// the hub.
    pub fn rates(&self) -> [Vector; 2] {
        [
            self.known.rotation_at(|mode| mode.hub, self.mean.iter().copied()),
            self.known.rotation_at(|mode| mode.gyro, self.mean.iter().copied()),
        ]
    }

    /// Propagates the modes over `seconds` under torques (N m), each with its duration (s). Returns the rotation of the
    /// gyro's mount relative to the hub over the interval (rad).
    pub fn propagate(&mut self, seconds: f64, torques: &[(f64, Vector)]) -> Vector {
        let known = self.known.clone();
        let mut rotation = Vector::zeros();
        let moving = self.state.iter_mut().zip(&mut self.mean).zip(&mut self.grown);
        for (((state, mean), grown), (mode, frequency)) in
            moving.zip(known.each.iter().zip(&self.frequencies))
        {
            let before = state[0];
            *grown = [0.0; 2];
            for (duration, torque) in torques {
                let rest = mode.hub.dot(torque) / (frequency * frequency);
                let [a, b, c, d] = transition(*frequency, mode.damping, *duration);
                let (x, y) = (state[0] - rest, state[1]);
                let (displacement, rate) = (a * x + b * y, c * x + d * y);
                *state = [rest + a * x + b * y, rate];
                // The derivative of exp(W t K) is W t K exp(W t K), and that of the equilibrium is -2 times it.
                let (x, y, angle) = (grown[0] + 2.0 * rest, grown[1], frequency * duration);
                *grown = [
                    a * x + b * y + angle * rate - 2.0 * rest,
                    c * x + d * y - angle * (displacement + 2.0 * mode.damping * rate),
                ];
            }
            *mean = if seconds > 0.0 { (state[0] - before) / seconds } else { 0.0 };
            rotation += mode.gyro * (state[0] - before);
        }
        rotation
    }

    /// Propagates the covariance over `seconds`, in which the body rotates by `turn` (rad).
    pub fn propagate_covariance(&mut self, turn: &Vector, seconds: f64, noise: &GyroNoise) {
        let order = 6 + 2 * self.state.len();
        let mut flow = DMatrix::zeros(order, order);
        flow.view_mut((0, 0), (3, 3)).copy_from(&(-turn.cross_matrix()));
        let (white, walk) = (noise.angle_random_walk, noise.rate_random_walk);
        let mut added = DMatrix::zeros(order, order);
        for axis in 0..3 {
            flow[(axis, axis + 3)] = -seconds;
            added[(axis, axis)] = white * white * seconds;
            added[(axis + 3, axis + 3)] = walk * walk * seconds;
        }
        for (index, mode) in self.known.each.iter().enumerate() {
            let frequency = self.frequencies[index];
            let (index, angle) = (6 + 2 * index, frequency * seconds);
            flow[(index, index + 1)] = angle;
            flow[(index + 1, index)] = -angle;
            flow[(index + 1, index + 1)] = -2.0 * mode.damping * angle;
            for axis in 0..3 {
                flow[(axis, index + 1)] = -mode.gyro[axis] * angle;
            }
            let force = self.known.noise / frequency;
            added[(index + 1, index + 1)] = force * force * seconds;
        }
        // [VanLoan78]: exp [[-F, Q], [0, F']] = [[.., Phi^-1 Qd], [0, Phi']].
        let mut both = DMatrix::zeros(2 * order, 2 * order);
        both.view_mut((0, 0), (order, order)).copy_from(&(-&flow));
        both.view_mut((0, order), (order, order)).copy_from(&added);
        both.view_mut((order, order), (order, order)).copy_from(&flow.transpose());
        let both = exponential(&both);
        let transition = both.view((order, order), (order, order)).transpose();
        let added = &transition * both.view((0, order), (order, order));
        let (transition, added) = self.identifying((transition, added), turn, seconds);
        let carried = &transition * &self.covariance * transition.transpose() + added;
        self.covariance = 0.5 * (&carried + carried.transpose());
    }

    /// Extends the transition and the added covariance of an interval by the frequencies, if they are identified.
    fn identifying(
        &self,
        (transition, added): (DMatrix<f64>, DMatrix<f64>),
        turn: &Vector,
        seconds: f64,
    ) -> (DMatrix<f64>, DMatrix<f64>) {
        let Some(identified) = self.known.identified else { return (transition, added) };
        let (first, order) = (transition.nrows(), self.covariance.nrows());
        let mut transition = transition.resize(order, order, 0.0);
        let mut added = added.resize(order, order, 0.0);
        let (Stumpff { c2: half, c3: sixth, .. }, across) =
            (Stumpff::at(turn.norm_squared()), turn.cross_matrix());
        for (index, (mode, [grown, rate])) in self.known.each.iter().zip(&self.grown).enumerate() {
            let state = first + index;
            // The derivative of the gyro mount's rotation relative to the hub enters the hub's attitude with a minus.
            let off = mode.gyro * -*grown;
            let off = off - across * off * half + across * (across * off) * sixth;
            for axis in 0..3 {
                transition[(axis, state)] = off[axis];
            }
            transition[(6 + 2 * index, state)] = *grown;
            transition[(7 + 2 * index, state)] = *rate;
            transition[(state, state)] = 1.0;
            added[(state, state)] = identified.walk * identified.walk * seconds;
        }
        (transition, added)
    }

    /// Corrects the filter by the attitude that a sensor measured, where the hub's is `attitude` and the error's
    /// covariance `noise`.
    pub fn correct(
        &mut self,
        attitude: &Quaternion<f64>,
        measured: &Quaternion<f64>,
        noise: &DMatrix<f64>,
        sensor: usize,
    ) -> Option<(Vector, ElasticInnovation)> {
        let off = rotation_vector(&(attitude * rotation(&self.mount_rotation(sensor))), measured);
        let reported = self.apply_innovation(
            &DMatrix::identity(3, 3),
            &DVector::from_column_slice(off.as_slice()),
            noise,
            sensor,
        )?;
        Some((off, reported))
    }

    /// Corrects the filter by the vector that a sensor measured, where the hub's attitude is `attitude`.
    pub fn correct_vector(
        &mut self,
        attitude: &Quaternion<f64>,
        measurement: &VectorMeasurement,
        noise: &DMatrix<f64>,
        sensor: usize,
    ) -> Option<(Vector, ElasticInnovation)> {
        let expected: Vector =
            to_body(&(attitude * rotation(&self.mount_rotation(sensor))), &measurement.inertial);
        let off = measurement.vector - expected;
        let jacobian = expected.cross_matrix();
        let whole =
            |block: &nalgebra::Matrix3<f64>| DMatrix::from_fn(3, 3, |row, column| block[(row, column)]);
        let reported = if measurement.is_direction {
            let rows = perpendicular_pair(&expected);
            let rows = DMatrix::from_fn(2, 3, |row, column| rows[(row, column)]);
            let off = &rows * DVector::from_column_slice(off.as_slice());
            let reported = self.apply_innovation(
                &(&rows * whole(&jacobian)),
                &off,
                &(&rows * noise * rows.transpose()),
                sensor,
            )?;
            ElasticInnovation { nis: reported.nis * 1.5, ..reported }
        } else {
            self.apply_innovation(
                &whole(&jacobian),
                &DVector::from_column_slice(off.as_slice()),
                noise,
                sensor,
            )?
        };
        Some((off.cross(&expected) / expected.norm_squared(), reported))
    }

    /// Updates the states with the innovation `off`, its derivatives `jacobian` with respect to a rotation of the sensor's
    /// mount, and the covariance `noise` of the measurement.
    fn apply_innovation(
        &mut self,
        jacobian: &DMatrix<f64>,
        off: &DVector<f64>,
        noise: &DMatrix<f64>,
        sensor: usize,
    ) -> Option<ElasticInnovation> {
        let order = self.covariance.nrows();
        let mut observation = DMatrix::zeros(3, order);
        for axis in 0..3 {
            observation[(axis, axis)] = 1.0;
            for (index, mode) in self.known.each.iter().enumerate() {
                observation[(axis, 6 + 2 * index)] = mode.mounts[sensor][axis];
            }
        }
        let observation = jacobian * observation;
        let to_measured = &self.covariance * observation.transpose();
        let inverse = Cholesky::new(&observation * &to_measured + noise)?.inverse();
        let gain = &to_measured * &inverse;
        let error = &gain * off;
        let reduction = DMatrix::identity(order, order) - &gain * &observation;
        let posterior =
            &reduction * &self.covariance * reduction.transpose() + &gain * noise * gain.transpose();
        self.covariance = 0.5 * (&posterior + posterior.transpose());
        for (index, state) in self.state.iter_mut().enumerate() {
            state[0] += error[6 + 2 * index];
            state[1] += error[7 + 2 * index];
        }
        let first = 6 + 2 * self.state.len();
        for (frequency, error) in self.frequencies.iter_mut().zip(error.iter().skip(first)) {
            *frequency *= libm::exp(error.clamp(-1.0, 1.0));
        }
        let part = |from: usize| Vector::new(error[from], error[from + 1], error[from + 2]);
        Some(ElasticInnovation { error: [part(0), part(3)], nis: off.dot(&(inverse * off)) })
    }
}

/// Returns the transition of q and q'/W of a free mode, row by row.
fn transition(frequency: f64, damping: f64, seconds: f64) -> [f64; 4] {
    let root = f64::sqrt((1.0 - damping) * (1.0 + damping));
    let (sin, cos) = libm::sincos(root * frequency * seconds);
    let decay = libm::exp(-damping * frequency * seconds);
    let (part, lag) = (sin / root, damping * sin / root);
    [decay * (cos + lag), decay * part, -decay * part, decay * (cos - lag)]
}
