//! Command with the smallest integral of its square.

use flexsc_dynamics::waveform::Waveform;
use flexsc_formats::document::ConfigError;

use super::adjoint::Adjoint;
use super::suppression::Zero;
use super::task::RestToRestTask;

/// Plans the command: the sum of adjoint functions that has the task's products with each.
pub fn plan(task: &RestToRestTask, zeros: &[Zero]) -> Result<Waveform, ConfigError> {
    let adjoint = Adjoint::new(task.time, zeros);
    match adjoint.least(&adjoint.products(task)) {
        Some(weights) => Ok(adjoint.waveform(&weights)),
        None => Err(too_short(task.time)),
    }
}

/// Returns the fault of a time that is too short for the zeros.
pub fn too_short(time: f64) -> ConfigError {
    let why = format!("must be longer for the modes that are to be at rest after it, got {time} s");
    ConfigError::new("time", why)
}
