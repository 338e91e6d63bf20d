//! Command-line options that campaigns and sweeps have in common.

use std::path::Path;

use clap::ValueEnum;
use flexsc_core::campaign::{Design, Sampling, parquet_is_built_in};
use flexsc_core::metrics::Selection;
use flexsc_core::scenario::Cost;

use crate::error::CliError;
use crate::out::Out;

/// Memory that a campaign with a directory of parts needs (bytes), apart from its runs.
const HELD: f64 = 2e8;
/// Additional memory per run of such a campaign (bytes).
const HELD_OF_RUN: f64 = 32.0;
/// Largest number of replicas of a point.
const MOST_REPLICAS: u64 = 1_000_000;

#[derive(clap::Args, Clone)]
#[command(next_help_heading = "Campaigns")]
#[group(skip)]
pub struct CampaignOptions {
    /// Format of the table in DIR [default: parquet; csv in a build without it], as the ending of a FILE says by itself
    #[arg(long, value_name = "TABLE", requires = "out")]
    table: Option<TableFormat>,
    /// Metrics to keep, separated by commas [default: all]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    metrics: Option<Vec<String>>,
    /// Stop at the first run that fails [default: record the error in its row]
    #[arg(long)]
    pub fail_fast: bool,
    /// Sampling of [uncertain] keys and of the ranges of a sweep: random, latin-hypercube or sobol
    #[arg(long, value_name = "METHOD[:POINTS]", value_parser = sample)]
    sample: Option<SamplePlan>,
    /// Run on the workers of a Dask scheduler, which share DIR; needs `pip install flexsc[dask]`
    #[arg(long, value_name = "ADDRESS", requires = "out")]
    pub scheduler: Option<String>,
    /// Runs per point, which differ only in their noise
    #[arg(long, value_name = "R", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=MOST_REPLICAS))]
    pub replicas: u64,
}

/// The form of a campaign's rows.
#[derive(Copy, Clone, Debug, PartialEq, Eq, ValueEnum)]
pub enum TableFormat {
    /// A directory of Parquet files; an interrupted campaign resumes
    Parquet,
    /// One file, runs.csv
    Csv,
}

impl TableFormat {
    /// Endings of the files that hold the rows of a campaign.
    pub const ENDINGS: [&str; 2] = ["csv", "parquet"];

    /// Returns the format of a file with one of these endings.
    pub fn for_ending(ending: &str) -> Self {
        if ending == Self::ENDINGS[0] { Self::Csv } else { Self::Parquet }
    }
}

/// Value of `--sample`: the sampling method and, if given, the number of points.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct SamplePlan {
    pub sampling: Sampling,
    pub points: Option<u64>,
}

fn sample(text: &str) -> Result<SamplePlan, String> {
    let (name, points) = text.split_once(':').map_or((text, None), |(name, points)| (name, Some(points)));
    let found = Sampling::ALL.into_iter().find(|(known, _)| *known == name);
    let names = Sampling::ALL.map(|(name, _)| name).join(", ");
    let (_, sampling) = found.ok_or_else(|| format!("must be one of {names}, got `{name}`"))?;
    let points = points.map(|text| text.parse().ok().filter(|points| *points > 0));
    match points {
        Some(None) => Err("needs a number of points after the colon".to_owned()),
        points => Ok(SamplePlan { sampling, points: points.flatten() }),
    }
}

impl CampaignOptions {
    /// Returns true if no option is given.
    pub fn are_default(&self) -> bool {
        let Self { table, metrics, fail_fast, sample, replicas, scheduler } = self;
        table.is_none()
            && metrics.is_none()
            && !fail_fast
            && sample.is_none()
            && *replicas == 1
            && scheduler.is_none()
    }

    /// Returns the file format of the rows.
    pub fn table(&self) -> TableFormat {
        self.table.unwrap_or(if cfg!(feature = "parquet") { TableFormat::Parquet } else { TableFormat::Csv })
    }

    /// Returns the address of the scheduler whose workers make the runs; `None` for this process.
    ///
    /// # Errors
    /// Options that the workers of a scheduler cannot satisfy.
    pub fn scheduler(&self, log: bool, json: bool) -> Result<Option<&str>, CliError> {
        let other = [
            ("--table csv", self.table() == TableFormat::Csv),
            ("--log", log),
            ("--json", json),
            ("--fail-fast", self.fail_fast),
        ];
        match (&self.scheduler, other.into_iter().find(|(_, is_given)| *is_given)) {
            (Some(address), Some((option, _))) => Err(CliError::Arguments(format!(
                "--scheduler {address}: its workers write only Parquet files; leave out {option}"
            ))),
            (address, _) => Ok(address.as_deref()),
        }
    }

    /// Returns the selected metrics.
    pub fn selection(&self) -> Result<Selection, CliError> {
        if self.table == Some(TableFormat::Parquet) {
            parquet_is_built_in().map_err(|error| CliError::Arguments(format!("--table: {error}")))?;
        }
        let Some(names) = &self.metrics else { return Ok(Selection::ALL) };
        Selection::from_names(names).map_err(|why| CliError::Arguments(format!("--metrics: {why}")))
    }

    /// Returns the cost of a campaign; with a directory of parts, few rows are held in memory.
    pub fn cost(&self, cost: Cost, in_directory: bool) -> Cost {
        match self.table() {
            TableFormat::Parquet if in_directory => Cost { memory: HELD + cost.runs * HELD_OF_RUN, ..cost },
            _ => cost,
        }
    }

    /// Returns the file format of the rows, and true if `out` is one file; `inputs` are files that the command reads.
    ///
    /// # Errors
    /// A file whose format contradicts `--table`, or a file where a directory is needed.
    pub fn place(
        &self,
        out: Option<&Path>,
        inputs: &[&Path],
        log: bool,
    ) -> Result<(TableFormat, bool), CliError> {
        let out = out.map(|out| Out::new(out, &TableFormat::ENDINGS, inputs)).transpose()?;
        let Some(Out::File(path, ending)) = out else { return Ok((self.table(), false)) };
        let kind = TableFormat::for_ending(ending);
        let refused = |why: &str| {
            Err(CliError::Arguments(format!("-o {}: {why}\n\nhint: give a directory", path.display())))
        };
        if kind == TableFormat::Parquet {
            parquet_is_built_in().map_err(|error| CliError::Arguments(format!("-o: {error}")))?;
        }
        match () {
            () if self.table.is_some_and(|table| table != kind) => refused("--table names another format"),
            () if log => refused("cannot contain the logs of --log"),
            () if self.scheduler.is_some() => refused("the workers of --scheduler need a directory"),
            () => Ok((kind, true)),
        }
    }

    /// Returns the sampling method of the points.
    pub fn sampling(&self) -> Sampling {
        self.sample.map_or(Sampling::Random, |sample| sample.sampling)
    }

    /// Returns the number of points given by `--sample`.
    pub fn points(&self) -> Option<u64> {
        self.sample.and_then(|sample| sample.points)
    }

    /// Completes a design with the replicas and, if keys are uncertain, the method of their draws; `points` is the
    /// number of points of the whole campaign, if known.
    pub fn complete(&self, design: Design, uncertain: bool, points: Option<u64>) -> Result<Design, CliError> {
        let draws = if uncertain { self.sampling() } else { Sampling::Random };
        let hypercube = match (draws, points) {
            (Sampling::LatinHypercube, Some(points)) => points,
            (Sampling::LatinHypercube, None) => {
                let why = "a Latin hypercube needs its number of points, such as latin-hypercube:1000";
                return Err(CliError::Arguments(format!("--sample: {why}")));
            }
            _ => 0,
        };
        if !uncertain && design.blocks.is_empty() && self.sample.is_some() {
            let why = "no key is uncertain, and none is varied: there is nothing to draw";
            return Err(CliError::Arguments(format!("--sample: {why}")));
        }
        Ok(Design { draws, hypercube, replicas: self.replicas, ..design })
    }
}
