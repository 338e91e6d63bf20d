//! `flexsc sweep`: a scenario once for each value of a key, or of several.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use flexsc_core::Scenario;
use flexsc_core::campaign::{Campaign, Grid};

use crate::consent::Consent;
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
    #[arg(long, required = true, value_name = "KEY=START:END:COUNT", value_parser = varied)]
    vary: Vec<Varied>,
    /// Directory for the tables, created if missing
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
    #[command(flatten)]
    consent: Consent,
}

/// A key, its first value, its last, and how many there are.
#[derive(Clone)]
struct Varied {
    key: String,
    first: f64,
    last: f64,
    count: u32,
}

fn varied(text: &str) -> Result<Varied, String> {
    let form = || format!("`{text}` is not KEY=START:END:COUNT, such as law.relay.k_t=0.28:0.40:25");
    let (key, range) = text.split_once('=').ok_or_else(form)?;
    let [start, end, count] = range.split(':').collect::<Vec<_>>()[..] else { return Err(form()) };
    let bound = |text: &str| text.parse().ok().filter(|v: &f64| v.is_finite()).ok_or_else(form);
    let count: u64 = count.parse().ok().filter(|count| *count > 0).ok_or_else(form)?;
    if count > u64::from(MOST_VALUES) {
        return Err(format!("a sweep has at most {MOST_VALUES} values, got {count}"));
    }
    Ok(Varied { key: key.to_owned(), first: bound(start)?, last: bound(end)?, count: count as u32 })
}

impl Args {
    /// The sweep over a scenario of this origin, and its runs.
    pub fn study(&self, scenario: Scenario, origin: &str) -> Result<(Campaign, Range<u64>), Failure> {
        let runs = self.vary.iter().try_fold(1_u64, |runs, grid| runs.checked_mul(u64::from(grid.count)));
        let runs = runs.filter(|runs| *runs <= u64::from(MOST_VALUES)).ok_or_else(|| {
            Failure::Arguments(format!("--vary: a sweep has at most {MOST_VALUES} combinations of values"))
        })?;
        let twice = |(place, grid): &(usize, &Varied)| self.vary[..*place].iter().any(|o| o.key == grid.key);
        if let Some((_, twice)) = self.vary.iter().enumerate().find(twice) {
            return Err(Failure::Arguments(format!("--vary {}: a key can be varied once", twice.key)));
        }
        let grid = |of: &Varied| Grid::even(of.key.clone(), of.first, of.last, of.count);
        let study = Campaign::new(scenario, origin, self.vary.iter().map(grid))?;
        let cost = study.cost(runs, None).map_err(|why| Failure::Arguments(format!("--vary: {why}")))?;
        self.consent.to(&cost)?;
        Ok((study, 0..runs))
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
        plain: true,
    };
    campaign::run(&Arc::new(study), &job, |run| Ok(Campaign::simulate(run, Stop)?))
}
