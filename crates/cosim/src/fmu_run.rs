//! Run behind the variables of an FMU: that of a spacecraft, or of laws alone.

use flexsc_core::Scenario;
use flexsc_core::numerics::time::Span;

use crate::content::{FmuContent, FmuPart};
use crate::controller_run::ControllerRun;
use crate::cosimulation::{CoSimulation, StepResult};
use crate::error::CoSimulationError;
use crate::variable_table::VariableTable;

/// Result of an access.
type Access<T> = Result<T, CoSimulationError>;

/// Run behind the variables of an FMU. A clone is a snapshot.
#[derive(Clone, Debug)]
pub enum FmuRun {
    /// Closed loop, or plant.
    Spacecraft(Box<CoSimulation>),
    /// Laws alone.
    Laws(Box<ControllerRun>),
}

impl FmuRun {
    /// Creates the run of the part of an FMU's content, before its start.
    ///
    /// # Errors
    /// Fails for an invalid scenario, and for laws that cannot run alone.
    pub fn new(content: FmuContent) -> Access<Self> {
        Ok(if content.part == FmuPart::Controller {
            Self::Laws(Box::new(ControllerRun::new(content)?))
        } else {
            Self::Spacecraft(Box::new(CoSimulation::new(content)?))
        })
    }

    /// Returns the variables.
    pub fn table(&self) -> &VariableTable {
        match self {
            Self::Spacecraft(run) => run.table(),
            Self::Laws(run) => run.table(),
        }
    }

    /// Returns the scenario, with the parameters that were set before the start.
    pub fn scenario(&self) -> &Scenario {
        match self {
            Self::Spacecraft(run) => run.scenario(),
            Self::Laws(run) => run.scenario(),
        }
    }

    /// Returns true from the start on.
    pub fn has_begun(&self) -> bool {
        match self {
            Self::Spacecraft(run) => run.has_begun(),
            Self::Laws(run) => run.has_begun(),
        }
    }

    /// Returns the current time (s), rounded to a double.
    pub fn time(&self) -> f64 {
        match self {
            Self::Spacecraft(run) => run.time(),
            Self::Laws(run) => run.time(),
        }
    }

    /// Begins the run with the parameters and inputs that are set, up to a stop time (s) if there is one.
    ///
    /// # Errors
    /// Fails for invalid parameters.
    pub fn begin(&mut self, stop_time: Option<f64>) -> Access<()> {
        match self {
            Self::Spacecraft(run) => run.begin(stop_time),
            Self::Laws(run) => run.begin(stop_time),
        }
    }

    /// Advances the run from a communication point (s) by `size` seconds; stops at the first event on the way if
    /// `stop_at_events`.
    ///
    /// # Errors
    /// Fails if the run is not at `from`, at its end, and if it fails.
    pub fn step(&mut self, from: f64, size: f64, stop_at_events: bool) -> Access<StepResult> {
        match self {
            Self::Spacecraft(run) => run.step(from, size, stop_at_events),
            Self::Laws(run) => run.step(from, size, stop_at_events),
        }
    }

    /// Enters the event at which a step has stopped.
    ///
    /// # Errors
    /// Fails if the run fails.
    pub fn enter_event(&mut self) -> Access<()> {
        match self {
            Self::Spacecraft(run) => run.enter_event(),
            Self::Laws(_) => Ok(()),
        }
    }

    /// Ends an event: the inputs that have changed act from now on.
    ///
    /// # Errors
    /// Fails if the run fails.
    pub fn end_event(&mut self) -> Access<()> {
        match self {
            Self::Spacecraft(run) => run.end_event(),
            Self::Laws(run) => {
                run.end_event();
                Ok(())
            }
        }
    }

    /// Returns the value of a floating-point variable.
    ///
    /// # Errors
    /// Fails for a reference of another kind, and if the state is no longer finite.
    pub fn get(&mut self, reference: u32) -> Access<f64> {
        match self {
            Self::Spacecraft(run) => run.get(reference),
            Self::Laws(run) => run.get(reference),
        }
    }

    /// Returns the value of an integer variable.
    ///
    /// # Errors
    /// Fails for a reference of another kind.
    pub fn get_integer(&mut self, reference: u32) -> Access<i64> {
        match self {
            Self::Spacecraft(run) => run.get_integer(reference),
            Self::Laws(run) => run.get_integer(reference),
        }
    }

    /// Sets an input, or a parameter before the start.
    ///
    /// # Errors
    /// Fails for a value that is not finite, for a reference of another kind and for a parameter after the start.
    pub fn set(&mut self, reference: u32, value: f64) -> Access<()> {
        match self {
            Self::Spacecraft(run) => run.set(reference, value),
            Self::Laws(run) => run.set(reference, value),
        }
    }

    /// Sets an integer parameter before the start.
    ///
    /// # Errors
    /// Fails for a negative value, for a reference of another kind and after the start.
    pub fn set_integer(&mut self, reference: u32, value: i64) -> Access<()> {
        match self {
            Self::Spacecraft(run) => run.set_integer(reference, value),
            Self::Laws(run) => run.set_integer(reference, value),
        }
    }

    /// Returns true if an output clock ticks at the current event.
    ///
    /// # Errors
    /// Fails for a reference that is no clock.
    pub fn clock(&self, reference: u32) -> Access<bool> {
        match self {
            Self::Spacecraft(run) => run.clock(reference),
            Self::Laws(run) => run.interval(reference).map(|_| false),
        }
    }

    /// Returns the interval of a periodic clock.
    ///
    /// # Errors
    /// Fails for a reference that is no periodic clock.
    pub fn interval(&self, reference: u32) -> Access<Span> {
        match self {
            Self::Spacecraft(run) => run.interval(reference),
            Self::Laws(run) => run.interval(reference),
        }
    }

    /// Returns the state as bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        match self {
            Self::Spacecraft(run) => run.to_bytes(),
            Self::Laws(run) => run.to_bytes(),
        }
    }

    /// Restores the state of [`Self::to_bytes`] by repeating the run.
    ///
    /// # Errors
    /// Fails for damaged bytes and those of another FMU.
    pub fn restored(&self, bytes: &[u8]) -> Access<Self> {
        Ok(match self {
            Self::Spacecraft(run) => Self::Spacecraft(Box::new(run.restored(bytes)?)),
            Self::Laws(run) => Self::Laws(Box::new(run.restored(bytes)?)),
        })
    }
}
