//! Start and end of a run.

use super::{Simulation, SimulationError};
use crate::law::Event;
use crate::record::Record;

impl Simulation {
    /// Begins the run after its first sample: first decision, first motion segment, first rows.
    pub(super) fn begin(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.plant.view(self.now)?;
        self.ask(Event::Start);
        self.feel();
        let rigid = self.plant.viewed().rigid;
        self.drive.command(self.now, self.laws.commands(), &self.beliefs, rigid);
        self.steered = false;
        self.drive.serve(self.now, rigid);
        self.depart(record)?;
        self.name_tuned();
        self.turned(self.now);
        self.tell_first_slips();
        self.check_own_parts()?;
        self.tell_begin(record)
    }

    /// Ends the run if it is at its end and has not been ended yet.
    pub(super) fn finish(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        if self.now == self.end && self.telling.close() {
            self.plant.tell_course(self.now, &self.exerted, record)?;
            self.telling.journal_end(self.now, record)?;
        }
        Ok(())
    }
}
