//! `flexsc merge`: parts of one campaign that several machines made, in one directory.

use std::io::Write;
use std::path::PathBuf;

use flexsc_core::campaign::{Directory, DirectoryError, MANIFEST};
use flexsc_core::count::counted;

use crate::campaign::{self, parts};
use crate::failure::Failure;
use crate::{say, stop};

#[derive(clap::Args)]
pub struct Args {
    /// Directories with parts of one campaign
    #[arg(required = true, value_name = "DIR")]
    directories: Vec<PathBuf>,
    /// Directory for all runs, created if missing
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
}

pub fn run(args: &Args) -> Result<(), Failure> {
    let all = args.directories.iter().map(|path| Directory::open(path).map_err(parts::failure));
    let all = all.collect::<Result<Vec<_>, _>>()?;
    let mut manifest = all[0].work().manifest.clone();
    // All are of one campaign before anything is written.
    for other in &all {
        let there = &other.work().manifest;
        if let Some(difference) = there.difference(&manifest) {
            let path = other.path().join(MANIFEST);
            return Err(parts::failure(DirectoryError::Other { path, difference }));
        }
        manifest.from = manifest.from.min(there.from);
        manifest.to = manifest.to.max(there.to);
    }
    let _writing = stop::writing();
    let into = Directory::create(&args.out, manifest, false).map_err(parts::failure)?;
    for other in &all {
        let new = into.take(other).map_err(parts::failure)?;
        say!("{}: {}", other.path().display(), counted(new, "run"));
    }
    let left: u64 = into.missing().map_err(parts::failure)?.iter().map(|runs| runs.end - runs.start).sum();
    let told = parts::told(&into)?;
    say!("{}: {}, {left} missing", args.out.display(), counted(told.runs, "run"));
    campaign::tell_statistics(&told.statistics, &into.work().campaign.design().keys(), told.runs);
    Ok(())
}
