//! Repetition of runs with external commands: scenario, commands and their times determine such a run completely.

use std::fmt::Write;

use flexsc_control::law::Command;
use flexsc_numerics::time::Instant;
use flexsc_record::{Attachment, COMMANDS, Provenance, Record};

use super::{Campaign, CampaignRun};
use crate::metrics::{Metrics, MetricsCollector};
use crate::sim::{Simulation, SimulationError};

const HEADER: &str = "time_whole_s,time_fs,x,y,z";

/// Log of the commands about each axis ([`Command::Torque`]) and of the instants at which they were given, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CommandLog(pub(super) Vec<(Instant, [f64; 3])>);

impl CommandLog {
    /// Appends a command given at `now`; it replaces one of the same instant, which was never executed.
    pub fn push(&mut self, now: Instant, values: [f64; 3]) {
        match self.0.last_mut() {
            Some((time, last)) if *time == now => *last = values,
            _ => self.0.push((now, values)),
        }
    }

    /// Returns true if there are no commands.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Advances a run to an instant, including everything that is due then, with the commands given on the way.
    ///
    /// # Errors
    /// The errors of a run.
    pub fn run_until(
        &self,
        simulation: &mut Simulation,
        until: Instant,
        record: &mut impl Record,
    ) -> Result<(), SimulationError> {
        for (time, values) in self.0.iter().take_while(|(time, _)| *time <= until) {
            simulation.run_up_to(*time, record)?;
            simulation.set_external_command(values.map(Command::Torque));
        }
        simulation.run_until(until, record)
    }

    /// Repeats a run up to an instant, or to its end if that is earlier, and returns the metrics up to then. The result
    /// does not depend on the pieces in which the run was advanced.
    ///
    /// # Errors
    /// The errors of a run.
    pub fn simulate(
        &self,
        run: &CampaignRun,
        until: Instant,
        record: impl Record,
    ) -> Result<Metrics, SimulationError> {
        // A partial run has the metrics of a run that ends there.
        let end = Instant::START + run.scenario.duration;
        let remaining = (until < end).then(|| {
            let mut rest = run.scenario.clone();
            rest.written.duration = until.since(Instant::START);
            rest
        });
        let judged = remaining.as_ref().unwrap_or(&run.scenario);
        let mut both = (MetricsCollector::new(judged), record);
        let mut simulation = Simulation::new(&run.scenario, run.number);
        self.run_until(&mut simulation, until, &mut both)?;
        simulation.record_interruption(&mut both)?;
        Ok(both.0.finish(judged))
    }

    /// Returns the provenance in the log of the run, including its commands.
    pub fn provenance(&self, run: &CampaignRun) -> Provenance {
        let mut provenance = Campaign::provenance(run);
        if !self.is_empty() {
            let data = self.to_csv().into_bytes();
            provenance.attachments.push(Attachment { name: COMMANDS, media_type: "text/csv", data });
        }
        provenance
    }

    /// Returns the commands as text: whole seconds, femtoseconds past them, and the values about x, y and z.
    pub fn to_csv(&self) -> String {
        let mut text = format!("{HEADER}\n");
        for (time, [x, y, z]) in &self.0 {
            let (whole, part) = time.parts();
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{whole},{part},{x:?},{y:?},{z:?}");
        }
        text
    }

    /// Parses the text of [`Self::to_csv`]; returns `None` if it is not in this form.
    pub fn parse(text: &str) -> Option<Self> {
        let mut lines = text.lines();
        if lines.next()? != HEADER {
            return None;
        }
        let mut all = Self::default();
        for line in lines {
            let mut cells = line.split(',');
            let mut whole = || cells.next()?.parse::<u64>().ok();
            let (seconds, part) = (whole()?, whole()?);
            let mut values = [0.0; 3];
            for value in &mut values {
                *value = cells.next()?.parse().ok().filter(|value: &f64| value.is_finite())?;
            }
            let time = Instant::from_parts(seconds, part);
            let is_instant = seconds < 1 << 60 && part < 1_000_000_000_000_000;
            let is_later = all.0.last().is_none_or(|(last, _)| *last < time);
            if !is_instant || !is_later || cells.next().is_some() {
                return None;
            }
            all.0.push((time, values));
        }
        Some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Scenario;
    use flexsc_numerics::time::Span;

    const TEXT: &str = "duration = 10.0\n[law.open]\n[body.planar]\ninertia = 2.0";

    fn at(seconds: f64) -> Instant {
        Instant::START + Span::from_seconds(seconds)
    }

    fn example_log() -> CommandLog {
        let mut log = CommandLog::default();
        log.push(at(1.0), [9.0, 0.0, 0.0]);
        // A command that was never executed is not kept.
        log.push(at(1.0), [0.5, 0.0, 0.0]);
        log.push(at(3.0), [-0.1, 0.0, 0.0]);
        log
    }

    #[test]
    fn what_is_written_is_read_back() {
        assert_eq!(CommandLog::parse(&example_log().to_csv()), Some(example_log()));
        assert_eq!(CommandLog::parse(&CommandLog::default().to_csv()), Some(CommandLog::default()));
        for wrong in ["", "1,0,0,0", "1,0,0,0,inf", "2,0,0,0,0\n1,0,0,0,0", "0,1000000000000000,0,0,0"] {
            assert_eq!(CommandLog::parse(&format!("{HEADER}\n{wrong}x")), None, "{wrong}");
            assert_eq!(
                CommandLog::parse(&format!("{HEADER}\n{wrong}")).is_none(),
                !wrong.is_empty(),
                "{wrong}"
            );
        }
    }

    #[test]
    fn a_repeated_run_moves_as_it_was_commanded() {
        let scenario = Scenario::parse("steered.toml", TEXT).expect("a scenario");
        let mut simulation = Simulation::new(&scenario, 0);
        example_log().run_until(&mut simulation, at(5.0), &mut ()).expect("a run");
        // The torque is 0.5 N m on 2 kg m² for 2 s, then -0.1 N m for 2 s.
        let rate = simulation.state().map(|state| state.rigid_rate);
        assert!((rate.expect("one angle") - 0.4).abs() < 1e-15);
    }
}
