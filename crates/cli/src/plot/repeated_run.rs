//! Repeated run of a log whose rows do not hold what a figure shows, checked against the log.

use std::io::Write;
use std::path::Path;

use flexsc_core::campaign::{CampaignRun, CommandLog};
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::metrics::Metrics;
use flexsc_core::record::row::TopicRow;
use flexsc_core::record::{self, Jets, Log, Metric, Record, RecordError, Sample};

use super::columns::topics;
use super::run_events::{RunEvents, SwitchingEvent, unusable};
use crate::error::CliError;
use crate::say;

/// Relative difference of a metric up to which a repeated run is that of the log: the end of a partial run is rounded.
const ROUNDING: f64 = 1e-6;
/// Difference of the times of a switching (s) up to which it is that of the log, which counts nanoseconds.
const SAME_TIME: f64 = 1e-6;

const FULL: &str = "hint: a log made with `--log full` holds all that figures need";

/// Events of a repeated run that its log has too.
#[derive(Default)]
struct RepeatedEvents {
    /// Times of the switchings (s).
    switchings: Vec<f64>,
    /// Propellant used after each series of pulses (kg).
    fuel: Vec<f64>,
}

impl Record for RepeatedEvents {
    fn record(&mut self, _: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        match sample {
            Sample::Switching(command, _) => self.switchings.push(command.time_s),
            Sample::Report(report) => self.fuel.extend(report.row().map(|jets: &Jets| jets.fuel_kg)),
            Sample::Row(row) => self.fuel.extend(row.downcast().map(|jets: &Jets| jets.fuel_kg)),
            Sample::Begin(_) => {}
        }
        Ok(())
    }
}

impl RunEvents {
    /// Repeats the run of the log at `path` with a record, because the log has none of what is `missing`, and returns its metrics.
    ///
    /// # Errors
    /// A run that is too long, that needs parts or commands that the log does not have, or that differs from the log.
    pub fn repeat(
        &self,
        log: &Log,
        path: &Path,
        missing: &str,
        recorder: &mut impl Record,
    ) -> Result<Metrics, CliError> {
        if let Some(own) = self.absent_parts.as_deref() {
            let why = format!(
                "has no {missing}, and only the program of its parts ({own}) can repeat its run\n\n{FULL}"
            );
            return Err(CliError::Arguments(format!("{}: {why}", path.display())));
        }
        if let Some(why) = self.scenario.cost(None, true).limit_exceeded() {
            let why = format!("{}: its run is not repeated: {why}\n\n{FULL}", path.display());
            return Err(CliError::Arguments(why));
        }
        let commands = self.commanded.as_ref().ok_or_else(|| {
            let why = "its run was killed, and is not repeated without its commands\n\n\
                       hint: a log made with `--log full` holds most of what figures need";
            unusable(path, why.to_owned())
        })?;
        if self.is_noted {
            say!("note: repeats the run, because {} has no {missing}", path.display());
        }
        let run = CampaignRun::new(self.scenario.clone(), self.run);
        let mut repeated = RepeatedEvents::default();
        let metrics = commands
            .simulate(&run, self.until(), (recorder, &mut repeated))
            .map_err(|source| CliError::run(&self.scenario.name, source))?;
        match self.difference(log, commands, &repeated, &metrics)? {
            None => Ok(metrics),
            Some(differs) => {
                let version = log.metadata().get("version").map_or("another", String::as_str);
                let own = env!("CARGO_PKG_VERSION");
                let why = format!(
                    "flexsc {own} repeats another run than that of this log of version {version}: {differs}\n\n{FULL}"
                );
                Err(unusable(path, why))
            }
        }
    }

    /// Returns the instant up to which the run is repeated: the end of a torn log is rounded, and a switching may lie on it.
    pub fn until(&self) -> Instant {
        Instant::START + Span::from_seconds(self.end + 1e-9).min(self.scenario.duration)
    }

    /// Returns how a repeated run differs from that of its log, if it does.
    fn difference(
        &self,
        log: &Log,
        commands: &CommandLog,
        repeated: &RepeatedEvents,
        metrics: &Metrics,
    ) -> Result<Option<String>, CliError> {
        let same = |(a, b): (&f64, &SwitchingEvent)| (a - b.time).abs() <= SAME_TIME;
        let times = &repeated.switchings;
        if times.len() < self.switchings.len() || !times.iter().zip(&self.switchings).all(same) {
            return Ok(Some("it switches at other times".to_owned()));
        }
        let [jets, logged] = topics(log, [Jets::TOPIC.name, record::Metrics::TOPIC.name])?;
        let fuel = jets.numbers("fuel_kg").unwrap_or_default();
        if !repeated.fuel.iter().take(fuel.len()).eq(fuel) {
            return Ok(Some("it fires at other times".to_owned()));
        }
        // A run that was stopped on its way has metrics up to an instant at which not everything was done.
        let is_whole = log.metadata().get("end").is_some_and(|end| end == "complete") || !commands.is_empty();
        let logged = logged.timed_rows::<record::Metrics>().filter(|_| is_whole).unwrap_or_default();
        let logged = logged.into_iter().flat_map(|(_, row)| row.metrics);
        let own = metrics.to_row().metrics;
        let other = |own: &&Metric, logged: &Metric| {
            own.name == logged.name && own.index == logged.index && !is_same(own, logged)
        };
        let different =
            logged.into_iter().find_map(|logged| own.iter().find(|own| other(own, &logged)).cloned());
        Ok(different.map(|metric| format!("its metric `{}` differs", metric.name)))
    }
}

/// Returns true if a metric of a repeated run is that of the log.
fn is_same(own: &Metric, logged: &Metric) -> bool {
    let (a, b) = (own.value, logged.value);
    let is_equal = a == b || (a.is_nan() && b.is_nan());
    own.text == logged.text && (is_equal || (a - b).abs() <= ROUNDING * a.abs().max(b.abs()))
}
