//! Figures of a campaign's directory, and its worst runs.

mod curve;
mod distribution;
mod fan;
mod parts;
mod region;
mod scatter;
mod table;
mod worst;

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

use flexsc_core::campaign::{ColumnCells, Work};
use flexsc_figure::{Figure, Named};

use super::Args;
use super::what::{What, chosen};
use crate::campaign::MAIN;
use crate::drawing::Target;
use crate::failure::Failure;
use crate::{print, say};
use table::{Metric, Runs};

/// Largest number of metrics that are drawn if none is named.
const MOST: usize = 4;
/// Number of worst runs that are listed for each metric.
const WORST: usize = 3;

pub fn run(args: &Args) -> Result<(), Failure> {
    let directory = args.path.as_path();
    let target = Target::new(args.out.as_deref().unwrap_or(directory), args.format, &[], args.force)?;
    let files = files(directory)?;
    let mut tables = table::read(directory, &files)?;
    tables.extend(parts::read(directory, &files, &args.metric)?);
    let fans = if args.what.is_empty() || args.what.contains(&What::Fan) {
        fan::logs(directory, &files, tables.is_empty() || !args.what.is_empty())?
    } else {
        BTreeMap::new()
    };
    if tables.is_empty() && fans.is_empty() {
        return Err(Failure::Arguments(format!(
            "{}: no campaign, neither parts nor a table `runs.csv`, and not several logs of one scenario\n\n\
             hint: `flexsc simulate SCENARIO --runs 1000 -o {}` makes one",
            directory.display(),
            directory.display()
        )));
    }
    let mut there: Vec<What> = tables.iter().flat_map(drawable).collect();
    there.extend((!fans.is_empty()).then_some(What::Fan));
    let all = chosen(&args.what, &there).map_err(|(missing, there)| {
        let path = directory.display();
        Failure::Arguments(format!("{path}: there is no figure `{missing}` for it\n\nhint: it has {there}"))
    })?;
    let mut figures = Vec::new();
    for runs in &tables {
        let metrics = metrics(&args.metric, &args.path, runs)?;
        let natural = natural(runs);
        let wanted = |what: &&What| !args.what.is_empty() || natural.contains(what);
        for what in drawable(runs).iter().filter(|what| all.contains(what)).filter(wanted) {
            figures.extend(drawn(*what, runs, &metrics));
        }
        let listed = if args.json { worst::lines } else { worst::table };
        let worst = args.worst.unwrap_or(WORST);
        if worst > 0 {
            print(listed(runs, directory, &metrics, worst).as_bytes())?;
        }
        if runs.scenario.is_none() && !args.json {
            say!(
                "{}: no scenario.toml beside the table: no run can be repeated from it",
                directory.display()
            );
        }
    }
    for (name, paths) in &fans {
        figures.push((format!("{name}-fan"), fan::figure(name, paths)?));
    }
    if figures.is_empty() {
        return Err(Failure::Arguments(format!(
            "{}: no metric varies from run to run\n\nhint: --metric NAME draws one anyway",
            directory.display()
        )));
    }
    target.save(&figures, args.style()?, args.json)
}

/// Returns figures of a campaign from its columns: of one kind, or the default ones.
pub fn of_columns(
    work: &Work,
    column: &dyn Fn(&str) -> Option<ColumnCells>,
    kind: Option<What>,
    metric: &[String],
) -> Result<Vec<Named>, Failure> {
    let path = Path::new(&work.campaign.scenario().name);
    let read = |names: &[&str]| Ok(names.iter().map(|name| column(name)).collect());
    of_runs(&parts::of(work, read, path, metric)?, kind.as_slice(), metric, path)
}

/// Returns the figures of the campaigns in a directory, and of its logs.
pub fn of_directory(directory: &Path, kinds: &[What], metric: &[String]) -> Result<Vec<Named>, Failure> {
    let files = files(directory)?;
    let mut tables = table::read(directory, &files)?;
    tables.extend(parts::read(directory, &files, metric)?);
    let mut figures = Vec::new();
    if kinds.is_empty() || kinds.iter().any(|kind| *kind != What::Fan) {
        for runs in &tables {
            figures.extend(of_runs(runs, kinds, metric, directory)?);
        }
    }
    if kinds.is_empty() || kinds.contains(&What::Fan) {
        for (name, paths) in fan::logs(directory, &files, false)? {
            figures.push((format!("{name}-fan"), fan::figure(&name, &paths)?));
        }
    }
    Ok(figures)
}

fn of_runs(runs: &Runs, kinds: &[What], metric: &[String], path: &Path) -> Result<Vec<Named>, Failure> {
    let (metrics, natural, all) = (metrics(metric, path, runs)?, natural(runs), drawable(runs));
    let kinds = if kinds.is_empty() { &natural } else { kinds };
    if let Some(missing) = kinds.iter().find(|kind| !all.contains(kind)) {
        let names: Vec<_> = all.iter().map(|what| what.name()).collect();
        return Err(Failure::Arguments(format!(
            "{}: there is no figure `{}` for it\n\nhint: it has {}",
            path.display(),
            missing.name(),
            names.join(", ")
        )));
    }
    Ok(all.iter().filter(|what| kinds.contains(what)).flat_map(|what| drawn(*what, runs, &metrics)).collect())
}

/// Returns the sorted names of the files in a directory.
fn files(directory: &Path) -> Result<Vec<String>, Failure> {
    let unread = |error: std::io::Error| Failure::Arguments(format!("{}: {error}", directory.display()));
    let entries =
        std::fs::read_dir(directory).map_err(unread)?.collect::<Result<Vec<_>, _>>().map_err(unread)?;
    let mut names: Vec<String> =
        entries.into_iter().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    Ok(names)
}

/// Returns the kinds of figures that a table has data for.
fn drawable(runs: &Runs) -> Vec<What> {
    let swept = runs.swept().len();
    [
        (What::Curve, swept == 1),
        (What::Region, swept == 2),
        (What::Distribution, true),
        (What::Scatter, !scatter::keys(runs).is_empty()),
    ]
    .into_iter()
    .filter_map(|(what, is)| is.then_some(what))
    .collect()
}

/// Returns the kinds of figures that are drawn if none is named.
fn natural(runs: &Runs) -> Vec<What> {
    let wanted = match runs.swept().len() {
        1 => vec![What::Curve],
        2 => vec![What::Region],
        _ => vec![What::Distribution, What::Scatter],
    };
    let drawable = drawable(runs);
    wanted.into_iter().filter(|what| drawable.contains(what)).collect()
}

/// Returns the named metrics, or else the main ones that vary.
fn metrics<'a>(asked: &[String], path: &Path, runs: &'a Runs) -> Result<Vec<&'a Metric>, Failure> {
    let named = |name: &str| runs.metrics.iter().find(|metric| metric.meaning.name == name);
    if asked.is_empty() {
        // A metric that only repeats a key is left out.
        let tells =
            |metric: &&Metric| metric.varies() && runs.keys.iter().all(|key| key.values != metric.values);
        // A required metric comes first.
        let required = runs.requirement().map(|(name, _)| name);
        let others = MAIN.into_iter().filter(|name| Some(*name) != required);
        let main: Vec<_> = required.into_iter().chain(others).filter_map(named).filter(tells).collect();
        let any = runs.metrics.iter().filter(tells);
        let found: Vec<_> = if main.is_empty() { any.collect() } else { main };
        return Ok(found.into_iter().take(MOST).collect());
    }
    let metric = |name: &String| {
        named(name).ok_or_else(|| {
            let names: Vec<_> = runs.metrics.iter().map(|metric| metric.meaning.name).collect();
            let (path, names) = (path.display(), names.join(", "));
            Failure::Arguments(format!(
                "{path}: there is no metric `{name}` that is a number\n\nhint: it has {names}"
            ))
        })
    };
    asked.iter().map(metric).collect()
}

/// Returns the figures of a kind, with their names.
fn drawn(what: What, runs: &Runs, metrics: &[&Metric]) -> Vec<(String, Figure)> {
    let name = |metric: &Metric| format!("{}-{}-{}", runs.name, what.name(), metric.meaning.name);
    let each = |figure: &dyn Fn(&Metric) -> Option<Figure>| {
        metrics.iter().filter_map(|metric| Some((name(metric), figure(metric)?))).collect()
    };
    match what {
        What::Distribution => each(&|metric| Some(distribution::figure(runs, metric))),
        What::Scatter => each(&|metric| Some(scatter::figure(runs, metric))),
        What::Region => each(&|metric| region::figure(runs, metric)),
        What::Curve => {
            let key = runs.swept().into_iter().next().filter(|_| !metrics.is_empty());
            let curve = key.map(|key| curve::figure(runs, metrics, key));
            curve.map(|figure| (format!("{}-{}", runs.name, what.name()), figure)).into_iter().collect()
        }
        _ => Vec::new(),
    }
}
