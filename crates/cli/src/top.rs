//! `flexsc top`: progress, speed and statistics of a campaign that runs elsewhere.

use std::fmt::Write as _;
use std::fs;
use std::io::IsTerminal;
use std::ops::Range;
use std::path::PathBuf;
use std::thread;
use std::time::{Duration, Instant, SystemTime};

use flexsc_core::campaign::{ColumnKind, Directory, ERROR, MAIN_METRICS, SECONDS};
use flexsc_core::formats::count::counted;
use flexsc_core::metrics::goal;
use indicatif::{HumanDuration, MultiProgress, ProgressBar, ProgressStyle};
use serde_json::json;

use crate::campaign::{RunningMean, part_files, table_so_far};
use crate::error::CliError;
use crate::quantity::in_unit;
use crate::terminal::is_plain;
use crate::{print, stop};

/// Largest number of metrics that are shown unless some are named.
const SHOWN: usize = 8;
/// Length of the recent interval over which the rate is computed (s).
const RECENT_S: f64 = 120.0;

#[derive(clap::Args)]
pub struct TopArgs {
    /// Directory of a campaign
    #[arg(value_name = "DIR")]
    directory: PathBuf,
    /// Refresh interval (s)
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = in_unit("s"))]
    every: f64,
    /// Print once and exit, as when the output is not a terminal
    #[arg(long)]
    once: bool,
    /// Metrics to show [default: the main ones]
    #[arg(long, value_name = "NAME")]
    metric: Vec<String>,
    /// Print one JSON object and exit
    #[arg(long)]
    json: bool,
}

/// Data of the parts that have been read, each once.
struct ReadParts {
    parts: Vec<(Range<u64>, SystemTime)>,
    metrics: Vec<(String, RunningMean)>,
    failed: u64,
    /// Total time of all runs on one core (s).
    seconds: f64,
}

pub fn run(args: &TopArgs) -> Result<(), CliError> {
    if !(args.every.is_finite() && (0.05..=86_400.0).contains(&args.every)) {
        return Err(CliError::Arguments(format!("--every must be from 0.05 to 86400 s, got {}", args.every)));
    }
    let directory = Directory::open(&args.directory).map_err(part_files::failure)?;
    let mut progress =
        ReadParts { parts: Vec::new(), metrics: metrics(args, &directory)?, failed: 0, seconds: 0.0 };
    progress.refresh(&directory)?;
    if args.json {
        return print(format!("{}\n", progress.to_json(&directory)).as_bytes());
    }
    if args.once || is_plain() || !std::io::stdout().is_terminal() || !std::io::stderr().is_terminal() {
        return print(format!("{}\n", progress.text(&directory)).as_bytes());
    }
    let screen = MultiProgress::new();
    let style = ProgressStyle::with_template("{msg}").unwrap_or_else(|_| ProgressStyle::default_spinner());
    let shown = screen.add(ProgressBar::new_spinner().with_style(style));
    loop {
        shown.set_message(progress.text(&directory));
        shown.tick();
        if progress.done() >= wanted(&directory) || stop::stop_requested() {
            shown.abandon();
            return Ok(());
        }
        let began = Instant::now();
        while began.elapsed().as_secs_f64() < args.every && !stop::stop_requested() {
            thread::sleep(Duration::from_millis(20));
        }
        progress.refresh(&directory)?;
    }
}

fn wanted(directory: &Directory) -> u64 {
    let runs = directory.work().manifest.runs();
    runs.end - runs.start
}

/// Returns the metrics to show: the named ones, or the main ones.
fn metrics(args: &TopArgs, directory: &Directory) -> Result<Vec<(String, RunningMean)>, CliError> {
    let work = directory.work();
    let numeric = |name: &str| {
        work.fields().iter().any(|field| {
            let counts = matches!(field.kind, ColumnKind::Integers | ColumnKind::Numbers)
                || goal::NAMES.contains(&name);
            field.name == name && counts
        })
    };
    let mut names: Vec<String> = args.metric.clone();
    if names.is_empty() {
        names =
            MAIN_METRICS.into_iter().filter(|name| numeric(name)).take(SHOWN).map(str::to_owned).collect();
    }
    if let Some(other) = names.iter().find(|name| !numeric(name)) {
        let why = format!("there is no metric `{other}` that is a number");
        return Err(CliError::Arguments(format!("{}: {why}", args.directory.display())));
    }
    Ok(names.into_iter().map(|name| (name, RunningMean::default())).collect())
}

impl ReadParts {
    /// Reads the new parts.
    fn refresh(&mut self, directory: &Directory) -> Result<(), CliError> {
        let all = directory.parts().map_err(part_files::failure)?;
        let new: Vec<_> =
            all.into_iter().filter(|runs| self.parts.iter().all(|(read, _)| read != runs)).collect();
        let mut names: Vec<&str> = vec![ERROR, SECONDS];
        names.extend(self.metrics.iter().map(|(name, _)| name.as_str()));
        let mut columns = Vec::new();
        for runs in &new {
            columns.push(directory.columns_of(runs, &names).map_err(part_files::failure)?);
        }
        for (runs, columns) in new.into_iter().zip(columns) {
            let written = fs::metadata(directory.file(&runs)).and_then(|file| file.modified());
            self.parts.push((runs, written.unwrap_or(SystemTime::UNIX_EPOCH)));
            let mut columns = columns.into_iter();
            self.failed += columns.next().map_or(0, |errors| errors.non_null_count() as u64);
            self.seconds += columns.next().map_or(0.0, |seconds| seconds.numbers().iter().sum());
            for ((_, running), column) in self.metrics.iter_mut().zip(columns) {
                column.numbers().into_iter().for_each(|value| running.add(value));
            }
        }
        Ok(())
    }

    fn done(&self) -> u64 {
        self.parts.iter().map(|(runs, _)| runs.end - runs.start).sum()
    }

    /// Returns the runs per second, by the recently written parts, and the age of the last one (s).
    fn rate(&self) -> Option<(f64, f64)> {
        let now = SystemTime::now();
        let age = |written: &SystemTime| now.duration_since(*written).map_or(0.0, |age| age.as_secs_f64());
        let last = self.parts.iter().map(|(_, written)| age(written)).fold(f64::INFINITY, f64::min);
        let oldest = self.parts.iter().map(|(_, written)| age(written) - last).filter(|age| *age <= RECENT_S);
        let oldest = oldest.fold(0.0, f64::max);
        // The first of the recent parts began earlier.
        let recent = self.parts.iter().filter(|(_, written)| age(written) - last < oldest);
        let runs: u64 = recent.map(|(runs, _)| runs.end - runs.start).sum();
        (last.is_finite()).then_some((if oldest > 0.0 { runs as f64 / oldest } else { f64::NAN }, last))
    }

    fn text(&self, directory: &Directory) -> String {
        let (done, all) = (self.done(), wanted(directory));
        let name = &directory.work().campaign.scenario().name;
        let mut text = format!("{name}   {done} of {}, {} failed", counted(all, "run"), self.failed);
        if let Some((rate, last)) = self.rate() {
            if done < all {
                // The parts may be copies, or their command may have ended.
                if directory.is_at_work() && rate > 0.0 {
                    let remaining = Duration::from_secs_f64(((all - done) as f64 / rate).min(1e12));
                    let _ = write!(text, ", {rate:.1} runs/s, {} left", HumanDuration(remaining));
                }
                let _ = write!(text, ", the last part {last:.0} s ago");
            }
            let each = 1e3 * self.seconds / (done.max(1) as f64);
            let _ = write!(text, "\n  {each:.3} ms a run on one core");
        }
        let table =
            table_so_far(&self.metrics.iter().map(|(n, r)| (n.as_str(), r.clone())).collect::<Vec<_>>());
        if table.is_empty() { text } else { format!("{text}\n{table}") }
    }

    fn to_json(&self, directory: &Directory) -> serde_json::Value {
        let (rate, last) = self.rate().unzip();
        let metrics: serde_json::Map<_, _> =
            self.metrics.iter().map(|(name, running)| (name.clone(), running.to_json())).collect();
        json!({
            "scenario": directory.work().campaign.scenario().name,
            "runs": wanted(directory),
            "done": self.done(),
            "failed": self.failed,
            "runs_per_s": rate,
            "last_part_s_ago": last,
            "core_s": self.seconds,
            "metrics": metrics,
        })
    }
}
