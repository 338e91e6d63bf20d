//! `flexsc merge`: merges the parts of a campaign that several machines made, into one directory or file.

use std::io::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};

use flexsc_core::campaign::{Directory, Merge};
use flexsc_core::formats::count::counted;

use crate::answer::AnswerArgs;
use crate::campaign::{TableFormat, file, part_files};
use crate::error::CliError;
use crate::out::Out;
use crate::{files, say, stop};

/// Largest number of missing ranges that are printed.
const MAX_LISTED: usize = 8;

#[derive(clap::Args)]
pub struct MergeArgs {
    /// Directories with parts of one campaign
    #[arg(required = true, value_name = "DIR")]
    directories: Vec<PathBuf>,
    /// Directory for all runs, created if missing, or FILE.csv or FILE.parquet
    #[arg(short, long, value_name = "DIR|FILE")]
    out: PathBuf,
    /// Replace another campaign, or a FILE that exists
    #[arg(long)]
    force: bool,
}

pub fn run(args: &MergeArgs) -> Result<(), CliError> {
    let out = Out::new(&args.out, &TableFormat::ENDINGS, &[])?;
    let open = |path: &Path| Directory::open(path).map_err(part_files::failure);
    let mut all = args.directories.iter().map(|path| open(path)).collect::<Result<Vec<_>, _>>()?;
    // The existing target comes first, unless it is another campaign that is replaced.
    let mut is_first = false;
    if let Out::Directory(path) = &out
        && Directory::is_campaign_directory(path)
    {
        let existing = open(path)?;
        let differs = existing.work().manifest.first_difference(&all[0].work().manifest).is_some();
        if !(args.force && differs) {
            all.insert(0, existing);
            is_first = true;
        }
    }
    let merge = Merge::new(&all).map_err(part_files::failure)?;
    let missing = merge.missing();
    let report_taken = || {
        for (directory, count) in all.iter().zip(merge.used_counts()).skip(usize::from(is_first)) {
            say!("{}: {}", directory.path().display(), counted(count, "run"));
        }
    };
    let _writing = stop::writing();
    match &out {
        Out::File(path, ending) => {
            if !missing.is_empty() {
                return Err(incomplete(&missing, "an incomplete campaign has no file"));
            }
            files::refuse_existing(path, args.force)?;
            file::validate_size(path, &merge)?;
            let rows = merge.rows().map_err(part_files::failure)?;
            file::write(path, TableFormat::for_ending(ending), merge.work(), &rows)?;
            report_taken();
            say!("{}: {}", path.display(), counted(rows.len(), "run"));
        }
        Out::Directory(path) => {
            let into =
                Directory::create(path, merge.manifest().clone(), args.force).map_err(part_files::failure)?;
            merge.write(&into, is_first).map_err(part_files::failure)?;
            report_taken();
            let remaining: u64 = missing.iter().map(|runs| runs.end - runs.start).sum();
            let reported = part_files::summary(&into, &merge.manifest().runs())?;
            say!("{}: {}, {remaining} missing", path.display(), counted(reported.runs, "run"));
            let args = AnswerArgs::default();
            let scenario = merge.work().campaign.scenario();
            if !reported.say_points(&scenario.name, None) {
                reported.say(&reported.answer(scenario, args), None, args);
            }
            if !missing.is_empty() {
                return Err(incomplete(
                    &missing,
                    &format!("merge their directory into {} too", path.display()),
                ));
            }
        }
    }
    Ok(())
}

fn incomplete(missing: &[Range<u64>], hint: &str) -> CliError {
    let reported: Vec<String> =
        missing.iter().take(MAX_LISTED).map(|runs| format!("{}:{}", runs.start, runs.end)).collect();
    let more = if missing.len() > MAX_LISTED { ", ..." } else { "" };
    CliError::Incomplete(format!("runs {}{more} are missing\n\nhint: {hint}", reported.join(", ")))
}
