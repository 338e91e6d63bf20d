//! Recorder of a run: when its rows and journal lines are due. It reads the parts of the run and changes none of them.

mod accelerometers;
mod bearing_rows;
mod blinding_rows;
mod cycle_rows;
mod failures;
mod journal;
mod journal_events;
mod lines_of_sight;
mod manoeuvre_end;
mod motion_rows;
mod reports;
mod requirement_samples;
mod scene_frames;

use flexsc_control::estimator::{EnvelopeWindow, ObjectiveWindow};
use flexsc_numerics::time::{Instant, Span};

use flexsc_record::{ModeEvent, Record, RecordError, Report, Sample};

use super::controllers::LawDecision;
use super::guidance::Guidance;
use super::run_view::RunView;
use accelerometers::Accelerometers;
use bearing_rows::BearingRows;
use blinding_rows::BlindingRows;
use cycle_rows::CycleRows;
use failures::Failures;
use flexsc_scenario::Scenario;
use journal_events::JournalEvents;
use lines_of_sight::LinesOfSight;
use manoeuvre_end::ManoeuvreEnd;
use motion_rows::MotionRows;
use requirement_samples::RequirementSamples;
use scene_frames::SceneFrames;

/// Schedule and memory of everything that a run writes to its record.
#[derive(Clone, Debug)]
pub struct Recorder {
    journal: JournalEvents,
    motion: MotionRows,
    cycles: CycleRows,
    bearings: BearingRows,
    blinding: BlindingRows,
    /// Pending end of the manoeuvre, if any.
    manoeuvre_end: Option<ManoeuvreEnd>,
    accelerometers: Accelerometers,
    lines_of_sight: LinesOfSight,
    requirements: RequirementSamples,
    failures: Failures,
    frames: SceneFrames,
    /// Report of the last sample, whose memory is used again.
    sample_report: Report,
    /// Instant at which the next row or journal line is due.
    due: Option<Instant>,
}

impl Recorder {
    /// Creates the schedule of a scenario's run, before its start.
    pub fn new(scenario: &Scenario, guidance: &Guidance, run: u64) -> Self {
        let mut recorder = Self {
            journal: JournalEvents::new(scenario, run),
            motion: MotionRows::new(scenario),
            cycles: CycleRows::new(scenario),
            bearings: BearingRows::default(),
            blinding: BlindingRows::new(scenario),
            manoeuvre_end: ManoeuvreEnd::new(scenario, &guidance.setpoint),
            accelerometers: Accelerometers::new(scenario, run),
            lines_of_sight: LinesOfSight::new(scenario),
            requirements: RequirementSamples::new(scenario),
            failures: Failures::new(scenario),
            frames: SceneFrames::default(),
            sample_report: Report::new(),
            due: None,
        };
        recorder.update_due();
        recorder
    }

    /// Returns the instant at which the next row or journal line is due.
    #[inline]
    pub fn due(&self) -> Option<Instant> {
        self.due
    }

    /// Finds the instant at which the next row or journal line is due.
    fn update_due(&mut self) {
        let due = [
            self.manoeuvre_end.as_ref().map(|end| end.at),
            self.motion.due(),
            self.frames.due(),
            self.failures.due(),
            self.accelerometers.due(),
            self.lines_of_sight.due(),
            self.requirements.due(),
        ];
        self.due = due.into_iter().flatten().min();
    }

    /// Returns true if no row is due at an instant of its own, and no scene is drawn.
    pub fn is_idle(&self) -> bool {
        self.due().is_none() && !self.frames.is_drawn()
    }

    /// Returns the period of the rows of a dense record.
    pub fn log_period(&self) -> Span {
        self.motion.period()
    }

    /// Returns the last sample of an accelerometer (m/s²) and the instant at which it became available.
    pub fn last_accelerations(&self, sensor: usize) -> Option<(Instant, &[f64])> {
        self.accelerometers.latest(sensor)
    }

    /// Opens the journal once; returns true if this call opened it.
    pub fn open(&mut self, now: Instant, record: &mut dyn Record) -> Result<bool, RecordError> {
        self.journal.open(now, record)
    }

    /// Closes the journal once; returns true if this call closed it.
    pub fn close(&mut self) -> bool {
        self.journal.close()
    }

    /// Records the last lines of the run's journal.
    pub fn journal_end(&self, now: Instant, record: &mut dyn Record) -> Result<(), RecordError> {
        for line in self.cycles.saturation_warnings(now) {
            self.journal.warned(now, "actuators", line, record)?;
        }
        self.journal.end(now, record)
    }

    /// Records that the run is stopped before its end.
    pub fn journal_interruption(&self, now: Instant, record: &mut dyn Record) -> Result<(), RecordError> {
        self.journal.interrupted(now, record)
    }

    /// Records the rows of the start.
    pub fn record_start(&mut self, run: &RunView<'_>, record: &mut dyn Record) -> Result<(), RecordError> {
        self.bearings.begin(run.plant);
        self.blinding.record_events(run, &self.journal, record)?;
        self.motion.record_start(run, record)?;
        self.frames.record_scene(run.now, &self.journal, record)?;
        self.update_due();
        Ok(())
    }

    /// Records the rows that are due, after all parts have acted; those of a cycle of three axes if `is_cycle`.
    #[inline]
    pub fn record_instant(
        &mut self,
        run: &RunView<'_>,
        is_cycle: bool,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let is_due = self.due.is_some_and(|due| due <= run.now);
        self.bearings.record_events(run, &self.journal, record)?;
        self.blinding.record_events(run, &self.journal, record)?;
        if is_due {
            self.failures.record_due(run.now, &self.journal, record)?;
            self.accelerometers.record_due(run, record)?;
            self.requirements.record_scopes(run, record)?;
            self.lines_of_sight.record_due(run, record)?;
            self.requirements.record_due(run, record)?;
        }
        if is_cycle {
            self.cycles.record(run, &mut self.journal, record)?;
        }
        self.motion.record_due(run, record)?;
        self.frames.record_due(run, &self.journal, record)?;
        if is_due {
            self.update_due();
        }
        Ok(())
    }

    /// Records the motion at the current instant, and the law's row of a one-axis body.
    pub fn record_now(&self, run: &RunView<'_>, record: &mut dyn Record) -> Result<(), RecordError> {
        self.motion.record_now(run, record)
    }

    /// Records a decision in which the one-axis law has changed its state.
    #[inline]
    pub fn record_switching(
        &self,
        run: &RunView<'_>,
        decision: LawDecision,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        self.motion.record_switching(run, decision, record)
    }

    /// Records the start of a mode of operation.
    pub fn record_mode(
        &self,
        now: Instant,
        event: &ModeEvent,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        record.record(now, Sample::Row(event))?;
        self.journal.mode_entered(now, event, record)
    }

    /// Records the estimates after the current sample, and journals losses of lock.
    #[inline]
    pub fn record_estimates(
        &mut self,
        run: &RunView<'_>,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let estimation = run.estimation;
        self.journal.lock_changed(
            run.now,
            estimation.estimator.lock_lost(),
            estimation.axis_count(),
            record,
        )?;
        if !record.wants_estimates(run.now) {
            return Ok(());
        }
        self.sample_report.clear();
        run.add_sample(&mut self.sample_report);
        run.record_report(&self.sample_report, record)
    }

    /// Records the end of the manoeuvre, if it is at the current instant.
    #[inline]
    pub fn record_manoeuvre_end(
        &mut self,
        run: &RunView<'_>,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let now = run.now;
        let Some(end) = self.manoeuvre_end.take_if(|end| end.at == now) else { return Ok(()) };
        self.update_due();
        let row = end.row(run.plant.truth(), &run.plant.about_axis(0, run.estimation.origin()));
        record.record(now, Sample::Row(&row))?;
        self.journal.manoeuvre_ended(now, &row, record)
    }

    /// Records a closed window of the envelope, if there is one, and the step of the adaptation.
    #[inline]
    pub fn record_envelope_window(
        &self,
        now: Instant,
        closed: Option<&EnvelopeWindow>,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let Some(closed) = closed else { return Ok(()) };
        record.record(now, Sample::Row(&closed.mean))?;
        let Some((row, before)) = &closed.step else { return Ok(()) };
        record.record(now, Sample::Row(row))?;
        self.journal.adaptation_step(now, row, *before, record)
    }

    /// Records a closed window of the objective, if there is one, and the step of the adaptation.
    #[inline]
    pub fn record_objective_window(
        &self,
        now: Instant,
        measured: Option<&ObjectiveWindow>,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let Some(measured) = measured else { return Ok(()) };
        record.record(now, Sample::Row(&measured.row))?;
        let Some((row, before)) = &measured.step else { return Ok(()) };
        record.record(now, Sample::Row(row))?;
        self.journal.adaptation_step(now, row, *before, record)
    }
}
