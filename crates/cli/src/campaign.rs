//! Running a campaign: the row of each run, and the statistics.

mod kept;

use std::io::Write;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant as WallInstant;

use flexsc_core::SimulationError;
use flexsc_core::campaign::{Campaign, Outcome, Run, RunError};
use flexsc_core::metrics::Metrics;
use flexsc_core::record::RecordError;
use flexsc_core::statistics::{QUANTILES, Statistics, statistics};
use serde::Serialize;
use serde_json::{Map, Value as Json, json};

use crate::failure::Failure;
use crate::number::short;
use crate::results::print_lines;
use crate::table::Table;
use crate::{files, progress, say, stop, summary};

use kept::Kept;
pub use kept::SCENARIO;

/// What of a campaign is run, and what is made of it.
#[allow(clippy::struct_excessive_bools, reason = "each is a choice of its own")]
pub struct Job<'a> {
    /// The runs.
    pub range: Range<u64>,
    /// Whether they are a part of a campaign: its tables are then named so.
    pub part: bool,
    /// The directory of the tables, if any are wanted.
    pub table: Option<&'a Path>,
    /// What the tables' names begin with, where several campaigns share a directory.
    pub prefix: Option<&'a str>,
    /// Whether tables of another campaign are replaced.
    pub force: bool,
    /// Threads.
    pub jobs: Option<u16>,
    /// Whether each run is printed as JSON.
    pub json: bool,
    /// Whether a run is nothing but simulated: many then go side by side.
    pub plain: bool,
}

/// Runs a campaign; `work` simulates one run.
pub fn run(
    study: &Arc<Campaign>,
    job: &Job<'_>,
    work: impl Fn(&Run) -> Result<Metrics, RunError> + Send + Sync + 'static,
) -> Result<(), Failure> {
    let began = WallInstant::now();
    let _writing = stop::writing();
    let threads = usize::from(job.jobs.unwrap_or(0));
    let runs = job.range.end - job.range.start;
    let mut table = None;
    if let Some(dir) = job.table {
        let kept = Kept::new(dir, job, study);
        // Before what a killed campaign left is touched, and again by the only process that writes there.
        kept.check()?;
        table = Some(Table::create(&dir.join(job.file("runs")))?);
        kept.keep()?;
    }
    let bar = progress::bar(runs, "runs");
    let next = job.range.start;
    let mut telling =
        Telling { study, json: job.json, table: table.as_mut(), all: Vec::new(), next, failed: None };
    let tell = |outcome: Option<Outcome>| {
        bar.inc(u64::from(outcome.is_some()));
        telling.tell(outcome)
    };
    let done = if job.plain {
        study.each_beside(job.range.clone(), threads, work, tell)
    } else {
        study.each(job.range.clone(), threads, work, tell)
    };
    bar.finish_and_clear();
    let Telling { all, failed, .. } = telling;
    if let Err(failure) = done {
        return Err(match (&failure, table) {
            (Failure::Interrupted(_) | Failure::Write { .. }, Some(table)) => table.interrupt(study, failure),
            _ => failure,
        });
    }
    let table = table.map(|table| table.finish(study)).transpose()?;
    let statistics = statistics(&all);
    if let Some(dir) = job.table {
        write_statistics(&dir.join(job.file("statistics")), &statistics)?;
    }
    if !job.json {
        let (name, took) = (&study.scenario().name, began.elapsed().as_secs_f64());
        if let [only] = &all[..] {
            summary::tell(study.scenario(), only, took);
        } else {
            say!("{name}   {runs} runs, {took:.2} s");
            tell_statistics(&statistics, all.len());
        }
        if let Some(path) = table {
            say!("  table          {}", path.display());
        }
    }
    match failed {
        None => Ok(()),
        Some((failed, number, why)) => Err(Failure::Runs { failed, runs, number, why }),
    }
}

impl Job<'_> {
    fn file(&self, kind: &str) -> String {
        let prefix = self.prefix.map_or(String::new(), |name| format!("{name}-"));
        let part =
            if self.part { format!("-{}-{}", self.range.start, self.range.end) } else { String::new() };
        format!("{prefix}{kind}{part}.csv")
    }
}

/// The rows of the runs, in order.
struct Telling<'a> {
    study: &'a Campaign,
    json: bool,
    table: Option<&'a mut Table>,
    all: Vec<Metrics>,
    /// The run whose row is next.
    next: u64,
    /// How many runs failed, and the first of them.
    failed: Option<(u64, u64, String)>,
}

impl Telling<'_> {
    fn tell(&mut self, outcome: Option<Outcome>) -> Result<(), Failure> {
        if let Some(table) = &mut self.table {
            table.flush_in_time()?;
        }
        let interrupted = |at: u64| Failure::Interrupted(format!(" at run {at}"));
        let Some(outcome) = outcome else {
            return if stop::asked() { Err(interrupted(self.next)) } else { Ok(()) };
        };
        self.next = outcome.number + 1;
        if let Err(RunError::Simulation(SimulationError::Record(error))) = outcome.metrics {
            return Err(match error {
                RecordError::Io(source) => {
                    Failure::write(Path::new(&format!("the log of run {}", outcome.number)))(source)
                }
                RecordError::Interrupted => interrupted(outcome.number),
            });
        }
        if let Some(table) = &mut self.table {
            table.row(self.study, &outcome)?;
        }
        if self.json {
            let Outcome { number, drawn, metrics } = &outcome;
            print_lines(&[object(self.study, *number, drawn, metrics.as_ref())])?;
        }
        match outcome.metrics {
            Ok(metrics) => self.all.push(metrics),
            Err(error) => {
                let first = self.failed.take();
                let (failed, number, why) = first.unwrap_or_else(|| (0, outcome.number, error.to_string()));
                self.failed = Some((failed + 1, number, why));
            }
        }
        Ok(())
    }
}

/// A run as JSON, with the value of each key that varies.
pub fn object(
    study: &Campaign,
    number: u64,
    drawn: &[impl Serialize],
    metrics: Result<&Metrics, &RunError>,
) -> Json {
    let drawn: Map<_, _> =
        study.keys().zip(drawn).map(|(key, value)| (key.to_owned(), json!(value))).collect();
    let mut object = json!({
        "scenario": study.scenario().name,
        "run": number,
        "seed": study.scenario().seed,
        "drawn": drawn,
    });
    match metrics {
        Ok(metrics) => object["metrics"] = metrics.to_json(),
        Err(error) => object["error"] = json!(error.to_string()),
    }
    object
}

fn write_statistics(path: &Path, statistics: &[Statistics]) -> Result<(), Failure> {
    let table = || -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let mut header: Vec<String> = ["metric", "unit", "runs", "mean", "sd"].map(str::to_owned).into();
        header.extend(QUANTILES.map(|q| format!("q{:02.0}", 100.0 * q)));
        writer.write_record(header)?;
        for s in statistics {
            let mut cells = vec![s.name.to_owned(), s.unit.to_owned(), s.runs.to_string()];
            let numbers = [s.mean, s.sd].into_iter().chain(s.quantiles);
            cells.extend(numbers.map(|n| if n.is_finite() { format!("{n:e}") } else { String::new() }));
            writer.write_record(cells)?;
        }
        Ok(writer.into_inner().map_err(csv::IntoInnerError::into_error)?)
    };
    files::write(path, &table().map_err(|error| Failure::write(path)(error.into()))?)
}

fn tell_statistics(statistics: &[Statistics], runs: usize) {
    if runs == 0 {
        return;
    }
    let quantiles = QUANTILES.map(|q| format!("{:>11}", format!("{:.0} %", 100.0 * q))).concat();
    say!("  {:32}{:>6}{:>12}{:>11}{quantiles}", "metric", "runs", "mean", "sd");
    for s in statistics.iter().filter(|s| s.runs > 0) {
        let quantiles = s.quantiles.map(|q| format!("{:>11}", short(q))).concat();
        say!("  {:32}{:>6}{:>12}{:>11}{quantiles}", s.name, s.runs, short(s.mean), short(s.sd));
    }
    for s in statistics.iter().filter(|s| s.infinite > 0) {
        say!("  {}: too large for a number in {} of {runs} runs, left out", s.name, s.infinite);
    }
}
