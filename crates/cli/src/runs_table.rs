//! Table of a campaign, `runs.csv`, with a row for each run.

use std::fs;
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use flexsc_core::campaign::{Campaign, RunOutcome, WORD_SEPARATOR};
use flexsc_core::metrics::{MetricValue, Metrics};
use flexsc_core::record::atomic_file::{self, AtomicFile};

use crate::error::CliError;

/// Longest time that finished rows stay in memory, and are lost if the campaign is killed.
const FLUSH: Duration = Duration::from_millis(500);

/// Largest size of the rows in memory (bytes).
const BUFFER: usize = 8 << 10;

/// Table of a campaign, under a `.partial` name until it is finished; an unfinished table is removed on drop.
pub struct RunsTable {
    path: PathBuf,
    partial: AtomicFile,
    /// Lines to write.
    lines: Vec<u8>,
    /// Number of bytes of the written lines.
    written: u64,
    /// True if the written lines include a row, not only the header.
    any: bool,
    /// Names of the metrics, known from the first run that has any; earlier rows wait for it.
    metrics: Option<Vec<&'static str>>,
    /// Rows of runs without metrics that wait for the header.
    waiting: Vec<Vec<String>>,
    /// Time of the last write.
    flushed: Instant,
}

impl RunsTable {
    pub fn create(path: &Path) -> Result<Self, CliError> {
        let partial = AtomicFile::create_unlinked(path).map_err(CliError::write(path))?;
        let (path, lines, waiting) = (path.to_owned(), Vec::new(), Vec::new());
        let flushed = Instant::now();
        Ok(Self { path, partial, lines, written: 0, any: false, metrics: None, waiting, flushed })
    }

    /// Writes the buffered rows to the file unless the last write was less than [`FLUSH`] ago.
    pub fn flush_if_due(&mut self) -> Result<(), CliError> {
        if self.flushed.elapsed() >= FLUSH {
            self.flushed = Instant::now();
            self.flush()?;
        }
        Ok(())
    }

    fn flush(&mut self) -> Result<(), CliError> {
        // Overwrites a partial line of a failed write.
        let position = self.partial.seek(SeekFrom::Start(self.written));
        position.and_then(|_| self.partial.write_all(&self.lines)).map_err(CliError::write(&self.path))?;
        self.written += self.lines.len() as u64;
        self.any |= self.metrics.is_some() && !self.lines.is_empty();
        self.lines.clear();
        Ok(())
    }

    pub fn row(&mut self, campaign: &Campaign, outcome: &RunOutcome) -> Result<(), CliError> {
        let mut cells = vec![outcome.number.to_string(), campaign.scenario().seed.to_string()];
        cells.extend(outcome.drawn.iter().map(ToString::to_string));
        match &outcome.metrics {
            Err(error) => {
                let error = error.to_string();
                if let Some(count) = self.metrics.as_ref().map(Vec::len) {
                    cells.extend(std::iter::repeat_n(String::new(), count));
                    cells.push(error);
                    return self.write(cells);
                }
                cells.push(error);
                self.waiting.push(cells);
                Ok(())
            }
            Ok(metrics) => {
                if self.metrics.is_none() {
                    self.header(campaign, metrics)?;
                }
                cells.extend(metrics.0.iter().map(|(_, value)| cell(value)));
                cells.push(String::new());
                self.write(cells)
            }
        }
    }

    fn header(&mut self, campaign: &Campaign, metrics: &Metrics) -> Result<(), CliError> {
        let names: Vec<&'static str> = metrics.0.iter().map(|(meaning, _)| meaning.name).collect();
        let mut header = vec!["run".to_owned(), "seed".to_owned()];
        header.extend(campaign.keys().map(str::to_owned));
        header.extend(names.iter().map(|&name| name.to_owned()));
        header.push("error".to_owned());
        self.write(header)?;
        for mut cells in std::mem::take(&mut self.waiting) {
            let error = cells.pop().unwrap_or_default();
            cells.extend(std::iter::repeat_n(String::new(), names.len()));
            cells.push(error);
            self.write(cells)?;
        }
        self.metrics = Some(names);
        Ok(())
    }

    fn write(&mut self, cells: Vec<String>) -> Result<(), CliError> {
        let mut writer = csv::Writer::from_writer(&mut self.lines);
        let written = writer.write_record(cells).map_err(io::Error::from).and_then(|()| writer.flush());
        drop(writer);
        written.map_err(CliError::write(&self.path))?;
        if self.lines.len() < BUFFER { Ok(()) } else { self.flush() }
    }

    /// Renames the table to its final name, which is returned.
    pub fn finish(mut self, campaign: &Campaign) -> Result<PathBuf, CliError> {
        if let Err(failure) = self.complete(campaign) {
            return Err(self.keep(failure));
        }
        self.partial.finish().map_err(CliError::write(&self.path))?;
        // Rows of an earlier, stopped campaign are among those of the complete one.
        let _ = fs::remove_file(interrupted(&self.path));
        Ok(self.path)
    }

    /// Keeps the rows of a campaign that was stopped by a failure, if any, under a name that marks them as interrupted.
    /// The returned failure has their path.
    pub fn interrupt(mut self, campaign: &Campaign, failure: CliError) -> CliError {
        if self.metrics.is_some() || !self.waiting.is_empty() {
            // On a full disk, the rows written before are kept.
            let _ = self.complete(campaign);
        }
        self.keep(failure)
    }

    /// Writes the buffered rows.
    fn complete(&mut self, campaign: &Campaign) -> Result<(), CliError> {
        // All runs failed: the rows have no metrics.
        if self.metrics.is_none() {
            self.header(campaign, &Metrics::default())?;
        }
        self.flush()
    }

    fn keep(self, failure: CliError) -> CliError {
        let path = interrupted(&self.path);
        // A full disk may have left a partial line.
        let kept = atomic_file::unlinked(&path).is_ok()
            && self.any
            && self.partial.truncate(self.written).is_ok()
            && self.partial.finish_at(&path).is_ok();
        if kept { CliError::Kept { failure: Box::new(failure), path } } else { failure }
    }
}

/// Returns the name of the table of a stopped campaign: `runs-interrupted.csv`.
pub fn interrupted(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}-interrupted.csv"))
}

/// Returns a metric as a cell: a list as JSON, and a value that is not a number as empty.
fn cell(value: &MetricValue) -> String {
    match value {
        MetricValue::Number(number) if number.is_nan() => String::new(),
        MetricValue::Number(number) => format!("{number:e}"),
        MetricValue::Word(word) => (*word).to_owned(),
        MetricValue::Words(words) => words.join(WORD_SEPARATOR),
        MetricValue::Count(_) | MetricValue::Numbers(_) | MetricValue::Quantities(_) => {
            value.to_json().to_string()
        }
    }
}
