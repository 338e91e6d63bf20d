//! The table of a campaign, `runs.csv`: a row a run.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use flexsc_core::campaign::{Campaign, Outcome};
use flexsc_core::metrics::{Metrics, Value};
use flexsc_core::whole::Partial;

use crate::failure::Failure;

/// How long finished rows stay in memory: what a killed campaign loses.
const FLUSH: Duration = Duration::from_millis(500);

/// The table of a campaign, under a `.partial` name until it is finished. Dropped before, it is removed.
pub struct Table {
    path: PathBuf,
    writer: csv::Writer<Partial>,
    /// Names of the metrics, known with the first run that has any; the rows before it wait.
    metrics: Option<Vec<&'static str>>,
    waiting: Vec<Vec<String>>,
    flushed: Instant,
}

impl Table {
    pub fn create(path: &Path) -> Result<Self, Failure> {
        let writer = csv::Writer::from_writer(Partial::create(path).map_err(Failure::write(path))?);
        let (path, flushed) = (path.to_owned(), Instant::now());
        Ok(Self { path, writer, metrics: None, waiting: Vec::new(), flushed })
    }

    /// Hands the rows so far to the system, unless that was done just now.
    pub fn flush_in_time(&mut self) -> Result<(), Failure> {
        if self.flushed.elapsed() >= FLUSH {
            self.flushed = Instant::now();
            self.writer.flush().map_err(Failure::write(&self.path))?;
        }
        Ok(())
    }

    pub fn row(&mut self, study: &Campaign, outcome: &Outcome) -> Result<(), Failure> {
        let mut cells = vec![outcome.number.to_string(), study.scenario().seed.to_string()];
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
                    self.header(study, metrics)?;
                }
                cells.extend(metrics.0.iter().map(|(_, value)| cell(value)));
                cells.push(String::new());
                self.write(cells)
            }
        }
    }

    fn header(&mut self, study: &Campaign, metrics: &Metrics) -> Result<(), Failure> {
        let names: Vec<&'static str> = metrics.0.iter().map(|(meaning, _)| meaning.name).collect();
        let mut header = vec!["run".to_owned(), "seed".to_owned()];
        header.extend(study.keys().map(str::to_owned));
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

    fn write(&mut self, cells: Vec<String>) -> Result<(), Failure> {
        let written = self.writer.write_record(cells).map_err(std::io::Error::from);
        written.map_err(Failure::write(&self.path))
    }

    /// Gives the table its name, which is returned.
    pub fn finish(self, study: &Campaign) -> Result<PathBuf, Failure> {
        let interrupted = interrupted(&self.path);
        let path = self.path.clone();
        self.finish_as(study, &path)?;
        // The rows of a campaign that was stopped before are among those of the whole one.
        let _ = std::fs::remove_file(interrupted);
        Ok(path)
    }

    /// Keeps the rows of a campaign that was stopped, under a name that says so; nothing if there are none.
    pub fn interrupt(self, study: &Campaign) -> Option<PathBuf> {
        let path = interrupted(&self.path);
        let any = self.metrics.is_some() || !self.waiting.is_empty();
        (any && self.finish_as(study, &path).is_ok()).then_some(path)
    }

    fn finish_as(mut self, study: &Campaign, path: &Path) -> Result<(), Failure> {
        // All runs failed: there are rows without metrics only.
        if self.metrics.is_none() {
            self.header(study, &Metrics::default())?;
        }
        let partial = self.writer.into_inner().map_err(csv::IntoInnerError::into_error);
        let finished = partial.and_then(|partial| partial.finish_as(path));
        finished.map_err(Failure::write(path)).map(|_| ())
    }
}

/// The name of the table of a campaign that was stopped: `runs-interrupted.csv`.
pub fn interrupted(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}-interrupted.csv"))
}

/// A metric as a cell: a list as JSON, and what is not a number as nothing.
fn cell(value: &Value) -> String {
    match value {
        Value::Number(number) if number.is_nan() => String::new(),
        Value::Number(number) => format!("{number:e}"),
        Value::Word(word) => (*word).to_owned(),
        Value::Count(_) | Value::Numbers(_) => value.to_json().to_string(),
    }
}
