//! Study of a report: its scenario, the commands on it, and the results that several blocks need.

use std::path::{Path, PathBuf};

use clap::Parser;
use flexsc_core::answer::{Answer, CampaignAnswer, RunObserver};
use flexsc_core::campaign::{Campaign, ColumnCells, RowMaker, RunRows};
use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_core::metrics::Selection;
use flexsc_core::record::{Detail, Log};
use flexsc_core::{Document, Scenario};
use flexsc_figure::Named;
use sha2::{Digest, Sha256};

use crate::error::CliError;
use crate::stop::{self, stop_flag};
use crate::{Cli, Verb, budget, memory_log, plot, scenario};

/// Figures of requirements that a campaign draws.
const DISTRIBUTION: &str = "distribution";

/// Scenario of a report with its file and the keys that are set.
pub struct Study {
    pub path: PathBuf,
    pub set: Vec<String>,
    pub scenario: Scenario,
    document: Document,
}

/// One run of the scenario as it is.
pub struct StudyRun {
    pub answer: Answer,
    /// Log, from which figures are drawn.
    pub log: Log,
}

/// Campaign over the uncertain keys and the noise, whose runs all blocks share.
pub struct StudyCampaign {
    pub answer: CampaignAnswer,
    /// Figures of the distributions of the requirements.
    pub figures: Vec<Named>,
    /// Budgets of pointing indices, if a requirement limits one.
    pub budgets: Option<budget::Budgets>,
    pub runs: u64,
}

impl Study {
    /// Reads the scenario of a report.
    pub fn load(path: &Path, set: &[String]) -> Result<Self, CliError> {
        Self::from_document(path, scenario::document(path)?, set)
    }

    /// Returns the study of a document, which commands call `path`.
    pub fn from_document(path: &Path, document: Document, set: &[String]) -> Result<Self, CliError> {
        let scenario = scenario::with(document.clone(), set, None)?;
        Ok(Self { path: path.to_owned(), set: set.to_owned(), scenario, document })
    }

    /// Returns the text of the scenario's file.
    pub fn text(&self) -> &str {
        self.document.source_text().unwrap_or_default()
    }

    /// Returns the SHA-256 of the scenario's file as hexadecimal digits.
    pub fn sha256(&self) -> String {
        let digits = Sha256::digest(self.text());
        digits.iter().map(|byte| format!("{byte:02x}")).collect::<Vec<_>>().concat()
    }

    /// Returns the name of the scenario's file.
    pub fn file(&self) -> String {
        self.path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    }

    /// Returns a command on the scenario as a user types it, with the keys that are set.
    pub fn command(&self, verb: &str, options: &str) -> String {
        let set = self.set.iter().map(|pair| format!("--set '{pair}'"));
        let words = [format!("flexsc {verb}"), self.file()].into_iter().chain(set);
        words.chain((!options.is_empty()).then(|| options.to_owned())).collect::<Vec<_>>().join(" ")
    }

    /// Parses an analysis, a verb with options, and returns it with the scenario with further keys set.
    pub fn analysis(&self, words: &[&str], set: &[String]) -> Result<(Verb, Scenario), CliError> {
        let path = self.path.to_string_lossy();
        let mut all = vec!["flexsc", words[0], &path];
        all.extend(&words[1..]);
        let failed = |error: clap::Error| CliError::Arguments(error.to_string());
        let verb = Cli::try_parse_from(all).map_err(failed)?.verb;
        let set = [&self.set, set].concat();
        Ok((verb, scenario::with(self.document.clone(), &set, None)?))
    }

    /// Simulates the scenario as it is, with a full log in memory.
    pub fn run(&self) -> Result<StudyRun, CliError> {
        let mut observer = RunObserver::new(&self.scenario);
        let path = PathBuf::from(format!("{}.mcap", self.scenario.name));
        let (log, metrics) = memory_log::observed(self.scenario.clone(), &path, Detail::Full, &mut observer)?;
        let observed = observer.finish();
        let answer = Answer::new(&self.scenario, &metrics, Some(&observed), ReaderUnits::default());
        Ok(StudyRun { answer, log })
    }

    /// Makes the runs of the campaign once, for its figures, its answer and the budgets of pointing indices; `nominal` is
    /// the answer of the scenario as it is.
    pub fn campaign(&self, runs: u64, nominal: &Answer) -> Result<StudyCampaign, CliError> {
        let origin = self.path.to_string_lossy();
        let campaign = Campaign::new(self.scenario.clone(), &origin, None)?;
        let wrong = |why: String| CliError::Arguments(format!("--runs: {why}"));
        let maker = RowMaker::in_memory(campaign, 0..runs, Selection::ALL).map_err(wrong)?;
        let mut rows = maker.rows();
        let budgets =
            budget::with_outcomes(self.scenario.clone(), origin.into_owned(), runs, |campaign, outcome| {
                rows.push(campaign, outcome);
            });
        if stop::stop_requested() {
            return Err(CliError::Interrupted(String::new()));
        }
        let budgets = budgets.ok();
        if budgets.is_none() {
            // No budget, or a run that fails: the campaign goes on without it.
            let made = maker.make_rows(0..runs, 0, stop_flag());
            if stop::stop_requested() {
                return Err(CliError::Interrupted(String::new()));
            }
            rows = made.map_err(|error| CliError::Arguments(error.to_string()))?;
        }
        if stop::stop_requested() {
            return Err(CliError::Interrupted(String::new()));
        }
        let values = maker.campaign_runs(|names| -> Result<_, CliError> {
            Ok(names.iter().map(|name| column(&rows, name)).collect())
        })?;
        let nominal = (!self.scenario.uncertain.is_empty()).then_some(nominal);
        let answer = CampaignAnswer::new(&self.scenario, &values, nominal, None, ReaderUnits::default());
        let count = self.scenario.study.requirements.len();
        Ok(StudyCampaign { figures: figures(&maker, &rows, &answer, count), answer, budgets, runs })
    }
}

fn column(rows: &RunRows, name: &str) -> Option<ColumnCells> {
    rows.column(name).map(std::borrow::Cow::into_owned)
}

/// Returns the figure of each requirement that varies from run to run, or of the main metrics without a requirement.
fn figures(maker: &RowMaker, rows: &RunRows, answer: &CampaignAnswer, count: usize) -> Vec<Named> {
    let drawn = |metrics: &[String]| {
        let kind =
            crate::figures::column_figure(maker, &|name| column(rows, name), Some(DISTRIBUTION), metrics);
        kind.unwrap_or_default()
    };
    if answer.requirements.is_empty() {
        return drawn(&[]).into_iter().take(2).collect();
    }
    (0..count).flat_map(|index| drawn(&[format!("requirement_values[{index}]")])).collect()
}

impl StudyRun {
    /// Returns the names of the figures of the log, in their order.
    pub fn kinds(&self) -> Vec<String> {
        let kinds = plot::drawable_kinds(&self.log, Path::new("run.mcap"), None).unwrap_or_default();
        kinds.into_iter().map(plot::FigureKind::name).collect()
    }

    /// Returns a figure of the log as SVG; `None` if it has nothing to show.
    pub fn drawn(&self, kind: &str) -> Option<String> {
        plot::figure_of(&self.log, Path::new("run.mcap"), kind, None).ok()?.svg().ok()
    }
}
