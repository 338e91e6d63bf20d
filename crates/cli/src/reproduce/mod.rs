//! `flexsc reproduce`: every figure and number of the papers, on one HTML page, and in Markdown for the site.

mod command;
mod command_output;
mod command_runner;
#[cfg(test)]
mod doc_numbers;
mod draw;
mod shipped_scenarios;

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::Instant as WallInstant;

use clap::ValueEnum;
use flexsc_papers::{Computed, Drawn, Filled, Paper, Section, Verdict, documentation, html};
use indicatif::ProgressBar;
use rayon::prelude::*;

use crate::error::CliError;
use crate::out::Out;
use crate::{files, progress, say, stop};
use command_runner::CommandRunner;

#[derive(clap::Args)]
pub struct ReproduceArgs {
    /// The paper [default: all of them]
    #[arg(value_enum)]
    paper: Option<Paper>,
    /// Page to write: FILE.html, or papers.html in a directory, created if missing
    #[arg(short, long, value_name = "DIR|FILE")]
    out: PathBuf,
    /// Also write the same as papers.md of the documentation, with its figures images/NAME.svg, into this directory
    #[arg(long, value_name = "DIR")]
    docs: Option<PathBuf>,
    /// Replace a FILE that exists
    #[arg(long)]
    force: bool,
}

pub fn run(args: &ReproduceArgs) -> Result<(), CliError> {
    let began = WallInstant::now();
    let page = args.docs.as_ref().map(|docs| docs.join("papers.md"));
    if let Some(page) = page.filter(|page| args.paper.is_some() && page.exists()) {
        let page = page.display();
        return Err(CliError::Arguments(format!(
            "--docs: {page} has a section of each paper: leave PAPER out"
        )));
    }
    let out = match Out::new(&args.out, &["html"], &[])? {
        Out::Directory(out) => out.join("papers.html"),
        Out::File(out, _) => {
            files::refuse_existing(&out, args.force)?;
            out
        }
    };
    files::make_parent(&out)?;
    args.docs.as_ref().map_or(Ok(()), |docs| files::make_directory(docs))?;
    // The target is checked before two minutes of computing.
    find_room(&out)?;
    args.docs.as_ref().map_or(Ok(()), |docs| find_room(&docs.join("papers.md")))?;
    let papers = args.paper.as_ref().map_or(Paper::value_variants(), std::slice::from_ref);
    let bar = progress::spinner();
    let filled = papers.par_iter().map(|paper| fill(*paper, &bar)).collect::<Result<Vec<_>, _>>();
    bar.finish_and_clear();
    if stop::stop_requested() {
        return Err(CliError::Interrupted(String::new()));
    }
    let (sections, markdown): (Vec<Section>, Vec<String>) =
        filled?.into_iter().map(|filled| (filled.section, filled.markdown)).unzip();
    let took = began.elapsed().as_secs_f64();
    let page = html::page(&sections, took, rayon::current_num_threads());
    let mut pages = vec![(out, page.into_bytes())];
    if let Some(docs) = &args.docs {
        pages.push((docs.join("papers.md"), documentation(&markdown).into_bytes()));
        let images = docs.join("images");
        files::make_directory(&images)?;
        let drawn = sections.iter().flat_map(|section| &section.outcome.figures);
        pages.extend(
            drawn.map(|Drawn { name, svg, .. }| {
                (images.join(format!("{name}.svg")), svg.clone().into_bytes())
            }),
        );
    }
    files::write_within(&pages)?;
    for (path, bytes) in pages.iter().take(1 + args.docs.iter().count()) {
        say!("{} ({:.0} kB)", path.display(), bytes.len() as f64 / 1e3);
    }
    let all = || sections.iter().flat_map(|section| &section.outcome.verdicts);
    say!("{} verdicts in {took:.1} s", all().count());
    let reported = |verdict: &Verdict| {
        let known = if verdict.expected { "yes" } else { "no" };
        format!("{}: {}, known as {known}", verdict.name, verdict.word())
    };
    let unexpected: Vec<String> = all().filter(|verdict| !verdict.is_as_expected()).map(reported).collect();
    if unexpected.is_empty() { Ok(()) } else { Err(CliError::Verdicts(unexpected)) }
}

/// Computes the section of a paper.
fn fill(paper: Paper, bar: &ProgressBar) -> Result<Filled, CliError> {
    let (bar, name) = (bar.clone(), paper.name());
    let computed = Computed::new(CommandRunner, move |command: &str| {
        bar.set_message(format!("{name}: {command}"));
        bar.tick();
    });
    flexsc_papers::fill(paper, computed).map_err(CliError::Page)
}

/// Disk space for a page with its figures (bytes), well above its size of about 2 MB.
const ROOM: usize = 16 << 20;

/// Checks that a page can be written: that an existing file may be replaced, and that there is disk space.
fn find_room(path: &Path) -> Result<(), CliError> {
    if let Ok(metadata) = std::fs::metadata(path) {
        let kind = match metadata.is_file() {
            true if metadata.permissions().readonly() => Some(ErrorKind::PermissionDenied),
            false if metadata.is_dir() => Some(ErrorKind::IsADirectory),
            _ => None,
        };
        kind.map_or(Ok(()), |kind| Err(CliError::write(path)(kind.into())))?;
    }
    let mut room = path.as_os_str().to_owned();
    room.push(format!(".room.{}", std::process::id()));
    let room = PathBuf::from(room);
    let made = OpenOptions::new().write(true).create_new(true).open(&room);
    let filled = made.and_then(|mut file| {
        let block = vec![0; 1 << 20];
        (0..ROOM / block.len()).try_for_each(|_| file.write_all(&block))?;
        file.sync_data()
    });
    // A file that cannot be removed is left behind.
    let _ = std::fs::remove_file(&room);
    filled.map_err(|source| {
        let why = format!("{source} ({} MB are looked for before it is computed)", ROOM >> 20);
        CliError::write(path)(std::io::Error::new(source.kind(), why))
    })
}
