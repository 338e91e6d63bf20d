//! Results of a campaign: the table of statistics as a file, and on the terminal.

use std::io::Write;
use std::path::{Path, PathBuf};

use flexsc_core::formats::count::counted;
use flexsc_core::metrics::{Metrics, goal};
use flexsc_core::requirement_verdict::RequirementVerdict;
use flexsc_core::statistics::{QUANTILES, Statistics};

use super::points::Points;
use crate::error::CliError;
use crate::human::Units;
use crate::number::short;
use crate::success_rate::success_rate;
use crate::{files, requirements, say};

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
    /// Prints the points of a sweep, or the verdicts and the statistics of another campaign.
    pub fn say(&self, units: Units) {
        if self.runs == 0 {
            return;
        }
        if let Some(points) = &self.points {
            say!("{}", points.text().trim_end());
            return;
        }
        requirements::print(&self.requirements, units);
        let is_verdict = |s: &&Statistics| goal::NAMES.contains(&s.name.as_str());
        for s in self.statistics.iter().filter(is_verdict).filter(|s| s.runs > 0) {
            say!("  {:32}{}", s.name, success_rate(s.runs as u64, s.mean));
        }
        let quantiles = QUANTILES.map(|q| format!("{:>11}", format!("{:.0} %", 100.0 * q))).concat();
        say!("  {:32}{:>6}{:>12}{:>11}{quantiles}", "metric", "runs", "mean", "sd");
        // An element of a list that is 0 in all runs does not apply, as the time at a limit in a mode that reaches none.
        let is_idle = |s: &&Statistics| s.name.ends_with(']') && s.mean == 0.0 && s.quantiles == [0.0; 5];
        for s in self.statistics.iter().filter(|s| s.runs > 0 && !is_verdict(s) && !is_idle(s)) {
            let quantiles = s.quantiles.map(|q| format!("{:>11}", short(q))).concat();
            say!("  {:32}{:>6}{:>12}{:>11}{quantiles}", s.name, s.runs, short(s.mean), short(s.sd));
        }
        for s in self.statistics.iter().filter(|s| s.infinite > 0) {
            let runs = counted(self.runs, "run");
            say!("  {}: too large for a number in {} of {runs}, left out", s.name, s.infinite);
        }
    }
}

/// Returns a verdict as one word.
pub fn verdict(is_met: bool) -> &'static str {
    if is_met { "met" } else { "missed" }
}
