//! Tables of a directory: `runs.csv`, its parts `runs-LO-HI.csv`, and those of several scenarios, `NAME-runs.csv`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use flexsc_core::Scenario;
use flexsc_core::campaign::Design;
use flexsc_core::metrics::{self, list_element};
use flexsc_core::record::atomic_file;
use flexsc_core::scenario::AssessedRequirement;
use flexsc_figure::FigureAxis;

use super::metric_column::{
    MetricColumn, elements, required_metric, requirement_label, value_of_requirement,
};
use super::text_cells::TextCells;
use crate::campaign::SCENARIO;
use crate::error::CliError;
use crate::key_axis::key_axis;
use crate::required_limit::RequiredLimit;

/// Runs of a campaign, in the order of their numbers.
pub struct CampaignRuns {
    /// Name of the scenario, or else of the directory.
    pub name: String,
    /// Scenario of the runs and its origin; `None` for tables of versions that did not keep the scenario.
    pub scenario: Option<(Scenario, ScenarioSource)>,
    /// Numbers of the runs.
    pub numbers: Vec<u64>,
    /// Keys that vary.
    pub keys: Vec<CampaignKey>,
    /// Metrics with numerical values.
    pub metrics: Vec<MetricColumn>,
    /// Error of each run; empty if the run succeeded.
    pub errors: Vec<String>,
    /// True if all points of a sweep have the noise of one run.
    pub has_same_noise: bool,
}

/// Origin of the scenario of a campaign.
pub enum ScenarioSource {
    /// File beside the campaign's tables.
    File(PathBuf),
    /// Directory of the campaign's parts.
    Directory(PathBuf),
}

/// Key that varies.
pub struct CampaignKey {
    pub name: String,
    /// Values of the key as TOML, and as numbers.
    pub texts: TextCells,
    pub values: Vec<f64>,
    /// True if a sweep varies the key; otherwise it is drawn.
    pub swept: bool,
}

/// Cells of a row by their columns.
type TextRow = BTreeMap<String, String>;

/// Columns of a table, and rows by the number of their run, each with its file.
#[derive(Default)]
struct TextTable {
    header: Vec<String>,
    rows: BTreeMap<u64, (TextRow, PathBuf)>,
}

/// Reads the campaigns of a directory by their names; `named` are requested metrics, such as elements of lists.
///
/// # Errors
/// A table that cannot be read or is not of a campaign, or parts that contradict each other.
pub fn read(directory: &Path, files: &[String], named: &[String]) -> Result<Vec<CampaignRuns>, CliError> {
    let mut tables: BTreeMap<String, TextTable> = BTreeMap::new();
    for file in files {
        if let Some(prefix) = prefix(file) {
            tables.entry(prefix).or_default().read(&directory.join(file))?;
        }
    }
    tables.into_iter().map(|(prefix, rows)| rows.into_runs(directory, &prefix, named)).collect()
}

/// Returns the prefix of a table's name, empty or `NAME-`; `None` if the file is not a table.
fn prefix(file: &str) -> Option<String> {
    let stem = file.strip_suffix(".csv")?;
    // The rows of a campaign that was stopped.
    let stem = stem.strip_suffix("-interrupted").unwrap_or(stem);
    let number = |text: &str| text.parse::<u64>().is_ok();
    let whole = match stem.rsplit('-').collect::<Vec<_>>()[..] {
        [high, low, _, ..] if number(high) && number(low) => &stem[..stem.len() - high.len() - low.len() - 2],
        _ => stem,
    };
    let before = whole.strip_suffix("runs")?;
    (before.is_empty() || before.ends_with('-')).then(|| before.to_owned())
}

fn refused(path: &Path, why: &str) -> CliError {
    CliError::Arguments(format!("{}: {why}", path.display()))
}

impl TextTable {
    fn read(&mut self, path: &Path) -> Result<(), CliError> {
        let wrong = |error: csv::Error| refused(path, &format!("is not the table of a campaign: {error}"));
        let mut reader =
            csv::Reader::from_reader(atomic_file::open(path).map_err(|error| wrong(error.into()))?);
        let header: Vec<String> = reader.headers().map_err(wrong)?.iter().map(str::to_owned).collect();
        if header.first().map(String::as_str) != Some("run")
            || header.last().map(String::as_str) != Some("error")
        {
            return Err(refused(
                path,
                "is not the table of a campaign: its columns must be `run`, ..., `error`",
            ));
        }
        // A part with failed runs only has no metrics: the longer header has them.
        let within = |short: &[String], long: &[String]| short.iter().all(|column| long.contains(column));
        if within(&self.header, &header) {
            self.header.clone_from(&header);
        } else if !within(&header, &self.header) {
            return Err(refused(path, "has different columns than the other parts of the campaign"));
        }
        for record in reader.records() {
            let record = record.map_err(wrong)?;
            let line = record.position().map_or(0, csv::Position::line);
            let row: TextRow = header.iter().cloned().zip(record.iter().map(str::to_owned)).collect();
            let Ok(number) = record[0].parse() else {
                let why = format!("line {line}: `run` must be the number of a run, got `{}`", &record[0]);
                return Err(refused(path, &why));
            };
            match self.rows.get(&number) {
                Some((existing, other)) if *existing != row => {
                    let why = format!("run {number} is another than in {}", other.display());
                    return Err(refused(path, &why));
                }
                _ => self.rows.insert(number, (row, path.to_owned())),
            };
        }
        Ok(())
    }

    fn into_runs(self, directory: &Path, prefix: &str, named: &[String]) -> Result<CampaignRuns, CliError> {
        if self.rows.is_empty() {
            return Err(refused(&directory.join(format!("{prefix}runs.csv")), "contains no runs"));
        }
        let path = directory.join(format!("{prefix}{SCENARIO}"));
        let scenario =
            if path.is_file() { Some((Scenario::load(&path)?, ScenarioSource::File(path))) } else { None };
        let absolute = std::path::absolute(directory).unwrap_or_default();
        let folder = absolute.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let name = match (&scenario, prefix.strip_suffix('-')) {
            (Some((scenario, _)), _) => scenario.name.clone(),
            (None, Some(prefix)) => prefix.to_owned(),
            (None, None) => folder,
        };
        let column = |name: &str| -> Vec<String> {
            self.rows.values().map(|(row, _)| row.get(name).cloned().unwrap_or_default()).collect()
        };
        let number = |text: &String| {
            let counted = || metrics::goal::score(text).unwrap_or(f64::NAN);
            text.parse::<f64>().unwrap_or_else(|_| counted())
        };
        let (mut keys, mut all) = (Vec::new(), Vec::new());
        for header in self.header.iter().filter(|name| !is_about(name)) {
            let texts = column(header);
            let values: Vec<f64> = texts.iter().map(number).collect();
            let known = scenario.as_ref().map(|(scenario, _)| scenario);
            if let Some(meaning) = metrics::meaning(header, known) {
                // Words and lists are not numbers.
                let goal = metrics::goal::NAMES.contains(&meaning.name);
                if goal || texts.iter().zip(&values).all(|(text, value)| text.is_empty() || !value.is_nan()) {
                    all.push(MetricColumn {
                        meaning,
                        name: meaning.name.to_owned(),
                        requirement: None,
                        texts: TextCells::Cells(texts),
                        values,
                    });
                }
            } else {
                let drawn = scenario.as_ref().map(|(scenario, _)| scenario.uncertain.contains_key(header));
                let swept = !drawn.unwrap_or_else(|| !values.is_sorted());
                keys.push(CampaignKey {
                    name: header.clone(),
                    texts: TextCells::Cells(texts),
                    values,
                    swept,
                });
            }
        }
        let known = scenario.as_ref().map(|(scenario, _)| scenario);
        all.extend(elements(known, named).into_iter().filter_map(|name| {
            let (list, index) = list_element(&name)?;
            let meaning = metrics::meaning(list, known)?;
            let element = |text: &String| -> Option<f64> {
                let values: Vec<Option<f64>> = serde_json::from_str(text).ok()?;
                *values.get(index)?
            };
            let found: Vec<Option<f64>> = column(list).iter().map(element).collect();
            found.iter().find(|value| value.is_some())?;
            let values = found.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect();
            let requirement = known.and_then(|scenario| requirement_label(scenario, &name));
            Some(MetricColumn { meaning, name, requirement, texts: TextCells::Numbers, values })
        }));
        let errors = column("error");
        let description = scenario.as_ref().and_then(|(_, source)| match source {
            ScenarioSource::File(path) => std::fs::read_to_string(path).ok(),
            ScenarioSource::Directory(_) => None,
        });
        let noise_run = |run| description.as_ref().map(|text| Design::described_noise_run(text, run));
        Ok(CampaignRuns {
            has_same_noise: noise_run(0).is_some() && noise_run(0) == noise_run(1),
            name,
            scenario,
            numbers: self.rows.into_keys().collect(),
            keys,
            metrics: all,
            errors,
        })
    }
}

/// Returns true if a column describes a run, and is neither a key nor a metric.
fn is_about(column: &str) -> bool {
    ["run", "seed", "error"].contains(&column)
}

impl CampaignRuns {
    /// Returns the keys that a sweep varies.
    pub fn swept(&self) -> Vec<&CampaignKey> {
        self.keys.iter().filter(|key| key.swept).collect()
    }

    /// Returns the columns of the requirements by their names: the values of each `[[requirement]]`, and the metric that
    /// `[reference]` limits; and the names of all limited metrics.
    pub fn requirements(&self) -> (Vec<String>, Vec<String>) {
        let Some((scenario, _)) = &self.scenario else { return Default::default() };
        let all = &scenario.study.requirements;
        let is_written = |name: &str| scenario.requirement.iter().any(|own| own.name == name);
        let column = |(index, requirement): (usize, &AssessedRequirement)| {
            let metric = required_metric(requirement).filter(|_| !is_written(&requirement.name));
            metric.unwrap_or_else(|| value_of_requirement(index))
        };
        (all.iter().enumerate().map(column).collect(), all.iter().filter_map(required_metric).collect())
    }

    /// Returns the limit on a metric, if there is one.
    pub fn required(&self, metric: &MetricColumn) -> Option<RequiredLimit> {
        let (scenario, _) = self.scenario.as_ref()?;
        let mut requirements = scenario.study.requirements.iter().enumerate();
        let (_, own) = requirements.find(|(index, requirement)| {
            let limited = required_metric(requirement);
            metric.name == value_of_requirement(*index) || limited.is_some_and(|name| name == metric.name)
        })?;
        Some(RequiredLimit::new(own))
    }

    /// Returns an axis around the values of a key.
    pub fn key_axis(&self, key: &CampaignKey) -> FigureAxis {
        let scenario = self.scenario.as_ref().map(|(scenario, _)| scenario);
        key_axis(scenario, &key.name, key.values.iter().copied())
    }

    /// Returns the point of the scenario itself over two keys, if it has both.
    pub fn design_point(&self, first: &CampaignKey, second: &CampaignKey) -> Vec<(f64, f64)> {
        let own = |key: &CampaignKey| self.scenario.as_ref()?.0.number_at(&key.name);
        own(first).zip(own(second)).into_iter().collect()
    }

    /// Returns the keys that are drawn.
    pub fn drawn(&self) -> Vec<&CampaignKey> {
        self.keys.iter().filter(|key| !key.swept).collect()
    }
}

impl CampaignKey {
    /// Returns the key's value in a run, as TOML.
    pub fn text(&self, index: usize) -> String {
        self.texts.formatted(index, self.values[index])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_known_by_their_names() {
        for (file, expected) in [
            ("runs.csv", Some("")),
            ("runs-interrupted.csv", Some("")),
            ("runs-0-500.csv", Some("")),
            ("relay-fixed-runs.csv", Some("relay-fixed-")),
            ("relay-2-runs-10-20.csv", Some("relay-2-")),
            ("statistics.csv", None),
            ("runs.csv.partial", None),
            ("overruns.csv", None),
            ("3-4.csv", None),
        ] {
            assert_eq!(prefix(file).as_deref(), expected, "{file}");
        }
    }
}
