//! Start and end of a run.

use flexsc_control::law::Event;
use flexsc_record::Record;

use super::{Simulation, SimulationError};

impl Simulation {
    /// Begins the run after its first sample: first decision, first motion segment, first rows.
    pub(super) fn begin(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.clock.now();
        self.plant.evaluate(now)?;
        let speeds = || self.loads.wheel_speeds(now, self.plant.truth().rigid_rate);
        let estimates = &mut self.estimation.estimates;
        self.laws.decide_uncounted(now, Event::Start, &self.guidance, estimates, &speeds);
        self.command_actuator();
        self.loads.apply_due_changes(now, self.plant.truth(), &self.estimation.estimates);
        self.trace_unloading(now);
        self.begin_segment(record)?;
        if let Some(search) = self.estimation.search().or(self.laws.objective.search()) {
            // The value of a tuned parameter is logged from the start on.
            let (key, value) = search.parameter();
            let key = key.to_owned();
            self.laws.tune(&key, value);
        }
        self.loads.update_rotor_states(now, &self.plant);
        self.check_custom_parts()?;
        self.clock.begin_cycles();
        if let Some(event) = self.operation.first_event(now) {
            self.recorder.record_mode(now, &event, record)?;
        }
        if record.wants_requirement_signals() {
            self.requirements.keep_signals();
        }
        self.update_requirements(|requirements, run| requirements.observe(run, true));
        let (run, recorder) = self.view();
        Ok(recorder.record_start(&run, record)?)
    }

    /// Ends the run if it is at its end and has not been ended yet.
    pub(super) fn finish(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.clock.now();
        if now == self.clock.end() && self.recorder.close() {
            self.plant.record_pieces(now, &self.loads.applied, record)?;
            self.end_requirement_segment();
            self.requirements.finish(now, record)?;
            self.check_custom_parts()?;
            self.recorder.journal_end(now, record)?;
        }
        Ok(())
    }
}
