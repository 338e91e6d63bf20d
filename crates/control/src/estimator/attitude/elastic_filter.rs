//! An attitude filter that estimates elastic modes too.

use flexsc_flight::attitude_filter::GyroNoise;
use flexsc_flight::attitude_observation::Correction;
use flexsc_flight::reading_status::ReadingStatus;
use flexsc_numerics::attitude::{Vector, rotation};
use flexsc_numerics::flight_types::to_vector3;
use nalgebra::{DMatrix, Matrix3, Quaternion};

use super::AttitudeFilterState;
use super::elastic_states::{ElasticFilterStates, ElasticInnovation};
use super::measurement::AttitudeMeasurement;

/// Attitude filter with elastic modes, which hold the full covariance; that of the state is its leading block.
#[derive(Clone, Debug, PartialEq)]
pub struct ElasticFilter {
    /// Attitude, bias and their covariance.
    pub state: AttitudeFilterState,
    /// Modes and the full covariance.
    pub modes: ElasticFilterStates,
}

impl ElasticFilter {
    /// Propagates the filter and its modes over `seconds`, under torques (N m), each with its duration (s).
    pub fn predict(&mut self, reading: &Vector, seconds: f64, noise: &GyroNoise, torques: &[(f64, Vector)]) {
        let Self { state, modes } = self;
        let mount = modes.propagate(seconds, torques);
        let turn = (reading - state.bias) * seconds - mount;
        modes.propagate_covariance(&turn, seconds, noise);
        state.attitude = unit(state.attitude * rotation(&turn));
        state.covariance = modes.attitude_block();
    }

    /// Corrects the filter by a measurement of a sensor whose mount is rotated by the modes.
    pub fn correct(
        &mut self,
        sensor: usize,
        measured: &AttitudeMeasurement,
        noise: &Matrix3<f64>,
    ) -> Option<Correction> {
        let Self { state, modes } = self;
        let noise = DMatrix::from_fn(3, 3, |row, column| noise[(row, column)]);
        let reported = match measured {
            AttitudeMeasurement::Attitude(attitude) => {
                modes.correct(&state.attitude, attitude, &noise, sensor)
            }
            AttitudeMeasurement::Vector(measurement) => {
                modes.correct_vector(&state.attitude, measurement, &noise, sensor)
            }
        };
        state.covariance = modes.attitude_block();
        let (innovation, ElasticInnovation { error: [angle, bias], nis }) = reported?;
        state.attitude = unit(state.attitude * rotation(&angle));
        state.bias += bias;
        let components = measured.dimension();
        Some(Correction {
            innovation: to_vector3(&innovation),
            nis,
            components,
            status: ReadingStatus::Accepted,
        })
    }
}

fn unit(q: Quaternion<f64>) -> Quaternion<f64> {
    q / q.norm()
}
