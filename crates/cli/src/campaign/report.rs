//! Results of a campaign: the table of statistics as a file, and on the terminal.

use std::io::Write;
use std::path::{Path, PathBuf};

use flexsc_core::Scenario;
use flexsc_core::answer::CampaignAnswer;
use flexsc_core::campaign::{CampaignRuns, MAIN_METRICS, MOST_METRICS};
use flexsc_core::formats::count::counted;
use flexsc_core::formats::reader_units::{ReaderUnits, rough_time};
use flexsc_core::formats::text_columns::columns;
use flexsc_core::metrics::{Metrics, goal};
use flexsc_core::requirement_verdict::RequirementVerdict;
use flexsc_core::statistics::{QUANTILES, Statistics};

use super::points::Points;
use crate::answer::{AnswerArgs, style};
use crate::error::CliError;
use crate::{files, say};

/// Results of a campaign.
pub struct CampaignReport {
    /// Number of runs.
    pub runs: usize,
    /// Statistics of the metrics.
    pub statistics: Vec<Statistics>,
    /// Verdicts on the requirements.
    pub requirements: Vec<RequirementVerdict>,
    /// Values of requirements and uncertain keys.
    pub values: CampaignRuns,
    /// Points of a sweep.
    pub points: Option<Points>,
    /// Number of failed runs, number of the first failed run, and its error.
    pub failed: Option<(u64, u64, String)>,
    /// Metrics of a single run.
    pub only: Option<Metrics>,
    /// Metrics of the scenario without drawn keys, if they are shown beside those of the runs.
    pub nominal: Option<Metrics>,
    /// Path of the rows.
    pub table: Option<PathBuf>,
}

/// Writes the table of statistics.
pub fn write_statistics(path: &Path, statistics: &[Statistics]) -> Result<(), CliError> {
    let table = || -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let mut header: Vec<String> = ["metric", "unit", "runs", "mean", "sd"].map(str::to_owned).into();
        header.extend(QUANTILES.map(|q| format!("q{:02.0}", 100.0 * q)));
        writer.write_record(header)?;
        for s in statistics {
            let mut cells = vec![s.name.clone(), s.unit.to_owned(), s.runs.to_string()];
            let numbers = [s.mean, s.sd].into_iter().chain(s.quantiles);
            cells.extend(numbers.map(|n| if n.is_finite() { format!("{n:e}") } else { String::new() }));
            writer.write_record(cells)?;
        }
        Ok(writer.into_inner().map_err(csv::IntoInnerError::into_error)?)
    };
    let bytes = table().map_err(|error| CliError::write(path)(error.into()))?;
    files::write_within(&[(path.to_owned(), bytes)])
}

/// Returns true if there are several runs and every metric has the same value in all of them.
pub fn are_alike(statistics: &[Statistics]) -> bool {
    let mut several = statistics.iter().filter(|s| s.runs + s.infinite > 1).peekable();
    several.peek().is_some() && several.all(|s| s.sd == 0.0 && s.infinite == 0)
}

impl CampaignReport {
    /// Prints the points of a sweep, which took some real time (s). Returns false without points, and of a sweep over faults.
    pub fn say_points(&self, name: &str, took: Option<f64>) -> bool {
        let is_shown = self.runs > 0 && !self.values.varies_faults();
        let Some(points) = self.points.as_ref().filter(|_| is_shown) else { return false };
        let took = took.map_or_else(String::new, |took| format!(" in {}", rough_time(took)));
        say!("{name}   {}{took}\n{}", counted(self.runs, "run"), points.text().trim_end());
        if let Some(path) = &self.table {
            say!("  table {}", path.display());
        }
        true
    }

    /// Prints the verdict, the requirements and the statistics of a campaign, which took some real time (s).
    pub fn say(&self, answer: &CampaignAnswer, took: Option<f64>, args: AnswerArgs) {
        let runs = counted(self.runs, "run");
        let table = self.table.as_ref().map(|path| format!("table {}", path.display()));
        say!("{}", answer.screen(took, args.screen()));
        if self.runs == 0 {
            return;
        }
        // Without a requirement, the statistics are what is asked for.
        let shown = self.shown_statistics(args.all);
        if !shown.is_empty() && (args.all || self.requirements.is_empty()) {
            say!("\n{}", style().styled(&statistics_table(&shown, args.units.units.into())));
        }
        for s in self.statistics.iter().filter(|s| s.infinite > 0) {
            say!("  {}: too large for a number in {} of {runs}, left out", s.name, s.infinite);
        }
        let printed = if args.all || self.requirements.is_empty() { shown.len() } else { 0 };
        let hidden = self.shown_statistics(true).len() - printed;
        let more = (hidden > 0).then(|| format!("{} more: --all", counted(hidden, "metric")));
        let last: Vec<String> = table.into_iter().chain(more).collect();
        if !last.is_empty() {
            say!("  {}", last.join("     "));
        }
    }

    /// Returns the statistics that are printed: those of metrics that have a value, but for verdicts and idle elements; unless
    /// `all` are wanted, some that vary, the main ones first.
    fn shown_statistics(&self, all: bool) -> Vec<&Statistics> {
        let is_verdict =
            |s: &Statistics| goal::NAMES.contains(&s.name.as_str()) || s.name.starts_with("requirement_");
        // An element of a list that is 0 in all runs does not apply, as the time at a limit in a mode that reaches none.
        let is_idle = |s: &Statistics| s.name.ends_with(']') && s.mean == 0.0 && s.quantiles == [0.0; 5];
        let known = self.statistics.iter().filter(|s| s.runs > 0 && !is_verdict(s) && !is_idle(s));
        if all {
            return known.collect();
        }
        let place = |s: &Statistics| {
            let name = s.name.split('[').next().unwrap_or_default();
            MAIN_METRICS.iter().position(|main| *main == name).unwrap_or(MAIN_METRICS.len())
        };
        let (mut shown, constant): (Vec<&Statistics>, Vec<&Statistics>) = known.partition(|s| s.sd != 0.0);
        if shown.is_empty() {
            shown = constant.into_iter().filter(|s| place(s) < MAIN_METRICS.len() && s.mean != 0.0).collect();
        }
        shown.sort_by_key(|s| place(s));
        shown.truncate(MOST_METRICS);
        shown
    }

    /// Returns the answer of the campaign.
    pub fn answer(&self, scenario: &Scenario, args: AnswerArgs) -> CampaignAnswer {
        let directory = self.table.as_ref().filter(|path| path.is_dir());
        let directory = directory.map(|path| path.display().to_string());
        let nominal = self.nominal.as_ref().map(|metrics| args.answer(scenario, metrics, None));
        let units = args.units.units.into();
        CampaignAnswer::new(scenario, &self.values, nominal.as_ref(), directory.as_deref(), units)
    }
}

/// Returns the statistics as a table, each row in a unit that fits it.
fn statistics_table(shown: &[&Statistics], units: ReaderUnits) -> String {
    let mut heads: Vec<String> = ["metric", "unit", "runs", "mean", "sd"].map(str::to_owned).into();
    heads.extend(QUANTILES.map(|q| format!("{:.0} %", 100.0 * q)));
    let mut rows = vec![heads];
    for s in shown {
        let numbers: Vec<f64> = [s.mean, s.sd].into_iter().chain(s.quantiles).collect();
        let largest = numbers
            .iter()
            .filter(|number| number.is_finite())
            .fold(0.0, |most: f64, own| most.max(own.abs()));
        let unit = units.for_metric(&s.name, largest, s.unit);
        let mut row = vec![s.name.clone(), unit.name.to_string(), s.runs.to_string()];
        row.extend(
            numbers.iter().map(|value| if value.is_nan() { "-".to_owned() } else { unit.number(*value) }),
        );
        rows.push(row);
    }
    let lines = columns(&rows, |column| column < 2);
    lines.iter().map(|line| format!("  {line}")).collect::<Vec<_>>().join("\n")
}

/// Returns a verdict as one word.
pub fn verdict(is_met: bool) -> &'static str {
    if is_met { "met" } else { "missed" }
}
