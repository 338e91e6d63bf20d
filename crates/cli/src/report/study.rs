//! Study of a report: its scenario, the commands on it, and the results that several blocks need.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use clap::Parser;
use flexsc_core::answer::{Answer, CampaignAnswer, RunObserver};
use flexsc_core::campaign::{Campaign, ColumnCells, Directory, Manifest, RowMaker, RunRows};
use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_core::metrics::Selection;
use flexsc_core::record::{Detail, Log};
use flexsc_core::{Document, Scenario};
use flexsc_figure::Named;
use sha2::{Digest, Sha256};

use crate::campaign::part_files;
use crate::error::CliError;
use crate::stop::{self, stop_flag};
use crate::{Cli, Verb, budget, memory_log, plot, scenario};

/// Number of runs of a campaign, unless another is asked for.
const DEFAULT_RUNS: u64 = 100;
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
    /// Directory of the runs, or the name that commands give it.
    pub directory: String,
}

/// Runs of a report's campaign.
#[derive(Copy, Clone)]
pub struct CampaignSource<'a> {
    /// Number of runs; by default those in the directory.
    pub runs: Option<u64>,
    /// Directory whose runs are used, and to which missing ones are added; `None` for memory.
    pub directory: Option<&'a Path>,
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

    /// Returns the campaign, whose runs are made once for its figures, its answer and the budgets of pointing indices; `nominal`
    /// is the answer of the scenario as it is.
    pub fn campaign(&self, source: CampaignSource<'_>, nominal: &Answer) -> Result<StudyCampaign, CliError> {
        let origin = self.path.to_string_lossy();
        let campaign = Campaign::new(self.scenario.clone(), &origin, None)?;
        let Some(path) = source.directory else {
            let runs = source.runs.unwrap_or(DEFAULT_RUNS);
            let wrong = |why: String| CliError::Arguments(format!("--runs: {why}"));
            let maker = RowMaker::in_memory(campaign, 0..runs, Selection::ALL).map_err(wrong)?;
            let (rows, budgets) = self.rows(&maker, runs)?;
            let column = |name: &str| Ok(rows.column(name).map(Cow::into_owned));
            return self.assessed(&maker, &column, nominal, (budgets, None));
        };
        let directory = filled(&campaign, path, source.runs)?;
        // The values of a pointing index over time are not in the directory.
        let of_index = budget::with_outcomes(
            self.scenario.clone(),
            origin.into_owned(),
            budget::DEFAULT_RUNS,
            |_, _| (),
        );
        uninterrupted()?;
        let column = |name: &str| directory.column(name).map_err(part_files::failure);
        self.assessed(directory.work(), &column, nominal, (of_index.ok(), Some(path)))
    }

    /// Makes the runs of the campaign in memory, with the budgets of pointing indices from the same runs, if there are any.
    fn rows(&self, maker: &RowMaker, runs: u64) -> Result<(RunRows, Option<budget::Budgets>), CliError> {
        let mut rows = maker.rows();
        let origin = self.path.to_string_lossy().into_owned();
        let budgets = budget::with_outcomes(self.scenario.clone(), origin, runs, |campaign, outcome| {
            rows.push(campaign, outcome);
        });
        uninterrupted()?;
        if let Ok(budgets) = budgets {
            return Ok((rows, Some(budgets)));
        }
        // No budget, or a run that fails: the campaign goes on without it.
        let rows = maker.make_rows(0..runs, 0, stop_flag()).map_err(part_files::failure)?;
        Ok((rows, None))
    }

    /// Returns the answer of a campaign's runs and their figures, from their columns.
    fn assessed(
        &self,
        maker: &RowMaker,
        column: &dyn Fn(&str) -> Result<Option<ColumnCells>, CliError>,
        nominal: &Answer,
        (budgets, directory): (Option<budget::Budgets>, Option<&Path>),
    ) -> Result<StudyCampaign, CliError> {
        let values = maker.campaign_runs(|names| names.iter().map(|name| column(name)).collect())?;
        let nominal = (!self.scenario.uncertain.is_empty()).then_some(nominal);
        let answer = CampaignAnswer::new(&self.scenario, &values, nominal, None, ReaderUnits::default());
        let count = self.scenario.study.requirements.len();
        let found = |name: &str| column(name).ok().flatten();
        Ok(StudyCampaign {
            figures: figures(maker, &found, &answer, count),
            runs: values.count(),
            directory: directory.map_or_else(|| "campaign".to_owned(), |path| path.display().to_string()),
            answer,
            budgets,
        })
    }
}

/// Returns an error if a stop was requested.
fn uninterrupted() -> Result<(), CliError> {
    if stop::stop_requested() { Err(CliError::Interrupted(String::new())) } else { Ok(()) }
}

/// Returns the directory of a campaign after its missing runs are made.
fn filled(campaign: &Campaign, path: &Path, runs: Option<u64>) -> Result<Directory, CliError> {
    if path.is_file() {
        let why = "is a file, not the directory of a campaign";
        return Err(CliError::Arguments(format!("--campaign {}: {why}", path.display())));
    }
    let is_there = Directory::is_campaign_directory(path);
    let existing = is_there.then(|| part_files::open(campaign, path)).transpose()?;
    let (held, selection) = existing.map_or((DEFAULT_RUNS, Selection::ALL), |held| {
        (held.work().manifest.runs().end, held.work().selection.clone())
    });
    let manifest = Manifest::new(campaign, 0..runs.unwrap_or(held), &selection)
        .map_err(|why| CliError::Arguments(format!("{}: {why}", campaign.scenario().name)))?;
    let directory = Directory::create(path, manifest, false).map_err(part_files::failure)?;
    for part in directory.missing().map_err(part_files::failure)? {
        directory.write_part(part, 0, stop_flag()).map_err(part_files::failure)?;
    }
    Ok(directory)
}

/// Returns the figure of each requirement that varies from run to run, or of the main metrics without a requirement.
fn figures(
    maker: &RowMaker,
    column: &dyn Fn(&str) -> Option<ColumnCells>,
    answer: &CampaignAnswer,
    count: usize,
) -> Vec<Named> {
    let drawn = |metrics: &[String]| {
        crate::figures::column_figure(maker, column, Some(DISTRIBUTION), metrics).unwrap_or_default()
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
