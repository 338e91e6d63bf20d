//! `flexsc report`: one page for a design review, made of the output and the figures of other commands, with the command
//! under each.

mod page;
mod scratch;
mod section;

use std::fs;
use std::io::Write;
use std::path::PathBuf;

use crate::error::CliError;
use crate::{files, out, say, scenario, stop};
use scratch::ScratchDirectory;
use section::{Section, SectionRunner};

/// Largest number of runs of the report's campaign.
const MOST_RUNS: u64 = 100_000;

#[derive(clap::Args)]
pub struct ReportArgs {
    /// Scenario file
    scenario: PathBuf,
    /// The page: FILE.html
    #[arg(short = 'o', long = "out", value_name = "FILE", required = true)]
    out: PathBuf,
    /// Set a key of the scenario, such as law.pd.k_d=300
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Number of runs of the campaign; 0 leaves it out
    #[arg(long, value_name = "COUNT", default_value_t = 100)]
    runs: u64,
    /// Replace a FILE of other content
    #[arg(long)]
    force: bool,
}

pub fn run(args: &ReportArgs) -> Result<(), CliError> {
    if out::file(&args.out, &["html"], &[&args.scenario])? != "html" {
        return Err(CliError::Arguments(format!("-o {}: must end in .html", args.out.display())));
    }
    files::refuse_existing(&args.out, args.force)?;
    if args.runs > MOST_RUNS {
        let why = format!("--runs must be at most {MOST_RUNS}, got {}", args.runs);
        return Err(CliError::Arguments(why));
    }
    let scenario = scenario::load(&args.scenario, &args.set, None)?;
    let scratch = ScratchDirectory::new()?;
    let runner = SectionRunner::new(&args.scenario, &args.set, scratch.path());
    let mut sections = Vec::new();
    for make in makers(args.runs) {
        if stop::stop_requested() {
            return Err(CliError::Interrupted(String::new()));
        }
        sections.push(make(&runner)?);
    }
    let text = fs::read_to_string(&args.scenario).unwrap_or_default();
    let page = page::html(&scenario, &args.set, &text, &sections);
    files::write(&args.out, page.as_bytes(), true)?;
    let failed: Vec<&str> =
        sections.iter().filter(|section| section.is_refused()).map(|of| of.title).collect();
    say!("{} ({:.0} kB)", args.out.display(), page.len() as f64 / 1e3);
    if !failed.is_empty() {
        say!("  without numbers, with the reason on the page: {}", failed.join(", "));
    }
    Ok(())
}

/// Function that makes a section.
type Maker = Box<dyn Fn(&SectionRunner<'_>) -> Result<Section, CliError>>;

/// Returns the makers of the sections.
fn makers(runs: u64) -> Vec<Maker> {
    let mut makers: Vec<Maker> = vec![
        Box::new(|runner| {
            let intro = "Masses and inertias, and the elastic modes: clamped, as a finite-element model has them, and \
                         free, as the loop sees them.";
            runner.printed("Spacecraft", intro, &["modes"], None)
        }),
        Box::new(|runner| {
            let intro = "Gain, phase and delay at every crossing, modulus and disk margins, of each loop with the others \
                         closed and of all together, with the loop cut open at the commands of the law.";
            runner.printed("Margins at the command", intro, &["margins"], Some("margins"))
        }),
        Box::new(|runner| {
            let intro = "The same with the loop cut open at the measurements.";
            runner.printed("Margins at the measurement", intro, &["margins", "--loop", "measurement"], None)
        }),
        Box::new(|runner| {
            runner.simulated("One run", "A run of the scenario as it is, with its metrics and verdicts.")
        }),
    ];
    if runs > 0 {
        makers.push(Box::new(move |runner| {
            let intro = "Runs with other noise, and with the uncertain keys drawn anew for each.";
            runner.campaign("Campaign", intro, runs)
        }));
    }
    makers
}
