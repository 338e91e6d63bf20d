//! Run of a scenario in lockstep: at each cycle the client gets the sensors, and its commands act from that instant on.

use flexsc_core::answer::{Observed, RunObserver};
use flexsc_core::campaign::{CampaignRun, CommandLog};
use flexsc_core::control::law::Command;
use flexsc_core::metrics::{Metrics, MetricsCollector};
use flexsc_core::numerics::time::Span;
use flexsc_core::record::{LogFile, Record, RecordError, RunEnd};
use flexsc_core::{Simulation, SimulationError};
use flexsc_view::scene::Scene;

use super::session::{Session, SessionEnd};
use crate::stop::stop_flag;

/// Outcome of a run in lockstep.
pub struct Served {
    /// Metrics of a complete run; none otherwise.
    pub metrics: Metrics,
    /// Observations of every control cycle.
    pub observed: Observed,
    /// Number of cycles that the client answered.
    pub cycles: u64,
    /// Reason why the run ended before its duration; `None` if it is complete.
    pub stopped: Option<StopReason>,
    /// Size of the log (bytes), if one was written.
    pub bytes: Option<u64>,
}

/// Reason why a run ended early.
pub enum StopReason {
    Session(SessionEnd),
    Simulation(SimulationError),
}

impl StopReason {
    /// Returns true if the user asked to stop.
    pub fn is_interruption(&self) -> bool {
        matches!(
            self,
            Self::Session(SessionEnd::Interrupted)
                | Self::Simulation(SimulationError::Record(RecordError::Interrupted))
        )
    }
}

impl From<SimulationError> for StopReason {
    fn from(error: SimulationError) -> Self {
        Self::Simulation(error)
    }
}

/// Run that a client controls.
struct Lockstep<'a> {
    simulation: Simulation,
    commands: CommandLog,
    session: &'a mut Session,
    period: Span,
    cycles: u64,
}

/// Simulates a run under the commands of a client, in cycles of a period, and finishes its log.
///
/// # Errors
/// A log that cannot be written, which leaves no file.
pub fn serve(
    run: &CampaignRun,
    session: &mut Session,
    period: Span,
    (mut log, scene): (Option<LogFile>, Option<Scene>),
) -> Result<Served, RecordError> {
    let (simulation, commands) = (Simulation::new(&run.scenario, run.noise_run), CommandLog::default());
    let mut lockstep = Lockstep { simulation, commands, session, period, cycles: 0 };
    let observers = (MetricsCollector::new(&run.scenario), RunObserver::new(&run.scenario));
    let mut record = (observers, (log.as_mut(), scene));
    let stopped = lockstep.step(&mut (&mut record, stop_flag())).err();
    // A run whose client is missing has ended at a cycle, where everything is done under the last commands.
    let stopped = match stopped {
        Some(StopReason::Session(end)) => match lockstep.leave(&mut record) {
            Ok(()) => Some(StopReason::Session(end)),
            Err(error) => Some(StopReason::Simulation(error)),
        },
        other => other,
    };
    if let Some(StopReason::Simulation(SimulationError::Record(RecordError::Io(error)))) = stopped {
        // The incomplete log is removed.
        lockstep.report_end(RunEnd::Failed);
        return Err(RecordError::Io(error));
    }
    let end = match &stopped {
        None => RunEnd::Complete,
        Some(StopReason::Session(_)) => RunEnd::Interrupted,
        Some(reason) if reason.is_interruption() => RunEnd::Interrupted,
        Some(StopReason::Simulation(_)) => RunEnd::Failed,
    };
    // As with `simulate`, a run that has not reached its end has no metrics.
    let (collector, observer) = record.0;
    let metrics = if stopped.is_none() { collector.finish(&run.scenario) } else { Metrics::default() };
    lockstep.report_end(end);
    let Lockstep { commands, cycles, .. } = lockstep;
    let written = log.map(|mut log| {
        log.set_commands(commands.to_csv());
        log.finish(&metrics, end)
    });
    Ok(Served { metrics, observed: observer.finish(), cycles, stopped, bytes: written.transpose()? })
}

impl Lockstep<'_> {
    /// Runs to the end, cycle by cycle.
    fn step(&mut self, record: &mut dyn Record) -> Result<(), StopReason> {
        let mut before = None;
        self.simulation.open(record)?;
        while !self.simulation.is_finished() {
            let (cycle, now) = (self.cycles, self.simulation.time());
            self.session.wait_for_cycle(cycle, now).map_err(StopReason::Session)?;
            self.simulation.test_modes(record)?;
            let telemetry = self.simulation.telemetry(&self.session.layout().telemetry)?;
            let commands = self.session.exchange(cycle, now, before, &telemetry);
            let commands = commands.map_err(StopReason::Session)?;
            if let Some(why) = self.refusal(commands.as_ref()) {
                return Err(StopReason::Session(self.session.refuse(why)));
            }
            if let Some(commands) = commands {
                self.commands.push(now, commands);
                self.simulation.set_external_command(commands);
            }
            self.simulation.run_up_to(now + self.period, record)?;
            before = Some(now);
            self.cycles += 1;
        }
        Ok(())
    }

    /// Returns the reason why commands are refused, or their absence if those in force are to stay and there are none; `None` if
    /// they are not.
    fn refusal(&self, commands: Option<&[Command; 3]>) -> Option<String> {
        let Some(commands) = commands else {
            return self
                .commands
                .is_empty()
                .then(|| "the first cycle has no commands: none are in force".to_owned());
        };
        let axis = self.simulation.unexecuted_axis(commands)?;
        let quantity = commands[axis].quantity().label();
        let axis = axis + 1;
        Some(format!(
            "the command about axis {axis} has the quantity {quantity}, which no actuator in use executes"
        ))
    }

    /// Does everything that is due at the current instant, under the last commands, and ends the record there.
    fn leave(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.simulation.run_until(self.simulation.time(), record)?;
        self.simulation.record_interruption(record)
    }

    /// Reports the end of the run to the client.
    fn report_end(&mut self, end: RunEnd) {
        let code = match end {
            RunEnd::Complete => 0,
            RunEnd::Interrupted => 1,
            RunEnd::Failed => 2,
        };
        self.session.end(self.cycles, self.simulation.time(), code);
    }
}
