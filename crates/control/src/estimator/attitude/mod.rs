//! Attitude and gyro bias, by a multiplicative extended Kalman filter that accepts delayed measurements.

mod elastic;
mod elastic_filter;
mod elastic_history;
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
pub use filter::AttitudeFilterState;
pub use filter_state::{AttitudeFilterRun, initial_state};
pub use flexsc_flight::attitude_filter::GyroNoise;
pub use flexsc_flight::attitude_observation::Correction;
pub use gains::{Complementary, GainMethod};
pub use history::FilterHistory;
pub use measurement::{AttitudeMeasurement, DelayedMeasurement};
pub use spec::{AttitudeFilter, AttitudeInitialDeviations, FilterSetup, ReadingGate, SensorRole};
