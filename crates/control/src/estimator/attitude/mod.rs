//! Attitude and gyro bias, by a multiplicative extended Kalman filter that accepts delayed measurements.

mod at_work;
mod carried;
mod elastic;
mod filter;
mod gains;
mod history;
mod measurement;
mod spec;
mod swinging;
#[cfg(test)]
mod tests;

pub use at_work::Tracking;
pub use elastic::{ElasticStates, Identified, KnownMode, KnownModes};
pub use filter::{AttitudeFilterState, Correction};
pub use gains::{Complementary, Form};
pub use history::{FilterHistory, Fix};
pub use measurement::{AttitudeMeasurement, GyroNoise};
pub use spec::{AttitudeFilter, AttitudeSetting, Initial, Role};
pub use swinging::Swinging;
