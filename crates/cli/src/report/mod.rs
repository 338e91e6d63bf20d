//! `flexsc report`: one page for a design review, made of the output and the figures of other commands, with the command
//! under each.

mod page;
mod scratch;
mod section;

use std::fs;
use std::io::Write;
use std::path::PathBuf;

use flexsc_core::Scenario;

use crate::error::CliError;
use crate::{files, out, say, scenario, stop};
use scratch::ScratchDirectory;
use section::{ReportRunner, ReportSection};

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
    // An interruption waits for the scratch directory to be removed.
    let _files = stop::writing();
    let scratch = ScratchDirectory::new()?;
    let runner = ReportRunner::new(&args.scenario, &args.set, scratch.path());
    let mut sections = Vec::new();
    for make in makers(&scenario, args.runs) {
        if stop::stop_requested() {
            return Err(CliError::Interrupted(String::new()));
        }
        sections.push(make(&runner)?);
    }
    let text = fs::read_to_string(&args.scenario).unwrap_or_default();
    let page = page::html(&scenario, &args.set, &text, &sections);
    files::write(&args.out, page.as_bytes(), true)?;
    let titles = |selected: fn(&ReportSection) -> bool| -> Vec<&str> {
        sections.iter().filter(|section| selected(section)).map(|section| section.title).collect()
    };
    let (failed, unmet) = (titles(ReportSection::is_refused), titles(ReportSection::is_unmet));
    say!("{} ({:.0} kB)", args.out.display(), page.len() as f64 / 1e3);
    if !failed.is_empty() {
        say!("  without numbers, with the reason on the page: {}", failed.join(", "));
    }
    if unmet.is_empty() {
        return Ok(());
    }
    Err(CliError::Requirements(format!("{}: not met or not proved: {}", scenario.name, unmet.join(", "))))
}

/// Function that makes a section.
type Maker = Box<dyn Fn(&ReportRunner<'_>) -> Result<ReportSection, CliError>>;

/// Returns the makers of the sections of a scenario.
fn makers(scenario: &Scenario, runs: u64) -> Vec<Maker> {
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
            let intro = "Noise of the measured angles and of lines of sight, exact from the closed loop: rms by source, \
                         spectral density with cumulative rms, and the lines of unbalanced wheels.";
            runner.printed("Noise", intro, &["spectrum"], Some("spectrum"))
        }),
        Box::new(|runner| {
            let intro = "A run of the scenario as it is, with its metrics and verdicts.";
            runner.simulated("One run", intro)
        }),
    ];
    if !scenario.bound.is_empty() {
        makers.push(Box::new(|runner| {
            let intro =
                "Guaranteed ranges of outputs over sets of initial states, inputs, frequencies and damping ratios.";
            runner.printed("Guaranteed ranges", intro, &["bound"], Some("bound"))
        }));
    }
    if runs > 0 && !scenario.requirement.is_empty() {
        makers.push(Box::new(move |runner| {
            let intro = "Levels of the pointing indices of the requirements: by a campaign, by convolution of the error \
                         sources, and by the rule of k sigma.";
            let count = runs.to_string();
            runner.printed("Pointing budget", intro, &["budget", "--runs", &count], Some("budget"))
        }));
    }
    if runs > 0 && !scenario.uncertain.is_empty() {
        makers.push(Box::new(|runner| {
            let intro = "The least modulus margin that a search over the uncertain keys finds, with the loop cut open at the \
                         commands of the law.";
            runner.printed("Least margins", intro, &["worst", "--margin", "modulus"], Some("least-margin"))
        }));
    }
    if runs > 0 && !scenario.uncertain.is_empty() && !scenario.study.requirements.is_empty() {
        makers.push(Box::new(move |runner| {
            let intro = "The worst case of each requirement that a search over the uncertain keys finds: a witness, not a \
                         proof.";
            let count = runs.to_string();
            runner.printed("Worst case", intro, &["worst", "--points", &count], Some("worst"))
        }));
    }
    if runs > 0 {
        makers.push(Box::new(move |runner| {
            let intro = "Runs with other noise, and with the uncertain keys drawn anew for each.";
            runner.campaign("Campaign", intro, runs)
        }));
    }
    makers
}
