//! Co-simulation of a scenario: values of its variables, steps from one communication point to the next, and its states.
//!
//! Communication points are questions and change nothing. Only events of the run, and inputs whose bits have changed, begin
//! a new segment of motion. The current instant is an integer number of femtoseconds; the importer's double names it.

mod snapshot;
mod values;

use flexsc_core::control::law::Command;
use flexsc_core::numerics::time::Instant;
use flexsc_core::{Scenario, Simulation, SimulationError, StopAt, Telemetry};

use crate::communication_point::{CommunicationPoint, step_end};
use crate::content::{FmuContent, FmuPart};
use crate::error::CoSimulationError;
use crate::journal::InputJournal;
use crate::moment::Moment;
use crate::variable_table::VariableTable;

/// Result of a step.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct StepResult {
    /// Time (s) that the run has reached, rounded to a double.
    pub reached: f64,
    /// True if the step stopped at an event whose response is pending.
    pub is_event: bool,
    /// True if the step stopped before its end.
    pub is_early: bool,
}

/// Run of a scenario behind the variables of an FMU. A clone is a snapshot.
#[derive(Clone, Debug)]
pub struct CoSimulation {
    content: FmuContent,
    scenario: Scenario,
    table: VariableTable,
    simulation: Simulation,
    /// Everything that the importer has set.
    journal: InputJournal,
    /// True from the start on.
    has_begun: bool,
    /// True if everything that is due at the current instant has been done.
    is_complete: bool,
    /// Observation at the current instant, if it was read there.
    observed: Option<Vec<f64>>,
    /// Readings, estimates and references that laws read at the current instant, if they were read there.
    telemetry: Option<Telemetry>,
    /// Error that ended the run.
    failure: Option<String>,
}

impl CoSimulation {
    /// Creates the run, before its start.
    ///
    /// # Errors
    /// Fails for an invalid scenario.
    pub fn new(content: FmuContent) -> Result<Self, CoSimulationError> {
        let scenario = content.scenario()?;
        let simulation = Simulation::new(&scenario, 0);
        let table = VariableTable::new(&scenario, &simulation, content.part);
        let journal = InputJournal::new(&content, scenario.seed, table.input_count());
        Ok(Self {
            content,
            scenario,
            table,
            simulation,
            journal,
            has_begun: false,
            is_complete: false,
            observed: None,
            telemetry: None,
            failure: None,
        })
    }

    /// Returns the variables.
    pub fn table(&self) -> &VariableTable {
        &self.table
    }

    /// Returns the scenario, with the parameters that were set before the start.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Returns true from the start on.
    pub fn has_begun(&self) -> bool {
        self.has_begun
    }

    /// Returns the current time (s), rounded to a double.
    pub fn time(&self) -> f64 {
        self.simulation.time().seconds()
    }

    /// Begins the run with the parameters and inputs that are set: the sensors measure, and the laws of a closed loop decide.
    /// The run ends at `stop_time` (s), if that is later than the scenario's end.
    ///
    /// # Errors
    /// Fails for invalid parameters.
    pub fn begin(&mut self, stop_time: Option<f64>) -> Result<(), CoSimulationError> {
        self.journal.set_stop_time(stop_time);
        self.rebuild()?;
        self.has_begun = true;
        self.apply_inputs();
        self.guarded(|simulation| simulation.open(&mut ()))?;
        if self.content.part == FmuPart::Loop {
            self.complete()?;
        }
        self.clear_clocks();
        Ok(())
    }

    /// Creates the simulation again, with the parameters that are set.
    fn rebuild(&mut self) -> Result<(), CoSimulationError> {
        self.scenario = self.journal.scenario(&self.content)?;
        self.simulation = Simulation::new(&self.scenario, 0);
        self.observed = None;
        self.telemetry = None;
        Ok(())
    }

    /// Advances the run from a communication point (s) by `size` seconds; stops at the first event on the way if
    /// `stop_at_events`.
    ///
    /// # Errors
    /// Fails if the run is not at `from`, at the end of the run, and if the run fails.
    pub fn step(
        &mut self,
        from: f64,
        size: f64,
        stop_at_events: bool,
    ) -> Result<StepResult, CoSimulationError> {
        let (now, grid) = (self.time(), self.journal.grid_ns);
        let end = self.simulation.end();
        let target = step_end(from, size, now, end, grid)?;
        let point = CommunicationPoint::new(target, grid).until(end);
        self.clear_clocks();
        self.apply_inputs();
        self.complete()?;
        let mut is_event = false;
        while self.advance_to_event(point)? {
            let here = self.simulation.time();
            let is_end = here >= point.at || (grid == 0 && here.seconds() == target);
            if stop_at_events || is_end {
                is_event = stop_at_events;
                break;
            }
            self.complete()?;
        }
        if self.content.part == FmuPart::Loop && !stop_at_events {
            self.complete()?;
        }
        let here = self.simulation.time();
        let is_early = is_event && here < point.at && here.seconds() < target;
        Ok(StepResult { reached: if is_early { here.seconds() } else { target }, is_event, is_early })
    }

    /// Advances to the next event, at most to the communication point; returns true if there was one.
    fn advance_to_event(&mut self, point: CommunicationPoint) -> Result<bool, CoSimulationError> {
        let now = self.simulation.time();
        let is_ahead = |next: &Instant| *next > now && *next <= point.latest;
        let until = match self.simulation.next_event().filter(is_ahead) {
            Some(next) if next > point.at => next,
            _ => point.at,
        };
        if until <= now {
            return Ok(false);
        }
        let sample = self.simulation.next_sample();
        self.is_complete = false;
        let came = self.guarded(|simulation| simulation.run_to_next(StopAt::Any, until, &mut ()))?;
        if came {
            let here = self.simulation.time();
            let counts = &mut self.journal.counts;
            counts.events += 1;
            counts.last_event = here.parts();
            counts.has_sampled = sample == Some(here);
        }
        Ok(came)
    }

    /// Enters the event at which a step has stopped: the laws of a closed loop respond, while a plant waits for commands.
    ///
    /// # Errors
    /// Fails if the run fails.
    pub fn enter_event(&mut self) -> Result<(), CoSimulationError> {
        if self.content.part == FmuPart::Loop { self.complete() } else { Ok(()) }
    }

    /// Ends an event: the inputs that have changed act from now on, and everything that is due is done.
    ///
    /// # Errors
    /// Fails if the run fails.
    pub fn end_event(&mut self) -> Result<(), CoSimulationError> {
        self.apply_inputs();
        self.complete()?;
        self.clear_clocks();
        Ok(())
    }

    fn clear_clocks(&mut self) {
        let counts = &mut self.journal.counts;
        (counts.has_sampled, counts.has_switched) = (false, false);
    }

    /// Does everything that is due at the current instant.
    fn complete(&mut self) -> Result<(), CoSimulationError> {
        if !self.is_complete {
            let has_switched = self.guarded(|simulation| simulation.complete_instant(&mut ()))?;
            self.is_complete = true;
            if has_switched {
                self.journal.counts.switchings += 1;
                self.journal.counts.has_switched = true;
            }
        }
        Ok(())
    }

    /// Applies the inputs if the bits of any have changed.
    fn apply_inputs(&mut self) {
        let inputs = &self.journal.inputs;
        let before = self.journal.applied.last();
        let is_changed = before.map_or_else(
            || self.table.is_commanded || inputs.iter().any(|bits| *bits != 0),
            |before| before != inputs,
        );
        if is_changed {
            let from = Moment::new(self.simulation.time(), self.is_complete);
            set_inputs(&mut self.simulation, &self.table, inputs, before);
            self.journal.applied.add(from, &self.journal.inputs);
            self.is_complete = false;
        }
    }

    /// Lets the simulation do something that can fail; after a failure it does nothing.
    fn guarded<T>(
        &mut self,
        action: impl FnOnce(&mut Simulation) -> Result<T, SimulationError>,
    ) -> Result<T, CoSimulationError> {
        if let Some(failure) = &self.failure {
            let why = format!("{failure}\n\nhint: reset the FMU, or set an earlier state");
            return Err(CoSimulationError::refused(why));
        }
        self.observed = None;
        self.telemetry = None;
        action(&mut self.simulation).map_err(|source| {
            self.failure = Some(format!("{}: {source}", self.scenario.name));
            CoSimulationError::Run { name: self.scenario.name.clone(), source }
        })
    }
}

/// Sets the inputs that differ from those before: external torques, then commands.
fn set_inputs(simulation: &mut Simulation, table: &VariableTable, bits: &[u64], before: Option<&[u64]>) {
    let axes = table.axes;
    let about =
        |values: &[u64]| [0, 1, 2].map(|axis| values.get(axis).map_or(0.0, |bits| f64::from_bits(*bits)));
    let (torques, commands) = bits.split_at(axes);
    let (old_torques, old_commands) =
        before.map_or((None, None), |before| (Some(&before[..axes]), Some(&before[axes..])));
    let is_first = old_torques.is_none() && torques.iter().all(|bits| *bits == 0);
    if !is_first && old_torques != Some(torques) {
        simulation.set_external_torque(about(torques));
    }
    if table.is_commanded && old_commands != Some(commands) {
        simulation.set_external_command(about(commands).map(Command::Torque));
    }
}
