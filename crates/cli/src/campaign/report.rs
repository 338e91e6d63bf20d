//! Results of a campaign: the table of statistics as a file, and on the terminal.

use std::io::Write;
use std::path::{Path, PathBuf};

use flexsc_core::Scenario;
use flexsc_core::answer::real_time;
use flexsc_core::formats::count::counted;
use flexsc_core::formats::reader_units::{ReaderUnits, percent, percent_beside};
use flexsc_core::metrics::{Metrics, goal};
use flexsc_core::requirement_verdict::{Decision, RequirementVerdict};
use flexsc_core::statistics::{QUANTILES, Statistics, wilson};

use super::points::Points;
use crate::answer::{AnswerArgs, style};
use crate::error::CliError;
use crate::{files, say};

/// Names of the metrics that say whether a run meets its goal, and all requirements.
const GOAL: &str = goal::NAMES[0];
const REQUIREMENT: &str = goal::NAMES[1];

/// Results of a campaign.
pub struct CampaignReport {
    /// Number of runs.
    pub runs: usize,
    /// Statistics of the metrics.
    pub statistics: Vec<Statistics>,
    /// Verdicts on the requirements.
    pub requirements: Vec<RequirementVerdict>,
    /// Points of a sweep.
    pub points: Option<Points>,
    /// Number of failed runs, number of the first failed run, and its error.
    pub failed: Option<(u64, u64, String)>,
    /// Metrics of a single run.
    pub only: Option<Metrics>,
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
    /// Prints the points of a sweep, or the verdict, the requirements and the statistics of another campaign, which took
    /// some real time (s).
    pub fn say(&self, scenario: &Scenario, took: Option<f64>, args: AnswerArgs) {
        let (name, runs) = (&scenario.name, counted(self.runs, "run"));
        let took = took.map_or_else(String::new, |took| format!(" in {}", real_time(took)));
        let table = self.table.as_ref().map(|path| format!("table {}", path.display()));
        if let (Some(points), true) = (&self.points, self.runs > 0) {
            say!("{name}   {runs}{took}\n{}", points.text().trim_end());
            if let Some(table) = table {
                say!("  {table}");
            }
            return;
        }
        let verdict = self.verdict(scenario.reference.band.is_some());
        say!("{}", style().styled(&format!("{name}   {verdict}   {runs}{took}")));
        if self.runs == 0 {
            return;
        }
        let rows = self.requirement_rows(args);
        if !rows.is_empty() {
            let text: Vec<String> = rows.iter().map(|row| format!("  {row}")).collect();
            say!("\n{}", style().styled(&text.join("\n")));
        }
        // Without a requirement, the statistics are what is asked for.
        let shown: Vec<&Statistics> = self.shown_statistics(args.all).collect();
        if args.all || self.requirements.is_empty() {
            say!("\n{}", style().styled(&statistics_table(&shown, args.units.units.into())));
        }
        for s in self.statistics.iter().filter(|s| s.infinite > 0) {
            say!("  {}: too large for a number in {} of {runs}, left out", s.name, s.infinite);
        }
        let printed = if args.all || self.requirements.is_empty() { shown.len() } else { 0 };
        let hidden = self.shown_statistics(true).count() - printed;
        let more = (hidden > 0).then(|| format!("{} more: --all", counted(hidden, "metric")));
        let last: Vec<String> = table.into_iter().chain(more).collect();
        if !last.is_empty() {
            say!("  {}", last.join("     "));
        }
    }

    /// Returns the statistics that are printed: those of metrics that have a value, but for verdicts, idle elements and,
    /// unless `all` are wanted, late elements of long lists.
    fn shown_statistics(&self, all: bool) -> impl Iterator<Item = &Statistics> {
        let is_verdict =
            |s: &Statistics| goal::NAMES.contains(&s.name.as_str()) || s.name.starts_with("requirement_");
        // An element of a list that is 0 in all runs does not apply, as the time at a limit in a mode that reaches none.
        let is_idle = |s: &Statistics| s.name.ends_with(']') && s.mean == 0.0 && s.quantiles == [0.0; 5];
        let is_late = move |s: &Statistics| {
            let element =
                s.name.split_once('[').and_then(|(_, rest)| rest.trim_end_matches(']').parse().ok());
            !all && element.is_some_and(|element: usize| element >= MOST_ELEMENTS)
        };
        self.statistics.iter().filter(move |s| s.runs > 0 && !is_verdict(s) && !is_idle(s) && !is_late(s))
    }

    /// Returns the verdict in words: how many runs meet all requirements, or the goal that the scenario gives.
    fn verdict(&self, has_goal: bool) -> String {
        let share = |name: &str, what: &str| {
            let own = self.statistics.iter().find(|s| s.name == name && s.runs > 0)?;
            let met = (own.mean * own.runs as f64).round() as u64;
            let share = met as f64 / self.runs as f64;
            let (low, high) = wilson(met, self.runs as u64);
            let runs = counted(self.runs, "run");
            Some(format!(
                "{met} of {runs} meet {what}, {} ({:.0} to {:.0} %)",
                percent(share),
                100.0 * low,
                100.0 * high
            ))
        };
        let what = match self.requirements.len() {
            0 => {
                let goal = share(GOAL, "the goal").filter(|_| has_goal);
                return goal.unwrap_or_else(|| "no requirement".to_owned());
            }
            1 => "the requirement".to_owned(),
            all => format!("all {all} requirements"),
        };
        let has = |decision: Decision| self.requirements.iter().any(|own| own.decision == decision);
        let head = match (has(Decision::Missed), has(Decision::Undecided)) {
            (true, _) => "MISSED: ",
            (false, true) => "undecided: ",
            (false, false) => "",
        };
        format!("{head}{}", share(REQUIREMENT, &what).unwrap_or_default())
    }

    /// Returns the lines of the requirements, and how the worst run of the first is repeated.
    fn requirement_rows(&self, args: AnswerArgs) -> Vec<String> {
        if self.requirements.is_empty() {
            return Vec::new();
        }
        let heads = ["", "requirement", "limit", "median", "95 %", "worst", "met"].map(str::to_owned);
        let mut rows = vec![heads.to_vec()];
        let mut notes = Vec::new();
        for (index, verdict) in self.requirements.iter().enumerate() {
            let RequirementVerdict { requirement, decision, runs, runs_met, worst: (run, worst), .. } =
                verdict;
            let units: ReaderUnits = args.units.units.into();
            let unit =
                units.as_written(requirement.written_limit.as_deref(), requirement.limit, requirement.unit);
            let own = self.statistics.iter().find(|s| s.name == format!("requirement_values[{index}]"));
            let quantiles = MEDIAN_AND_P95
                .map(|place| own.map_or_else(String::new, |own| unit.number(own.quantiles[place])));
            let [median, p95] = quantiles;
            let mark = match decision {
                Decision::Met => "✓",
                Decision::Undecided => "?",
                Decision::Missed => "✗",
            };
            let worst =
                if worst.is_nan() { "no value".to_owned() } else { unit.beside(*worst, requirement.limit) };
            rows.push(vec![
                mark.to_owned(),
                requirement.name.clone(),
                format!("at most {}", unit.limit(requirement.limit, requirement.written_limit.as_deref())),
                median,
                p95,
                format!("{worst}, run {run}"),
                format!("{runs_met} of {runs}"),
            ]);
            notes.extend(confidence_note(verdict));
        }
        let mut lines = left_aligned(&rows);
        lines.extend(notes);
        if let (Some(path), Some(missed)) =
            (&self.table, self.requirements.iter().find(|own| own.decision == Decision::Missed))
            && path.is_dir()
        {
            let (path, run) = (path.display(), missed.worst.0);
            lines.push(format!("repeat the worst: flexsc simulate --from {path} --row {run} -o run-{run}"));
        }
        lines
    }
}

/// Index of the median and of the 95 % quantile among the quantiles.
const MEDIAN_AND_P95: [usize; 2] = [2, 4];

/// Number of elements of a list that are printed.
const MOST_ELEMENTS: usize = 8;

/// Returns a line on the level of the ensemble or on the share of all values, if the requirement has one.
fn confidence_note(verdict: &RequirementVerdict) -> Option<String> {
    let RequirementVerdict { requirement, decision, value, share, confidence, .. } = verdict;
    let name = &requirement.name;
    let least = percent(requirement.level);
    if !value.is_finite() && share.is_finite() {
        return Some(format!(
            "{name}: within its limit for {} of all values, at least {least}",
            percent_beside(*share, requirement.level)
        ));
    }
    let shown = confidence.as_ref()?;
    let mut text = format!(
        "{name}: {} at {least} of the runs; confidence {}",
        decision.word(),
        percent_beside(shown.reached, shown.wanted.unwrap_or(1.0))
    );
    if let (Some(wanted), Some(needed)) = (shown.wanted, shown.runs_needed) {
        let wanted_part = percent(wanted);
        let more = if shown.reached >= wanted {
            format!(", at least {wanted_part}")
        } else if *decision == Decision::Missed {
            // More runs are no remedy.
            format!(", below {wanted_part}")
        } else {
            format!(", {} needed for {wanted_part}", counted(needed, "run"))
        };
        text.push_str(&more);
    }
    Some(text)
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
        let unit = units.fitting(largest, s.unit);
        let mut row = vec![s.name.clone(), unit.name.to_string(), s.runs.to_string()];
        row.extend(
            numbers.iter().map(|value| if value.is_nan() { "-".to_owned() } else { unit.number(*value) }),
        );
        rows.push(row);
    }
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..rows[0].len()).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, width))| {
            if column < 2 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        format!("  {}", cells.collect::<Vec<_>>().join("  ")).trim_end().to_owned()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// Returns rows as columns that are aligned to the left.
fn left_aligned(rows: &[Vec<String>]) -> Vec<String> {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..rows[0].len()).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}"));
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

/// Returns a verdict as one word.
pub fn verdict(is_met: bool) -> &'static str {
    if is_met { "met" } else { "missed" }
}
