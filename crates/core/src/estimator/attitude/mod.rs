//! Attitude and gyro bias, by a multiplicative extended Kalman filter to which measurements may be late.

mod at_work;
mod filter;
mod gains;
mod history;
#[cfg(test)]
mod loop_tests;
mod spec;
#[cfg(test)]
mod tests;

pub use at_work::Tracking;
pub use filter::{Correction, Filter, GyroNoise};
pub use gains::{Complementary, Form};
pub use history::{Fix, History, Measured};
pub use spec::{AttitudeFilter, Initial, Role, Setting};
