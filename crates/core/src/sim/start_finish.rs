//! Start and end of a run.

use flexsc_control::law::Event;
use flexsc_record::Record;

use super::{Simulation, SimulationError};

impl Simulation {
    /// Begins the run after its first sample: first decision, first motion segment, first rows.
    pub(super) fn begin(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.plant.evaluate(self.now)?;
        self.ask_laws(Event::Start);
        self.set_magnetic_field();
        let rigid = self.plant.truth().rigid;
        self.loads.command(self.now, self.controllers.outputs(), &self.estimates, rigid);
        self.external_command_pending = false;
        self.loads.serve(self.now, rigid);
        self.begin_segment(record)?;
        self.declare_tuned_parameter();
        self.update_rotor_states(self.now);
        self.record_initial_bearings();
        self.check_custom_parts()?;
        self.record_start(record)
    }

    /// Ends the run if it is at its end and has not been ended yet.
    pub(super) fn finish(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        if self.now == self.end && self.recorder.close() {
            self.plant.record_pieces(self.now, &self.applied, record)?;
            self.recorder.journal_end(self.now, record)?;
        }
        Ok(())
    }
}
