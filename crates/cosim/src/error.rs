//! Errors of a co-simulation and of the export of an FMU.

use flexsc_core::{ScenarioError, SimulationError};
use thiserror::Error;

/// Error of a co-simulation.
#[derive(Debug, Error)]
pub enum CoSimulationError {
    /// Invalid scenario, or invalid values of its keys.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// Failed run.
    #[error("{name}: {source}")]
    Run {
        /// Name of the scenario.
        name: String,
        /// Cause of the failure.
        source: SimulationError,
    },
    /// Request that cannot be met.
    #[error("{0}")]
    Refused(String),
}

impl CoSimulationError {
    /// Creates the error of a request that cannot be met.
    pub fn refused(why: impl Into<String>) -> Self {
        Self::Refused(why.into())
    }

    /// Creates the error of a serialised state that is later than its run ends.
    pub fn after_end() -> Self {
        Self::refused("the serialised state is damaged: it is after the end of the run")
    }

    /// Creates the error of a value reference that stands for no variable of a kind.
    pub fn no_variable(reference: u32, kind: &str) -> Self {
        Self::Refused(format!("there is no {kind} variable with the value reference {reference}"))
    }
}
