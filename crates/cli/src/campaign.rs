//! Running a campaign: what is told of each run, and its statistics.

use std::fs;
use std::io::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Instant as WallInstant;

use flexsc_core::SimulationError;
use flexsc_core::campaign::{Campaign, Outcome, Run, RunError};
use flexsc_core::metrics::Metrics;
use flexsc_core::record::RecordError;
use flexsc_core::statistics::{QUANTILES, Statistics, statistics};
use flexsc_core::whole;
use serde::Serialize;
use serde_json::{Map, Value as Json, json};

use crate::failure::Failure;
use crate::number::short;
use crate::results::print_lines;
use crate::table::Table;
use crate::{progress, say, summary};

/// The file that holds the scenario of a campaign, beside its tables.
pub const SCENARIO: &str = "scenario.toml";
/// How that file begins.
const MARK: &str = "# What the runs beside it were drawn from, by flexsc";

/// What of a campaign is run, and what is made of it.
pub struct Job<'a> {
    /// The runs.
    pub range: Range<u64>,
    /// Whether they are a part of a campaign: its tables are then named so.
    pub part: bool,
    /// The directory of the tables, if any are wanted.
    pub table: Option<&'a Path>,
    /// What the tables' names begin with, where several campaigns share a directory.
    pub prefix: Option<&'a str>,
    /// Threads.
    pub jobs: Option<u16>,
    /// Whether each run is printed as JSON.
    pub json: bool,
}

/// Runs a campaign; `work` simulates one run.
pub fn run(
    study: &Campaign,
    job: &Job<'_>,
    work: impl Fn(&Run) -> Result<Metrics, RunError> + Sync + Send,
) -> Result<(), Failure> {
    let began = WallInstant::now();
    let threads = usize::from(job.jobs.unwrap_or(0));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| Failure::Arguments(format!("--jobs: {error}")))?;
    let runs = job.range.end - job.range.start;
    job.keep_scenario(study)?;
    let bar = progress::bar(runs, "runs");
    let mut table = job.table.map(|dir| Table::create(&dir.join(job.file("runs")))).transpose()?;
    let mut telling = Telling { study, json: job.json, table: table.as_mut(), all: Vec::new(), failed: None };
    let done = pool.install(|| {
        study.each(job.range.clone(), work, |outcome| {
            bar.inc(1);
            telling.tell(outcome)
        })
    });
    bar.finish_and_clear();
    let Telling { all, failed, .. } = telling;
    if let Err(failure) = done {
        if let Some(table) = table {
            table.abandon(study, &failure);
        }
        return Err(failure);
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
    /// Writes the scenario beside the tables, so that any run can be repeated from them alone.
    fn keep_scenario(&self, study: &Campaign) -> Result<(), Failure> {
        let Some(dir) = self.table else { return Ok(()) };
        let path =
            dir.join(self.prefix.map_or_else(|| SCENARIO.to_owned(), |name| format!("{name}-{SCENARIO}")));
        let text = format!("{MARK} {}.\n{}", env!("CARGO_PKG_VERSION"), study.to_toml());
        // Parts make up one campaign only if they are of one scenario; and a file that somebody wrote is not lost.
        let stays =
            |there: &[u8]| there != text.as_bytes() && (self.part || !there.starts_with(MARK.as_bytes()));
        if fs::read(&path).is_ok_and(|there| stays(&there)) {
            let path = path.display();
            return Err(Failure::Arguments(format!(
                "{path}: is there, and is not the scenario of these runs, with their seed and of this version\n\n\
                 hint: give another directory"
            )));
        }
        let own = format!("{}.partial", self.range.start);
        whole::write_by(&path, &own, text.as_bytes()).map_err(Failure::write(&path))
    }

    fn file(&self, kind: &str) -> String {
        let prefix = self.prefix.map_or(String::new(), |name| format!("{name}-"));
        let part =
            if self.part { format!("-{}-{}", self.range.start, self.range.end) } else { String::new() };
        format!("{prefix}{kind}{part}.csv")
    }
}

/// What is told of each run, in order.
struct Telling<'a> {
    study: &'a Campaign,
    json: bool,
    table: Option<&'a mut Table>,
    all: Vec<Metrics>,
    /// How many runs failed, and the first of them.
    failed: Option<(u64, u64, String)>,
}

impl Telling<'_> {
    fn tell(&mut self, outcome: Outcome) -> Result<(), Failure> {
        if let Err(RunError::Simulation(SimulationError::Record(error))) = outcome.metrics {
            return Err(match error {
                RecordError::Io(source) => Failure::Write {
                    path: PathBuf::from(format!("the log of run {}", outcome.number)),
                    source,
                },
                RecordError::Interrupted => Failure::Interrupted(format!(" at run {}", outcome.number)),
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

/// What machines are told of a run, with the value of each key that varies.
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
    let write = || -> Result<(), csv::Error> {
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
        let bytes = writer.into_inner().map_err(csv::IntoInnerError::into_error)?;
        Ok(whole::write(path, &bytes)?)
    };
    write().map_err(|error| Failure::write(path)(error.into()))
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
