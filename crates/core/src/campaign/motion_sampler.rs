//! Motion of a repeated run at instants chosen by the caller, with snapshots from which later samples go on.

use flexsc_numerics::time::{Instant, Span};
use flexsc_record::Record;

use super::{CampaignRun, CommandLog};
use flexsc_sim::{Simulation, SimulationError};

/// Number of snapshots of a run, evenly spaced in time.
const SNAPSHOTS: usize = 64;

/// Sampler of the motion of a run. The run is simulated once, as far as samples need it; its state is kept at instants on
/// the way, and at the last sample.
pub struct MotionSampler {
    run: CampaignRun,
    commands: CommandLog,
    /// Time between snapshots; `None` for a run with custom parts, which may be impossible to copy.
    spacing: Option<Span>,
    /// Snapshots, in order of time.
    snapshots: Vec<Snapshot>,
    /// Time of the last sample (s), and the state at it.
    last: Option<(f64, Snapshot)>,
}

/// State of a run between two calls.
#[derive(Clone)]
struct Snapshot {
    simulation: Simulation,
    /// Number of commands that were given.
    given: usize,
}

impl Snapshot {
    /// Gives the commands whose instants are due, each at its instant.
    fn give_commands(
        &mut self,
        commands: &CommandLog,
        is_due: impl Fn(Instant) -> bool,
        stop: &mut impl Record,
    ) -> Result<(), SimulationError> {
        while let Some((changed_at, given)) = commands.0.get(self.given).filter(|(at, _)| is_due(*at)) {
            self.simulation.run_up_to(*changed_at, stop)?;
            self.simulation.set_external_command(*given);
            self.given += 1;
        }
        Ok(())
    }
}

impl MotionSampler {
    /// Creates the sampler of a run with the commands that were given to it.
    pub fn new(run: CampaignRun, commands: CommandLog) -> Self {
        let spacing = Span::from_seconds(run.scenario.duration.seconds() / SNAPSHOTS as f64);
        let can_copy = !run.scenario.has_custom_parts() && spacing > Span::ZERO;
        Self { run, commands, spacing: can_copy.then_some(spacing), snapshots: Vec::new(), last: None }
    }

    /// Records the motion at increasing times (s). The rows do not depend on the samples before.
    ///
    /// # Errors
    /// The errors of a run.
    pub fn sample(
        &mut self,
        times: &[f64],
        stop: &mut impl Record,
        record: &mut impl Record,
    ) -> Result<(), SimulationError> {
        let Some(first) = times.first() else { return Ok(()) };
        let mut state = self.state_before(*first);
        for time in times {
            self.pass_snapshots(&mut state, *time, stop)?;
            state.give_commands(&self.commands, |at| at.seconds() <= *time, stop)?;
            state.simulation.run_to(*time, stop)?;
            state.simulation.record_now(record)?;
        }
        if self.spacing.is_some() {
            self.last = times.last().map(|time| (*time, state));
        }
        Ok(())
    }

    /// Returns the latest state from which the run reaches a time (s), which is removed if it is that of the last sample.
    fn state_before(&mut self, time: f64) -> Snapshot {
        let kept = self.snapshots.iter().rev().find(|kept| is_before(kept.simulation.time(), time));
        if let Some((_, last)) = self.last.take_if(|(at, last)| {
            *at <= time && kept.is_none_or(|kept| kept.simulation.time() <= last.simulation.time())
        }) {
            return last;
        }
        kept.cloned().unwrap_or_else(|| Snapshot {
            simulation: Simulation::new(&self.run.scenario, self.run.noise_run),
            given: 0,
        })
    }

    /// Runs to the instants of snapshots before a time (s), and keeps those that are missing.
    fn pass_snapshots(
        &mut self,
        state: &mut Snapshot,
        time: f64,
        stop: &mut impl Record,
    ) -> Result<(), SimulationError> {
        let Some(spacing) = self.spacing else { return Ok(()) };
        loop {
            let latest = self.snapshots.last().map_or(Instant::START, |kept| kept.simulation.time());
            let next = latest + spacing;
            if state.simulation.time() >= next || !is_before(next, time) {
                return Ok(());
            }
            state.give_commands(&self.commands, |at| at <= next, stop)?;
            state.simulation.run_until(next, stop)?;
            self.snapshots.push(state.clone());
        }
    }
}

/// Returns true if an instant is before all that a time (s) stands for.
fn is_before(instant: Instant, time: f64) -> bool {
    instant.seconds() < time * (1.0 - 4.0 * f64::EPSILON)
}
