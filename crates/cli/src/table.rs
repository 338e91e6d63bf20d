//! The table of a campaign, `runs.csv`: a row a run.

use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use flexsc_core::campaign::{Campaign, Outcome};
use flexsc_core::metrics::{Metrics, Value};
use flexsc_core::whole::discard;

use crate::failure::Failure;

/// The table of a campaign, under a `.partial` name until it is finished.
pub struct Table {
    path: PathBuf,
    partial: PathBuf,
    writer: csv::Writer<BufWriter<File>>,
    /// Names of the metrics, known with the first run that has any; the rows before it wait.
    metrics: Option<Vec<&'static str>>,
    waiting: Vec<Vec<String>>,
}

impl Table {
    pub fn create(path: &Path) -> Result<Self, Failure> {
        let partial = PathBuf::from(format!("{}.partial", path.display()));
        let file = File::create(&partial).map_err(Failure::write(path))?;
        let writer = csv::Writer::from_writer(BufWriter::new(file));
        Ok(Self { path: path.to_owned(), partial, writer, metrics: None, waiting: Vec::new() })
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

    pub fn finish(mut self, study: &Campaign) -> Result<PathBuf, Failure> {
        // All runs failed: there are rows without metrics only.
        let whole = if self.metrics.is_none() { self.header(study, &Metrics::default()) } else { Ok(()) };
        let Self { path, partial, mut writer, .. } = self;
        whole
            .and_then(|()| writer.flush().map_err(Failure::write(&path)))
            .and_then(|()| fs::rename(&partial, &path).map_err(Failure::write(&path)))
            .inspect_err(|_| discard(&partial))?;
        Ok(path)
    }

    /// A stopped campaign keeps the rows that it has; one that cannot be written keeps nothing.
    pub fn abandon(self, study: &Campaign, why: &Failure) {
        if matches!(why, Failure::Interrupted(_)) {
            let _ = self.finish(study);
        } else {
            discard(&self.partial);
        }
    }
}

/// A metric as a cell: a list as JSON, and what is not a number as nothing.
fn cell(value: &Value) -> String {
    match value {
        Value::Number(number) if number.is_nan() => String::new(),
        Value::Number(number) => format!("{number:e}"),
        Value::Word(word) => (*word).to_owned(),
        Value::Count(_) | Value::Numbers(_) | Value::Quantities(_) => value.to_json().to_string(),
    }
}
