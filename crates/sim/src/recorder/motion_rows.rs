//! Rows of the motion at the instants of a dense record and at pulses, and the rows of a one-axis law.

use flexsc_control::law::DecisionCause;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{Command, Law, Record, RecordError, Sample, Trigger};

use super::reports::TorqueRows;
use crate::controllers::LawDecision;
use crate::run_view::RunView;
use flexsc_scenario::Scenario;

/// Schedule and memory of the rows of the motion.
#[derive(Clone, Debug)]
pub struct MotionRows {
    period: Span,
    /// Instant of the next row, if the record wants the motion.
    next: Option<Instant>,
    next_law: Instant,
    /// Torques of the pulses of thrusters that were on at the last row (N m).
    firing: [f64; 3],
    torques: TorqueRows,
}

impl MotionRows {
    /// Creates the schedule of a scenario's rows, before its start.
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            period: scenario.log_period(),
            next: None,
            next_law: Instant::START,
            firing: [0.0; 3],
            torques: TorqueRows::new(scenario),
        }
    }

    /// Returns the instant of the next row.
    #[inline]
    pub fn due(&self) -> Option<Instant> {
        self.next
    }

    /// Returns the period of the rows.
    pub fn period(&self) -> Span {
        self.period
    }

    /// Records the law's row at the start, and schedules the rows of the motion if the record wants them.
    pub fn record_start(&mut self, run: &RunView<'_>, record: &mut dyn Record) -> Result<(), RecordError> {
        let now = run.now;
        if run.plant.quantities().one_axis().is_some() {
            record.record(now, Sample::Begin(&law_row(run)))?;
        }
        if record.wants_motion() {
            self.next = Some(now);
            self.next_law = now + Span::from_seconds(1.0);
        }
        Ok(())
    }

    /// Records the rows that are due at the current instant.
    #[inline]
    pub fn record_due(&mut self, run: &RunView<'_>, record: &mut dyn Record) -> Result<(), RecordError> {
        match self.next {
            Some(due) => self.record_until(due, run, record),
            None => Ok(()),
        }
    }

    /// Records the rows that are due at the current instant; the next row of a dense record is due at `due`.
    fn record_until(
        &mut self,
        due: Instant,
        run: &RunView<'_>,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let now = run.now;
        // A pulse that begins or ends has a row of its own, or a log could miss it.
        let mut firing = [0.0; 3];
        for (axis, firing) in firing.iter_mut().enumerate().take(run.estimation.axis_count()) {
            *firing = run.loads.actuator.effort(axis).firing;
        }
        let pulses = std::mem::replace(&mut self.firing, firing) != firing;
        if due == now {
            self.next = Some(now + self.period);
        }
        if due == now || pulses {
            self.record_motion(run, record)?;
            if due == now && now >= self.next_law {
                if run.plant.quantities().one_axis().is_some() {
                    record.record(now, Sample::Row(&law_row(run)))?;
                }
                self.next_law += Span::from_seconds(1.0);
            }
        }
        Ok(())
    }

    /// Records the motion at the current instant, and the law's row of a one-axis body.
    pub fn record_now(&self, run: &RunView<'_>, record: &mut dyn Record) -> Result<(), RecordError> {
        self.record_motion(run, record)?;
        if run.plant.quantities().one_axis().is_some() {
            record.record(run.now, Sample::Row(&law_row(run)))?;
        }
        Ok(())
    }

    /// Records a decision in which the one-axis law has changed its state, with the sensed angle (rad) and rate (rad/s)
    /// and the commanded torque.
    #[inline]
    pub fn record_switching(
        &self,
        run: &RunView<'_>,
        decision: LawDecision,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        if decision.before == decision.after {
            return Ok(());
        }
        self.record_changed_state(run, decision, record)
    }

    /// Records the state that the law has after a decision.
    fn record_changed_state(
        &self,
        run: &RunView<'_>,
        LawDecision { after, cause, .. }: LawDecision,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let Some(motion) = run.plant.quantities().one_axis() else { return Ok(()) };
        let truth = run.plant.truth();
        let (time_s, time_whole_s, time_fs) = Command::times(run.now);
        let command = Command {
            time_s,
            time_whole_s,
            time_fs,
            state: after,
            cause: if cause == Some(DecisionCause::Timeout) { Trigger::Timeout } else { Trigger::Guard },
            torque_nm: run.loads.actuator.effort(0).demanded,
            angle_rad: truth.sensor_angles()[0],
            rate_rad_s: truth.rate[0],
            gain: run.laws.tuned_value(),
        };
        record.record(run.now, Sample::Switching(&command, &motion.body().state))?;
        if record.wants_motion() {
            self.record_motion(run, record)?;
        }
        Ok(())
    }

    /// Records the motion at the current instant.
    fn record_motion(&self, run: &RunView<'_>, record: &mut dyn Record) -> Result<(), RecordError> {
        run.record_report(&run.period_report(self.torques), record)
    }
}

/// Returns the row of the one-axis law.
fn law_row(run: &RunView<'_>) -> Law {
    Law {
        state: run.laws.phase(),
        torque_nm: run.loads.actuator.effort(0).demanded,
        gain: run.laws.tuned_value(),
    }
}
