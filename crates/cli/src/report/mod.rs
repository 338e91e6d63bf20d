//! `flexsc report`: one page for a design review, made from the structures of the other verbs, with the command that repeats each
//! block.

mod assumptions;
mod campaign_block;
mod conclusions;
mod craft_block;
mod editable_study;
mod html;
mod loop_blocks;
mod margins_block;
mod mode_analysis;
mod mode_block;
mod model_block;
mod noise_block;
mod page;
mod requirement_block;
mod study;
mod time_line;
mod watch;

use std::io::Write;
use std::path::PathBuf;

use flexsc_core::answer::RunVerdict;

pub use editable_study::EditableStudy;

use crate::error::CliError;
use crate::human::Units;
use crate::{bound, files, out, progress, say, stop};
use page::Review;
use study::{CampaignSource, Study};

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
    /// Number of runs of the campaign; 0 leaves it out [default: 100, or those in DIR]
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(..=MOST_RUNS))]
    runs: Option<u64>,
    /// Directory of the campaign, as of `simulate --runs N -o DIR`: all of its runs are used, and missing ones are added
    #[arg(long, value_name = "DIR")]
    campaign: Option<PathBuf>,
    /// Write the page again, without the campaign, each time the scenario file is saved, until Ctrl-C; an open page reloads itself
    #[arg(long, conflicts_with_all = ["runs", "campaign"])]
    watch: bool,
    /// Replace a FILE of other content
    #[arg(long)]
    force: bool,
}

/// Page with what it found.
struct FinishedPage {
    html: String,
    /// Titles of blocks without numbers.
    refused: Vec<&'static str>,
    /// Requirements that are not met, and claims that are not proved.
    unmet: Vec<String>,
}

pub fn run(args: &ReportArgs) -> Result<(), CliError> {
    if out::file(&args.out, &["html"], &[&args.scenario])? != "html" {
        return Err(CliError::Arguments(format!("-o {}: must end in .html", args.out.display())));
    }
    files::refuse_existing(&args.out, args.force)?;
    let _files = stop::writing();
    if args.watch {
        return watch::run(args);
    }
    let study = Study::load(&args.scenario, &args.set)?;
    let directory = args.campaign.as_deref();
    let source = match args.runs {
        Some(0) if directory.is_some() => {
            let why = "--runs 0 leaves the campaign out, and --campaign names its directory";
            return Err(CliError::Arguments(why.to_owned()));
        }
        Some(0) => None,
        runs => Some(CampaignSource { runs, directory }),
    };
    let page = finished(&study, source, String::new())?;
    files::write(&args.out, page.html.as_bytes(), true)?;
    say!("{} ({:.0} kB)", args.out.display(), page.html.len() as f64 / 1e3);
    if !page.refused.is_empty() {
        say!("  without numbers, with the reason on the page: {}", page.refused.join(", "));
    }
    if page.unmet.is_empty() {
        return Ok(());
    }
    Err(CliError::Requirements(format!("{}: {}", study.scenario.name, page.unmet.join("; "))))
}

/// Computes the page of a study, with or without a campaign.
fn finished(
    study: &Study,
    source: Option<CampaignSource<'_>>,
    script: String,
) -> Result<FinishedPage, CliError> {
    progress::begin_stage("the run");
    let run = study.run()?;
    // A page that is watched is to be there soon.
    let loops = loop_blocks::blocks(study, script.is_empty())?;
    let bounds = if study.scenario.bound.is_empty() {
        None
    } else {
        Some(bound::claims(&study.scenario, Units::default())?)
    };
    progress::begin_stage("the campaign");
    let campaign = source.map(|source| study.campaign(source, &run.answer)).transpose()?;
    let mut unmet = Vec::new();
    if run.answer.verdict == RunVerdict::Failed || run.answer.verdict == RunVerdict::Missed {
        unmet.push(run.answer.verdict_text.clone());
    }
    let runs_verdict =
        campaign.as_ref().map(|own| &own.answer).filter(|own| own.verdict == RunVerdict::Missed);
    unmet.extend(runs_verdict.map(|own| own.verdict_text.clone()));
    let refuted = bounds.as_ref().map_or(0, bound::OutputBounds::failed);
    if refuted > 0 {
        unmet.push(format!("{refuted} of the claims not proved"));
    }
    progress::begin_stage("the figures");
    let refused = loops.refused.clone();
    let review = Review { study, run: &run, campaign: campaign.as_ref(), loops, bounds, script };
    Ok(FinishedPage { html: page::html(&review), refused, unmet })
}
