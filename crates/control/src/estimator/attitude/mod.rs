//! Attitude and gyro bias, by a multiplicative extended Kalman filter that accepts delayed measurements.

mod covariance_propagation;
mod elastic;
mod elastic_states;
mod filter;
mod filter_state;
mod gains;
mod history;
mod measurement;
mod spec;
#[cfg(test)]
mod tests;

pub use elastic::{ElasticStates, FilterMode, FilterModes, FrequencyIdentification};
pub use elastic_states::ElasticFilterStates;
pub use filter::{AttitudeFilterState, Correction};
pub use filter_state::AttitudeFilterRun;
pub use gains::{Complementary, GainMethod};
pub use history::{DelayedMeasurement, FilterHistory};
pub use measurement::{AttitudeMeasurement, GyroNoise};
pub use spec::{AttitudeFilter, AttitudeInitialDeviations, FilterSetup, SensorRole};
