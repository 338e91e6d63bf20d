//! Scenario file next to a campaign's tables: it identifies them, and any run can be repeated from it.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use flexsc_core::campaign::Campaign;
use flexsc_core::formats::count::counted;
use flexsc_core::record::atomic_file::{self, AtomicFile};
use flexsc_core::record::difference;

use super::CampaignJob;
use crate::error::CliError;

/// Name of the file with a campaign's scenario, in the directory of its tables.
pub const SCENARIO: &str = "scenario.toml";
/// First words of a scenario file that flexsc wrote.
const MARK: &str = "# What the runs beside it were drawn from, by flexsc";
/// Hint of the errors about files of another campaign.
const HINT: &str = "hint: give another directory with -o, or use --force to replace what is there";

/// Scenario file of a campaign within a directory.
pub struct CampaignRecord<'a> {
    directory: &'a Path,
    /// Prefix of all file names.
    prefix: String,
    job: &'a CampaignJob<'a>,
    /// Content of the scenario file.
    text: String,
}

impl<'a> CampaignRecord<'a> {
    /// Returns the scenario file of a job of a campaign in `directory`.
    pub fn new(directory: &'a Path, job: &'a CampaignJob<'a>, campaign: &Campaign) -> Self {
        let prefix = job.prefix.map_or(String::new(), |name| format!("{name}-"));
        let grids = campaign.design().describe();
        let text = format!("{MARK} {}.\n{grids}{}", env!("CARGO_PKG_VERSION"), campaign.to_toml());
        Self { directory, prefix, job, text }
    }

    /// Writes the scenario file if [`check`](Self::check) allows it, and removes the tables of another campaign.
    pub fn keep(&self) -> Result<(), CliError> {
        let path = self.path(SCENARIO);
        atomic_file::unlinked(&path).map_err(CliError::write(&path))?;
        let mut partial = AtomicFile::create_waiting(&path).map_err(CliError::write(&path))?;
        if !self.check()? {
            for table in self.tables() {
                fs::remove_file(&table).map_err(CliError::write(&table))?;
            }
        }
        let written = partial.write_all(self.text.as_bytes()).and_then(|()| partial.finish());
        written.map_err(CliError::write(&path)).map(|_| ())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.directory.join(format!("{}{name}", self.prefix))
    }

    /// Returns true if the directory's tables are of this campaign.
    ///
    /// # Errors
    /// Tables of another campaign, or with more runs of this one, that must not be replaced.
    pub fn check(&self) -> Result<bool, CliError> {
        let path = &self.path(SCENARIO);
        let refused = |path: &Path, why: &str, hint: &str| {
            Err(CliError::Arguments(format!("{}: {why}\n\n{hint}", path.display())))
        };
        atomic_file::unlinked(path).map_err(CliError::write(path))?;
        let existing = match fs::read(path) {
            Ok(bytes) => String::from_utf8_lossy(&bytes).into_owned(),
            Err(_) => String::new(),
        };
        if !existing.is_empty() && !existing.starts_with(MARK) {
            let why = "exists, and flexsc did not write it";
            return refused(path, why, "hint: give another directory with -o");
        }
        let tables = self.tables();
        if existing == self.text {
            if self.job.part || self.job.force {
                return Ok(true);
            }
            let (whole, runs) = (self.path("runs.csv"), self.job.range.end - self.job.range.start);
            let before = rows(&whole);
            if before > runs {
                let why = format!(
                    "holds {} of this campaign, and {runs} would replace them",
                    counted(before, "run")
                );
                return refused(&whole, &why, HINT);
            }
            return Ok(true);
        }
        if self.job.force {
            return Ok(false);
        }
        match tables.first() {
            Some(table) if existing.is_empty() => refused(table, "exists, but its campaign is unknown", HINT),
            _ if existing.is_empty() => Ok(true),
            _ => {
                let why = format!("contains another campaign{}", other(&existing, &self.text));
                refused(path, &why, HINT)
            }
        }
    }

    /// Returns the paths of the existing tables, of whole campaigns and of parts.
    fn tables(&self) -> Vec<PathBuf> {
        let entries = fs::read_dir(self.directory).into_iter().flatten().flatten();
        let is_table = |name: &str| {
            let stem = name.strip_prefix(&self.prefix)?.strip_suffix(".csv")?;
            let rest = stem.strip_prefix("runs").or_else(|| stem.strip_prefix("statistics"))?;
            let rest = rest.strip_suffix("-interrupted").unwrap_or(rest);
            rest.chars().all(|c| c == '-' || c.is_ascii_digit()).then_some(())
        };
        let mut tables: Vec<PathBuf> = entries
            .filter(|entry| is_table(&entry.file_name().to_string_lossy()).is_some())
            .map(|entry| entry.path())
            .collect();
        tables.sort();
        tables
    }
}

/// Describes the difference of two campaigns: scenario, version or swept keys.
fn other(existing: &str, current: &str) -> String {
    let difference = difference(existing, current);
    let comments = |text: &str| -> Vec<String> {
        text.lines().take_while(|line| line.starts_with('#')).map(str::to_owned).collect()
    };
    if !difference.is_empty() {
        return difference;
    }
    let (existing_comments, current_comments) = (comments(existing), comments(current));
    let not_in = |one: &[String], other: &[String]| {
        let line = one.iter().find(|line| !other.contains(line));
        line.map_or("nothing".to_owned(), |line| line.trim_start_matches("# ").to_owned())
    };
    format!(
        " ({} before, {} now)",
        not_in(&existing_comments, &current_comments),
        not_in(&current_comments, &existing_comments)
    )
}

/// Returns the number of rows of a table; 0 without a file.
fn rows(path: &Path) -> u64 {
    let Ok(file) = atomic_file::open(path) else { return 0 };
    let mut reader = csv::Reader::from_reader(file);
    let mut row = csv::ByteRecord::new();
    let mut rows = 0;
    while reader.read_byte_record(&mut row).is_ok_and(|any| any) {
        rows += 1;
    }
    rows
}
