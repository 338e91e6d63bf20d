//! Rows of the motion at the instants of a dense record and at pulses, and the rows of a one-axis law.

use flexsc_control::law::DecisionCause;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{Command, GoalMotion, Law, Motion, Record, RecordError, Sample, Torque, Trigger};

use super::spatial_motion::spatial_motion;
use crate::scenario::Scenario;
use crate::sim::controllers::LawDecision;
use crate::sim::plant::{OneAxisPlant, Plant};
use crate::sim::run_view::RunView;

/// Schedule and memory of the rows of the motion.
#[derive(Clone, Debug)]
pub struct MotionRows {
    period: Span,
    /// Instant of the next row, if the record wants the motion.
    next: Option<Instant>,
    next_law: Instant,
    /// Torques of the pulses of thrusters that were on at the last row (N m).
    firing: [f64; 3],
    /// True if the torque consists of more than the switchings of a law.
    has_torque_rows: bool,
    /// True if jets are the only actuator.
    jets_only: bool,
}

impl MotionRows {
    /// Creates the schedule of a scenario's rows, before its start.
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            period: scenario.log_period(),
            next: None,
            next_law: Instant::START,
            firing: [0.0; 3],
            has_torque_rows: scenario.has_torque_rows(),
            jets_only: scenario.study.jets_alone,
        }
    }

    /// Returns the instant of the next row.
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
        if let Plant::OneAxis(_) = run.plant {
            record.record(now, Sample::Begin(&law_row(run)))?;
        }
        if record.wants_motion() {
            self.next = Some(now);
            self.next_law = now + Span::from_seconds(1.0);
        }
        Ok(())
    }

    /// Records the rows that are due at the current instant.
    pub fn record_due(&mut self, run: &RunView<'_>, record: &mut dyn Record) -> Result<(), RecordError> {
        let now = run.now;
        let Some(due) = self.next else { return Ok(()) };
        // A pulse that begins or ends has a row of its own, or a log could miss it.
        let firing = [0, 1, 2].map(|axis| run.loads.actuator.firing(axis));
        let pulses = std::mem::replace(&mut self.firing, firing) != firing;
        if due == now {
            self.next = Some(now + self.period);
        }
        if due == now || pulses {
            self.record_motion(run, record)?;
            if due == now && now >= self.next_law {
                if let Plant::OneAxis(_) = run.plant {
                    record.record(now, Sample::Law(&law_row(run)))?;
                }
                self.next_law += Span::from_seconds(1.0);
            }
        }
        Ok(())
    }

    /// Records the motion at the current instant, and the law's row of a one-axis body.
    pub fn record_now(&self, run: &RunView<'_>, record: &mut dyn Record) -> Result<(), RecordError> {
        self.record_motion(run, record)?;
        if let Plant::OneAxis(_) = run.plant {
            record.record(run.now, Sample::Law(&law_row(run)))?;
        }
        Ok(())
    }

    /// Records a decision in which the one-axis law has changed its state, with the sensed angle (rad) and rate (rad/s)
    /// and the commanded torque.
    pub fn record_switching(
        &self,
        run: &RunView<'_>,
        decision: LawDecision,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let Plant::OneAxis(plant) = run.plant else { return Ok(()) };
        let LawDecision { before, after, cause } = decision;
        if before == after {
            return Ok(());
        }
        let truth = run.plant.truth();
        let (time_s, time_whole_s, time_fs) = Command::times(run.now);
        let command = Command {
            time_s,
            time_whole_s,
            time_fs,
            state: after,
            cause: if cause == Some(DecisionCause::Timeout) { Trigger::Timeout } else { Trigger::Guard },
            torque_nm: run.loads.actuator.demanded_torque(0),
            angle_rad: truth.sensor_angles()[0],
            rate_rad_s: truth.rate[0],
            gain: run.laws.tuned_value(),
        };
        record.record(run.now, Sample::Switching(&command, plant.state()))?;
        if record.wants_motion() {
            self.record_motion(run, record)?;
        }
        Ok(())
    }

    /// Records the motion at the current instant.
    fn record_motion(&self, run: &RunView<'_>, record: &mut dyn Record) -> Result<(), RecordError> {
        match run.plant {
            Plant::OneAxis(plant) => {
                record.record(run.now, Sample::Motion(&self.one_axis_motion(run, plant)))
            }
            Plant::ThreeAxis(plant) => {
                let row = spatial_motion(run, plant, self.jets_only);
                record.record(run.now, Sample::SpatialMotion(&row))
            }
        }
    }

    /// Returns the rows of a one-axis motion at the current instant.
    fn one_axis_motion(&self, run: &RunView<'_>, plant: &OneAxisPlant) -> Motion {
        let now = run.now;
        let measured = run.sensors.reading.map_or(0.0, |_| run.sensors.measured[0][0]);
        let (attitude, rate, modes) = plant.motion((!run.sensors.is_continuous()).then_some(measured));
        let envelope = run.estimation.monitor.as_ref().map(|monitor| monitor.envelope(now));
        let (actuator, rates) = (&run.loads.actuator, [rate.rate_rad_s, rate.rigid_rad_s]);
        let drive = self.has_torque_rows.then(|| {
            let (angle_rad, rate_rad_s) = run.guidance.manoeuvre_state(now);
            let torque = Torque {
                feedforward_nm: run.guidance.feedforward(now),
                feedback_nm: actuator.demanded_torque(0),
                applied_nm: actuator.applied_torque(now, 0, rates),
                disturbance_nm: run.loads.disturbance(now, 0),
            };
            (GoalMotion { angle_rad, rate_rad_s }, torque)
        });
        let wheel = actuator.wheel(0, rate.rigid_rad_s);
        Motion { attitude, rate, modes, outputs: plant.outputs(), drive, wheel, envelope }
    }
}

/// Returns the row of the one-axis law.
fn law_row(run: &RunView<'_>) -> Law {
    Law {
        state: run.laws.state(),
        torque_nm: run.loads.actuator.demanded_torque(0),
        gain: run.laws.tuned_value(),
    }
}
