//! Repetition of runs with external commands: scenario, commands and their times determine such a run completely.

use std::fmt::Write;

use flexsc_control::law::{Command, CommandQuantity};
use flexsc_numerics::time::Instant;
use flexsc_record::{Attachment, COMMANDS, Provenance, Record};

use super::{Campaign, CampaignRun};
use crate::metrics::{Metrics, MetricsCollector};
use flexsc_sim::{Simulation, SimulationError};

/// Columns of commands that are all torques, and of others.
const TORQUES: &str = "time_whole_s,time_fs,x,y,z";
const QUANTITIES: &str = "time_whole_s,time_fs,x,y,z,x_quantity,y_quantity,z_quantity";

/// Log of the commands about each axis and of the instants at which they were given, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CommandLog(pub(super) Vec<(Instant, [Command; 3])>);

impl CommandLog {
    /// Appends a command given at `now`; it replaces one of the same instant, which was never executed.
    pub fn push(&mut self, now: Instant, commands: [Command; 3]) {
        match self.0.last_mut() {
            Some((time, last)) if *time == now => *last = commands,
            _ => self.0.push((now, commands)),
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
        for (time, commands) in self.0.iter().take_while(|(time, _)| *time <= until) {
            simulation.run_up_to(*time, record)?;
            simulation.set_external_command(*commands);
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
        let mut simulation = Simulation::new(&run.scenario, run.noise_run);
        self.run_until(&mut simulation, until, &mut both)?;
        simulation.record_interruption(&mut both)?;
        Ok(both.0.finish(judged))
    }

    /// Returns the provenance in the log of the run, including its commands.
    pub fn provenance(&self, run: &CampaignRun) -> Provenance {
        let mut provenance = Campaign::provenance(run);
        if !self.is_empty() {
            provenance.attachments.push(self.attachment());
        }
        provenance
    }

    /// Returns the file with the commands within the log of the run.
    pub fn attachment(&self) -> Attachment {
        Attachment { name: COMMANDS, media_type: "text/csv", data: self.to_csv().into_bytes() }
    }

    /// Returns the commands as text: whole seconds, femtoseconds past them, and the values about x, y and z; with their
    /// quantities, unless all are torques.
    pub fn to_csv(&self) -> String {
        let all = self.0.iter().flat_map(|(_, commands)| commands);
        let are_torques = all.map(Command::quantity).all(|quantity| quantity == CommandQuantity::Torque);
        let mut text = format!("{}\n", if are_torques { TORQUES } else { QUANTITIES });
        for (time, commands) in &self.0 {
            let (whole, part) = time.parts();
            let [x, y, z] = commands.map(|command| command.value());
            // Writing to a string cannot fail.
            let _ = write!(text, "{whole},{part},{x:?},{y:?},{z:?}");
            if !are_torques {
                for command in commands {
                    let _ = write!(text, ",{}", command.quantity().label());
                }
            }
            text.push('\n');
        }
        text
    }

    /// Parses the text of [`Self::to_csv`]; returns `None` if it is not in this form.
    pub fn parse(text: &str) -> Option<Self> {
        let mut lines = text.lines();
        let has_quantities = match lines.next()? {
            TORQUES => false,
            QUANTITIES => true,
            _ => return None,
        };
        let mut all = Self::default();
        for line in lines {
            let mut cells = line.split(',');
            let mut whole = || cells.next()?.parse::<u64>().ok();
            let (seconds, part) = (whole()?, whole()?);
            let mut values = [0.0; 3];
            for value in &mut values {
                *value = cells.next()?.parse().ok().filter(|value: &f64| value.is_finite())?;
            }
            let mut commands = values.map(Command::Torque);
            if has_quantities {
                for (command, value) in commands.iter_mut().zip(values) {
                    *command = CommandQuantity::from_label(cells.next()?)?.command(value);
                }
            }
            let time = Instant::from_parts(seconds, part);
            let is_instant = seconds < 1 << 60 && part < 1_000_000_000_000_000;
            let is_later = all.0.last().is_none_or(|(last, _)| *last < time);
            if !is_instant || !is_later || cells.next().is_some() {
                return None;
            }
            all.0.push((time, commands));
        }
        Some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_numerics::time::Span;
    use flexsc_scenario::Scenario;

    const TEXT: &str = "duration = 10.0\n[law.open]\n[body.planar]\ninertia = 2.0";

    fn at(seconds: f64) -> Instant {
        Instant::START + Span::from_seconds(seconds)
    }

    fn example_log() -> CommandLog {
        let mut log = CommandLog::default();
        log.push(at(1.0), [9.0, 0.0, 0.0].map(Command::Torque));
        // A command that was never executed is not kept.
        log.push(at(1.0), [0.5, 0.0, 0.0].map(Command::Torque));
        log.push(at(3.0), [-0.1, 0.0, 0.0].map(Command::Torque));
        log
    }

    #[test]
    fn what_is_written_is_read_back() {
        assert_eq!(CommandLog::parse(&example_log().to_csv()), Some(example_log()));
        assert_eq!(CommandLog::parse(&CommandLog::default().to_csv()), Some(CommandLog::default()));
        for wrong in ["", "1,0,0,0", "1,0,0,0,inf", "2,0,0,0,0\n1,0,0,0,0", "0,1000000000000000,0,0,0"] {
            assert_eq!(CommandLog::parse(&format!("{TORQUES}\n{wrong}x")), None, "{wrong}");
            assert_eq!(
                CommandLog::parse(&format!("{TORQUES}\n{wrong}")).is_none(),
                !wrong.is_empty(),
                "{wrong}"
            );
        }
    }

    #[test]
    fn commands_of_several_quantities_are_read_back() {
        let mut log = example_log();
        assert!(!log.to_csv().contains("torque"));
        let mixed = [Command::Acceleration(1e-3), Command::Change(-2e-4), Command::Moment(5.0)];
        log.push(at(4.0), mixed);
        let text = log.to_csv();
        assert!(
            text.starts_with(QUANTITIES) && text.contains(",acceleration,rate_change,moment\n"),
            "{text}"
        );
        assert_eq!(CommandLog::parse(&text), Some(log));
        assert_eq!(CommandLog::parse(&text.replace("moment", "force")), None);
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
