//! Attitude and gyro bias, by a multiplicative extended Kalman filter to which measurements may be late.

mod at_work;
mod elastic;
mod filter;
mod gains;
mod history;
#[cfg(test)]
mod loop_tests;
mod measurement;
mod spec;
mod swinging;
#[cfg(test)]
mod tests;

pub use at_work::Tracking;
pub use elastic::{ElasticStates, KnownMode, KnownModes};
pub use filter::{Correction, Filter};
pub use gains::{Complementary, Form};
pub use history::{Fix, History};
pub use measurement::{GyroNoise, Measured};
pub use spec::{AttitudeFilter, Initial, Role, Setting};
pub use swinging::Swinging;
