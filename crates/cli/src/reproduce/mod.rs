//! `flexsc reproduce`: every figure and number of the papers, on one HTML page, and in docs/papers.md.

mod chart;
mod command;
mod computed;
mod draw;
mod html;
mod number;
mod page;
mod paper;
mod shipped;
mod tell;
mod verdict;

use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant as WallInstant;

use clap::ValueEnum;
use indicatif::ProgressBar;
use rayon::prelude::*;

use crate::failure::Failure;
use crate::{files, progress, say, stop};
use computed::Computed;
use html::Section;
use page::{Drawn, Form, Outcome};
use paper::Paper;

#[derive(clap::Args)]
pub struct Args {
    /// The paper [default: all of them]
    #[arg(value_enum)]
    paper: Option<Paper>,
    /// Directory for papers.html, made if it is not there
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    /// Also write the same as papers.md of the documentation, with its figures images/NAME.svg, into this directory
    #[arg(long, value_name = "DIR")]
    docs: Option<PathBuf>,
}

/// A paper's section in both forms.
struct Filled {
    section: Section,
    markdown: String,
}

pub fn run(args: &Args) -> Result<(), Failure> {
    let began = WallInstant::now();
    let page = args.docs.as_ref().map(|docs| docs.join("papers.md"));
    if let Some(page) = page.filter(|page| args.paper.is_some() && page.exists()) {
        let page = page.display();
        return Err(Failure::Arguments(format!(
            "--docs: {page} has a section of each paper: leave PAPER out"
        )));
    }
    for directory in std::iter::once(&args.out).chain(&args.docs) {
        files::make_directory(directory)?;
    }
    let papers = args.paper.as_ref().map_or(Paper::value_variants(), std::slice::from_ref);
    let bar = progress::spinner();
    let filled = papers.par_iter().map(|paper| fill(*paper, &bar)).collect::<Result<Vec<_>, _>>();
    bar.finish_and_clear();
    if stop::asked() {
        return Err(Failure::Interrupted(String::new()));
    }
    let (sections, markdown): (Vec<Section>, Vec<String>) =
        filled?.into_iter().map(|filled| (filled.section, filled.markdown)).unzip();
    let took = began.elapsed().as_secs_f64();
    let mut pages = vec![(args.out.join("papers.html"), html::page(&sections, took).into_bytes())];
    if let Some(docs) = &args.docs {
        let text = format!("{HEAD}\n{}", markdown.join("\n"));
        pages.push((docs.join("papers.md"), text.into_bytes()));
        let images = docs.join("images");
        files::make_directory(&images)?;
        let drawn = sections.iter().flat_map(|section| &section.outcome.figures);
        pages.extend(
            drawn.map(|Drawn { name, svg, .. }| {
                (images.join(format!("{name}.svg")), svg.clone().into_bytes())
            }),
        );
    }
    files::write_all(&pages)?;
    for (path, bytes) in pages.iter().take(1 + args.docs.iter().count()) {
        say!("{} ({:.0} kB)", path.display(), bytes.len() as f64 / 1e3);
    }
    let all = || sections.iter().flat_map(|section| &section.outcome.verdicts);
    say!("{} verdicts in {took:.1} s", all().count());
    let told = |verdict: &verdict::Verdict| {
        let known = if verdict.expected { "yes" } else { "no" };
        format!("{}: {}, known as {known}", verdict.name, verdict.word())
    };
    let unexpected: Vec<String> = all().filter(|verdict| !verdict.is_as_expected()).map(told).collect();
    if unexpected.is_empty() { Ok(()) } else { Err(Failure::Verdicts(unexpected)) }
}

const HEAD: &str = "# What the papers say, and what we measure\n\n\
    <!-- Written by `flexsc reproduce -o . --docs docs` from crates/cli/src/reproduce/papers: change it there. -->\n";

/// Computes a paper's section.
fn fill(paper: Paper, bar: &ProgressBar) -> Result<Filled, Failure> {
    let (bar, name) = (bar.clone(), paper.name());
    let computed = Arc::new(Computed::new(move |command: &str| {
        bar.set_message(format!("{name}: {command}"));
        bar.tick();
    }));
    let form = |form: Form| -> Result<(String, Outcome), Failure> {
        page::fill(&computed, paper.template(), form).map_err(|failure| match failure {
            Failure::Page(why) => Failure::Page(format!("{}.md: {why}", paper.name())),
            other => other,
        })
    };
    let (text, outcome) = form(Form::Html)?;
    let (markdown, _) = form(Form::Markdown)?;
    Ok(Filled { section: Section { name: paper.name(), text, outcome, times: computed.times() }, markdown })
}
