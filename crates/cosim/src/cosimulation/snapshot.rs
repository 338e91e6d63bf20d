//! State of a co-simulation as bytes, and its restoration.

use super::{CoSimulation, set_inputs};
use crate::error::CoSimulationError;
use crate::journal::InputJournal;
use crate::moment::Moment;

impl CoSimulation {
    /// Returns the state as bytes: everything that the importer has set, from which the run can be repeated.
    pub fn to_bytes(&self) -> Vec<u8> {
        let reached = Moment::new(self.simulation.time(), self.is_complete);
        InputJournal { reached: self.has_begun.then_some(reached), ..self.journal.clone() }.to_bytes()
    }

    /// Restores the state of [`Self::to_bytes`] by repeating the run, which takes the time of the run.
    ///
    /// # Errors
    /// Fails for damaged bytes and those of another FMU.
    pub fn restored(&self, bytes: &[u8]) -> Result<Self, CoSimulationError> {
        let mut run = Self::new(self.content.clone())?;
        run.journal = InputJournal::from_bytes(bytes, &self.journal.token, self.table.input_count())?;
        // Before the start nothing was built with the parameters, which may not fit.
        let Some(reached) = run.journal.reached else { return Ok(run) };
        run.rebuild()?;
        if reached.at() > run.simulation.end() {
            return Err(CoSimulationError::after_end());
        }
        run.has_begun = true;
        let mut before: Option<Vec<u64>> = None;
        for change in run.journal.applied.clone().changes() {
            run.repeat_to(change.from)?;
            let mut bits = before.clone().unwrap_or_else(|| vec![0; run.table.input_count()]);
            change.apply(&mut bits);
            set_inputs(&mut run.simulation, &run.table, &bits, before.as_deref());
            before = Some(bits);
            run.is_complete = false;
        }
        run.guarded(|simulation| simulation.open(&mut ()))?;
        run.repeat_to(reached)?;
        Ok(run)
    }

    /// Repeats the run up to a moment.
    fn repeat_to(&mut self, moment: Moment) -> Result<(), CoSimulationError> {
        if moment.at() > self.simulation.time() {
            self.is_complete = false;
            self.guarded(|simulation| simulation.run_up_to(moment.at(), &mut ()))?;
        }
        if moment.is_complete && !self.is_complete {
            self.guarded(|simulation| simulation.complete_instant(&mut ()))?;
            self.is_complete = true;
        }
        Ok(())
    }
}
