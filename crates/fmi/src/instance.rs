//! Instance of an FMU: a run with the mode in which the importer has it, for both versions of FMI.

use std::ffi::c_int;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use flexsc_cosim::{CoSimulationError, FmuContent, FmuRun};

use crate::boundary::Held;
use crate::logger::Logger;

/// Status of a call that succeeded.
pub const OK: c_int = 0;
/// Status of a step that an importer may repeat with another size.
pub const DISCARD: c_int = 2;
/// Status of a call that failed.
pub const ERROR: c_int = 3;
/// Status of an instance that cannot be used any more.
pub const FATAL: c_int = 4;

/// Result of a call.
pub type Outcome = Result<(), CoSimulationError>;

/// Mode of an instance.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum InstanceMode {
    /// Before the initialization.
    Instantiated,
    /// Structural parameters can be set.
    Configuration,
    /// Parameters and inputs can be set, and outputs read.
    Initialization,
    /// At an event.
    Event,
    /// Between steps.
    Step,
    /// After the end.
    Terminated,
}

/// Options that an importer states when it creates an instance.
pub struct InstanceOptions {
    /// Name of the instance.
    pub name: String,
    /// Token of the model description.
    pub token: String,
    /// True if steps stop at events.
    pub stops_at_events: bool,
    /// True if the importer uses the event mode.
    pub uses_event_mode: bool,
    /// Receiver of messages.
    pub logger: Logger,
}

/// Run with its mode.
pub struct Instance {
    pub run: FmuRun,
    pub mode: InstanceMode,
    pub options: InstanceOptions,
    /// Stop time (s) that the importer has stated.
    pub stop_time: Option<f64>,
    content: FmuContent,
    is_broken: bool,
}

/// Snapshot of an instance.
#[derive(Clone)]
pub struct InstanceState {
    run: FmuRun,
    mode: InstanceMode,
}

/// Returns the error of a call that is not possible.
pub fn refused(why: &str) -> CoSimulationError {
    CoSimulationError::Refused(why.to_owned())
}

/// Returns the error of a null pointer.
pub fn no_pointer() -> CoSimulationError {
    refused("a pointer is null")
}

impl Instance {
    /// Creates an instance with the resources in a directory; sends a message and returns null if that fails.
    pub fn create(resources: &Path, options: InstanceOptions) -> Held<Self> {
        let (name, logger) = (options.name.clone(), options.logger);
        let report = |why: &str| {
            logger.send(&name, ERROR, why);
            Held::null()
        };
        match catch_unwind(AssertUnwindSafe(|| Self::new(resources, options))) {
            Ok(Ok(instance)) => Held::new(instance),
            Ok(Err(error)) => report(&error.to_string()),
            Err(_) => report("internal error: the scenario cannot be loaded"),
        }
    }

    fn new(resources: &Path, options: InstanceOptions) -> Result<Self, CoSimulationError> {
        let content = FmuContent::read(resources)?;
        if options.token != content.token() {
            return Err(refused(
                "the resources of the FMU do not belong to its model description: the token differs\n\nhint: export the FMU again",
            ));
        }
        Ok(Self {
            run: FmuRun::new(content.clone())?,
            mode: InstanceMode::Instantiated,
            options,
            stop_time: None,
            content,
            is_broken: false,
        })
    }

    /// Returns an error unless the instance is in one of these modes.
    pub fn in_mode(&self, accepted: &[InstanceMode]) -> Outcome {
        if accepted.contains(&self.mode) {
            return Ok(());
        }
        let modes: Vec<String> = accepted.iter().map(|mode| format!("{mode:?}")).collect();
        let why = format!(
            "the function is called in the mode {:?}, and is allowed in {}",
            self.mode,
            modes.join(", ")
        );
        Err(CoSimulationError::Refused(why))
    }

    /// Begins the run, at the end of the initialization.
    pub fn begin(&mut self) -> Outcome {
        self.in_mode(&[InstanceMode::Initialization])?;
        self.run.begin(self.stop_time)?;
        self.mode = if self.options.uses_event_mode { InstanceMode::Event } else { InstanceMode::Step };
        Ok(())
    }

    /// Begins the initialization.
    pub fn initialize(&mut self, start_time: f64, stop_time: Option<f64>) -> Outcome {
        self.in_mode(&[InstanceMode::Instantiated])?;
        if start_time != 0.0 {
            let why = format!("the run starts at 0 s, and the start time is {start_time:?} s");
            return Err(CoSimulationError::Refused(why));
        }
        self.stop_time = stop_time;
        self.mode = InstanceMode::Initialization;
        Ok(())
    }

    /// Resets the instance to its state after the creation.
    pub fn reset(&mut self) -> Outcome {
        self.run = FmuRun::new(self.content.clone())?;
        self.mode = InstanceMode::Instantiated;
        self.stop_time = None;
        Ok(())
    }

    /// Returns a snapshot.
    pub fn snapshot(&self) -> InstanceState {
        InstanceState { run: self.run.clone(), mode: self.mode }
    }

    /// Restores a snapshot.
    pub fn restore(&mut self, state: &InstanceState) {
        let InstanceState { run, mode } = state.clone();
        (self.run, self.mode) = (run, mode);
    }

    /// Returns the number of the mode and the bytes of the run of a snapshot.
    pub fn to_bytes(state: &InstanceState) -> Vec<u8> {
        let mut bytes = vec![state.mode as u8];
        bytes.extend(state.run.to_bytes());
        bytes
    }

    /// Returns the snapshot of these bytes.
    pub fn snapshot_from_bytes(&self, bytes: &[u8]) -> Result<InstanceState, CoSimulationError> {
        let modes = [
            InstanceMode::Instantiated,
            InstanceMode::Configuration,
            InstanceMode::Initialization,
            InstanceMode::Event,
            InstanceMode::Step,
            InstanceMode::Terminated,
        ];
        let damaged = || refused("the serialised state is damaged: there is no such mode");
        let (first, rest) = bytes.split_first().ok_or_else(damaged)?;
        let mode = modes.into_iter().find(|mode| *mode as u8 == *first).ok_or_else(damaged)?;
        let run = self.run.restored(rest)?;
        let follows_start =
            matches!(mode, InstanceMode::Event | InstanceMode::Step | InstanceMode::Terminated);
        if run.has_begun() != follows_start {
            return Err(refused("the serialised state is damaged: its mode and its start do not fit"));
        }
        Ok(InstanceState { run, mode })
    }
}

/// Calls an action with the instance, sends the message of an error, and returns the status. A panic does not leave the
/// library.
pub fn call(mut held: Held<Instance>, action: impl FnOnce(&mut Instance) -> Outcome) -> c_int {
    let Some(instance) = held.get() else { return ERROR };
    if instance.is_broken {
        return FATAL;
    }
    let (status, message) = match catch_unwind(AssertUnwindSafe(|| action(instance))) {
        Ok(Ok(())) => return OK,
        Ok(Err(error)) => (ERROR, error.to_string()),
        Err(_) => {
            instance.is_broken = true;
            (FATAL, "internal error: the instance cannot be used any more".to_owned())
        }
    };
    instance.options.logger.send(&instance.options.name, status, &message);
    status
}
