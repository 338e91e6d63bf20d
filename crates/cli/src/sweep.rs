//! `flexsc sweep`: a scenario once for each value of a key, or of several.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use flexsc_core::Scenario;
use flexsc_core::campaign::{Campaign, Grid};

use crate::failure::Failure;
use crate::stop::Stop;
use crate::{campaign, files, scenario};

/// Values, and what their runs come to, are held in memory.
const MOST_VALUES: u32 = 10_000_000;

#[derive(clap::Args)]
pub struct Args {
    /// Scenario file
    pub scenario: PathBuf,
    /// A key, and its first value, last value and number of values, such as law.relay.k_t=0.28:0.40:2401; given again, every
    /// combination with the values of another key
    #[arg(long, required = true, value_name = "KEY=START:END:COUNT", value_parser = grid)]
    vary: Vec<Grid>,
    /// Directory for the tables, made if it is not there
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Set a key of the scenario, such as duration=1e4
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Seed, instead of the scenario's
    #[arg(long, value_name = "S", value_parser = clap::value_parser!(u64).range(..=scenario::LARGEST_SEED))]
    pub seed: Option<u64>,
    /// Threads [default: one for each core]
    #[arg(long, value_name = "J", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Replace the tables of another campaign in DIR
    #[arg(long, requires = "out")]
    force: bool,
    /// Print one JSON object for each run on stdout
    #[arg(long)]
    json: bool,
}

fn grid(text: &str) -> Result<Grid, String> {
    let form = || format!("`{text}` is not KEY=START:END:COUNT, such as law.relay.k_t=0.28:0.40:25");
    let (key, range) = text.split_once('=').ok_or_else(form)?;
    let [start, end, count] = range.split(':').collect::<Vec<_>>()[..] else { return Err(form()) };
    let bound = |text: &str| text.parse().ok().filter(|v: &f64| v.is_finite()).ok_or_else(form);
    let count: u32 = count.parse().ok().filter(|count| *count > 0).ok_or_else(form)?;
    if count > MOST_VALUES {
        return Err(format!("a sweep has at most {MOST_VALUES} values, got {count}"));
    }
    Ok(Grid::even(key.to_owned(), bound(start)?, bound(end)?, count))
}

impl Args {
    /// The sweep over a scenario of this origin, and its runs.
    pub fn study(&self, scenario: Scenario, origin: &str) -> Result<(Campaign, Range<u64>), Failure> {
        let runs = self.vary.iter().try_fold(1_u64, |runs, grid| runs.checked_mul(grid.values.len() as u64));
        let runs = runs.filter(|runs| *runs <= u64::from(MOST_VALUES)).ok_or_else(|| {
            Failure::Arguments(format!("--vary: a sweep has at most {MOST_VALUES} combinations of values"))
        })?;
        let varied = |(place, grid): &(usize, &Grid)| self.vary[..*place].iter().any(|o| o.key == grid.key);
        if let Some((_, twice)) = self.vary.iter().enumerate().find(varied) {
            return Err(Failure::Arguments(format!("--vary {}: a key can be varied once", twice.key)));
        }
        Ok((Campaign::new(scenario, origin, self.vary.clone())?, 0..runs))
    }
}

pub fn run(args: &Args) -> Result<(), Failure> {
    let scenario = scenario::load(&args.scenario, &args.set, args.seed)?;
    let (study, range) = args.study(scenario, &args.scenario.display().to_string())?;
    if let Some(out) = &args.out {
        files::make_directory(out)?;
    }
    let job = campaign::Job {
        range,
        part: false,
        table: args.out.as_deref(),
        prefix: None,
        force: args.force,
        jobs: args.jobs,
        json: args.json,
    };
    campaign::run(&Arc::new(study), &job, |run| Ok(Campaign::simulate(run, Stop)?))
}
